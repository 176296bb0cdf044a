#pragma once

#include <array>
#include <cstdint>

#include "components/hand_rig.hpp"
#include "engine/ecs/entity.hpp"
#include "engine/math/math.hpp"

// How hands are shown: fitted to what they hold. None of it ever moves the player. Every hand
// entity has all of these.
namespace handhold {

// By place in HandRig::fingers: how each is bent, as finger_room.hpp numbers bends; 0: not at all
// known.
using FingerSamplePoses = std::array<std::uint8_t, k_finger_count>;

// Surface under one palm, chosen for the least movement of the palm. Written by search_grip; read
// by constrain_palms, sweep_fingers, pose_thumb.
struct GripSurface {
    static constexpr std::uint32_t k_none = ~0U;

    Entity body = k_no_entity;        // owner of the triangle; null: the hand is empty
    std::uint32_t triangle = k_none;  // of the body's search detail
    Vec3 point_bs = Vec3::Zero();     // on the surface itself, in the body's frame
    Vec3 normal_bs = Vec3::UnitY();   // unit, towards the back of the hand: the surface's mean
                                      // around the point
    // What it was chosen for: it is not looked for again while that stays.
    Pose wrist_bs;
    std::uint64_t surroundings_signature = 0;
    Pose fitted_wrist_bs;  // the wrist held to it, without a lift, where that is known
    bool has_fitted_wrist = false;
    // Fingers that had no room where the palm alone would be held: bent like this they are held
    // clear with it.
    FingerSamplePoses finger_samples = {};
    // Where it is not the one that is cheapest by its limits alone, or palm or fingers have no
    // room: how far the hand still goes until it looks for another. 0: it need not.
    double candidate_recheck_in_m = 0.0;
    // While it looks, a few surfaces in each frame: those it has tried or passed over, then
    // those that it is to try, once they are listed; and what the best of those tried cost where it
    // was tried, which is this one.
    static constexpr std::size_t k_max_candidates = 14;
    std::array<std::uint32_t, k_max_candidates> candidates = {};
    std::uint32_t evaluated_count = 0;  // 0: it does not look
    std::uint32_t candidate_count = 0;  // with those to be tried; 0: not listed yet
    double cost_m = 0.0;
    // The palm may have gone through the first of them: backs of surfaces are tried as well.
    bool allows_backfaces = false;
    // Fingers that had no room at the last of those: it is yet to be tried with them held clear.
    FingerSamplePoses pending_finger_samples = {};
    // Where the fingers had room: how far the hand still goes until that is asked again.
    double clearance_recheck_in_m = 0.0;
    // While it is held: how far the hand still goes until all around is searched again, and the
    // mean of the surface found anew.
    double full_search_in_m = 0.0;
    // False: pushing the palm on moves it still. A hand that rests is held again until it does
    // not, but for no more than a few frames.
    bool is_converged = true;
    std::uint32_t stationary_refine_frames = 0;  // frames
    // A surface was judged in this frame, or others listed: what is dear has turns. Next frame it
    // is not, while the surface and its room are there, and in this one nothing that is sunk is
    // tried anew.
    bool evaluated_this_frame = false;
};

// How far the hand as shown is from the hand as tracked, and where it is bound for: in hand space
// (_hs), so that it travels with the hand. Written by constrain_palms; lift_m also by
// sweep_fingers and pose_thumb.
struct PalmOffset {
    Vec3 shown_m = Vec3::Zero();         // follows target_m no faster than PalmTuning::rate_mps
    Vec3 shown_turn_rad = Vec3::Zero();  // rotation vector
    Vec3 target_m = Vec3::Zero();
    Vec3 target_turn_rad = Vec3::Zero();
    double lift_m = 0.0;  // off the surface, because fingers or the thumb did not fit
    Pose lift_wrist_bs;   // where the tracked hand was then: elsewhere it is tried anew
    // What the target was found for: it is not found again while that stays.
    Pose target_wrist_bs;
    std::uint64_t target_signature = 0;
    double target_lift_m = 0.0;
    std::uint32_t target_triangle = GripSurface::k_none;
};

// The wrist as it is shown, at the end of the frame. Arms reach for it. Written by constrain_palms.
struct PalmPose {
    Pose pose_ws;
};

// When a finger that is sunk, or was bent away from what it was sunk in, or a thumb that touches
// nothing, is closed anew: what was in vain at one place is mostly in vain a little farther on. By
// the way of the wrist shown.
struct FingerBackoff {
    double retry_in_m = 0.0;      // still to go until then, at least -1; time counts as a way too
    double travel_since_m = 0.0;  // gone since all was tried; 0: nothing has changed since
    std::uint32_t failures = 0;   // in vain, in a row: the wait grows with them
    bool was_fast_hand = false;   // the last try was a fast hand's: a thumb tries all anew then
    // Frames since it was to be closed anew: a hand closes a few fingers in each. 0: it has a fit.
    std::uint32_t queued_frames = 0;
};

// Whether a finger that touches nothing would touch something if it closed: to look for that is
// dear, and mostly the same a little farther on. By the way of the wrist shown. Written by
// sweep_fingers and pose_thumb.
struct FingerLookahead {
    double retry_in_m = 0.0;  // still to go until it looks again, when it may; time counts as a way
    double travel_since_m = 0.0;  // gone since it looked
    bool has_surface_ahead = false;
    bool is_known = false;  // it has looked since it touched
};

// A thumb's way through its oppositions, of which a few are tried in each frame.
struct ThumbSearch {
    bool is_running = false;
    bool may_end_early = false;    // it is over early where it is not sunk next to start_step
    std::uint32_t start_step = 0;  // below ThumbTuning::opposition_steps; the nearest come first
    std::uint32_t evaluated_count = 0;
    double cost_m = 0.0;  // of the cheapest so far where it was tried: the thumb's target
    bool needs_depenetration = false;  // that is sunk
};

// How the hand's fingers are shown, by place in HandRig::fingers. Written by sweep_fingers and
// pose_thumb.
struct FingerPose {
    std::array<FingerAngles, k_finger_count> shown;
    std::array<FingerAngles, k_finger_count> target;  // shown follows: opens at once but for
                                                      // opening_lag_rad, closes at
                                                      // FingerTuning::close_radps
    // What shown still has to open after its digit changed from one fit to another, at
    // FingerTuning::transition_radps; in [0, 2 pi].
    std::array<std::array<double, k_max_links>, k_finger_count> opening_lag_rad = {};
    // Where each finger's search ended, on the gripped body's search detail: where it begins next.
    std::array<std::uint32_t, k_finger_count> seed_triangle = {~0U, ~0U, ~0U, ~0U, ~0U};
    // What the targets were found for: nothing is solved again while it stays.
    Entity solved_body = k_no_entity;
    Pose solved_wrist_bs;
    std::uint64_t solved_signature = 0;
    double slow_s =
        0.0;  // since the wrist shown was faster than FingerTuning::slow_speed_mps, at most 1
    bool solved = false;
    bool converged = false;  // no target is on its way to where it turns, none may be closed anew
    Pose thumb_wrist_bs;     // the same of the thumb
    bool thumb_solved = false;
    bool thumb_converged = false;
    ThumbSearch thumb_search;
    std::array<FingerBackoff, k_finger_count> backoff;
    std::array<FingerLookahead, k_finger_count> lookahead;
    // A hand tries anew one sunk digit in a frame, beside those that are closed for the first time:
    // the fingers leave the next turn to a thumb that waits.
    bool finger_refit_this_frame = false;  // in this frame; by sweep_fingers
    bool thumb_refit_pending = false;      // since the last one; by pose_thumb
    // Authored poses that would be sunk with the palm in its grip: counted already.
    std::array<bool, k_finger_count> authored_pose_rejected = {};
};

}  // namespace handhold
