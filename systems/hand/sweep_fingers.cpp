#include "systems/hand/sweep_fingers.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "engine/geometry/chain_refit.hpp"
#include "systems/hand/shared/finger_chain.hpp"
#include "systems/rigs/authored_hand.hpp"

namespace handhold {
namespace {

// True if the hand's finger targets can be kept as they are.
bool is_cached(const FingerPose& pose, const HandSurroundings& hand, double travel_m,
               double reuse_travel_m) {
    return pose.solved && pose.converged && pose.solved_signature == hand.signature &&
           travel_m < reuse_travel_m;
}

// Sets the fingers of a hand without a surface to the rest pose, or to a fist.
void rest_fingers(const HandRig& rig, bool is_fist, FingerPose& pose) {
    for (std::size_t f = 0; f < rig.fingers.size(); ++f) {
        const FingerRig& finger = rig.fingers[f];
        if (finger.name == FingerName::thumb) {
            continue;
        }
        for (std::size_t i = 0; i < finger.link_count; ++i) {
            const double fist =
                finger.lower_rad[i] + k_fist_curl * (finger.upper_rad[i] - finger.lower_rad[i]);
            pose.target[f].curl_rad[i] = is_fist ? fist : finger.rest_rad[i];
        }
        pose.backoff[f].queued_frames = 0;
    }
    pose.solved = false;
    pose.slow_s = 0.0;
    pose.authored_pose_rejected.fill(false);
}

void count_fallback(ChainFallback fallback, StageStats& stats) {
    if (fallback == ChainFallback::all_cuts) {
        stats.count(Fallback::finger_full_search);
    } else if (fallback == ChainFallback::sample_pose) {
        stats.count(Fallback::finger_depenetrated);
    } else if (fallback == ChainFallback::opened) {
        stats.count(Fallback::finger_opened);
    } else if (fallback == ChainFallback::rest_pose) {
        stats.count(Fallback::finger_no_contact);
    }
}

using FingerSet = std::array<bool, k_finger_count>;

// Fits the fingers of one hand at a time. In each frame, the fingers fall into three groups:
// - queued: have no usable fit; are closed from scratch, refits_per_frame of them per frame;
// - kept: their last fit is updated (refit_last), which is cheap;
// - refitted: one of the kept fingers that needs a refit and whose back-off is over is closed from
//   scratch.
class FingerFitter {
  public:
    FingerFitter(const SweepFingersIo& io, const Tuning& tuning, SearchOrder order,
                 StageStats& stats)
        : io_(io), tuning_(tuning), settings_(chain_settings(tuning.finger)), stats_(stats) {
        settings_.order = order;
    }

    void close(std::size_t hand_index) {
        const HandSurroundings& hand = io_.hands[hand_index];
        const GripSurface& surface = io_.surface.at(hand.hand);
        const PalmOffset& offset = io_.offset.at(hand.hand);
        FingerPose& pose = io_.fingers.at(hand.hand);
        pose.finger_refit_this_frame = false;
        if (surface.triangle == GripSurface::k_none) {
            rest_fingers(*hand.rig, !hand.is_gripping && io_.hand.at(hand.hand).pressed, pose);
            pose_unverified(hand, pose);
            return;
        }
        const Pose wrist_bs = inverse(hand.body_ws) * io_.palm.at(hand.hand).pose_ws;
        const bool is_same = pose.solved && pose.solved_body == hand.body;
        const double travel_m = is_same ? hand_travel_m(pose.solved_wrist_bs, wrist_bs) : 0.0;
        update_slow_time(travel_m, io_.dt_s, tuning_.finger, pose);
        if (is_cached(pose, hand, travel_m, tuning_.finger.reuse_travel_m)) {
            return;
        }
        if (!is_same) {
            pose.seed_triangle.fill(GripSurface::k_none);
            pose.thumb_solved = false;
            pose.thumb_search = {};
        }
        if (pose.solved_signature != hand.signature) {
            expire_caches(pose);
        }
        // A hand that still moves into its authored grip is solved every frame, even if it travels
        // less than reuse_travel_m: an authored pose that penetrates now can be clear later.
        pose.converged = hand.authored == nullptr || is_at_target(offset);
        const double depth_m = fit_fingers(hand_index, wrist_bs, travel_m, pose);
        pose.solved = true;
        pose.solved_body = hand.body;
        pose.solved_signature = hand.signature;
        pose.solved_wrist_bs = wrist_bs;
        lift_palm(hand, depth_m, pose);
    }

  private:
    // Called when something near the hand has moved. This counts as travel of the hand.
    static void expire_caches(FingerPose& pose) {
        constexpr double k_equivalent_travel_m = 1e-3;
        pose.thumb_converged = false;
        for (FingerBackoff& backoff : pose.backoff) {
            advance(backoff, k_equivalent_travel_m, 0.0);
        }
        pose.lookahead = {};
    }

    // Fingers of a hand without a surface take their authored poses without a penetration check.
    static void pose_unverified(const HandSurroundings& hand, FingerPose& pose) {
        for (std::size_t f = 0; hand.authored != nullptr && f < hand.rig->fingers.size(); ++f) {
            const auto posed = posed_angles(hand.rig->fingers[f], *hand.authored);
            if (posed && hand.rig->fingers[f].name != FingerName::thumb) {
                pose.target[f] = *posed;
            }
        }
    }

    // Takes the finger's authored pose unless it penetrates. Returns true if it was taken.
    bool take_authored_pose(const HandSurroundings& hand, std::size_t f, const HingeChain& chain,
                            FingerPose& pose) {
        const auto posed = hand.authored != nullptr
                               ? posed_angles(hand.rig->fingers[f], *hand.authored)
                               : std::nullopt;
        if (!posed) {
            pose.authored_pose_rejected[f] = false;
            return false;
        }
        if (posed_depth_m(chain, posed->curl_rad, hand.meshes, io_.scratch.patch) >
            tuning_.finger.search_depth_m) {
            count_rejected_pose(io_.offset.at(hand.hand), f, pose, stats_);
            return false;
        }
        pose.authored_pose_rejected[f] = false;
        pose.target[f] = *posed;
        return true;
    }

    // Fits all fingers for this frame, within the budget that the class comment describes. Returns
    // the largest penetration depth, not counting fingers whose refit is due.
    double fit_fingers(std::size_t hand_index, const Pose& wrist_bs, double travel_since_solve_m,
                       FingerPose& pose) {
        const HandSurroundings& hand = io_.hands[hand_index];
        const bool reuses_fit = can_reuse_fit(pose, hand, wrist_bs);
        const FingerSet needs_fit = update_queue(hand, wrist_bs, reuses_fit, pose);
        std::size_t refits_left = max_refits();
        FingerSet is_fitted = refit_queued(hand, wrist_bs, refits_left, pose);
        const double travel_m = reuses_fit ? travel_since_solve_m : 0.0;
        FingerSet is_kept = {};
        for (std::size_t f = 0; f < k_finger_count; ++f) {
            is_kept[f] = needs_fit[f] && !is_fitted[f] && pose.backoff[f].queued_frames == 0;
            if (is_kept[f]) {
                advance(pose.backoff[f], travel_m, io_.dt_s);
                advance(pose.lookahead[f], travel_m, io_.dt_s);
            }
        }
        const std::size_t lookahead_finger = next_lookahead(hand, is_kept, pose);
        std::size_t next_refit = k_finger_count;
        for (std::size_t f = 0; f < k_finger_count; ++f) {
            FingerBackoff& backoff = pose.backoff[f];
            if (!is_kept[f]) {
                continue;
            }
            fits_[f] =
                refit_last(hand, wrist_bs, f, std::isinf(io_.dt_s) || f == lookahead_finger, pose);
            is_fitted[f] = true;
            if (needs_refit(fits_[f], f, pose)) {
                const bool is_first = next_refit == k_finger_count ||
                                      backoff.retry_in_m < pose.backoff[next_refit].retry_in_m;
                next_refit = is_retry_due(backoff) && is_first ? f : next_refit;
            } else if (backoff.retry_in_m <= 0.0 && touches(fits_[f])) {
                backoff.failures = 0;
            }
        }
        const bool has_budget =
            std::isinf(io_.dt_s) ||
            (!io_.surface.at(hand.hand).evaluated_this_frame && !pose.thumb_refit_pending);
        pose.finger_refit_this_frame =
            next_refit != k_finger_count && refits_left > 0 && has_budget;
        if (pose.finger_refit_this_frame) {
            refit_if_better(hand, wrist_bs, next_refit, pose);
        }
        double depth_m = 0.0;
        for (std::size_t f = 0; f < hand.rig->fingers.size(); ++f) {
            if (is_fitted[f]) {
                depth_m = std::max(depth_m, take_fit(hand_index, f, pose));
            }
            pose.converged = pose.converged && queued_frames_of(hand, f, pose) == 0;
        }
        return depth_m;
    }

    // Queues fingers that must be closed from scratch; increments the waiting time of queued ones.
    // Returns the fingers to fit: all except thumbs and fingers in an authored pose.
    FingerSet update_queue(const HandSurroundings& hand, const Pose& wrist_bs, bool reuses_fit,
                           FingerPose& pose) {
        FingerSet needs_fit = {};
        for (std::size_t f = 0; f < hand.rig->fingers.size(); ++f) {
            const FingerRig& finger = hand.rig->fingers[f];
            if (finger.name == FingerName::thumb) {
                continue;
            }
            needs_fit[f] = !take_authored_pose(hand, f, finger_chain(finger, 0.0, wrist_bs), pose);
            std::uint32_t& queued_frames = pose.backoff[f].queued_frames;
            queued_frames =
                needs_fit[f] && (queued_frames > 0 || !reuses_fit) ? queued_frames + 1 : 0;
        }
        return needs_fit;
    }

    // Closes queued fingers from scratch, those that have waited longest first, while the budget
    // lasts.
    FingerSet refit_queued(const HandSurroundings& hand, const Pose& wrist_bs,
                           std::size_t& refits_left, FingerPose& pose) {
        FingerSet is_refitted = {};
        for (; refits_left > 0; --refits_left) {
            std::size_t next = 0;
            for (std::size_t f = 1; f < k_finger_count; ++f) {
                next =
                    queued_frames_of(hand, f, pose) > queued_frames_of(hand, next, pose) ? f : next;
            }
            if (queued_frames_of(hand, next, pose) == 0) {
                break;
            }
            pose.backoff[next] = {};
            fits_[next] = refit_from_scratch(hand, wrist_bs, next, false, pose);
            is_refitted[next] = true;
        }
        return is_refitted;
    }

    // Returns the number of frames that a finger has waited in the queue; 0 for thumbs, which
    // pose_thumb queues.
    static std::uint32_t queued_frames_of(const HandSurroundings& hand, std::size_t f,
                                          const FingerPose& pose) {
        const bool is_finger =
            f < hand.rig->fingers.size() && hand.rig->fingers[f].name != FingerName::thumb;
        return is_finger ? pose.backoff[f].queued_frames : 0;
    }

    // True if the fit penetrates so deeply that another fit is worth the visible change.
    bool is_penetrating(const ChainFit& fit) const {
        return fit.depth_m > settings_.search_depth_m;
    }

    // True if the finger was moved to a clear sample pose, touches nothing, and has no surface
    // ahead. While the hand is slow, a refit may bring such a finger back to the surface.
    static bool is_idle_bent_clear(const ChainFit& fit, std::size_t f, const FingerPose& pose) {
        const FingerLookahead& lookahead = pose.lookahead[f];
        return !touches(fit) && pose.backoff[f].failures > 0 &&
               !(lookahead.is_known && lookahead.has_surface_ahead);
    }

    // A slow hand refits more readily, because the new fit of a fast hand would not last.
    bool needs_refit(const ChainFit& fit, std::size_t f, const FingerPose& pose) const {
        return is_slow(pose) ? is_penetrating(fit) || is_idle_bent_clear(fit, f, pose)
                             : fit.depth_m > tuning_.finger.fast_refit_depth_m;
    }

    std::size_t max_refits() const {
        return std::isinf(io_.dt_s)
                   ? k_finger_count
                   : static_cast<std::size_t>(std::max(1, tuning_.finger.refits_per_frame));
    }

    // Returns the one finger that may renew its look-ahead in this frame: among those that are due,
    // the one with the oldest result. k_finger_count: none, for example because candidates were
    // evaluated in this frame.
    std::size_t next_lookahead(const HandSurroundings& hand, const FingerSet& is_kept,
                               const FingerPose& pose) const {
        std::size_t next = k_finger_count;
        for (std::size_t f = 0; f < k_finger_count; ++f) {
            const FingerLookahead& lookahead = pose.lookahead[f];
            const bool is_first = next == k_finger_count ||
                                  lookahead.travel_since_m > pose.lookahead[next].travel_since_m;
            const bool is_due = is_kept[f] && lookahead.is_known && lookahead.retry_in_m <= 0.0;
            next = is_due && is_first ? f : next;
        }
        return io_.surface.at(hand.hand).evaluated_this_frame ? k_finger_count : next;
    }

    // Updates the finger's last fit to the current wrist pose.
    ChainFit refit_last(const HandSurroundings& hand, const Pose& wrist_bs, std::size_t f,
                        bool may_query_lookahead, FingerPose& pose) {
        ChainRefitSettings refit;
        refit.max_turn_rad = io_.dt_s * tuning_.finger.close_radps;
        refit.has_surface_ahead = has_surface_ahead(pose.lookahead[f], may_query_lookahead);
        ChainFit fit =
            refit_chain(finger_chain(hand.rig->fingers[f], 0.0, wrist_bs), pose.target[f].curl_rad,
                        hand.meshes, settings_, refit, io_.scratch);
        update_lookahead(fit, pose.lookahead[f]);
        return fit;
    }

    // Closes a finger from scratch, and changes to that fit if it is clearly better.
    void refit_if_better(const HandSurroundings& hand, const Pose& wrist_bs, std::size_t f,
                         FingerPose& pose) {
        const bool slow_hand = is_slow(pose);
        const ChainFitSettings saved_settings = std::exchange(
            settings_, sliding_refit_settings(settings_, fits_[f].angle_rad, slow_hand));
        const ChainFit refitted = refit_from_scratch(hand, wrist_bs, f, !slow_hand, pose);
        settings_ = saved_settings;
        if (is_clearly_better(refitted, fits_[f], settings_) &&
            (is_penetrating(fits_[f]) || touches(refitted))) {
            begin_transition(refitted.angle_rad, f, pose);
            fits_[f] = refitted;
            // Marks the fit as not converged: hinges that nothing stopped close further in the next
            // frame.
            fits_[f].is_turn_limited = true;
        }
    }

    // Makes the fit the finger's target. Returns the fit's penetration depth; 0 if a refit is due.
    double take_fit(std::size_t hand_index, std::size_t f, FingerPose& pose) {
        const ChainFit& fit = fits_[f];
        pose.target[f].curl_rad = fit.angle_rad;
        pose.target[f].opposition_rad = 0.0;
        const bool wants_refit = is_penetrating(fit) || is_idle_bent_clear(fit, f, pose);
        const bool is_moving = (wants_refit && pose.backoff[f].travel_since_m > 0.0) ||
                               (!is_penetrating(fit) && fit.is_turn_limited);
        pose.converged = pose.converged && !is_moving;
        if (!io_.traces.empty()) {
            io_.traces[hand_index][f] = {fit.discs,        fit.pops,     fit.walked,
                                         fit.contact_link, fit.fallback, fit.depth_m};
        }
        const bool is_refit_due = needs_refit(fit, f, pose) && pose.backoff[f].retry_in_m <= 0.0;
        return is_refit_due ? 0.0 : fit.depth_m;
    }

    ChainFit refit_from_scratch(const HandSurroundings& hand, const Pose& wrist_bs, std::size_t f,
                                bool is_fast, FingerPose& pose) {
        const HingeChain chain = finger_chain(hand.rig->fingers[f], 0.0, wrist_bs);
        const ChainSeed seed = settings_.searches ? chain_seed(hand, io_.surface.at(hand.hand),
                                                               pose.seed_triangle[f], chain)
                                                  : ChainSeed{};
        const ChainFit fit = fit_chain(chain, hand.meshes, seed, settings_, io_.scratch);
        if (fit.contact_triangle != k_no_triangle) {
            pose.seed_triangle[f] = fit.contact_triangle;
        }
        pose.lookahead[f] = {};
        count_fallback(fit.fallback, stats_);
        record_attempt(pose.backoff[f], is_penetrating(fit) || is_bent_clear(fit), is_fast);
        return fit;
    }

    void lift_palm(const HandSurroundings& hand, double depth_m, FingerPose& pose) {
        if (lift_if_penetrating(hand, depth_m, tuning_.palm, io_.offset.at(hand.hand))) {
            stats_.count(Fallback::palm_lifted);
            pose.solved = !lifts_within_frame(tuning_.palm, io_.dt_s);
        }
    }

    const SweepFingersIo& io_;
    const Tuning& tuning_;
    ChainFitSettings settings_;
    StageStats& stats_;
    std::array<ChainFit, k_finger_count> fits_;  // of the current hand
};

}  // namespace

void sweep_fingers(const SweepFingersIo& io, const Tuning& tuning, StageStats& stats,
                   SearchOrder order) {
    FingerFitter fitter(io, tuning, order, stats);
    for (std::size_t hand_index = 0; hand_index < io.hands.size(); ++hand_index) {
        fitter.close(hand_index);
        const HandSurroundings& hand = io.hands[hand_index];
        FingerPose& pose = io.fingers.at(hand.hand);
        for (std::size_t f = 0; f < hand.rig->fingers.size(); ++f) {
            if (hand.rig->fingers[f].name != FingerName::thumb) {
                follow_target(f, io.dt_s, tuning.finger, pose);
            }
        }
    }
}

}  // namespace handhold
