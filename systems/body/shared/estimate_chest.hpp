#pragma once

#include <array>

#include "components/arm.hpp"
#include "components/body_tuning.hpp"
#include "engine/math/math.hpp"
#include "systems/body/shared/body_view.hpp"
#include "systems/body/shared/level_direction.hpp"

// The chest from head and hands: the talk's form (rows 19 and 21), then a network's correction.
// Constants: body_constants.hpp, fitted by tools/lab/fit_body.
namespace handhold {

// The head as the trunk follows it: eyes and up axis. A head that looks up turns ever more about
// the ears alone: of a pitch p the trunk follows p k / (p + k), with k = body_constants::k_nod_rad.
// `lying` (lying_share) blends this away: the trunk of a player who lies follows the whole head.
struct TrunkView {
    Vec3 eyes_ps;
    Vec3 up_ps;
    double lying = 0.0;
};
TrunkView trunk_view(const TrackedBody& body, const BodyAxes& axes);

// Lean of the chest: the rotation from the play space's up towards the head's up, by a fitted
// share; all the way for a player who lies. `up_ps`: TrunkView::up_ps.
Quat chest_lean(const Vec3& up_ps, double lying = 0.0);

// Level direction in which the chest faces, in the talk's form. The chest turns from `look_ps`
// towards the mean position of the hands, turns perpendicular to the line between them, and follows
// rolling hands. `lean_ps`: chest_lean. `limit`: the maximum angle from the look direction.
Vec3 chest_facing(const Vec3& look_ps, const Quat& lean_ps, const TrackedBody& body,
                  const BodyAxes& axes, const TurnLimit& limit);

// What the network adds to the talk's form. All zero for inputs that do not resemble its data.
struct ChestCorrection {
    double turn_rad = 0.0;  // positive: to the left
    ChestOffset offset;
};
// facing_ps: result of chest_facing. looks_ps: ArmMemory::looks_ps. look_ps: look direction, not
// filtered.
ChestCorrection chest_correction(const Vec3& facing_ps, const Vec3& look_ps,
                                 const std::array<Vec3, k_look_filters>& looks_ps,
                                 const TrackedBody& body, const BodyAxes& axes);

inline constexpr double k_across_most_rad = 1.1;

// Turn to the left (rad) that reduces how far a nearly straight arm reaches across the chest, if it
// is farther than shoulders allow. The line between the hands does not determine the chest's facing
// if both hands are on one side, as on a rail beside the player: chest_facing may then turn away
// from them, and the far arm would pass through the neck. Zero for the usual poses; continuous; its
// absolute value is below k_across_most_rad. `chest_ps`: chest_pose for `facing_ps` and `lean_ps`.
double turn_to_reach_across(const Vec3& facing_ps, const Quat& lean_ps, const Pose& chest_ps,
                            const TrackedBody& body);

// The point about which a neck bends, play space: midway between the ears, about which a head nods,
// and the base of the neck.
Vec3 neck_pivot(const TrackedBody& body, const BodyAxes& axes);

// Pose of the chest: its position is the middle between the resting shoulders. The lower shoulder
// of a player who lies is above the tracked floor.
Pose chest_pose(const Vec3& facing_ps, const Quat& lean_ps, const ChestOffset& offset,
                const TrackedBody& body, const TrunkView& trunk);

}  // namespace handhold
