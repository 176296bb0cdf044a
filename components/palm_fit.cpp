#include "components/palm_fit.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "engine/collision/closest_point.hpp"

namespace handhold {
namespace {

constexpr int k_most_pushes = 6;
constexpr double k_sunk_m = 5e-5;        // what is sunk less is not pushed out
constexpr double k_far_inside_m = 0.03;  // deeper than this inside of something is not seen

// How far beside the found triangle the palm is: along the triangle's plane, zero over it.
Vec3 slide_onto(const PlacedMesh& placed, std::uint32_t triangle, const Vec3& center_bs) {
    const SurfaceGraph& graph = placed.mesh->search;
    const auto& [a, b, c] = graph.triangles[triangle];
    const Corners corners = {graph.positions[a], graph.positions[b], graph.positions[c]};
    const Vec3 center = inverse_transform_point(placed.pose, center_bs);
    const Vec3& normal = graph.normals[triangle];
    const Vec3 flat = center - (center - corners[0]).dot(normal) * normal;
    return placed.pose.rotation * Vec3(closest_on_triangle(flat, corners) - flat);
}

// Height first, tilt second: tilting about the palm's centre keeps its height.
Pose hold_to_limits(const HandSurroundings& hand, const GripSurface& surface, double lift_m,
                    const PalmTuning& tuning) {
    const HandRig& rig = *hand.rig;
    const Vec3& normal = surface.normal_bs;
    Vec3 center = transform_point(hand.wrist_bs, rig.palm_center_hs);
    center += slide_onto(hand.meshes.front(), surface.triangle, center);
    const double height_m = (center - surface.point_bs).dot(normal);
    const double wanted_m = std::clamp(height_m, tuning.min_height_m,
                                       std::max(tuning.min_height_m, tuning.max_height_m)) +
                            lift_m;
    center += (wanted_m - height_m) * normal;

    Pose wrist = hand.wrist_bs;
    const Vec3 up = wrist.rotation * -rig.palm_normal_hs;
    const Vec3 across = up.cross(normal);
    const double angle_rad = arc_tangent2(across.norm(), up.dot(normal));
    if (angle_rad > tuning.max_angle_rad && across.norm() > 1e-9) {
        wrist.rotation =
            (rotation_about(across.normalized(), angle_rad - tuning.max_angle_rad) * wrist.rotation)
                .normalized();
    }
    wrist.position = center - wrist.rotation * rig.palm_center_hs;
    return wrist;
}

// Looks at the palm as spheres along its capsules; which side of a surface is out follows from its
// winding, and from which side the palm is held to.
class SunkPalm {
  public:
    SunkPalm(const HandSurroundings& hand, const GripSurface& surface) : hand_(hand) {
        const PlacedMesh& placed = hand.meshes.front();
        const Vec3 wound = placed.pose.rotation * placed.mesh->search.normals[surface.triangle];
        side_ = wound.dot(surface.normal_bs) < 0.0 ? -1.0 : 1.0;
    }

    // How the deepest of the palm's spheres gets out; zero where none is sunk.
    Vec3 way_out(const Pose& wrist) {
        Vec3 deepest = Vec3::Zero();
        std::size_t place = 0;
        for (const PalmCapsule& capsule : hand_.rig->palm) {
            constexpr int k_spheres = 3;
            for (int i = 0; i < k_spheres; ++i) {
                const double share = static_cast<double>(i) / (k_spheres - 1);
                const Vec3 center =
                    transform_point(wrist, capsule.a_hs + share * (capsule.b_hs - capsule.a_hs));
                for (std::size_t m = 0; m < hand_.meshes.size(); ++m, ++place) {
                    const Vec3 way = way_out_of(hand_.meshes[m], m == 0 ? side_ : 1.0,
                                                {center, capsule.radius_m}, place);
                    deepest = way.squaredNorm() > deepest.squaredNorm() ? way : deepest;
                }
            }
        }
        return deepest;
    }

  private:
    struct Sphere {
        Vec3 center;
        double radius_m = 0.0;
    };
    // What a sphere found when it was last looked at: until it has moved so far that it may be sunk
    // it need not be looked at again, and the nearest point is no farther than the last one.
    struct Seen {
        Vec3 center = Vec3::Zero();
        Vec3 point = Vec3::Zero();
        double clear_m = 0.0;
        bool has_point = false;
    };

    Vec3 way_out_of(const PlacedMesh& placed, double side, const Sphere& sphere_bs,
                    std::size_t place) {
        const Vec3 center = inverse_transform_point(placed.pose, sphere_bs.center);
        Seen overflow;
        Seen& seen = place < seen_.size() ? seen_[place] : overflow;
        if ((center - seen.center).squaredNorm() < seen.clear_m * seen.clear_m) {
            return Vec3::Zero();
        }
        double look_m = std::max(sphere_bs.radius_m, k_far_inside_m);
        if (seen.has_point) {
            constexpr double k_noise_m = 1e-9;
            look_m = std::min(look_m, (center - seen.point).norm() + k_noise_m);
        }
        const auto near = placed.mesh->contact_bvh.closest_point(center, look_m);
        seen = {center, near ? near->point : Vec3::Zero(), 0.0, near.has_value()};
        if (!near) {
            return Vec3::Zero();
        }
        Vec3 way = way_out_of(placed, side, *near, {center, sphere_bs.radius_m});
        if (way.isZero(0.0)) {
            seen.clear_m = near->distance_m - sphere_bs.radius_m;
        }
        return way;
    }

    // `sphere` in the mesh's frame.
    static Vec3 way_out_of(const PlacedMesh& placed, double side, const TriangleHit& near,
                           const Sphere& sphere) {
        const Vec3 outward = side * placed.mesh->contact.normals[near.triangle];
        const Vec3 from_surface = sphere.center - near.point;
        const double height_m = outward.dot(from_surface);
        // Beyond an edge a sphere is high over neither side, but not inside either.
        constexpr double k_surely_below = 0.5;
        const bool is_inside = height_m < -k_surely_below * near.distance_m;
        const double depth_m =
            is_inside ? sphere.radius_m + near.distance_m : sphere.radius_m - near.distance_m;
        if (depth_m <= 0.0) {
            return Vec3::Zero();
        }
        constexpr double k_on_surface_m = 1e-9;
        const Vec3 away = near.distance_m > k_on_surface_m
                              ? Vec3((is_inside ? -1.0 : 1.0) / near.distance_m * from_surface)
                              : outward;
        return depth_m * (placed.pose.rotation * away);
    }

    static constexpr std::size_t k_most_seen = 64;  // the others are looked at every time

    const HandSurroundings& hand_;
    double side_ = 1.0;
    std::array<Seen, k_most_seen> seen_;
};

}  // namespace

PalmFit fit_palm(const HandSurroundings& hand, const GripSurface& surface, double lift_m,
                 const PalmTuning& tuning) {
    SunkPalm palm(hand, surface);
    Pose wrist = hold_to_limits(hand, surface, lift_m, tuning);
    Vec3 way = palm.way_out(wrist);
    PalmFit best = {wrist, way.norm()};
    for (int i = 0; i < k_most_pushes && way.norm() > k_sunk_m; ++i) {
        wrist.position += way;
        way = palm.way_out(wrist);
        if (way.norm() < best.sunk_m) {
            best = {wrist, way.norm()};
        }
    }
    return best;
}

}  // namespace handhold
