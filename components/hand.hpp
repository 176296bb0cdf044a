#pragma once

#include <array>
#include <cstdint>

#include "components/hand_rig.hpp"
#include "engine/ecs/entity.hpp"
#include "engine/math/math.hpp"

// How hands are shown: palm and fingers fitted to the gripped surface. None of this ever moves the
// player. Every hand entity has one element of each component.
//
// Where to look:
//   a grab begins         systems/locomotion/update_grabs.hpp
//   palm surface          systems/hand/search_grip.hpp      -> GripSurface
//   the palm's limits     systems/hand/constrain_palms.hpp  -> PalmOffset, PalmPose
//   where a finger stops  systems/hand/sweep_fingers.hpp    -> FingerPose
//   the thumb             systems/hand/pose_thumb.hpp       -> FingerPose
//
// Distances named `*_in_m` and `travel_*` are wrist travel in the gripped body's frame: translation
// plus 0.1 m per radian of rotation (hand_travel_m). Elapsed time also counts as travel, so that a
// stationary hand is checked again too.
namespace handhold {

// Per finger, by index into HandRig::fingers: a sample pose of shared/finger_clearance.hpp;
// 0: none.
using FingerSamplePoses = std::array<std::uint8_t, k_finger_count>;

// The surface under one palm: the candidate that needs the least palm movement. Written by
// search_grip; read by constrain_palms, sweep_fingers and pose_thumb. _bs is the gripped body.
struct GripSurface {
    static constexpr std::uint32_t k_none = ~0U;

    Entity body = k_no_entity;        // owner of the triangle; null: the hand is empty
    std::uint32_t triangle = k_none;  // index into the body's search mesh; k_none: no surface
    Vec3 point_bs = Vec3::Zero();     // point on the contact mesh under the palm
    Vec3 normal_bs = Vec3::UnitY();   // mean normal around the point, towards the hand's back; unit
    // Cache key: tracked wrist and HandSurroundings::signature of the last search. The search is
    // skipped while both are unchanged.
    Pose wrist_bs;
    std::uint64_t surroundings_signature = 0;
    Pose fitted_wrist_bs;           // wrist fitted to this surface, without PalmOffset::lift_m
    bool has_fitted_wrist = false;  // fitted_wrist_bs is valid
    // Per finger, the sample pose used as part of the palm's collision shape because the finger has
    // no clearance here; 0: none.
    FingerSamplePoses finger_samples = {};
    // Travel left until other candidates are evaluated again. 0: never, because this surface is the
    // cheapest in closed form and has clearance.
    double candidate_recheck_in_m = 0.0;
    // Progress of a candidate search that is spread over frames. Triangles of the candidates:
    // [0, evaluated_count) were evaluated or skipped, [evaluated_count, candidate_count) are next.
    static constexpr std::size_t k_max_candidates = 14;
    std::array<std::uint32_t, k_max_candidates> candidates = {};
    std::uint32_t evaluated_count = 0;  // 0: no search is in progress
    std::uint32_t candidate_count = 0;  // 0: the candidates are not listed yet
    double cost_m = 0.0;                // cost of the best candidate so far, which is this surface
    // The palm may have crossed the first candidate's surface, so backfaces are evaluated as well.
    bool allows_backfaces = false;
    // Fingers without clearance at the last candidate. It is evaluated again with these sample
    // poses as part of the palm; all 0: not pending.
    FingerSamplePoses pending_finger_samples = {};
    // Travel left until clearance is checked again. 0: palm or fingers have no clearance here.
    double clearance_recheck_in_m = 0.0;
    // Travel left until the next full search. Until then the search only follows this surface's
    // neighbours and keeps normal_bs.
    double full_search_in_m = 0.0;
    // False: more iterations would still move the fitted palm. A stationary hand continues for a
    // limited number of frames.
    bool is_converged = true;
    std::uint32_t stationary_refine_frames = 0;  // frames spent on that so far
    // A candidate was evaluated or the candidates were listed in this frame. That is the hand's
    // expensive work of the frame: no candidate is evaluated in the next frame, and no penetrating
    // digit is refitted in this one.
    bool evaluated_this_frame = false;
};

// Offset of the shown hand from the tracked hand: shown wrist = tracked wrist * offset, in hand
// space (_hs), so that it moves with the hand. Written by constrain_palms; sweep_fingers and
// pose_thumb raise lift_m.
struct PalmOffset {
    Vec3 shown_m = Vec3::Zero();         // follows target_m at up to PalmTuning::rate_mps
    Vec3 shown_turn_rad = Vec3::Zero();  // rotation vector; follows target_turn_rad
    Vec3 target_m = Vec3::Zero();
    Vec3 target_turn_rad = Vec3::Zero();  // rotation vector
    double lift_m =
        0.0;  // extra palm height because fingers penetrate; at most 3 * PalmTuning::lift_m
    Pose lift_wrist_bs;  // tracked wrist when lift_m last grew; far from here lift_m resets to 0
    // Cache key of the target, which is kept while all of these are unchanged.
    Pose solved_wrist_bs;  // tracked wrist
    std::uint64_t solved_signature = 0;
    double solved_lift_m = 0.0;
    std::uint32_t solved_triangle = GripSurface::k_none;
};

// The shown wrist at the end of the frame, which the arms reach for. Written by constrain_palms.
struct PalmPose {
    Pose pose_ws;
};

// Back-off between refits from scratch of one digit that penetrates, was moved out of a
// penetration, or (thumb) touches nothing. A failed refit usually fails again nearby. Distances are
// travel of the shown wrist.
struct FingerBackoff {
    double retry_in_m = 0.0;      // travel left until the next refit; at least -1
    double travel_since_m = 0.0;  // travel since every option was tried; 0: a refit is pointless
    std::uint32_t failures = 0;   // failed refits in a row; the back-off grows with them
    bool was_fast_hand = false;   // the last refit tried the fewer options of a fast hand
    // Frames this digit has waited for a first fit (a few fingers of a hand per frame); 0: not
    // waiting.
    std::uint32_t queued_frames = 0;
};

// Cached look-ahead of a digit that touches nothing: would it touch something if it closed? The
// query is expensive and the answer rarely changes nearby. Distances are travel of the shown wrist.
// Written by sweep_fingers and pose_thumb.
struct FingerLookahead {
    double retry_in_m = 0.0;         // travel left until the next query
    double travel_since_m = 0.0;     // travel since the last query
    bool has_surface_ahead = false;  // cached result
    bool is_known = false;           // the result is valid
};

// Progress of a thumb's search over its opposition angles, a few of which are evaluated per frame.
// The best so far is the thumb's target.
struct ThumbSearch {
    bool is_running = false;
    bool may_end_early = false;    // end after start_step's neighbours if the best is clear
    std::uint32_t start_step = 0;  // below ThumbTuning::opposition_steps; nearest steps come first
    std::uint32_t evaluated_count = 0;
    double cost_m = 0.0;               // cost of the best so far, where it was evaluated
    bool needs_depenetration = false;  // the best so far still penetrates
};

// The digits of one hand, by index into HandRig::fingers. Written by sweep_fingers and pose_thumb.
struct FingerPose {
    std::array<FingerAngles, k_finger_count> shown;
    // `shown` follows: it opens at once except for opening_lag_rad, and closes at
    // FingerTuning::close_radps.
    std::array<FingerAngles, k_finger_count> target;
    // How far `shown` is still more closed than `target` after the digit changed to another fit.
    // Shrinks at FingerTuning::transition_radps; in [0, 2 pi].
    std::array<std::array<double, k_max_links>, k_finger_count> opening_lag_rad = {};
    // Triangle of the gripped body's search mesh at which each digit's last search ended: the seed
    // of its next search.
    std::array<std::uint32_t, k_finger_count> seed_triangle = {~0U, ~0U, ~0U, ~0U, ~0U};
    // Cache key of the finger targets: nothing is solved again while it is unchanged.
    Entity solved_body = k_no_entity;
    Pose solved_wrist_bs;  // shown wrist
    std::uint64_t solved_signature = 0;
    // Time since the shown wrist was last faster than FingerTuning::slow_speed_mps; at most 1.
    double slow_s = 0.0;
    bool solved = false;     // the finger targets and their key are valid
    bool converged = false;  // no finger target is still turning and no finger awaits a refit
    Pose thumb_wrist_bs;     // the same for the thumb: shown wrist it was solved for
    bool thumb_solved = false;
    bool thumb_converged = false;
    ThumbSearch thumb_search;
    std::array<FingerBackoff, k_finger_count> backoff;
    std::array<FingerLookahead, k_finger_count> lookahead;
    // One penetrating digit of a hand is refitted per frame, besides first fits. Fingers and thumb
    // alternate: the fingers skip a frame if the thumb is pending.
    bool finger_refit_this_frame = false;  // written by sweep_fingers
    bool thumb_refit_pending = false;      // written by pose_thumb
    // The authored pose of this digit penetrates with the palm in its grip; already counted.
    std::array<bool, k_finger_count> authored_pose_rejected = {};
};

}  // namespace handhold
