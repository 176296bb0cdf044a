#pragma once

#include "engine/math/math.hpp"
#include "systems/body/shared/elbow_direction.hpp"

// Keeps elbows and forearms outside of the trunk.
namespace handhold {

// Distance from the spine that elbows and the middles of forearms keep: the radius of a trunk and a
// margin. For a player with an eye height of k_scale_eye_m. True elbows of body_train are hardly
// ever nearer.
inline constexpr double k_clear_trunk_m = 0.12;

// Arms that get out of the trunk by less than this turn less.
inline constexpr double k_trunk_gain_m = 0.02;

// The trunk as a capsule; positions relative to the shoulder, torso axes.
struct TrunkCapsule {
    Vec3 top_ts = Vec3::Zero();
    Vec3 bottom_ts = Vec3::Zero();
    double radius_m = 0.0;
};
// `chest_ts`: the middle between the shoulders. `down_ts`: unit, along the trunk.
TrunkCapsule trunk_capsule(const Vec3& chest_ts, const Vec3& down_ts, double scale);

// How deep elbow or forearm are in the trunk; negative: clear by that much.
double depth_in_trunk(const Vec3& elbow_ts, const Vec3& hand_ts, const TrunkCapsule& trunk);

// Returns `bend_ts` (unit, perpendicular to the circle's axis), turned towards the arm's own side
// by the smallest angle that takes elbow and forearm out of the trunk, or as far out as they get on
// the way. Continuous. `hand_ts`: relative to the shoulder.
Vec3 bend_clear_of_trunk(const ElbowCircle& circle, const Vec3& bend_ts, const Vec3& hand_ts,
                         HandSide side, const TrunkCapsule& trunk);

}  // namespace handhold
