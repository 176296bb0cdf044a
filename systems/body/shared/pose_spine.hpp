#pragma once

#include "components/spine.hpp"
#include "engine/math/math.hpp"

namespace handhold {

// The tracked floor below a player.
struct TrackedFloor {
    double chest_m = 0.0;  // height of the chest above the floor
    double scale = 1.0;    // size of the player: their eye height / k_scale_eye_m
    double lying = 0.0;    // ArmEstimate::lying
};

// Last step of propagate_spine: writes the chain that is shown. Interpolates between the last two
// ticks of `memory`, leans the chest (hang_body.hpp), restores the lengths of the bones, and folds
// the body above the floor (fold_body.hpp). chest_ps and chest_ws are the same pose, in play space
// and in the world.
void pose_spine(const Pose& chest_ws, const SpineMemory& memory, const Pose& chest_ps,
                const TrackedFloor& floor, SpinePose& out);

}  // namespace handhold
