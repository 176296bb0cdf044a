#include <algorithm>

#include <gtest/gtest.h>

#include "fitted_hand.hpp"
#include "tests/engine/surface_cuts.hpp"

namespace handhold::hand_turns_test {
namespace {

using test::FittedHand;
using test::k_right;

// Of one frame: what a sliding hand was dear by.
struct Dear {
    int surfaces = 0;
    int fingers = 0;
    int thumbs = 0;
};

// A digit that was tried anew waits longer than before: its way makes the wait shorter.
Dear dear_in(FittedHand& hand, const FingerPose& before) {
    Dear dear;
    dear.surfaces = hand.surface.at(k_right).was_judged ? 1 : 0;
    for (std::size_t f = 0; f < hand.rig.fingers.size(); ++f) {
        const bool is_anew = hand.pose().retry[f].wait_m > before.retry[f].wait_m;
        const bool is_thumb = hand.rig.fingers[f].name == FingerName::thumb;
        dear.fingers += is_anew && !is_thumb ? 1 : 0;
        dear.thumbs += is_anew && is_thumb ? 1 : 0;
    }
    return dear;
}

// Round a ring that is smaller than the hand neither palm nor digits ever have room.
TEST(HandTurns, SlidingHandDoesOneDearThingAFrame) {
    constexpr double k_dt_s = 1.0 / 90.0;
    constexpr double k_step_m = 0.002;
    constexpr int k_settling = 30;
    constexpr int k_frames = 600;
    const GripMesh ring = build_grip_mesh(test::make_torus(0.035, 0.008, 40, 16));
    const HandRig rig = builtin_hand_rig(HandSide::right);
    Dear all;
    for (const double z : {-0.03, 0.0, 0.03}) {
        const Pose from = test::wrist_with_palm_at(rig, {0.0, 0.02, z}, Vec3::UnitY());
        FittedHand hand(ring, from);
        bool was_judged = false;
        for (int frame = 0; frame < k_frames; ++frame) {
            const int slid = std::max(0, frame - k_settling) % 40;
            hand.wrist_bs().position.x() = from.position.x() + k_step_m * std::min(slid, 40 - slid);
            const FingerPose before = hand.pose();
            hand.frame(k_dt_s);
            const Dear dear = dear_in(hand, before);
            EXPECT_FALSE(was_judged && dear.surfaces > 0 && frame > 0) << frame;
            was_judged = dear.surfaces > 0;
            const FingerPose& pose = hand.pose();
            const bool is_closing =
                pose.thumb_search.runs ||
                std::any_of(pose.retry.begin(), pose.retry.end(),
                            [](const FingerRetry& retry) { return retry.queued > 0; });
            if (frame < k_settling || is_closing) {
                continue;
            }
            EXPECT_LE(dear.surfaces + dear.fingers + dear.thumbs, 1) << frame;
            all.surfaces += dear.surfaces;
            all.fingers += dear.fingers;
            all.thumbs += dear.thumbs;
        }
    }
    EXPECT_GT(all.surfaces, 10);  // and each kind has its turn
    EXPECT_GT(all.fingers, 10);
    EXPECT_GT(all.thumbs, 10);
}

}  // namespace
}  // namespace handhold::hand_turns_test
