#include <algorithm>

#include <gtest/gtest.h>

#include "fitted_hand.hpp"
#include "systems/hand/shared/finger_chain.hpp"
#include "tests/engine/geometry/surface_cuts.hpp"

namespace handhold::hand_budget_test {
namespace {

using test::FittedHand;
using test::k_right;

// Expensive updates of one hand: candidate evaluations, and refits from scratch.
struct Updates {
    int surfaces = 0;
    int fingers = 0;
    int thumbs = 0;
};

// The updates of the last frame. A refit is recognised by its back-off, which travel only shortens.
Updates updates_since(FittedHand& hand, const FingerPose& before) {
    Updates updates;
    updates.surfaces = hand.surface.at(k_right).evaluated_this_frame ? 1 : 0;
    for (std::size_t f = 0; f < hand.rig.fingers.size(); ++f) {
        const bool is_refitted = hand.pose().backoff[f].retry_in_m > before.backoff[f].retry_in_m;
        const bool is_thumb = hand.rig.fingers[f].name == FingerName::thumb;
        updates.fingers += is_refitted && !is_thumb ? 1 : 0;
        updates.thumbs += is_refitted && is_thumb ? 1 : 0;
    }
    return updates;
}

// On a ring smaller than the hand, palm and digits never have clearance, so updates never stop.
TEST(HandBudget, SlidingHandDoesOneExpensiveUpdatePerFrame) {
    constexpr double k_dt_s = 1.0 / 90.0;
    constexpr double k_step_m = 0.002;
    constexpr int k_first_frames = 30;  // the grip's first fits
    constexpr int k_frames = 600;
    const GripMesh ring = build_grip_mesh(test::make_torus(0.035, 0.008, 40, 16));
    const HandRig rig = builtin_hand_rig(HandSide::right);
    Updates all;
    for (const double z : {-0.03, 0.0, 0.03}) {
        const Pose from = test::wrist_with_palm_at(rig, {0.0, 0.02, z}, Vec3::UnitY());
        FittedHand hand(ring, from);
        bool evaluated_last_frame = false;
        for (int frame = 0; frame < k_frames; ++frame) {
            const int slid = std::max(0, frame - k_first_frames) % 40;
            hand.wrist_bs().position.x() = from.position.x() + k_step_m * std::min(slid, 40 - slid);
            const FingerPose before = hand.pose();
            hand.frame(k_dt_s);
            const Updates updates = updates_since(hand, before);
            EXPECT_FALSE(evaluated_last_frame && updates.surfaces > 0 && frame > 0) << frame;
            evaluated_last_frame = updates.surfaces > 0;
            const FingerPose& pose = hand.pose();
            const bool is_closing =
                pose.thumb_search.is_running ||
                std::any_of(pose.backoff.begin(), pose.backoff.end(),
                            [](const FingerBackoff& backoff) { return backoff.queued_frames > 0; });
            if (frame < k_first_frames || is_closing) {
                continue;
            }
            EXPECT_LE(updates.surfaces + updates.fingers + updates.thumbs, 1) << frame;
            all.surfaces += updates.surfaces;
            all.fingers += updates.fingers;
            all.thumbs += updates.thumbs;
        }
    }
    EXPECT_GT(all.surfaces, 10);  // every kind gets a share
    EXPECT_GT(all.fingers, 10);
    EXPECT_GT(all.thumbs, 10);
}

// Penetration of the digit with its links thicker by margin_m; 0: its distance to everything is at
// least margin_m.
double depth_with_margin_m(FittedHand& hand, const HingeChain& chain, std::size_t f,
                           double margin_m) {
    double deepest_m = 0.0;
    for (Capsule capsule : chain_capsules(chain, hand.pose().target[f].curl_rad)) {
        if (capsule.radius_m > 0.0) {
            capsule.radius_m += margin_m;
            deepest_m =
                std::max(deepest_m, find_penetration(capsule, hand.hands.front().meshes).depth_m);
        }
    }
    return deepest_m;
}

struct Stops {
    int idle_after_slides = 0;
    int idle_at_rest = 0;
    int bad_thumbs = 0;
    int unconverged = 0;
};

// Fingers that were depenetrated and touch nothing, although closing them from scratch would touch.
int count_idle(FittedHand& hand) {
    constexpr double k_touches_m = 1e-3;
    ChainFitSettings settings = chain_settings(hand.tuning.finger);
    settings.searches = false;
    int idle = 0;
    for (std::size_t f = 0; f < hand.rig.fingers.size(); ++f) {
        const FingerRig& finger = hand.rig.fingers[f];
        if (finger.name == FingerName::thumb || hand.pose().backoff[f].failures == 0) {
            continue;
        }
        const HingeChain chain = finger_chain(finger, 0.0, hand.shown_bs());
        const ChainFit refitted =
            fit_chain(chain, hand.hands.front().meshes, {}, settings, hand.fit_scratch);
        const bool can_touch = refitted.fallback == ChainFallback::sample_pose &&
                               touches(refitted) && refitted.depth_m <= settings.open_depth_m;
        idle += can_touch && depth_with_margin_m(hand, chain, f, k_touches_m) <= 0.0 ? 1 : 0;
    }
    return idle;
}

// True if the thumb penetrates or touches nothing, although a fit at its own opposition would be
// good.
bool is_thumb_bad(FittedHand& hand) {
    constexpr double k_touches_m = 1e-3;
    constexpr double k_max_depth_m = 1.5e-3;
    ChainFitSettings settings = chain_settings(hand.tuning.finger);
    settings.searches = false;
    for (std::size_t f = 0; f < hand.rig.fingers.size(); ++f) {
        if (hand.rig.fingers[f].name != FingerName::thumb) {
            continue;
        }
        const double opposition_rad = hand.pose().target[f].opposition_rad;
        const HingeChain chain = finger_chain(hand.rig.fingers[f], opposition_rad, hand.shown_bs());
        const ChainFit refitted =
            fit_chain(chain, hand.hands.front().meshes, {}, settings, hand.fit_scratch);
        const bool can_be_good = touches(refitted) && refitted.depth_m <= settings.open_depth_m;
        return can_be_good && (depth_with_margin_m(hand, chain, f, k_touches_m) <= 0.0 ||
                               depth_with_margin_m(hand, chain, f, 0.0) > k_max_depth_m);
    }
    return false;
}

// Slides at random over a mesh and stops, repeatedly; counts the state after each slide and after
// three seconds at rest.
void slide_and_stop(const GripMesh& mesh, const Pose& from, std::uint32_t seed, Stops& stops) {
    constexpr double k_dt_s = 1.0 / 90.0;
    constexpr int k_stops = 300;
    constexpr int k_slide_frames = 12;
    constexpr int k_rest_frames = 270;
    test::Random random(seed);
    FittedHand hand(mesh, from);
    for (int stop = 0; stop < k_stops; ++stop) {
        const Vec3 displacement_m = random.vector(0.05);
        const Pose to = from * Pose{displacement_m, rotation_from_vector(random.vector(0.6))};
        const Pose start = hand.wrist_bs();
        for (int frame = 1; frame <= k_slide_frames; ++frame) {
            const double share = static_cast<double>(frame) / k_slide_frames;
            hand.wrist_bs().position = start.position + share * (to.position - start.position);
            hand.wrist_bs().rotation = start.rotation.slerp(share, to.rotation);
            hand.frame(k_dt_s);
        }
        stops.idle_after_slides += count_idle(hand);
        for (int frame = 0; frame < k_rest_frames; ++frame) {
            hand.frame(k_dt_s);
        }
        stops.idle_at_rest += count_idle(hand);
        stops.bad_thumbs += is_thumb_bad(hand) ? 1 : 0;
        stops.unconverged += hand.pose().converged && hand.pose().thumb_converged ? 0 : 1;
    }
}

// Fingers depenetrated during a slide return to the surface once the hand stops, and then every
// target is constant. A finger that slid off a surface into its rest pose stays there: nothing is
// ahead of it.
TEST(HandBudget, StoppedHandTouchesAgainAndConverges) {
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
    EXPECT_GE(stops.idle_after_slides, 10);
    EXPECT_LE(stops.idle_at_rest, 1);
    EXPECT_LE(stops.bad_thumbs, 1);
    EXPECT_EQ(stops.unconverged, 0);
}

// Number of finger refits on a hand that slides back and forth fast.
int count_refits(const GripMesh& mesh, double fast_refit_depth_m) {
    constexpr double k_dt_s = 1.0 / 90.0;
    const HandRig rig = builtin_hand_rig(HandSide::right);
    const Pose from = test::wrist_with_palm_at(rig, {0.0, 0.02, 0.0}, Vec3::UnitY());
    FittedHand hand(mesh, from);
    hand.tuning.finger.fast_refit_depth_m = fast_refit_depth_m;
    hand.frame(test::k_unbudgeted_s);
    int refits = 0;
    for (int frame = 0; frame < 400; ++frame) {
        hand.wrist_bs().position.x() = from.position.x() + 0.04 * std::sin(0.08 * frame);
        hand.wrist_bs().position.y() = from.position.y() + 0.02 * std::sin(0.3 * frame);
        const FingerPose before = hand.pose();
        hand.frame(k_dt_s);
        refits += updates_since(hand, before).fingers;
    }
    return refits;
}

TEST(HandBudget, FastHandRefitsFingersDeeperThanItsThreshold) {
    const GripMesh ring = build_grip_mesh(test::make_torus(0.035, 0.008, 40, 16));
    const int usual = count_refits(ring, FingerTuning{}.fast_refit_depth_m);
    EXPECT_GT(usual, 10);
    EXPECT_GT(count_refits(ring, 1e-4), usual + usual / 10);
    EXPECT_LT(count_refits(ring, 0.1), usual / 2);
}

}  // namespace
}  // namespace handhold::hand_budget_test
