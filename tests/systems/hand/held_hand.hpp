#pragma once

#include <algorithm>

#include "engine/geometry/chain_fit.hpp"
#include "engine/geometry/closest_point.hpp"
#include "fitted_hand.hpp"
#include "systems/hand/shared/finger_chain.hpp"
#include "systems/hand/shared/palm_fit.hpp"

namespace handhold::search_grip_test {

using test::FittedHand;
using test::k_right;
using test::Random;
using test::wrist_with_palm_at;

// Penetration of the palm. Oracle: find_penetration, which has its own tests.
inline double palm_penetration_m(const FittedHand& hand, const Pose& wrist_bs) {
    double deepest_m = 0.0;
    for (const PalmCapsule& palm : hand.rig.palm) {
        const Capsule capsule = {
            {transform_point(wrist_bs, palm.a_hs), transform_point(wrist_bs, palm.b_hs)},
            palm.radius_m};
        deepest_m =
            std::max(deepest_m, find_penetration(capsule, hand.hands.front().meshes).depth_m);
    }
    return deepest_m;
}

// Penetration of the palm fitted by search_grip.
inline double palm_penetration_m(const FittedHand& hand) {
    return palm_penetration_m(hand, hand.surface.at(k_right).fitted_wrist_bs);
}

// Penetration of the open fingers, without the thumb.
inline double finger_penetration_m(const FittedHand& hand, const Pose& wrist_bs) {
    double deepest_m = 0.0;
    for (const FingerRig& finger : hand.rig.fingers) {
        if (finger.name == FingerName::thumb) {
            continue;
        }
        const auto links = chain_capsules(finger_chain(finger, 0.0, wrist_bs), finger.lower_rad);
        for (std::size_t i = 0; i < finger.link_count; ++i) {
            deepest_m =
                std::max(deepest_m, find_penetration(links[i], hand.hands.front().meshes).depth_m);
        }
    }
    return deepest_m;
}

// True if a surface crosses the axis of a finger.
inline bool is_crossed(const FittedHand& hand, const FingerRig& finger, const FingerAngles& angles,
                       const Pose& wrist_bs) {
    const auto links =
        chain_capsules(finger_chain(finger, angles.opposition_rad, wrist_bs), angles.curl_rad);
    for (std::size_t i = 0; i < finger.link_count; ++i) {
        if (find_penetration(links[i], hand.hands.front().meshes).crossed_at) {
            return true;
        }
    }
    return false;
}

// True if a surface crosses the axis of a shown digit.
inline bool is_digit_crossed(FittedHand& hand) {
    const Pose wrist_bs = hand.shown_bs();
    for (std::size_t f = 0; f < hand.rig.fingers.size(); ++f) {
        if (is_crossed(hand, hand.rig.fingers[f], hand.pose().shown[f], wrist_bs)) {
            return true;
        }
    }
    return false;
}

// True if a surface crosses the axis of an open finger, without the thumb, beside the palm fitted
// by search_grip.
inline bool is_open_finger_crossed(const FittedHand& hand) {
    const Pose& wrist_bs = hand.surface.at(k_right).fitted_wrist_bs;
    return std::ranges::any_of(hand.rig.fingers, [&](const FingerRig& finger) {
        return finger.name != FingerName::thumb &&
               is_crossed(hand, finger, {.curl_rad = finger.lower_rad}, wrist_bs);
    });
}

}  // namespace handhold::search_grip_test
