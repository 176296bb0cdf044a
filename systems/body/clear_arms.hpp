#pragma once

#include "components/arm.hpp"
#include "components/spine.hpp"
#include "engine/ecs/column.hpp"

namespace handhold {

// Radius of the trunk about the line from chest to waist to hips, for an eye height of
// k_scale_eye_m; includes half an arm.
inline constexpr double k_trunk_clearance_m = 0.125;
// Most that an elbow is turned out of the trunk.
inline constexpr double k_most_clear_rad = 1.5;

// Greatest rates at which an elbow is turned, and turned back.
inline constexpr double k_clear_radps = 9.0;
inline constexpr double k_clear_back_radps = 3.0;
// From this angle between forearm and hand on, the forearm follows the hand.
inline constexpr double k_wrist_follow_rad = 95.0 / 180.0 * k_pi;

struct ClearArmsIo {
    double dt_s;                           // in: > 0
    const Column<BodyMeasures>& measures;  // in: has every player
    const Column<SpinePose>& spine;        // in
    Column<ArmMemory>& memory;             // in/out: cleared_rad, cleared_known
    Column<ArmPose>& arms;                 // in/out: upper arms and forearms
};

// Turns elbows about the line from shoulder to hand: until a wrist is bent by at most
// k_wrist_follow_rad, then until elbow and forearm are outside of the shown trunk, which the
// estimate of the elbow does not know: the trunk swings. Each search begins at the turn of the last
// frame, so that an elbow keeps to its side of the trunk, and turns change at limited rates.
// Shoulders and hands stay. An arm that needs no turn is unchanged, exactly. A forearm near a hand
// that is itself inside stays inside.
void clear_arms(const ClearArmsIo& io);

}  // namespace handhold
