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

struct ClearArmsIo {
    const Column<BodyMeasures>& measures;  // in: has every player
    const Column<SpinePose>& spine;        // in
    Column<ArmPose>& arms;                 // in/out: upper arms and forearms
};

// Turns elbows about the line from shoulder to hand until elbow and forearm are outside of the
// shown trunk, which the estimate of the elbow does not know: the trunk swings. Shoulders and hands
// stay. An arm that is outside is unchanged, exactly. A forearm near a hand that is itself inside
// stays inside.
void clear_arms(const ClearArmsIo& io);

}  // namespace handhold
