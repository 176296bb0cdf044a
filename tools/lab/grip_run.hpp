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
#include "tools/lab/finger_baselines.hpp"

// One hand on one mesh, posed by the runtime's own systems over columns of one row.
namespace handhold::lab {

struct GripVariant {
    bool sync = true;  // the palm moves to its limits; else it stays where it is tracked
    SearchOrder order = SearchOrder::best_first;
    GripSearch palm = GripSearch::smallest_sync;
    // The talk's fingers come with its palm: held to its three limits, never pushed out of what its
    // knuckles and heel are sunk in. Palms are lifted for none but the runtime's own fingers.
    FingerMethod fingers = FingerMethod::sweep;
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

// How a hand moves that is measured warm.
struct HandSlide {
    std::int32_t frames = 0;  // of 1/90 s: first sliding, then as many standing still
    double speed_mps = 0.2;   // to and fro by 4 cm: along the surface, across the fingers
};

// What the frames of a hand that knows its last solution took, each from search_grip to pose_thumb:
// microseconds of thread CPU time.
struct WarmHand {
    std::vector<double> slide_us;
    std::vector<double> stand_us;
    std::vector<std::uint32_t> pops;  // a searched disc, in the mean of a finger and a frame
    PosedHand slid;                   // in the last frame of these; without times
    std::uint32_t joint_frames = 0;   // sliding: hinges of all fingers, times frames
    std::uint32_t jumps = 0;          // of these, bound for 10 degrees away or more in one frame
    std::uint32_t shown_jumps = 0;    // of these, shown 10 degrees away or more: opened
};

// A hand that has closed at `wrist` as pose_cold_hand closes it, and then slides and stands. Empty
// where it does not grip.
WarmHand slide_hand(const GripMesh& mesh, const HandRig& rig, const Pose& wrist,
                    const Tuning& tuning, const GripVariant& variant, const HandSlide& slide);

}  // namespace handhold::lab
