#include "systems/hand/shared/outside_surfaces.hpp"

#include <algorithm>
#include <array>
#include <optional>

#include "engine/core/check.hpp"
#include "engine/geometry/surface_crossings.hpp"
#include "systems/rigs/hand_kinematics.hpp"

namespace handhold {
namespace {

constexpr int k_most_faces = 4;  // three faces that meet in a corner, and one more

struct Exit {
    Vec3 direction_bs = Vec3::Zero();  // unit, out of the surface
    double depth_m = 0.0;              // > 0 if there is one
};

// The palm as one mesh has it near.
class PalmNear {
  public:
    PalmNear(const PlacedMesh& placed, const Vec3& eye_bs, const Vec3& palm_bs)
        : placed_(placed), palm_(inverse_transform_point(placed.pose, palm_bs)) {
        const auto near = surface().closest_point(palm_, k_sight_m);
        is_near_ = near.has_value();
        distance_m_ = near ? near->distance_m : k_sight_m;
        is_behind_ = is_near_ && handhold::is_behind(placed, eye_bs, palm_bs);
    }

    // The way out for a point of the hand, if it is deeper than `deepest`.
    void exit_of(const Vec3& point_bs, Exit& deepest) const {
        constexpr double k_slack_m = 1e-9;
        constexpr double k_same_place_m = 1e-6;
        const Vec3 point = inverse_transform_point(placed_.pose, point_bs);
        const double from_palm_m = (point - palm_).norm();
        const bool is_surely_before = !is_behind_ && distance_m_ > from_palm_m;
        if (!is_near_ || is_surely_before || crosses_oddly(surface(), palm_, point) == is_behind_) {
            return;
        }
        const auto near = surface().closest_point(point, distance_m_ + from_palm_m + k_slack_m);
        if (near && near->distance_m > std::max(deepest.depth_m, k_same_place_m)) {
            const Vec3 direction = (near->point - point) / near->distance_m;
            deepest = {placed_.pose.rotation * direction, near->distance_m};
        }
    }

  private:
    const TriangleBvh& surface() const { return placed_.mesh->contact_bvh; }

    const PlacedMesh& placed_;
    Vec3 palm_;
    bool is_near_ = false;
    bool is_behind_ = false;
    double distance_m_ = 0.0;
};

// The ends of the axes of a hand's capsules, without those at the digits' first hinges.
struct AxisEnds {
    static constexpr std::size_t k_most = 2 * k_max_palm_capsules + k_finger_count * k_max_links;

    std::array<Vec3, k_most> at_bs;
    std::array<double, k_most> radius_m = {};
    std::size_t count = 0;

    AxisEnds(const HandRig& rig, const HandPose& pose) {
        HH_CHECK(rig.palm.size() <= k_max_palm_capsules, "too many palm capsules", rig.palm.size());
        const auto add = [&](const Vec3& at_hs, double radius) {
            at_bs[count] = transform_point(pose.wrist_bs, at_hs);
            radius_m[count++] = radius;
        };
        for (const PalmCapsule& capsule : rig.palm) {
            add(capsule.a_hs, capsule.radius_m);
            add(capsule.b_hs, capsule.radius_m);
        }
        for (std::size_t f = 0; f < rig.fingers.size(); ++f) {
            const FingerRig& finger = rig.fingers[f];
            const auto points_hs = finger_points(finger, pose.fingers[f]);
            for (std::size_t i = 0; i < finger.link_count; ++i) {
                add(points_hs[i + 1], finger.radius_m[i]);
            }
        }
    }
};

Exit exit_of_hand(const HandSurroundings& hand, const HandPose& pose) {
    const Vec3 palm_bs = transform_point(pose.wrist_bs, hand.rig->palm_center_hs);
    const AxisEnds ends(*hand.rig, pose);
    Exit deepest;
    for (const PlacedMesh& placed : hand.meshes) {
        const PalmNear near(placed, *hand.eye_bs, palm_bs);
        for (std::size_t i = 0; i < ends.count; ++i) {
            near.exit_of(ends.at_bs[i], deepest);
        }
    }
    return deepest;
}

}  // namespace

bool is_behind(const PlacedMesh& placed, const Vec3& eye_bs, const Vec3& point_bs) {
    const Vec3 to_eye = eye_bs - point_bs;
    const double share = k_sight_m / std::max(k_sight_m, to_eye.norm());
    return crosses_oddly(placed.mesh->contact_bvh,
                         inverse_transform_point(placed.pose, point_bs + share * to_eye),
                         inverse_transform_point(placed.pose, point_bs));
}

bool is_outside(const HandSurroundings& hand, const HandPose& pose) {
    return !hand.eye_bs || exit_of_hand(hand, pose).depth_m <= 0.0;
}

Pose wrist_outside_bs(const HandSurroundings& hand, const HandPose& pose) {
    HandPose moved = pose;
    for (int i = 0; hand.eye_bs && i < k_most_faces; ++i) {
        const Exit exit = exit_of_hand(hand, moved);
        if (exit.depth_m <= 0.0) {
            break;
        }
        moved.wrist_bs.position += exit.depth_m * exit.direction_bs;
        if ((moved.wrist_bs.position - pose.wrist_bs.position).norm() > k_sight_m) {
            return pose.wrist_bs;
        }
    }
    return moved.wrist_bs;
}

Vec3 displacement_to_touch(const HandSurroundings& hand, const HandPose& pose, double reach_m) {
    const PlacedMesh& placed = hand.meshes.front();
    const AxisEnds ends(*hand.rig, pose);
    double gap_m = reach_m;
    Vec3 way = Vec3::Zero();
    for (std::size_t i = 0; i < ends.count; ++i) {
        const Vec3 end = inverse_transform_point(placed.pose, ends.at_bs[i]);
        const auto near = placed.mesh->contact_bvh.closest_point(end, gap_m + ends.radius_m[i]);
        if (near) {
            gap_m = std::max(0.0, near->distance_m - ends.radius_m[i]);
            way = gap_m > 0.0 ? Vec3(gap_m / near->distance_m * (near->point - end)) : Vec3::Zero();
        }
    }
    return placed.pose.rotation * way;
}

}  // namespace handhold
