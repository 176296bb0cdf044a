#pragma once

#include <array>

#include "components/authored_grip.hpp"
#include "components/tuning.hpp"
#include "engine/geometry/grip_mesh.hpp"

namespace handhold {

// A hand on one mesh, as the game's own stages fit it, at rest.
struct FittedGrip {
    Pose wrist_bs;
    std::array<FingerAngles, k_finger_count> fingers;  // by place in HandRig::fingers
    bool is_gripping = false;                          // false: no surface in reach
    std::uint64_t penetrating_fingers = 0;  // posed, but fitted, since they would be sunk
};

// From where the hand would close: palm and fingers fitted to the surface. With `authored`: the
// palm held to that, posed fingers as they are posed, where they are not sunk.
FittedGrip fit_grip(const GripMesh& mesh, const HandRig& rig, const Pose& wrist_bs,
                    const Tuning& tuning, const AuthoredHand* authored = nullptr);

}  // namespace handhold
