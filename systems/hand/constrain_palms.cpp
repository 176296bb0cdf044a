#include "systems/hand/constrain_palms.hpp"

#include <algorithm>
#include <cmath>

#include "engine/collision/closest_point.hpp"
#include "engine/geometry/segment_triangle.hpp"

namespace handhold {
namespace {

constexpr int k_most_pushes = 4;
constexpr double k_sunk_m = 2e-4;  // what is sunk less is not pushed out
constexpr double k_lifts_kept_m = 0.01;  // a hand that moved farther may try its surface again
constexpr double k_lifts_kept_rad = 0.17;

Vec3 palm_center(const HandRig& rig, const Pose& wrist) {
    return transform_point(wrist, rig.palm_center_hs);
}

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
    Vec3 center = palm_center(rig, hand.wrist_bs);
    center += slide_onto(hand.meshes.front(), surface.triangle, center);
    const double height_m = (center - surface.point_bs).dot(normal);
    const double wanted_m =
        std::clamp(height_m, tuning.min_height_m + lift_m,
                   std::max(tuning.max_height_m, tuning.min_height_m + lift_m));
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

// How the deepest of the palm's capsules gets out; zero where none is sunk.
class Sunk {
  public:
    Sunk(const HandSurroundings& hand, const Vec3& outward_bs)
        : hand_(hand), outward_bs_(outward_bs) {}

    Vec3 way_out(const Pose& wrist) const {
        Vec3 deepest = Vec3::Zero();
        for (const PalmCapsule& capsule : hand_.rig->palm) {
            const std::array<Vec3, 2> ends = {transform_point(wrist, capsule.a_hs),
                                              transform_point(wrist, capsule.b_hs)};
            for (const PlacedMesh& placed : hand_.meshes) {
                const Vec3 way = way_out_of(placed, ends, capsule.radius_m);
                if (way.squaredNorm() > deepest.squaredNorm()) {
                    deepest = way;
                }
            }
        }
        return deepest.norm() > k_sunk_m ? deepest : Vec3(Vec3::Zero());
    }

  private:
    Vec3 way_out_of(const PlacedMesh& placed, const std::array<Vec3, 2>& ends_bs,
                    double radius_m) const {
        const std::array<Vec3, 2> ends = {inverse_transform_point(placed.pose, ends_bs[0]),
                                          inverse_transform_point(placed.pose, ends_bs[1])};
        SegmentTriangle nearest;
        nearest.distance_m = radius_m;
        const SurfaceGraph& surface = placed.mesh->contact;
        placed.mesh->contact_bvh.visit_in_sphere(
            0.5 * (ends[0] + ends[1]), 0.5 * (ends[1] - ends[0]).norm() + radius_m,
            [&](std::uint32_t triangle) {
                const auto& [a, b, c] = surface.triangles[triangle];
                const Corners corners = {surface.positions[a], surface.positions[b],
                                         surface.positions[c]};
                if (least_distance(ends, corners) < nearest.distance_m) {
                    const SegmentTriangle found = nearest_between(ends, corners);
                    nearest = found.distance_m < nearest.distance_m ? found : nearest;
                }
            });
        if (nearest.distance_m >= radius_m) {
            return Vec3::Zero();
        }
        const Vec3 outward = placed.pose.rotation.conjugate() * outward_bs_;
        if (nearest.distance_m < 1e-9) {
            // The surface goes through its middle: out until the deeper end is clear.
            const double below_m = std::max({0.0, outward.dot(nearest.on_triangle - ends[0]),
                                             outward.dot(nearest.on_triangle - ends[1])});
            return (radius_m + below_m) * outward_bs_;
        }
        const Vec3 away = (nearest.on_segment - nearest.on_triangle) / nearest.distance_m;
        // From inside, the way to the surface and a radius beyond.
        return away.dot(outward) > -0.5
                   ? Vec3((radius_m - nearest.distance_m) * (placed.pose.rotation * away))
                   : Vec3((radius_m + nearest.distance_m) * (placed.pose.rotation * -away));
    }

    const HandSurroundings& hand_;
    const Vec3 outward_bs_;
};

Pose find_target(const HandSurroundings& hand, const GripSurface& surface, double lift_m,
                 const PalmTuning& tuning) {
    Pose wrist = hold_to_limits(hand, surface, lift_m, tuning);
    const Sunk sunk(hand, surface.normal_bs);
    for (int i = 0; i < k_most_pushes; ++i) {
        const Vec3 way = sunk.way_out(wrist);
        if (way.isZero()) {
            break;
        }
        wrist.position += way;
    }
    return wrist;
}

void set_target(const HandSurroundings& hand, const GripSurface& surface,
                const PalmTuning& tuning, PalmOffset& offset) {
    if (surface.triangle == GripSurface::k_none) {
        offset.target_m = Vec3::Zero();
        offset.target_turn_rad = Vec3::Zero();
        offset.lift_m = 0.0;
        return;
    }
    const Pose moved = inverse(offset.lifted_at_bs) * hand.wrist_bs;
    if (moved.position.norm() > k_lifts_kept_m ||
        rotation_to_vector(moved.rotation).norm() > k_lifts_kept_rad) {
        offset.lift_m = 0.0;
    }
    const Pose target = inverse(hand.wrist_bs) * find_target(hand, surface, offset.lift_m, tuning);
    offset.target_m = target.position;
    offset.target_turn_rad = rotation_to_vector(target.rotation);
}

// Both parts go the same share of their way, turning counted as the search counts it.
void follow_target(double dt_s, const PalmTuning& tuning, PalmOffset& offset) {
    const Vec3 way_m = offset.target_m - offset.shown_m;
    const Vec3 turn_rad = offset.target_turn_rad - offset.shown_turn_rad;
    const double all_m = way_m.norm() + tuning.tilt_cost_m_per_rad * turn_rad.norm();
    const double step_m = tuning.rate_mps * dt_s;
    if (all_m <= step_m) {
        offset.shown_m = offset.target_m;
        offset.shown_turn_rad = offset.target_turn_rad;
    } else {
        offset.shown_m += step_m / all_m * way_m;
        offset.shown_turn_rad += step_m / all_m * turn_rad;
    }
}

}  // namespace

void constrain_palms(const ConstrainPalmsIo& io, const Tuning& tuning) {
    for (const HandSurroundings& hand : io.hands) {
        PalmOffset& offset = io.offset.at(hand.hand);
        set_target(hand, io.surface.at(hand.hand), tuning.palm, offset);
        follow_target(io.dt_s, tuning.palm, offset);
        const bool is_tracked = offset.shown_m.isZero() && offset.shown_turn_rad.isZero();
        const Pose wrist_ws = hand.body_ws * hand.wrist_bs;
        io.palm.at(hand.hand).pose_ws =
            is_tracked ? wrist_ws
                       : wrist_ws * Pose{offset.shown_m,
                                         rotation_from_vector(offset.shown_turn_rad)};
    }
}

}  // namespace handhold
