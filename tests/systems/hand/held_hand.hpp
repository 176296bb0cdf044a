#pragma once

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

// Penetration of the palm fitted by search_grip. Oracle: find_penetration, which has its own tests.
inline double palm_penetration_m(FittedHand& hand) {
    const Pose& wrist_bs = hand.surface.at(k_right).fitted_wrist_bs;
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

// Calls `use` with the penetration of each link of the open fingers, without the thumb.
template <typename Use>
void visit_open_fingers(const FittedHand& hand, const Pose& wrist_bs, Use&& use) {
    for (const FingerRig& finger : hand.rig.fingers) {
        if (finger.name == FingerName::thumb) {
            continue;
        }
        const auto links = chain_capsules(finger_chain(finger, 0.0, wrist_bs), finger.lower_rad);
        for (std::size_t i = 0; i < finger.link_count; ++i) {
            use(find_penetration(links[i], hand.hands.front().meshes));
        }
    }
}

// Penetration of the open fingers.
inline double finger_penetration_m(const FittedHand& hand, const Pose& wrist_bs) {
    double deepest_m = 0.0;
    visit_open_fingers(hand, wrist_bs, [&](const CapsulePenetration& found) {
        deepest_m = std::max(deepest_m, found.depth_m);
    });
    return deepest_m;
}

// True if a surface crosses the axis of an open finger.
inline bool is_finger_crossed(FittedHand& hand) {
    bool is_crossed = false;
    visit_open_fingers(hand, hand.surface.at(k_right).fitted_wrist_bs,
                       [&](const CapsulePenetration& found) {
                           is_crossed = is_crossed || found.crossed_at.has_value();
                       });
    return is_crossed;
}

}  // namespace handhold::search_grip_test
