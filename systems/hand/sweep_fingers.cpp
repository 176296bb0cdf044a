#include "systems/hand/sweep_fingers.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "engine/geometry/chain_refit.hpp"
#include "systems/hand/shared/finger_chain.hpp"
#include "systems/rigs/authored_hand.hpp"

namespace handhold {
namespace {

bool stands(const FingerPose& pose, const HandSurroundings& hand, double way_m, double stroll_m) {
    return pose.solved && pose.arrived && pose.solved_surroundings == hand.signature &&
           way_m < stroll_m;
}

void rest_fingers(const HandRig& rig, bool is_fist, FingerPose& pose) {
    for (std::size_t f = 0; f < rig.fingers.size(); ++f) {
        const FingerRig& finger = rig.fingers[f];
        if (finger.name == FingerName::thumb) {
            continue;
        }
        for (std::size_t i = 0; i < finger.link_count; ++i) {
            const double fist =
                finger.lower_rad[i] + k_fist * (finger.upper_rad[i] - finger.lower_rad[i]);
            pose.target[f].curl_rad[i] = is_fist ? fist : finger.relaxed_rad[i];
        }
        pose.retry[f].queued = 0;
    }
    pose.solved = false;
    pose.slow_s = 0.0;
    pose.pose_refused.fill(false);
}

void count_fallback(ChainFallback fallback, StageStats& stats) {
    if (fallback == ChainFallback::all_cuts) {
        stats.count(Fallback::finger_searched_all);
    } else if (fallback == ChainFallback::bent) {
        stats.count(Fallback::finger_bent);
    } else if (fallback == ChainFallback::opened) {
        stats.count(Fallback::finger_opened);
    } else if (fallback == ChainFallback::relaxed) {
        stats.count(Fallback::finger_touches_nothing);
    }
}

using FingerSet = std::array<bool, k_finger_count>;

class HandCloser {
  public:
    HandCloser(const SweepFingersIo& io, const Tuning& tuning, SearchOrder order, StageStats& stats)
        : io_(io), tuning_(tuning), settings_(chain_settings(tuning.finger)), stats_(stats) {
        settings_.order = order;
    }

    void close(std::size_t place) {
        const HandSurroundings& hand = io_.hands[place];
        const GripSurface& surface = io_.surface.at(hand.hand);
        const PalmOffset& offset = io_.offset.at(hand.hand);
        FingerPose& pose = io_.fingers.at(hand.hand);
        pose.finger_tried = false;
        if (surface.triangle == GripSurface::k_none) {
            rest_fingers(*hand.rig, !hand.grips && io_.hand.at(hand.hand).pressed, pose);
            pose_unverified(hand, pose);
            return;
        }
        const Pose wrist_bs = inverse(hand.body_ws) * io_.palm.at(hand.hand).pose_ws;
        const bool is_same = pose.solved && pose.solved_body == hand.body;
        const double way_m = is_same ? hand_way_m(pose.solved_wrist_bs, wrist_bs) : 0.0;
        note_speed(way_m, io_.dt_s, tuning_.finger, pose);
        if (stands(pose, hand, way_m, tuning_.finger.stroll_m)) {
            return;
        }
        if (!is_same) {
            pose.seed_triangle.fill(GripSurface::k_none);
            pose.thumb_solved = false;
            pose.thumb_search = {};
        }
        if (pose.solved_surroundings != hand.signature) {
            look_again(pose);
        }
        // On its way into its grip a hand is solved in every frame, however slow it is: what is
        // sunk there is not in the grip.
        pose.arrived = hand.authored == nullptr || has_arrived(offset);
        const double depth_m = close_fingers(place, wrist_bs, way_m, pose);
        pose.solved = true;
        pose.solved_body = hand.body;
        pose.solved_surroundings = hand.signature;
        pose.solved_wrist_bs = wrist_bs;
        lift(hand, depth_m, pose);
    }

  private:
    // Something near has moved, the hand need not have.
    static void look_again(FingerPose& pose) {
        constexpr double k_seen_as_m = 1e-3;
        pose.thumb_arrived = false;
        for (FingerRetry& retry : pose.retry) {
            age(retry, k_seen_as_m, 0.0);
        }
        pose.outlook = {};
    }

    // Where there is no surface near an authored grip its fingers stand as they were posed.
    static void pose_unverified(const HandSurroundings& hand, FingerPose& pose) {
        for (std::size_t f = 0; hand.authored != nullptr && f < hand.rig->fingers.size(); ++f) {
            const auto posed = posed_angles(hand.rig->fingers[f], *hand.authored);
            if (posed && hand.rig->fingers[f].name != FingerName::thumb) {
                pose.target[f] = *posed;
            }
        }
    }

    // As an authored grip has the finger, where it has it so that it is not sunk.
    bool take_posed(const HandSurroundings& hand, std::size_t f, const HingeChain& chain,
                    FingerPose& pose) {
        const auto posed = hand.authored != nullptr
                               ? posed_angles(hand.rig->fingers[f], *hand.authored)
                               : std::nullopt;
        if (!posed) {
            pose.pose_refused[f] = false;
            return false;
        }
        if (posed_depth_m(chain, posed->curl_rad, hand.meshes, io_.scratch.patch) >
            tuning_.finger.search_depth_m) {
            count_refusal(io_.offset.at(hand.hand), f, pose, stats_);
            return false;
        }
        pose.pose_refused[f] = false;
        pose.target[f] = *posed;
        return true;
    }

    // Fingers stay with the fits that they have, but for a few: those that have none have their
    // turn to close anew, or one of those that are sunk. A hand never pays for more in one frame.
    // Returns how deep the fingers are, but for what is yet to be closed anew.
    double close_fingers(std::size_t place, const Pose& wrist_bs, double solved_way_m,
                         FingerPose& pose) {
        const HandSurroundings& hand = io_.hands[place];
        const bool keeps = keeps_fit(pose, hand, wrist_bs);
        const FingerSet is_free = queue(hand, wrist_bs, keeps, pose);
        std::size_t closings = most_closings();
        FingerSet is_fitted = close_queued(hand, wrist_bs, closings, pose);
        const double way_m = keeps ? solved_way_m : 0.0;
        FingerSet is_kept = {};
        for (std::size_t f = 0; f < k_finger_count; ++f) {
            is_kept[f] = is_free[f] && !is_fitted[f] && pose.retry[f].queued == 0;
            if (is_kept[f]) {
                age(pose.retry[f], way_m, io_.dt_s);
                age(pose.outlook[f], way_m, io_.dt_s);
            }
        }
        const std::size_t looking = next_to_look(hand, is_kept, pose);
        std::size_t neediest = k_finger_count;
        for (std::size_t f = 0; f < k_finger_count; ++f) {
            FingerRetry& retry = pose.retry[f];
            if (!is_kept[f]) {
                continue;
            }
            fits_[f] = keep(hand, wrist_bs, f, std::isinf(io_.dt_s) || f == looking, pose);
            is_fitted[f] = true;
            if (wants_another(fits_[f], f, pose)) {
                const bool is_first =
                    neediest == k_finger_count || retry.wait_m < pose.retry[neediest].wait_m;
                neediest = may_retry(retry) && is_first ? f : neediest;
            } else if (retry.wait_m <= 0.0 && touches(fits_[f])) {
                retry.tries = 0;
            }
        }
        const bool is_turn =
            std::isinf(io_.dt_s) || (!io_.surface.at(hand.hand).was_judged && !pose.thumb_waits);
        pose.finger_tried = neediest != k_finger_count && closings > 0 && is_turn;
        if (pose.finger_tried) {
            change_if_better(hand, wrist_bs, neediest, pose);
        }
        double depth_m = 0.0;
        for (std::size_t f = 0; f < hand.rig->fingers.size(); ++f) {
            if (is_fitted[f]) {
                depth_m = std::max(depth_m, take_fit(place, f, pose));
            }
            pose.arrived = pose.arrived && waits(hand, f, pose) == 0;
        }
        return depth_m;
    }

    // Those that are to be closed anew wait one frame longer. Returns the fingers that are to be
    // fitted: thumbs and those that an authored grip poses are not.
    FingerSet queue(const HandSurroundings& hand, const Pose& wrist_bs, bool keeps,
                    FingerPose& pose) {
        FingerSet is_free = {};
        for (std::size_t f = 0; f < hand.rig->fingers.size(); ++f) {
            const FingerRig& finger = hand.rig->fingers[f];
            if (finger.name == FingerName::thumb) {
                continue;
            }
            is_free[f] = !take_posed(hand, f, finger_chain(finger, 0.0, wrist_bs), pose);
            std::uint32_t& queued = pose.retry[f].queued;
            queued = is_free[f] && (queued > 0 || !keeps) ? queued + 1 : 0;
        }
        return is_free;
    }

    // As many as may be, those that wait longest first.
    FingerSet close_queued(const HandSurroundings& hand, const Pose& wrist_bs,
                           std::size_t& closings, FingerPose& pose) {
        FingerSet is_closed = {};
        for (; closings > 0; --closings) {
            std::size_t next = 0;
            for (std::size_t f = 1; f < k_finger_count; ++f) {
                next = waits(hand, f, pose) > waits(hand, next, pose) ? f : next;
            }
            if (waits(hand, next, pose) == 0) {
                break;
            }
            pose.retry[next] = {};
            fits_[next] = close_anew(hand, wrist_bs, next, false, pose);
            is_closed[next] = true;
        }
        return is_closed;
    }

    // Frames that a finger waits for its turn; a thumb has its own.
    static std::uint32_t waits(const HandSurroundings& hand, std::size_t f,
                               const FingerPose& pose) {
        const bool is_finger =
            f < hand.rig->fingers.size() && hand.rig->fingers[f].name != FingerName::thumb;
        return is_finger ? pose.retry[f].queued : 0;
    }

    // So deep that another fit is worth the change.
    bool is_sunk(const ChainFit& fit) const { return fit.depth_m > settings_.search_depth_m; }

    // In the air, and not on its way to anything, since it was bent out of what it was sunk in: it
    // may come back when the hand is slow.
    static bool hangs(const ChainFit& fit, std::size_t f, const FingerPose& pose) {
        const FingerOutlook& outlook = pose.outlook[f];
        return !touches(fit) && pose.retry[f].tries > 0 && !(outlook.is_known && outlook.is_ahead);
    }

    // For a slow hand another fit is worth the change where for a fast one it is not.
    bool wants_another(const ChainFit& fit, std::size_t f, const FingerPose& pose) const {
        return is_slow(pose) ? is_sunk(fit) || hangs(fit, f, pose)
                             : fit.depth_m > tuning_.finger.slide_depth_m;
    }

    std::size_t most_closings() const {
        return std::isinf(io_.dt_s)
                   ? k_finger_count
                   : static_cast<std::size_t>(std::max(1, tuning_.finger.closings_per_frame));
    }

    // What is ahead is looked at anew by one finger in a frame, of those that may the one that
    // looked longest ago; by none where a surface was judged.
    std::size_t next_to_look(const HandSurroundings& hand, const FingerSet& is_kept,
                             const FingerPose& pose) const {
        std::size_t next = k_finger_count;
        for (std::size_t f = 0; f < k_finger_count; ++f) {
            const FingerOutlook& outlook = pose.outlook[f];
            const bool is_first =
                next == k_finger_count || outlook.since_m > pose.outlook[next].since_m;
            const bool wants = is_kept[f] && outlook.is_known && outlook.wait_m <= 0.0;
            next = wants && is_first ? f : next;
        }
        return io_.surface.at(hand.hand).was_judged ? k_finger_count : next;
    }

    ChainFit keep(const HandSurroundings& hand, const Pose& wrist_bs, std::size_t f, bool may_look,
                  FingerPose& pose) {
        ChainRefitSettings refit;
        refit.most_turn_rad = io_.dt_s * tuning_.finger.close_radps;
        refit.is_ahead = is_ahead(pose.outlook[f], may_look);
        ChainFit fit =
            refit_chain(finger_chain(hand.rig->fingers[f], 0.0, wrist_bs), pose.target[f].curl_rad,
                        hand.meshes, settings_, refit, io_.scratch);
        note_outlook(fit, pose.outlook[f]);
        return fit;
    }

    void change_if_better(const HandSurroundings& hand, const Pose& wrist_bs, std::size_t f,
                          FingerPose& pose) {
        const bool slow = is_slow(pose);
        const ChainFitSettings usual =
            std::exchange(settings_, in_a_slide(settings_, fits_[f].angle_rad, slow));
        const ChainFit anew = close_anew(hand, wrist_bs, f, !slow, pose);
        settings_ = usual;
        if (is_clearly_better(anew, fits_[f], settings_) && (is_sunk(fits_[f]) || touches(anew))) {
            begin_change(anew.angle_rad, f, pose);
            fits_[f] = anew;
            fits_[f].is_on_its_way = true;  // hinges that it was stopped by nothing at close on
        }
    }

    double take_fit(std::size_t place, std::size_t f, FingerPose& pose) {
        const ChainFit& fit = fits_[f];
        pose.target[f].curl_rad = fit.angle_rad;
        pose.target[f].opposition_rad = 0.0;
        const bool wants_more = is_sunk(fit) || hangs(fit, f, pose);
        const bool goes_on =
            (wants_more && pose.retry[f].since_m > 0.0) || (!is_sunk(fit) && fit.is_on_its_way);
        pose.arrived = pose.arrived && !goes_on;
        if (!io_.traces.empty()) {
            io_.traces[place][f] = {fit.discs,        fit.pops,     fit.walked,
                                    fit.contact_link, fit.fallback, fit.depth_m};
        }
        const bool has_its_turn_first = wants_another(fit, f, pose) && pose.retry[f].wait_m <= 0.0;
        return has_its_turn_first ? 0.0 : fit.depth_m;
    }

    ChainFit close_anew(const HandSurroundings& hand, const Pose& wrist_bs, std::size_t f,
                        bool is_fast, FingerPose& pose) {
        const HingeChain chain = finger_chain(hand.rig->fingers[f], 0.0, wrist_bs);
        const ChainSeed seed = settings_.searches ? chain_seed(hand, io_.surface.at(hand.hand),
                                                               pose.seed_triangle[f], chain)
                                                  : ChainSeed{};
        const ChainFit fit = fit_chain(chain, hand.meshes, seed, settings_, io_.scratch);
        if (fit.contact_triangle != k_no_triangle) {
            pose.seed_triangle[f] = fit.contact_triangle;
        }
        pose.outlook[f] = {};
        count_fallback(fit.fallback, stats_);
        note_try(pose.retry[f], is_sunk(fit) || is_bent_away(fit), is_fast);
        return fit;
    }

    void lift(const HandSurroundings& hand, double depth_m, FingerPose& pose) {
        if (lift_if_sunk(hand, depth_m, tuning_.palm, io_.offset.at(hand.hand))) {
            stats_.count(Fallback::palm_lifted);
            pose.solved = !lifts_at_once(tuning_.palm, io_.dt_s);
        }
    }

    const SweepFingersIo& io_;
    const Tuning& tuning_;
    ChainFitSettings settings_;
    StageStats& stats_;
    std::array<ChainFit, k_finger_count> fits_;  // of the hand that is being closed
};

}  // namespace

void sweep_fingers(const SweepFingersIo& io, const Tuning& tuning, StageStats& stats,
                   SearchOrder order) {
    HandCloser closer(io, tuning, order, stats);
    for (std::size_t place = 0; place < io.hands.size(); ++place) {
        closer.close(place);
        const HandSurroundings& hand = io.hands[place];
        FingerPose& pose = io.fingers.at(hand.hand);
        for (std::size_t f = 0; f < hand.rig->fingers.size(); ++f) {
            if (hand.rig->fingers[f].name != FingerName::thumb) {
                follow_target(f, io.dt_s, tuning.finger, pose);
            }
        }
    }
}

}  // namespace handhold
