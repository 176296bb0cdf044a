#pragma once

#include "engine/geometry/chain_fit.hpp"
#include "engine/geometry/closest_point.hpp"
#include "fitted_hand.hpp"
#include "systems/hand/shared/finger_chain.hpp"
#include "systems/hand/shared/finger_clearance.hpp"
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

// True if a surface crosses the axis of a finger without clearance, in the sample pose in which it
// penetrates least.
inline bool is_finger_crossed(FittedHand& hand) {
    const GripSurface& surface = hand.surface.at(k_right);
    ChainPatch patch;
    const FingerClearance clearance =
        find_finger_clearance(hand.hands.front(), surface.fitted_wrist_bs, patch);
    for (std::size_t f = 0; f < hand.rig.fingers.size(); ++f) {
        const FingerRig& finger = hand.rig.fingers[f];
        const auto bent = sample_pose_angles(finger, clearance.finger_samples[f]);
        if (!bent) {
            continue;
        }
        const HingeChain chain =
            finger_chain(finger, bent->opposition_rad, surface.fitted_wrist_bs);
        const auto links = chain_capsules(chain, bent->curl_rad);
        for (std::size_t i = 0; i < chain.link_count; ++i) {
            if (find_penetration(links[i], hand.hands.front().meshes).crossed_at) {
                return true;
            }
        }
    }
    return false;
}

}  // namespace handhold::search_grip_test
