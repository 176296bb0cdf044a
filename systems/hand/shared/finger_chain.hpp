#pragma once

#include <optional>

#include "components/hand.hpp"
#include "components/hand_rig.hpp"
#include "components/hand_surroundings.hpp"
#include "components/stats.hpp"
#include "components/tuning.hpp"
#include "engine/geometry/chain_fit.hpp"

// Code shared by sweep_fingers and pose_thumb: fingers and thumbs as chains of hinged capsules.
namespace handhold {

// Returns the digit's chain in the frame in which `wrist` is given.
HingeChain finger_chain(const FingerRig& finger, double opposition_rad, const Pose& wrist);

ChainFitSettings chain_settings(const FingerTuning& tuning);
// Updates FingerPose::slow_s for one frame in which the shown wrist travelled `travel_m`.
void update_slow_time(double travel_m, double dt_s, const FingerTuning& tuning, FingerPose& pose);
// True if the shown wrist has been slow for 0.1 s. One slow frame is not enough: a hand that is
// tracked at half the frame rate stands still in every second frame.
bool is_slow(const FingerPose& pose);
// Returns settings for refitting a digit of a sliding hand from scratch: a cheap fit that prefers
// sample poses near `last_rad`. A digit of a slow hand closes from its clear sample pose until it
// touches. A digit of a fast hand stays there, because it would soon penetrate again.
ChainFitSettings sliding_refit_settings(ChainFitSettings settings, const ChainAngles& last_rad,
                                        bool is_slow);

// Returns the seeds of a finger's surface searches: the point of `last_triangle` nearest to the
// finger's base. If `last_triangle` is not a triangle of the gripped mesh, returns two seeds: the
// point under the palm, and the point nearest to the half-closed finger, which may be over another
// part of the mesh. `chain` is in the body's frame. Precondition: the hand has a mesh.
ChainSeed chain_seed(const HandSurroundings& hand, const GripSurface& surface,
                     std::uint32_t last_triangle, const HingeChain& chain);

// Returns the approximate travel of a hand between two wrist poses: |translation| + 0.1 m *
// |rotation|.
double hand_travel_m(const Pose& from, const Pose& to);

// True if replacing the penetrating fit `current` by `fit` is worth the visible change: `fit` is
// clear, or penetrates less than half as deep.
bool is_clearly_better(const ChainFit& fit, const ChainFit& current,
                       const ChainFitSettings& settings);

// True if the fingers were fitted on this body with the shown wrist near `wrist_bs`, so that
// refit_chain can start from their angles.
bool can_reuse_fit(const FingerPose& pose, const HandSurroundings& hand, const Pose& wrist_bs);
// True if the hand travels less than 8 mm between two wrist poses on one body.
bool is_small_move(const Pose& from, const Pose& to);

// True if the shown palm offset equals its target.
bool is_at_target(const PalmOffset& offset);

// Counts an authored pose that penetrates: once per grip, and only after the palm has reached its
// target, because penetration before that is expected.
void count_rejected_pose(const PalmOffset& offset, std::size_t finger, FingerPose& pose,
                         StageStats& stats);

// Advances the back-off by one frame in which the shown wrist travelled `travel_m`.
void advance(FingerBackoff& backoff, double travel_m, double dt_s);
bool is_retry_due(const FingerBackoff& backoff);
// Records an attempt at one of `option_count` different refits. Each failure doubles the back-off,
// up to four times its first value. Once every option has failed, no refit is due until the wrist
// travels again. Exception: if the last attempt was a fast hand's, a refit becomes due without
// travel.
void record_attempt(FingerBackoff& backoff, bool has_failed, bool is_fast,
                    std::uint32_t option_count = 1);
// True if a surface stops the chain. False for a rest pose, even if it penetrates.
bool touches(const ChainFit& fit);
// True if the fit is a clear sample pose that touches nothing.
bool is_bent_clear(const ChainFit& fit);

// Advances the look-ahead by one frame in which the shown wrist travelled `travel_m`.
void advance(FingerLookahead& lookahead, double travel_m, double dt_s);
// Returns the cached look-ahead to use for a refit; none: the refit must query it. If
// `may_query_lookahead` is false, an outdated result is returned too.
std::optional<bool> has_surface_ahead(const FingerLookahead& lookahead, bool may_query_lookahead);
// Updates the cache after a refit: stores the result of a new query, or clears the cache if the
// chain touches. A fit that used a result from another wrist pose is marked as not converged, so
// that a hand at rest queries again.
void update_lookahead(ChainFit& fit, FingerLookahead& lookahead);

// Raises the palm by PalmTuning::lift_m, at most three times, if a digit penetrates deeper than
// PalmTuning::lift_from_depth_m. Does nothing before the shown palm has reached its target, because
// penetration before that is expected. Returns true if the palm was raised.
bool lift_if_penetrating(const HandSurroundings& hand, double depth_m, const PalmTuning& tuning,
                         PalmOffset& offset);
// True if a lift step is shown within one frame, which invalidates the current finger fits.
bool lifts_within_frame(const PalmTuning& tuning, double dt_s);

// Starts a transition of a sliding hand's digit to another fit: `shown` opens towards it at
// FingerTuning::transition_radps instead of at once. Call before the target is set.
void begin_transition(const ChainAngles& to_rad, std::size_t finger, FingerPose& pose);

// Moves a finger's `shown` angles towards its target for one frame. Curl opens at once, except for
// opening_lag_rad, and closes at FingerTuning::close_radps. Opposition turns at the closing rate in
// both directions.
void follow_target(std::size_t finger, double dt_s, const FingerTuning& tuning, FingerPose& pose);

// Curl of a fist, as a share of the range from open (0) to fully curled (1).
inline constexpr double k_fist_curl = 0.85;

}  // namespace handhold
