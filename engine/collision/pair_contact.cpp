#include "engine/collision/pair_contact.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "engine/collision/bullet_sweep.hpp"

namespace handhold {
namespace {

// b as one convex core, in near space.
Convex place_b(const PairIo& io) { return io.b->at({-io.to_bs.position, Quat::Identity()}); }

// What may be sunk by the end of the way without a stop on it: contacts at the end push that back
// whole. Small against both bodies, and enough that a body that slides over a floor is not stopped
// by the floor before it gets to the wall.
double graze_m(const PairIo& io) {
    double least = std::min(io.limits.sweep_m, io.a.thinnest_half_m());
    if (io.b != nullptr) {
        least = std::min(least, io.b->thinnest_half_m());
    }
    return 0.1 * least;
}

bool stops(const Impact& impact, const RelativeMotion& motion, const Vec3& normal, double graze) {
    const double velocity = motion.velocity_at(impact.point_b_ns, impact.fraction).dot(normal);
    return -velocity * (1.0 - impact.fraction) > graze;
}

std::optional<Impact> first_impact_on_mesh(const PairIo& io, const RelativeMotion& motion) {
    const double graze = graze_m(io);
    std::optional<Impact> first;
    for (const NearTriangle& triangle : io.triangles) {
        const Convex b = io.scratch.triangle.place(triangle.corners_ns, triangle.normal);
        auto impact = time_of_impact(io.a, motion, b, first ? first->fraction : 1.0);
        if (!impact || (first && impact->fraction >= first->fraction)) {
            continue;
        }
        // An internal edge's bent normal would stop what only slides over it: there the face
        // decides.
        if (!in_normal_cone(io.triangles, impact->point_b_ns, impact->normal)) {
            const bool in_front =
                (motion.from_ns() - triangle.corners_ns[0]).dot(triangle.normal) >= 0.0;
            impact->normal = in_front ? triangle.normal : Vec3(-triangle.normal);
        }
        if (stops(*impact, motion, impact->normal, graze)) {
            first = impact;
        }
    }
    return first;
}

std::optional<Impact> first_impact(const PairIo& io, const RelativeMotion& motion) {
    const double displacement_m =
        motion.move().norm() + motion.turn_rad().norm() * io.a.bounding_radius_m();
    if (displacement_m <= io.limits.sweep_m) {
        return std::nullopt;
    }
    if (io.b == nullptr) {
        return first_impact_on_mesh(io, motion);
    }
    const auto impact = time_of_impact(io.a, motion, place_b(io), 1.0);
    return impact && stops(*impact, motion, impact->normal, graze_m(io)) ? impact : std::nullopt;
}

void add_contacts_at(const PairIo& io, const Pose& pose_ns, const Vec3& from_ns) {
    const Convex a = io.a.at(pose_ns);
    PairScratch& scratch = io.scratch;
    if (io.b == nullptr) {
        add_mesh_contacts({a, io.a.core_reach_m(), from_ns, io.triangles, io.limits.margin_m,
                           scratch.triangle, scratch.clip, scratch.contacts});
        return;
    }
    const Convex b = place_b(io);
    add_manifold(a, b, separate(a, b), io.limits.margin_m, scratch.clip, scratch.contacts);
}

}  // namespace

void find_pair_contacts(const PairIo& io) {
    const Pose from_ns{io.from_bs.position - io.to_bs.position, io.from_bs.rotation};
    const Pose to_ns{Vec3::Zero(), io.to_bs.rotation};
    const RelativeMotion motion(from_ns, to_ns);
    const std::optional<Impact> impact = first_impact(io, motion);
    const Pose pose_ns = impact ? motion.at(impact->fraction) : to_ns;

    io.scratch.contacts.clear();
    add_contacts_at(io, pose_ns, from_ns.position);
    if (impact && io.scratch.contacts.empty()) {
        io.scratch.contacts.push_back(
            {impact->point_b_ns, impact->point_b_ns, impact->normal, 0.0});
    }
    reduce_contacts(io.scratch.contacts, io.scratch.spare);

    std::uint32_t feature = 0;
    for (const NearContact& near : io.scratch.contacts) {
        ContactPoint contact;
        contact.point_a_bs = inverse_transform_point(pose_ns, near.point_a_ns);
        contact.point_b_bs = near.point_b_ns + io.to_bs.position;
        contact.normal_b_bs = near.normal_ns;
        // At to_ws, whatever the pose of first touch: the plane of the contact stays where it was
        // met.
        contact.separation_m =
            near.normal_ns.dot(transform_point(to_ns, contact.point_a_bs) - near.point_b_ns);
        if (contact.separation_m < io.limits.margin_m) {
            contact.feature = feature++;
            io.contacts.push_back(contact);
        }
    }
}

}  // namespace handhold
