#include <algorithm>

#include <gtest/gtest.h>

#include "components/finger_chain.hpp"
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

// Fingers of the hand as it is that are in the air, though one closed anew from there would touch
// something and be clear.
int count_hanging(FittedHand& hand) {
    constexpr double k_touches_m = 1e-3;
    const HandSurroundings& around = hand.hands.front();
    ChainFitSettings settings = chain_settings(hand.tuning.finger);
    settings.searches = false;
    int hanging = 0;
    for (std::size_t f = 0; f < hand.rig.fingers.size(); ++f) {
        const FingerRig& finger = hand.rig.fingers[f];
        if (finger.name == FingerName::thumb) {
            continue;
        }
        const HingeChain chain = finger_chain(finger, 0.0, hand.shown_bs());
        const ChainFit anew = fit_chain(chain, around.meshes, {}, settings, hand.fit_scratch);
        const bool could = anew.fallback == ChainFallback::bent && touches(anew) &&
                           anew.depth_m <= settings.open_depth_m;
        double deepest_m = 0.0;
        for (Capsule capsule : chain_capsules(chain, hand.pose().target[f].curl_rad)) {
            if (capsule.radius_m <= 0.0) {
                continue;
            }
            capsule.radius_m += k_touches_m;
            deepest_m = std::max(deepest_m, find_sunk(capsule, around.meshes).depth_m);
        }
        hanging += could && deepest_m <= 0.0 ? 1 : 0;
    }
    return hanging;
}

// What was bent out of something while the hand slid comes back to it when the hand stops. A finger
// that slid off something and is at ease stays so: it would close on nothing from there.
TEST(HandTurns, FingersOfAHandThatStopsComeBackToWhatTheyTouch) {
    constexpr double k_dt_s = 1.0 / 90.0;
    constexpr int k_stops = 600;
    constexpr int k_slide_frames = 12;
    constexpr int k_rest_frames = 90;
    const GripMesh ring = build_grip_mesh(test::make_torus(0.035, 0.008, 40, 16));
    const HandRig rig = builtin_hand_rig(HandSide::right);
    test::Random random(4201);
    const Pose from = test::wrist_with_palm_at(rig, {0.0, 0.02, 0.0}, Vec3::UnitY());
    FittedHand hand(ring, from);
    int hanging_in_slides = 0;
    int hanging_at_rest = 0;
    for (int stop = 0; stop < k_stops; ++stop) {
        const Pose to = from * Pose{random.vector(0.05), rotation_from_vector(random.vector(0.6))};
        const Pose start = hand.wrist_bs();
        for (int frame = 1; frame <= k_slide_frames; ++frame) {
            const double share = static_cast<double>(frame) / k_slide_frames;
            hand.wrist_bs().position = start.position + share * (to.position - start.position);
            hand.wrist_bs().rotation = start.rotation.slerp(share, to.rotation);
            hand.frame(k_dt_s);
        }
        hanging_in_slides += count_hanging(hand);
        for (int frame = 0; frame < k_rest_frames; ++frame) {
            hand.frame(k_dt_s);
        }
        hanging_at_rest += count_hanging(hand);
    }
    EXPECT_GE(hanging_in_slides, 10);
    EXPECT_LE(hanging_at_rest, hanging_in_slides / 10);
}

}  // namespace
}  // namespace handhold::hand_turns_test
