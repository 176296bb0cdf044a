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
//   the palm's limits     systems/hand/constrain_palms.hpp  -> PalmOffset, PalmPose
//   where a finger stops  systems/hand/sweep_fingers.hpp    -> FingerPose::closed
//   the fit               systems/hand/fit_hands.hpp        -> PalmOffset, PalmPose, FingerPose
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
// and fit_hands. _bs is the gripped body's frame.
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
    Pose fitted_wrist_bs;           // wrist fitted to this surface
    bool has_fitted_wrist = false;  // fitted_wrist_bs is valid
    // Per finger, the sample pose used as part of the palm's collision shape because the finger has
    // no clearance here; 0: none.
    FingerSamplePoses finger_samples = {};
    // Travel left until other candidates are evaluated again. 0: no recheck is needed, because this
    // surface has clearance and the lowest closed-form cost of all.
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
    // Travel left until this surface's clearance is checked again. 0: palm or fingers have no
    // clearance here.
    double clearance_recheck_in_m = 0.0;
    // Travel left until the next full search. Until then only triangles near this one are searched,
    // and normal_bs is kept.
    double full_search_in_m = 0.0;
    // False: more iterations would still move the fitted palm. The fit of a stationary hand is then
    // refined for a limited number of frames.
    bool is_converged = true;
    std::uint32_t stationary_refine_frames = 0;  // number of such frames so far
    // A candidate was evaluated, or the candidates were listed, in this frame. search_grip then
    // evaluates none in the next frame, because evaluation is expensive.
    bool evaluated_this_frame = false;
};

// The shown palm relative to the tracked hand: shown wrist = tracked wrist * offset. An offset is a
// translation and a rotation vector in hand space (_hs), so that it moves with the hand.
struct PalmOffset {
    // Written by constrain_palms: the palm within its limits, or in its authored grip.
    Vec3 held_m = Vec3::Zero();
    Vec3 held_turn_rad = Vec3::Zero();
    // Written by fit_hands: the fitted wrist, and the shown one, which follows it at up to
    // PalmTuning::rate_mps.
    Vec3 target_m = Vec3::Zero();
    Vec3 target_turn_rad = Vec3::Zero();
    Vec3 shown_m = Vec3::Zero();
    Vec3 shown_turn_rad = Vec3::Zero();
    // Cache key of `held`, which is kept while all of these are unchanged.
    Pose solved_wrist_bs;  // tracked wrist
    std::uint64_t solved_signature = 0;
    std::uint32_t solved_triangle = GripSurface::k_none;
};

// The shown wrist at the end of the frame; the arms reach for it. Written by fit_hands.
struct PalmPose {
    Pose pose_ws;
};

// The digits of one hand, by index into HandRig::fingers.
struct FingerPose {
    std::array<FingerAngles, k_finger_count> shown;   // follows `target` at the tuned rates
    std::array<FingerAngles, k_finger_count> target;  // written by fit_hands
    // The last closing, written by sweep_fingers: angles, and whether the digit touched something
    // and is known to be outside solids.
    std::array<FingerAngles, k_finger_count> closed;
    std::array<bool, k_finger_count> touches = {};
    std::array<bool, k_finger_count> is_closed_clear = {};
    // Digits in their authored pose, and digits whose authored pose penetrates in this grip.
    std::array<bool, k_finger_count> is_authored = {};
    std::array<bool, k_finger_count> authored_pose_rejected = {};
    // Cache key of the closing. The digits close again on another body, at another place of its
    // surface, in another grip, or after enough wrist travel. Null body: not closed.
    Entity closed_body = k_no_entity;
    Pose closed_wrist_bs;  // wrist of the closed hand with the held palm
    Vec3 closed_point_bs = Vec3::Zero();
    Vec3 closed_normal_bs = Vec3::UnitY();
    bool is_closed_in_grip = false;  // closed by an authored grip
    // True until fit_hands has fitted the closing.
    bool is_newly_closed = false;
    // The body that `target` was fitted to; null: none. Below, the digits that this fit left
    // outside of solids.
    Entity fitted_body = k_no_entity;
    std::array<bool, k_finger_count> is_clear = {};
    // Cache key of the target: tracked wrist and HandSurroundings::signature of the last fit.
    Pose fitted_wrist_bs;
    std::uint64_t fitted_signature = 0;
    bool is_converged = false;  // another fit for the same key would change nothing
};

}  // namespace handhold
