#pragma once

#include <array>

#include "components/authored_grip.hpp"
#include "components/tuning.hpp"
#include "engine/geometry/grip_mesh.hpp"

namespace handhold {

// A hand at rest on one mesh, as the runtime's stages fit it.
struct FittedGrip {
    Pose wrist_bs;
    std::array<FingerAngles, k_finger_count> fingers;  // in the order of HandRig::fingers
    bool is_gripping = false;                          // false: no surface in reach
    std::uint64_t penetrating_fingers =
        0;  // posed fingers that would penetrate and were fitted instead
};

// Fits palm and fingers to the surface, from where the hand would close. With `authored`: the palm
// is held to that wrist, and posed fingers keep their pose unless they penetrate.
FittedGrip fit_grip(const GripMesh& mesh, const HandRig& rig, const Pose& wrist_bs,
                    const Tuning& tuning, const AuthoredHand* authored = nullptr);

}  // namespace handhold
