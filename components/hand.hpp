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
//   a grab begins         systems/locomotion/update_grabs.hpp
//   palm surface          systems/hand/search_grip.hpp      -> GripSurface
//   the palm's limits     systems/hand/constrain_palms.hpp  -> PalmOffset, PalmPose
//   where a finger stops  systems/hand/sweep_fingers.hpp    -> FingerPose
//   the thumb             systems/hand/pose_thumb.hpp       -> FingerPose
//
// Distances named `*_in_m` and `travel_*` are wrist travel in the gripped body's frame: translation
// plus 0.1 m per radian of rotation (hand_travel_m). For `*_in_m`, elapsed time also counts as
// travel, so that a stationary hand is checked again too.
namespace handhold {

// One sample pose per finger (see systems/hand/shared/finger_clearance.hpp), by index into
// HandRig::fingers; 0: none.
using FingerSamplePoses = std::array<std::uint8_t, k_finger_count>;

// The surface under one palm: the candidate with the smallest full cost
// (shared/surface_candidates.hpp). Written by search_grip; read by constrain_palms, sweep_fingers
// and pose_thumb. _bs is the gripped body's frame.
struct GripSurface {
    static constexpr std::uint32_t k_none = ~0U;

    Entity body = k_no_entity;        // owner of the triangle; null: the hand is empty
    std::uint32_t triangle = k_none;  // index into the body's search mesh; k_none: no surface
    Vec3 point_bs = Vec3::Zero();     // point on the contact mesh under the palm
    // Mean surface normal around the point; unit, towards the back of the hand.
    Vec3 normal_bs = Vec3::UnitY();
    // Cache key: tracked wrist and HandSurroundings::signature of the last search. The search is
    // skipped while both are unchanged.
    Pose wrist_bs;
    std::uint64_t surroundings_signature = 0;
    Pose fitted_wrist_bs;  // wrist fitted to this surface, before PalmOffset::lift_m is added
    bool has_fitted_wrist = false;  // fitted_wrist_bs is valid
    // Per finger, the sample pose used as part of the palm's collision shape because the finger has
    // no clearance here; 0: none.
    FingerSamplePoses finger_samples = {};
    // Travel left until other candidates are evaluated again. 0: they are not, because this surface
    // has the lowest closed-form cost and clearance.
    double candidate_recheck_in_m = 0.0;
    // Progress of a candidate search that is spread over frames: the triangles of its candidates.
    // Those before evaluated_count were evaluated or skipped; those from there to candidate_count
    // come next.
    static constexpr std::size_t k_max_candidates = 14;
    std::array<std::uint32_t, k_max_candidates> candidates = {};
    std::uint32_t evaluated_count = 0;  // 0: no search is in progress
    std::uint32_t candidate_count = 0;  // 0: the candidates are not listed yet
    double cost_m = 0.0;                // full cost of this surface, the best candidate so far
    // The palm may have crossed the first candidate's surface, so backfaces are evaluated as well.
    bool allows_backfaces = false;
    // Sample poses of the fingers without clearance at the last candidate. That candidate is
    // evaluated again with these poses as part of the palm's shape. All 0: nothing is pending.
    FingerSamplePoses pending_finger_samples = {};
    // Travel left until this surface's clearance is checked again. 0: palm or fingers have none.
    double clearance_recheck_in_m = 0.0;
    // Travel left until the next full search. Until then only triangles near this one are searched,
    // and normal_bs is kept.
    double full_search_in_m = 0.0;
    // False: more iterations would still move the fitted palm. The fit of a stationary hand is then
    // refined for a limited number of frames.
    bool is_converged = true;
    std::uint32_t stationary_refine_frames = 0;  // number of such frames so far
    // A candidate was evaluated, or the candidates were listed, in this frame. Because this is
    // expensive, no penetrating digit is refitted in this frame, and no candidate is evaluated in
    // the next.
    bool evaluated_this_frame = false;
};

// Offset of the shown hand from the tracked hand: shown wrist = tracked wrist * offset. The offset
// is in hand space, so that it moves with the hand. Written by constrain_palms; sweep_fingers and
// pose_thumb raise lift_m.
struct PalmOffset {
    Vec3 shown_m = Vec3::Zero();         // follows target_m at up to PalmTuning::rate_mps
    Vec3 shown_turn_rad = Vec3::Zero();  // rotation vector; follows target_turn_rad
    Vec3 target_m = Vec3::Zero();
    Vec3 target_turn_rad = Vec3::Zero();  // rotation vector
    // Extra palm height because fingers penetrate; at most 3 * PalmTuning::lift_m.
    double lift_m = 0.0;
    // Tracked wrist when lift_m last grew. Once the wrist is far from here, lift_m resets to 0.
    Pose lift_wrist_bs;
    // Cache key of the target: it is kept while these four fields are unchanged.
    Pose solved_wrist_bs;  // tracked wrist
    std::uint64_t solved_signature = 0;
    double solved_lift_m = 0.0;
    std::uint32_t solved_triangle = GripSurface::k_none;
};

// The shown wrist at the end of the frame, which the arms reach for. Written by constrain_palms.
struct PalmPose {
    Pose pose_ws;
};

// Back-off between refits from scratch of one digit. A refit is wanted if the digit penetrates, was
// depenetrated, or (thumb) touches nothing. A failed refit usually fails again nearby. Distances
// are travel of the shown wrist.
struct FingerBackoff {
    double retry_in_m = 0.0;      // travel left until the next refit; at least -1
    double travel_since_m = 0.0;  // travel since every option failed; 0: a refit would fail again
    std::uint32_t failures = 0;   // failed refits in a row; lengthens the back-off
    bool was_fast_hand = false;   // the last refit used a fast hand's settings
    // Frames for which this digit has waited for its first fit (the number of fits per frame is
    // limited); 0: not waiting.
    std::uint32_t queued_frames = 0;
};

// Cached look-ahead of a digit that touches nothing: whether it would touch something if it closed.
// The query is expensive, and its result rarely changes nearby. Distances are travel of the shown
// wrist. Written by sweep_fingers and pose_thumb.
struct FingerLookahead {
    double retry_in_m = 0.0;         // travel left until the next query
    double travel_since_m = 0.0;     // travel since the last query
    bool has_surface_ahead = false;  // cached result
    bool is_known = false;           // has_surface_ahead is valid
};

// Progress of a thumb's search over its opposition angles. A few angles are evaluated per frame;
// the thumb's target is the best fit so far.
struct ThumbSearch {
    bool is_running = false;
    // True: ends after start_step and its neighbours if the best fit is clear.
    bool may_end_early = false;
    std::uint32_t start_step = 0;  // opposition step evaluated first; nearest steps follow
    std::uint32_t evaluated_count = 0;
    double cost_m = 0.0;  // cost of the best fit so far, at the wrist pose of its evaluation
    bool needs_depenetration = false;  // the best fit so far penetrates
};

// The digits of one hand, by index into HandRig::fingers. Written by sweep_fingers and pose_thumb.
struct FingerPose {
    std::array<FingerAngles, k_finger_count> shown;
    // `shown` follows `target`: it opens at once except for opening_lag_rad, and closes at
    // FingerTuning::close_radps.
    std::array<FingerAngles, k_finger_count> target;
    // Angle by which `shown` may still be more closed than `target` after the digit changed to
    // another fit. Shrinks at FingerTuning::transition_radps; in [0, 2 pi].
    std::array<std::array<double, k_max_links>, k_finger_count> opening_lag_rad = {};
    // Per digit: triangle of the gripped body's search mesh at which the last search ended. Seeds
    // the next search.
    std::array<std::uint32_t, k_finger_count> seed_triangle = {~0U, ~0U, ~0U, ~0U, ~0U};
    // Cache key of the finger targets: they are not solved again while these three fields are
    // unchanged.
    Entity solved_body = k_no_entity;
    Pose solved_wrist_bs;  // shown wrist
    std::uint64_t solved_signature = 0;
    // Time since the shown wrist was last faster than FingerTuning::slow_speed_mps; at most 1.
    double slow_s = 0.0;
    bool solved = false;     // the finger targets and their key are valid
    bool converged = false;  // false: a finger target still turns, or a finger awaits a refit
    Pose thumb_wrist_bs;     // shown wrist for which the thumb was solved
    bool thumb_solved = false;
    bool thumb_converged = false;
    ThumbSearch thumb_search;
    std::array<FingerBackoff, k_finger_count> backoff;
    std::array<FingerLookahead, k_finger_count> lookahead;
    // Per frame, one penetrating digit of a hand is refitted, besides first fits. Fingers and thumb
    // take turns: if thumb_refit_pending is set, the fingers skip a frame.
    bool finger_refit_this_frame = false;  // written by sweep_fingers
    bool thumb_refit_pending = false;      // written by pose_thumb
    // True: this digit's authored pose penetrates although the palm is in its grip. The fallback
    // was counted.
    std::array<bool, k_finger_count> authored_pose_rejected = {};
};

}  // namespace handhold
