#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "components/hand.hpp"
#include "components/hand_rig.hpp"
#include "components/hand_surroundings.hpp"
#include "components/tuning.hpp"
#include "engine/geometry/grip_mesh.hpp"
#include "tools/lab/finger_baselines.hpp"

// One hand on one mesh, posed by the runtime's systems over columns of one element.
namespace handhold::lab {

// How the palm's surface is chosen.
enum class PalmChoice : std::uint8_t {
    smallest_sync,  // search_grip, the runtime's
    ray_only,       // the surface that the palm ray hits
};

struct GripVariant {
    bool sync = true;  // true: the palm moves to its limits; false: it stays at its tracked pose
    SearchOrder order = SearchOrder::best_first;  // FingerMethod::talk only
    PalmChoice palm = PalmChoice::smallest_sync;
    // The talk's fingers include its palm fit: three limits and no depenetration of knuckles and
    // heel. Only the runtime's own method fits the wrist together with the fingers.
    FingerMethod fingers = FingerMethod::fit;
    // Frames of 1/90 s from an empty hand at rest, the first of which begins the grip, after which
    // the hand is shown. 0: the shown hand is at its target at once.
    int shown_after = 0;
};

struct GripTimes {  // microseconds of thread CPU time
    double search_us = 0.0;
    double palm_us = 0.0;
    double fingers_us = 0.0;
    double fit_us = 0.0;
    double later_us = 0.0;  // later frames, which start from other thumbs; not in the total
    double total_us() const { return search_us + palm_us + fingers_us + fit_us; }
};

struct PosedHand {
    bool gripped = false;
    std::string reason;  // why the hand does not grip; empty if it grips
    Pose wrist;          // shown wrist, in the mesh's frame
    double sync_m = 0.0;
    double sync_rad = 0.0;
    std::uint32_t triangle = 0;  // index in the mesh as loaded
    Vec3 point = Vec3::Zero();
    Vec3 normal = Vec3::UnitY();
    std::array<FingerAngles, k_finger_count> angles;  // indexed as HandRig::fingers
    std::array<FingerTrace, k_finger_count> traces;
    GripTimes us;
};

// Poses a hand that closes at `wrist` (in the mesh's frame) without cached results. Runs the hand
// stages of one frame in order; GripVariant::shown_after says when the hand is shown.
PosedHand pose_cold_hand(const GripMesh& mesh, const HandRig& rig, const Pose& wrist,
                         const Tuning& tuning, const GripVariant& variant);

// Costs of a hand that reuses its last solution: microseconds of thread CPU time per frame, from
// search_grip to fit_hands.
struct WarmHand {
    std::vector<double> moving_us;
    std::vector<double> stand_us;
    // Visited triangles per searched disc: one mean for each finger and frame.
    std::vector<std::uint32_t> pops;
    PosedHand moved;  // pose in the last moving frame; without times
    // Joint frames: joints of all fingers times frames, while the hand moves.
    std::uint32_t joint_frames = 0;
    // Joint frames in which the target angle changed by 10 degrees or more.
    std::uint32_t jumps = 0;
    // Joint frames in which the shown angle changed by 10 degrees or more.
    std::uint32_t shown_jumps = 0;
};

// Closes a hand like pose_cold_hand, then lets it move, one wrist of `motion` per frame of 1/90 s,
// and then stand still for as many frames. `motion`: wrists of a right hand relative to `wrist`; a
// left hand moves mirrored. The result is empty if the hand does not grip.
WarmHand move_hand(const GripMesh& mesh, const HandRig& rig, const Pose& wrist,
                   const Tuning& tuning, const GripVariant& variant, std::span<const Pose> motion);

}  // namespace handhold::lab
