#pragma once

#include <optional>

#include "components/hand.hpp"
#include "components/hand_rig.hpp"
#include "components/hand_surroundings.hpp"
#include "components/stats.hpp"
#include "components/tuning.hpp"
#include "engine/geometry/chain_fit.hpp"

// Fingers and thumbs as chains of hinged capsules: code shared by sweep_fingers and pose_thumb.
namespace handhold {

// The digit's chain in the frame of `wrist`.
HingeChain finger_chain(const FingerRig& finger, double opposition_rad, const Pose& wrist);

ChainFitSettings chain_settings(const FingerTuning& tuning);
// Updates FingerPose::slow_s for one frame in which the shown wrist travelled `travel_m`.
void update_slow_time(double travel_m, double dt_s, const FingerTuning& tuning, FingerPose& pose);
// True if the shown wrist has been slow for 0.1 s. A single slow frame does not count: a hand
// sampled at half the frame rate stands still in every second frame.
bool is_slow(const FingerPose& pose);
// Settings for refitting a digit of a sliding hand from scratch: cheap, and preferring fits near
// `last_rad`. A digit of a fast hand stays at a clear sample pose instead of closing from there
// until it touches, because it would soon penetrate again.
ChainFitSettings sliding_refit_settings(ChainFitSettings settings, const ChainAngles& last_rad,
                                        bool is_slow);

// Seeds of a finger's cut searches: its last search's triangle, at the point nearest to the
// finger's base. Without a valid `last_triangle`, two seeds: under the palm, and nearest to the
// half-closed finger, which may be over another part of the mesh. `chain` is in the body's frame;
// the triangle may be from an older mesh. Precondition: the hand has a mesh.
ChainSeed chain_seed(const HandSurroundings& hand, const GripSurface& surface,
                     std::uint32_t last_triangle, const HingeChain& chain);

// Approximate travel of a hand's parts between two wrist poses: |translation| + 0.1 m * |rotation|.
double hand_travel_m(const Pose& from, const Pose& to);

// True if replacing the penetrating fit `current` by `fit` is worth the visible change: `fit` is
// clear, or less than half as deep.
bool is_clearly_better(const ChainFit& fit, const ChainFit& current,
                       const ChainFitSettings& settings);

// True if the fingers were fitted on this body with the shown wrist near `wrist_bs`, so that their
// angles can be carried along.
bool can_reuse_fit(const FingerPose& pose, const HandSurroundings& hand, const Pose& wrist_bs);
// True if the hand travels less than 8 mm between two wrist poses on one body.
bool is_small_move(const Pose& from, const Pose& to);

// True if the shown palm offset equals its target.
bool is_at_target(const PalmOffset& offset);

// Counts a penetrating authored pose, once per grip and only after the palm has reached its target:
// penetration on the way there is expected.
void count_rejected_pose(const PalmOffset& offset, std::size_t finger, FingerPose& pose,
                         StageStats& stats);

// Advances the back-off by one frame in which the shown wrist travelled `travel_m`.
void advance(FingerBackoff& backoff, double travel_m, double dt_s);
bool is_retry_due(const FingerBackoff& backoff);
// Records one of `option_count` different refits. The back-off doubles after a failure, up to four
// times the first. Once every option has failed, nothing is due until the wrist travels again,
// except that attempts of a fast hand do not count as complete.
void record_attempt(FingerBackoff& backoff, bool has_failed, bool is_fast,
                    std::uint32_t option_count = 1);
// True if a surface stops the chain; false for a rest pose, even a penetrating one.
bool touches(const ChainFit& fit);
// True if the fit is a clear sample pose that touches nothing.
bool is_bent_clear(const ChainFit& fit);

// Advances the look-ahead by one frame in which the shown wrist travelled `travel_m`.
void advance(FingerLookahead& lookahead, double travel_m, double dt_s);
// The cached look-ahead to use for a refit; none: query it. If no query is allowed now, an outdated
// result is used too.
std::optional<bool> has_surface_ahead(const FingerLookahead& lookahead, bool may_query_lookahead);
// Updates the cache after a refit: stores a new query, or clears the cache if the chain touches. A
// fit that used a result from another wrist pose is marked as turn-limited, so that a hand at rest
// queries again.
void update_lookahead(ChainFit& fit, FingerLookahead& lookahead);

// Raises the palm by one step (PalmTuning::lift_m, up to three) if a digit penetrates deeper than
// PalmTuning::lift_from_depth_m. Only once the shown palm has reached its target: penetration on
// the way there is expected. Returns whether it did.
bool lift_if_penetrating(const HandSurroundings& hand, double depth_m, const PalmTuning& tuning,
                         PalmOffset& offset);
// True if a lift step is shown within one frame, which invalidates the current finger fits.
bool lifts_within_frame(const PalmTuning& tuning, double dt_s);

// Starts a change of a sliding hand's digit to another fit: `shown` will open towards it at
// FingerTuning::transition_radps. Call before the target is set. Without it `shown` opens at once.
void begin_transition(const ChainAngles& to_rad, std::size_t finger, FingerPose& pose);

// Moves a finger's `shown` angles towards its target for one frame. Curl opens at once, except for
// opening_lag_rad, and closes at FingerTuning::close_radps; opposition turns at that rate both
// ways.
void follow_target(std::size_t finger, double dt_s, const FingerTuning& tuning, FingerPose& pose);

// Curl of a fist, as a share of the range from open (0) to fully curled (1).
inline constexpr double k_fist_curl = 0.85;

}  // namespace handhold
