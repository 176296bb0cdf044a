#include "engine/collision/pair_contact.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "engine/collision/bullet_sweep.hpp"

namespace handhold {
namespace {

Convex place_b(const PairIo& io, const ConvexPart& part) {
    return part.at({-io.to_bs.position, Quat::Identity()});
}

// Grazing tolerance: an impact is ignored if less penetration than this follows by the end of the
// motion. The contacts at the end resolve that penetration. The tolerance is small compared with
// both bodies, yet large enough that a body sliding over a floor reaches the wall.
double grazing_tolerance_m(const PairIo& io, const ConvexPart& a, const ConvexPart* b) {
    double tolerance_m = std::min(io.limits.sweep_m, a.shape().thinnest_half_m());
    if (b != nullptr) {
        tolerance_m = std::min(tolerance_m, b->shape().thinnest_half_m());
    }
    return 0.1 * tolerance_m;
}

bool stops(const Impact& impact, const RelativeMotion& motion, const Vec3& normal,
           double grazing_m) {
    const double velocity = motion.velocity_at(impact.point_b_ns, impact.fraction).dot(normal);
    return -velocity * (1.0 - impact.fraction) > grazing_m;
}

void keep_earlier(const std::optional<Impact>& impact, std::optional<Impact>& first) {
    if (impact && (!first || impact->fraction < first->fraction)) {
        first = impact;
    }
}

// Comparison for a priority queue with the smallest fraction on top.
bool touches_later(const TriangleApproach& x, const TriangleApproach& y) {
    return x.approach.fraction != y.approach.fraction ? x.approach.fraction > y.approach.fraction
                                                      : x.triangle > y.triangle;
}

// At an internal edge, replaces the tilted normal by the face's, so that the edge does not stop a
// body that slides over it.
void straighten(const NearTriangles& triangles, const NearTriangle& triangle, const Vec3& from,
                Impact& impact) {
    if (!in_normal_cone(triangles, impact.point_b_ns, impact.normal)) {
        const bool in_front = (from - triangle.corners_ns[0]).dot(triangle.normal) >= 0.0;
        impact.normal = in_front ? triangle.normal : Vec3(-triangle.normal);
    }
}

// Always advances the triangle with the smallest fraction, so that none is advanced beyond the
// first impact.
std::optional<Impact> first_impact_on_mesh(const PairIo& io, const ConvexPart& a,
                                           const NearTriangles& triangles,
                                           const RelativeMotion& motion, double limit) {
    const double grazing_m = grazing_tolerance_m(io, a, nullptr);
    const Vec3 from = a.placed(motion.at(0.0)).position;
    const auto place = [&](std::uint32_t index) {
        const NearTriangle& triangle = triangles.all()[index];
        return io.scratch.triangle.place(triangle.corners_ns, triangle.normal);
    };
    std::vector<TriangleApproach>& queue = io.scratch.approaches;
    queue.clear();
    for (std::uint32_t i = 0; i < triangles.all().size(); ++i) {
        if (const auto approach = begin_approach(a, motion, place(i), {limit, grazing_m})) {
            queue.push_back({*approach, i});
        }
    }
    std::ranges::make_heap(queue, touches_later);
    while (!queue.empty()) {
        std::ranges::pop_heap(queue, touches_later);
        TriangleApproach& next = queue.back();
        const ApproachState state =
            advance(a, motion, place(next.triangle), {limit, grazing_m}, next.approach);
        if (state == ApproachState::continues) {
            std::ranges::push_heap(queue, touches_later);
            continue;
        }
        Impact impact = next.approach.impact;
        const NearTriangle& triangle = triangles.all()[next.triangle];
        queue.pop_back();
        if (state == ApproachState::touches) {
            straighten(triangles, triangle, from, impact);
            if (stops(impact, motion, impact.normal, grazing_m)) {
                return impact;
            }
        }
    }
    return std::nullopt;
}

// Radius about the body's origin that contains all parts.
double reach_m(std::span<const ConvexPart> parts) {
    double reach = 0.0;
    for (const ConvexPart& part : parts) {
        reach = std::max(reach, part.extent().radius_m);
    }
    return reach;
}

// First impact of any part of a with any part of b. nullopt if there is none or the displacement is
// too small to sweep.
std::optional<Impact> first_impact(const PairIo& io, const RelativeMotion& motion) {
    const double displacement_m = motion.move().norm() + motion.turn_rad().norm() * reach_m(io.a);
    if (displacement_m <= io.limits.sweep_m) {
        return std::nullopt;
    }
    std::optional<Impact> first;
    for (std::size_t i = 0; i < io.a.size(); ++i) {
        const ConvexPart& a = io.a[i];
        if (io.b.empty()) {
            const double limit = first ? first->fraction : 1.0;
            auto impact = first_impact_on_mesh(io, a, io.triangles[i], motion, limit);
            if (impact) {
                impact->part = static_cast<std::uint32_t>(i);
                keep_earlier(impact, first);
            }
        }
        for (const ConvexPart& b : io.b) {
            const double limit = first ? first->fraction : 1.0;
            const double grazing_m = grazing_tolerance_m(io, a, &b);
            auto impact = time_of_impact(a, motion, place_b(io, b), {limit, grazing_m});
            if (impact && stops(*impact, motion, impact->normal, grazing_m)) {
                impact->part = static_cast<std::uint32_t>(i);
                keep_earlier(impact, first);
            }
        }
    }
    return first;
}

// True if the bounding spheres are farther apart than the margin.
bool are_beyond_margin(const ConvexPart& a, const Convex& placed_a, const ConvexPart& b,
                       const Convex& placed_b, double margin_m) {
    const double reach = a.shape().bounding_radius_m() + b.shape().bounding_radius_m() + margin_m;
    return (placed_a.centre_ns() - placed_b.centre_ns()).norm() > reach;
}

void add_contacts_at(const PairIo& io, const Pose& pose_ns, const Pose& from_ns) {
    PairScratch& scratch = io.scratch;
    const double margin_m = io.limits.margin_m;
    for (std::size_t i = 0; i < io.a.size(); ++i) {
        const std::size_t before = scratch.contacts.size();
        const Convex a = io.a[i].at(pose_ns);
        if (io.b.empty()) {
            add_mesh_contacts({a, io.a[i].shape().core_reach_m(), io.a[i].placed(from_ns).position,
                               io.triangles[i], margin_m, scratch.triangle, scratch.clip,
                               scratch.contacts});
        }
        for (const ConvexPart& part : io.b) {
            const Convex b = place_b(io, part);
            if (are_beyond_margin(io.a[i], a, part, b, margin_m)) {
                continue;
            }
            if (const auto separation = separate_within(a, b, margin_m + a.radius_m + b.radius_m)) {
                add_manifold(a, b, *separation, margin_m, scratch.clip, scratch.contacts);
            }
        }
        for (std::size_t added = before; added < scratch.contacts.size(); ++added) {
            scratch.contacts[added].part = static_cast<std::uint32_t>(i);
        }
    }
}

// The deepest overlap of a part of a with b, as a separation <= 0.
double overlap_at_end(const PairIo& io, const Convex& a) {
    double least_m = 0.0;
    for (const ConvexPart& part : io.b) {
        const Convex b = place_b(io, part);
        const double radii_m = a.radius_m + b.radius_m;
        if (const auto separation = separate_within(a, b, radii_m)) {
            least_m = std::min(least_m, separation->separation_m - radii_m);
        }
    }
    return least_m;
}

// After the touch, a may continue to rotate, as a rolling ball does, so that points that did not
// touch become the deepest. For each contact plane found at `touch_ns`, adds a's deepest point at
// `to_ns`. A point beyond b's radius is beside b, where only the plane is: it counts only as deep
// as a and b then overlap, because a wall that a small rotating b touches would seem to reach far
// behind it.
void add_deepest_at_end(const PairIo& io, const Pose& touch_ns, const Pose& to_ns) {
    std::vector<NearContact>& contacts = io.scratch.contacts;
    const auto depth_at_end = [&](const NearContact& contact) {
        const Vec3 point_a_bs = inverse_transform_point(touch_ns, contact.point_a_ns);
        return contact.normal_ns.dot(transform_point(to_ns, point_a_bs) - contact.point_b_ns);
    };
    constexpr double k_deeper_m = 1e-6;
    constexpr double k_same_normal = 0.9999;
    const std::size_t met = contacts.size();
    for (std::size_t i = 0; i < met; ++i) {
        const NearContact plane = contacts[i];
        const Convex a = io.a[plane.part].at(to_ns);
        const Vec3 deepest = a.support(-plane.normal_ns) - a.radius_m * plane.normal_ns;
        double separation_m = plane.normal_ns.dot(deepest - plane.point_b_ns);
        const bool is_known = std::ranges::any_of(contacts, [&](const NearContact& other) {
            return other.normal_ns.dot(plane.normal_ns) > k_same_normal &&
                   depth_at_end(other) < separation_m + k_deeper_m;
        });
        const Vec3 point_b_bs = deepest - separation_m * plane.normal_ns + io.to_bs.position;
        const bool is_beside = !io.b.empty() && point_b_bs.norm() > reach_m(io.b);
        if (is_known) {
            continue;
        }
        if (is_beside) {
            separation_m = std::max(separation_m, overlap_at_end(io, a));
            if (separation_m >= 0.0) {
                continue;
            }
        }
        const Vec3 at_touch = transform_point(touch_ns, inverse_transform_point(to_ns, deepest));
        contacts.push_back({at_touch, deepest - separation_m * plane.normal_ns, plane.normal_ns,
                            separation_m, plane.part});
    }
}

// Appends the contacts found at `pose_ns` that are within the margin at `to_ns`. If the sweep
// touched and no contact is within the margin, appends the nearest one: the rest of the motion may
// leave this contact and end inside another part of b, and overlaps are searched only in pairs with
// a contact (find_missed_overlaps).
void append_contacts(const PairIo& io, const Pose& pose_ns, const Pose& to_ns, bool touched) {
    std::uint32_t feature = 0;
    std::optional<ContactPoint> nearest;
    for (const NearContact& near : io.scratch.contacts) {
        ContactPoint contact;
        contact.point_a_bs = inverse_transform_point(pose_ns, near.point_a_ns);
        contact.point_b_bs = near.point_b_ns + io.to_bs.position;
        contact.normal_b_bs = near.normal_ns;
        contact.separation_m =
            near.normal_ns.dot(transform_point(to_ns, contact.point_a_bs) - near.point_b_ns);
        if (contact.separation_m < io.limits.margin_m) {
            contact.feature = feature++;
            io.contacts.push_back(contact);
        } else if (touched && (!nearest || contact.separation_m < nearest->separation_m)) {
            nearest = contact;
        }
    }
    if (feature == 0 && nearest) {
        io.contacts.push_back(*nearest);
    }
}

}  // namespace

void find_pair_contacts(const PairIo& io) {
    const Pose from_ns{io.from_bs.position - io.to_bs.position, io.from_bs.rotation};
    const Pose to_ns{Vec3::Zero(), io.to_bs.rotation};
    const RelativeMotion motion(from_ns, to_ns);
    const std::optional<Impact> impact = first_impact(io, motion);
    const Pose pose_ns = impact ? motion.at(impact->fraction) : to_ns;

    io.scratch.contacts.clear();
    add_contacts_at(io, pose_ns, from_ns);
    if (impact && io.scratch.contacts.empty()) {
        io.scratch.contacts.push_back(
            {impact->point_b_ns, impact->point_b_ns, impact->normal, 0.0, impact->part});
    }
    reduce_contacts(io.scratch.contacts, io.scratch.spare);
    if (impact) {
        add_deepest_at_end(io, pose_ns, to_ns);
    }
    append_contacts(io, pose_ns, to_ns, impact.has_value());
}

}  // namespace handhold
