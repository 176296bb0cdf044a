#pragma once

#include <array>
#include <cstdint>

#include "components/hand_rig.hpp"
#include "engine/ecs/entity.hpp"
#include "engine/math/math.hpp"

// How hands are shown: palm and fingers fitted to the gripped surface. None of this moves the
// player. Every hand entity has each of these components.
//
// Where to look:
//   a grab begins         systems/grab/update_grabs.hpp
//   palm surface          systems/hand/search_grip.hpp      -> GripSurface
//   the palm's limits     systems/hand/constrain_palms.hpp  -> PalmOffset
//   where a finger stops  systems/hand/sweep_fingers.hpp    -> FingerPose::closed
//   the fit               systems/hand/fit_hands.hpp        -> PalmOffset, PalmPose, FingerPose
//
// All lengths are in the hand's metres: the world's over PlayerOrigin::scale.
namespace handhold {

// The surface under one palm: the candidate with the smallest full cost
// (shared/surface_candidates.hpp). Written by search_grip; change_shape resets it. Read by
// constrain_palms, sweep_fingers and fit_hands. _bs is the gripped body's frame.
struct GripSurface {
    static constexpr std::uint32_t k_none = ~0U;

    Entity body = k_no_entity;        // body that was searched; null: the hand is empty
    std::uint32_t triangle = k_none;  // index into the body's search mesh; k_none: no surface
    Vec3 point_bs = Vec3::Zero();     // point on the contact mesh under the palm
    // Mean surface normal around the point; unit, towards the back of the hand.
    Vec3 normal_bs = Vec3::UnitY();
    // Tracked wrist and HandSurroundings::search_signature of the last search. The next one is due
    // when the hand has travelled by k_search_again_m from there, or the signature has changed.
    Pose wrist_bs;
    std::uint64_t surroundings_signature = 0;
    // The palm within its limits here. Not set without a surface and in an authored grip.
    Pose fitted_wrist_bs;
};

// The palm relative to the tracked hand: wrist = tracked wrist * offset. An offset is a
// translation and a rotation vector in hand space (_hs), so that it moves with the hand.
struct PalmOffset {
    // Written by constrain_palms: the palm within its limits, or in its authored grip.
    Vec3 held_m = Vec3::Zero();
    Vec3 held_turn_rad = Vec3::Zero();
    // Written by fit_hands. `target`: the fitted wrist; of a fist, the tracked wrist moved
    // to the player's side of surfaces and into contact. `shown`: follows it at up to
    // PalmTuning::rate_mps; PalmPose has the shown wrist, which may be moved out of surfaces.
    Vec3 target_m = Vec3::Zero();
    Vec3 target_turn_rad = Vec3::Zero();
    Vec3 shown_m = Vec3::Zero();
    Vec3 shown_turn_rad = Vec3::Zero();
};

// The shown wrist at the end of the frame; the arms reach for it. Written by fit_hands; by
// estimate_arms for lost hands and those that come back.
struct PalmPose {
    Pose pose_ws;
};

// The digits of one hand, by index into HandRig::fingers. Written by sweep_fingers and fit_hands;
// change_shape resets both cache keys.
struct FingerPose {
    std::array<FingerAngles, k_finger_count> shown;   // follows `target` at the tuned rates
    std::array<FingerAngles, k_finger_count> target;  // written by fit_hands
    // Result of the last closing, written by sweep_fingers: the angles, whether the digit touched
    // something, and whether it is known to be outside solids.
    std::array<FingerAngles, k_finger_count> closed;
    std::array<bool, k_finger_count> touches = {};
    std::array<bool, k_finger_count> is_closed_clear = {};
    // Digits in their authored pose, and digits whose authored pose penetrates in this grip.
    std::array<bool, k_finger_count> is_authored = {};
    std::array<bool, k_finger_count> authored_pose_rejected = {};
    // Cache key of the closing. The digits close again on another body, at another place of its
    // surface, in another grip, or after enough wrist travel. Null body: not closed, or given up by
    // fit_hands.
    Entity closed_body = k_no_entity;
    Pose closed_wrist_bs;  // wrist at the closing, with PalmOffset::held_m and held_turn_rad
    Vec3 closed_point_bs = Vec3::Zero();
    Vec3 closed_normal_bs = Vec3::UnitY();
    bool is_closed_in_grip = false;  // the hand was in an authored grip at the closing
    // True until fit_hands has fitted the closing.
    bool is_newly_closed = false;
    // The body that `target` was fitted to; null: none.
    Entity fitted_body = k_no_entity;
    // The digits that this fit left outside of solids.
    std::array<bool, k_finger_count> is_clear = {};
    // Cache key of the target: tracked wrist and HandSurroundings::signature of the last fit.
    Pose fitted_wrist_bs;
    std::uint64_t fitted_signature = 0;
    bool is_converged = false;  // another fit for the same key would change nothing
    // Number of fits since the last closing that also started from another thumb. State, unlike
    // other work that is spread over frames, because it says which thumbs have been rejected.
    std::uint32_t thumbs_tried = 0;
};

}  // namespace handhold
