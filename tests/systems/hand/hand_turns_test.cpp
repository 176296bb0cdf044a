#include <algorithm>

#include <gtest/gtest.h>

#include "fitted_hand.hpp"
#include "systems/hand/shared/finger_chain.hpp"
#include "tests/engine/geometry/surface_cuts.hpp"

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
    dear.surfaces = hand.surface.at(k_right).evaluated_this_frame ? 1 : 0;
    for (std::size_t f = 0; f < hand.rig.fingers.size(); ++f) {
        const bool is_anew = hand.pose().backoff[f].retry_in_m > before.backoff[f].retry_in_m;
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
        bool evaluated_this_frame = false;
        for (int frame = 0; frame < k_frames; ++frame) {
            const int slid = std::max(0, frame - k_settling) % 40;
            hand.wrist_bs().position.x() = from.position.x() + k_step_m * std::min(slid, 40 - slid);
            const FingerPose before = hand.pose();
            hand.frame(k_dt_s);
            const Dear dear = dear_in(hand, before);
            EXPECT_FALSE(evaluated_this_frame && dear.surfaces > 0 && frame > 0) << frame;
            evaluated_this_frame = dear.surfaces > 0;
            const FingerPose& pose = hand.pose();
            const bool is_closing =
                pose.thumb_search.is_running ||
                std::any_of(pose.backoff.begin(), pose.backoff.end(),
                            [](const FingerBackoff& backoff) { return backoff.queued_frames > 0; });
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

// How deep the digit is with its links thicker by that; 0: it is as far from everything.
double depth_with_m(FittedHand& hand, const HingeChain& chain, std::size_t f, double thicker_m) {
    double deepest_m = 0.0;
    for (Capsule capsule : chain_capsules(chain, hand.pose().target[f].curl_rad)) {
        if (capsule.radius_m > 0.0) {
            capsule.radius_m += thicker_m;
            deepest_m =
                std::max(deepest_m, find_penetration(capsule, hand.hands.front().meshes).depth_m);
        }
    }
    return deepest_m;
}

struct Stops {
    int hanging_in_slides = 0;
    int hanging_at_rest = 0;
    int thumbs_amiss = 0;
    int restless = 0;  // that have not arrived
};

// Fingers of the hand as it is that were bent out of something and are in the air, though closed
// anew from there they would touch something.
int count_hanging(FittedHand& hand) {
    constexpr double k_touches_m = 1e-3;
    ChainFitSettings settings = chain_settings(hand.tuning.finger);
    settings.searches = false;
    int hanging = 0;
    for (std::size_t f = 0; f < hand.rig.fingers.size(); ++f) {
        const FingerRig& finger = hand.rig.fingers[f];
        if (finger.name == FingerName::thumb || hand.pose().backoff[f].failures == 0) {
            continue;
        }
        const HingeChain chain = finger_chain(finger, 0.0, hand.shown_bs());
        const ChainFit anew =
            fit_chain(chain, hand.hands.front().meshes, {}, settings, hand.fit_scratch);
        const bool could = anew.fallback == ChainFallback::sample_pose && touches(anew) &&
                           anew.depth_m <= settings.open_depth_m;
        hanging += could && depth_with_m(hand, chain, f, k_touches_m) <= 0.0 ? 1 : 0;
    }
    return hanging;
}

// True where the thumb is sunk or in the air, though at its own opposition it need not be.
bool is_thumb_amiss(FittedHand& hand) {
    constexpr double k_touches_m = 1e-3;
    constexpr double k_sunk_m = 1.5e-3;
    ChainFitSettings settings = chain_settings(hand.tuning.finger);
    settings.searches = false;
    for (std::size_t f = 0; f < hand.rig.fingers.size(); ++f) {
        if (hand.rig.fingers[f].name != FingerName::thumb) {
            continue;
        }
        const double opposition_rad = hand.pose().target[f].opposition_rad;
        const HingeChain chain = finger_chain(hand.rig.fingers[f], opposition_rad, hand.shown_bs());
        const ChainFit anew =
            fit_chain(chain, hand.hands.front().meshes, {}, settings, hand.fit_scratch);
        const bool could = touches(anew) && anew.depth_m <= settings.open_depth_m;
        return could && (depth_with_m(hand, chain, f, k_touches_m) <= 0.0 ||
                         depth_with_m(hand, chain, f, 0.0) > k_sunk_m);
    }
    return false;
}

// Slides at random over a mesh, and stops; three seconds later the hand should rest.
void slide_and_stop(const GripMesh& mesh, const Pose& from, std::uint32_t seed, Stops& stops) {
    constexpr double k_dt_s = 1.0 / 90.0;
    constexpr int k_stops = 300;
    constexpr int k_slide_frames = 12;
    constexpr int k_rest_frames = 270;
    test::Random random(seed);
    FittedHand hand(mesh, from);
    for (int stop = 0; stop < k_stops; ++stop) {
        const Vec3 way_m = random.vector(0.05);
        const Pose to = from * Pose{way_m, rotation_from_vector(random.vector(0.6))};
        const Pose start = hand.wrist_bs();
        for (int frame = 1; frame <= k_slide_frames; ++frame) {
            const double share = static_cast<double>(frame) / k_slide_frames;
            hand.wrist_bs().position = start.position + share * (to.position - start.position);
            hand.wrist_bs().rotation = start.rotation.slerp(share, to.rotation);
            hand.frame(k_dt_s);
        }
        stops.hanging_in_slides += count_hanging(hand);
        for (int frame = 0; frame < k_rest_frames; ++frame) {
            hand.frame(k_dt_s);
        }
        stops.hanging_at_rest += count_hanging(hand);
        stops.thumbs_amiss += is_thumb_amiss(hand) ? 1 : 0;
        stops.restless += hand.pose().converged && hand.pose().thumb_converged ? 0 : 1;
    }
}

// What was bent out of something while the hand slid comes back to it when the hand stops, and then
// all is still. A finger that slid off something and is at ease stays so: it would close on nothing
// from there.
TEST(HandTurns, HandsThatStopTouchAgainAndRest) {
    const HandRig rig = builtin_hand_rig(HandSide::right);
    const auto palm_at = [&](double y_m) {
        return test::wrist_with_palm_at(rig, {0.0, y_m, 0.0}, Vec3::UnitY());
    };
    const GripMesh ring = build_grip_mesh(test::make_torus(0.035, 0.008, 40, 16));
    const GripMesh wheel = build_grip_mesh(test::make_torus(0.08, 0.012, 40, 16));
    Stops stops;
    slide_and_stop(ring, palm_at(0.02), 4201, stops);
    slide_and_stop(ring, palm_at(0.0), 4202, stops);
    slide_and_stop(wheel, palm_at(0.02), 4203, stops);
    slide_and_stop(ring, palm_at(0.01), 4204, stops);
    EXPECT_GE(stops.hanging_in_slides, 10);
    EXPECT_LE(stops.hanging_at_rest, 1);
    EXPECT_LE(stops.thumbs_amiss, 1);
    EXPECT_EQ(stops.restless, 0);
}

// How often a digit of a hand that slides fast to and fro is tried anew.
int count_tries(const GripMesh& mesh, double fast_refit_depth_m) {
    constexpr double k_dt_s = 1.0 / 90.0;
    const HandRig rig = builtin_hand_rig(HandSide::right);
    const Pose from = test::wrist_with_palm_at(rig, {0.0, 0.02, 0.0}, Vec3::UnitY());
    FittedHand hand(mesh, from);
    hand.tuning.finger.fast_refit_depth_m = fast_refit_depth_m;
    hand.frame(test::k_at_once_s);
    int tries = 0;
    for (int frame = 0; frame < 400; ++frame) {
        hand.wrist_bs().position.x() = from.position.x() + 0.04 * std::sin(0.08 * frame);
        hand.wrist_bs().position.y() = from.position.y() + 0.02 * std::sin(0.3 * frame);
        const FingerPose before = hand.pose();
        hand.frame(k_dt_s);
        tries += dear_in(hand, before).fingers;
    }
    return tries;
}

TEST(HandTurns, FingersOfAFastHandAreTriedAnewWhereTheyAreSunkSoDeep) {
    const GripMesh ring = build_grip_mesh(test::make_torus(0.035, 0.008, 40, 16));
    const int usual = count_tries(ring, FingerTuning{}.fast_refit_depth_m);
    EXPECT_GT(usual, 10);
    EXPECT_GT(count_tries(ring, 1e-4), usual + usual / 10);
    EXPECT_LT(count_tries(ring, 0.1), usual / 2);
}

}  // namespace
}  // namespace handhold::hand_turns_test
