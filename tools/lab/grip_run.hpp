#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "components/hand.hpp"
#include "components/hand_rig.hpp"
#include "components/hand_surroundings.hpp"
#include "components/tuning.hpp"
#include "engine/geometry/grip_mesh.hpp"
#include "systems/hand/search_grip.hpp"

// One hand on one mesh, posed by the runtime's own systems over columns of one row.
namespace handhold::lab {

struct GripVariant {
    bool sync = true;  // the palm moves to its limits; else it stays where it is tracked
    SearchOrder order = SearchOrder::best_first;
    GripSearch palm = GripSearch::least_sync;
};

struct GripTimes {  // microseconds of thread CPU time
    double search_us = 0.0;
    double palm_us = 0.0;
    double fingers_us = 0.0;
    double total_us() const { return search_us + palm_us + fingers_us; }
};

struct PosedHand {
    bool gripped = false;
    std::string reason;  // why not, or empty
    Pose wrist;          // as shown, in the mesh's frame
    double sync_m = 0.0;
    double sync_rad = 0.0;
    std::uint32_t triangle = 0;  // of the mesh as loaded
    Vec3 point = Vec3::Zero();
    Vec3 normal = Vec3::UnitY();
    std::array<FingerAngles, k_finger_count> angles;  // by place in HandRig::fingers
    std::array<FingerTrace, k_finger_count> traces;
    GripTimes us;
};

// A hand that closes at `wrist` (in the mesh's frame) with nothing known from before: the frame's
// stages in their order, shown at once where they aim, and again while fingers lift the palm.
PosedHand pose_cold_hand(const GripMesh& mesh, const HandRig& rig, const Pose& wrist,
                         const Tuning& tuning, const GripVariant& variant);

}  // namespace handhold::lab
