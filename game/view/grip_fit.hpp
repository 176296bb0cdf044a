#pragma once

#include <array>

#include "components/authored_grip.hpp"
#include "components/tuning.hpp"
#include "engine/geometry/grip_mesh.hpp"

namespace handhold {

// Result of the runtime's hand stages for a hand that grips one mesh.
struct FittedGrip {
    Pose wrist_bs;
    std::array<FingerAngles, k_finger_count> fingers;  // indexed by index in HandRig::fingers
    bool is_gripping = false;                          // false: no surface is within reach
    // Number of posed fingers that would penetrate, so that they were fitted instead.
    std::uint64_t penetrating_fingers = 0;
};

// Fits palm and fingers to the surface for a hand that closes at `wrist_bs`. With `authored`: uses
// its wrist and its posed fingers, except for posed fingers that penetrate.
FittedGrip fit_grip(const GripMesh& mesh, const HandRig& rig, const Pose& wrist_bs,
                    const Tuning& tuning, const AuthoredHand* authored = nullptr);

}  // namespace handhold
