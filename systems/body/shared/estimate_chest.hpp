#pragma once

#include <array>

#include "components/arm.hpp"
#include "components/body_tuning.hpp"
#include "engine/math/math.hpp"
#include "systems/body/shared/body_view.hpp"
#include "systems/body/shared/level_direction.hpp"

// Estimates the chest from head and hands by the talk's formulas (rows 19 and 21), and corrects it
// by a network. Constants: body_constants.hpp, fitted by tools/lab/fit_body.
namespace handhold {

// Eyes and up axis of the head as far as the trunk follows the head. If the head looks up by a
// pitch p, the trunk follows only p k / (p + k) of it, with k = body_constants::k_nod_rad; the rest
// is a turn of the head about the ears. `lying` (lying_share) blends this away: the trunk of a
// player who lies follows the head's whole pitch.
struct TrunkView {
    Vec3 eyes_ps;
    Vec3 up_ps;
    double lying = 0.0;
};
TrunkView trunk_view(const TrackedBody& body, const BodyAxes& axes);

// Lean of the chest: the rotation from the play space's up towards the head's up, by a fitted
// share; all the way for a player who lies. `up_ps`: TrunkView::up_ps.
Quat chest_lean(const Vec3& up_ps, double lying = 0.0);

// Level direction in which the chest faces, by the talk's formula. The chest turns from `look_ps`
// towards the mean position of the hands, turns perpendicular to the line between them, and follows
// rolling hands. `lean_ps`: chest_lean. `limit`: the maximum angle from the look direction.
Vec3 chest_facing(const Vec3& look_ps, const Quat& lean_ps, const TrackedBody& body,
                  const BodyAxes& axes, const TurnLimit& limit);

// What the network adds to the results of the talk's formulas. All zero for inputs that do not
// resemble its data.
struct ChestCorrection {
    double turn_rad = 0.0;  // positive: to the left
    ChestOffset offset;
};
// facing_ps: result of chest_facing. looks_ps: ArmMemory::looks_ps. look_ps: look direction, not
// filtered.
ChestCorrection chest_correction(const Vec3& facing_ps, const Vec3& look_ps,
                                 const std::array<Vec3, k_look_filters>& looks_ps,
                                 const TrackedBody& body, const BodyAxes& axes);

// The point about which a neck bends, play space: midway between the ears, about which a head nods,
// and the base of the neck.
Vec3 neck_pivot(const TrackedBody& body, const BodyAxes& axes);

// Pose of the chest: its position is the middle between the resting shoulders. The lower shoulder
// of a player who lies is above the tracked floor.
Pose chest_pose(const Vec3& facing_ps, const Quat& lean_ps, const ChestOffset& offset,
                const TrackedBody& body, const TrunkView& trunk);

}  // namespace handhold
