#pragma once

#include <optional>

#include "components/hand.hpp"
#include "components/hand_rig.hpp"
#include "components/hand_surroundings.hpp"
#include "components/stats.hpp"
#include "components/tuning.hpp"
#include "engine/geometry/chain_fit.hpp"

// Fingers and thumbs as chains of hinged capsules: what sweep_fingers and pose_thumb share.
namespace handhold {

// In the frame that `wrist` is in.
HingeChain finger_chain(const FingerRig& finger, double opposition_rad, const Pose& wrist);

ChainFitSettings chain_settings(const FingerTuning& tuning);
// FingerPose::slow_s' frame: the wrist shown went `way_m`.
void update_slow_time(double travel_m, double dt_s, const FingerTuning& tuning, FingerPose& pose);
// The wrist shown stands, trembles or hardly slides, and has so for a moment: hands whose samples
// come at half the frames' rate stand in every second frame.
bool is_slow(const FingerPose& pose);
// For what a sliding hand tries anew beside the fit that it has: cheap, and near to that. A digit
// of a fast hand does not come back from where it is bent clear: it would soon be sunk again.
ChainFitSettings sliding_refit_settings(ChainFitSettings settings, const ChainAngles& last_rad,
                                        bool is_slow);

// Where a finger's searches begin: at the triangle where they ended last time, nearest to the
// finger's base. Where that is none, under the palm, and, as the palm may lie on another part than
// the finger will, at what is nearest to where a finger is when it is half closed. `chain` is in
// the body's frame; the triangle may be of an older mesh. Precondition: there is a mesh.
ChainSeed chain_seed(const HandSurroundings& hand, const GripSurface& surface,
                     std::uint32_t last_triangle, const HingeChain& chain);

// How far the parts of a hand have moved, roughly: a turn moves fingers by its angle times 0.1 m.
double hand_travel_m(const Pose& from, const Pose& to);

// Of a chain sunk deeper than it should be: whether it is worth changing from one fit to another.
bool is_clearly_better(const ChainFit& fit, const ChainFit& than, const ChainFitSettings& settings);

// True where the hand's fingers were fitted a moment ago, with the wrist shown nearly at
// `wrist_bs`: their angles are where to begin from.
bool can_reuse_fit(const FingerPose& pose, const HandSurroundings& hand, const Pose& wrist_bs);
// The same of two places of the wrist on one body.
bool is_small_move(const Pose& from, const Pose& to);

// The palm shown has come to where it is bound for.
bool is_at_target(const PalmOffset& offset);

// An authored pose that would be sunk: counted once, when the palm is in its grip. On its way there
// it is no wonder.
void count_rejected_pose(const PalmOffset& offset, std::size_t finger, FingerPose& pose,
                         StageStats& stats);

// FingerBackoff's frame: the wrist shown went `way_m`.
void advance(FingerBackoff& backoff, double travel_m, double dt_s);
bool is_retry_due(const FingerBackoff& backoff);
// After a try, of `most` things that there are to try. A fast hand's is not all that there is.
void record_attempt(FingerBackoff& backoff, bool has_failed, bool is_fast, std::uint32_t most = 1);
// Something is in its way where it is; false of what is relaxed, sunk or not.
bool touches(const ChainFit& fit);
// Clear of what it was sunk in, but only because it was bent out of it: it touches nothing there.
bool is_bent_clear(const ChainFit& fit);

// FingerLookahead's frame: the wrist shown went `way_m`.
void advance(FingerLookahead& lookahead, double travel_m, double dt_s);
// What of it still counts for a chain that is fitted again; where that may not look now, all that
// is known.
std::optional<bool> has_surface_ahead(const FingerLookahead& lookahead, bool may_query_lookahead);
// After the chain was fitted again: it looked, it touches something and need not, or it goes by
// what it knew. What it knew of another place has to be looked at again where the hand rests.
void update_lookahead(ChainFit& fit, FingerLookahead& lookahead);

// Lifts the palm by one step more where fingers or the thumb are sunk so deep, up to three times.
// Not before the hand that is shown has come to where it is bound for: on its way there they may
// well be sunk.
bool lift_if_penetrating(const HandSurroundings& hand, double depth_m, const PalmTuning& tuning,
                         PalmOffset& offset);
// True where a lift is shown within one frame: the fits that the fingers had are of no use then.
bool lifts_within_frame(const PalmTuning& tuning, double dt_s);

// A digit of a hand that slides was sunk, or touched nothing, and changes to another fit: what is
// shown opens on its way there at a rate. Before its target is set. First closings, fast hands,
// authored poses and letting go open at once.
void begin_transition(const ChainAngles& to_rad, std::size_t finger, FingerPose& pose);

// What is shown of a finger follows its target: opens at once but for a change, closes at a rate;
// opposition turns at that rate either way.
void follow_target(std::size_t finger, double dt_s, const FingerTuning& tuning, FingerPose& pose);

// How curled a fist is, of the way from open to curled.
inline constexpr double k_fist = 0.85;

}  // namespace handhold
