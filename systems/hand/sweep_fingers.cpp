#include "systems/hand/sweep_fingers.hpp"

#include <algorithm>
#include <cmath>

#include "components/finger_chain.hpp"
#include "engine/geometry/chain_refit.hpp"

namespace handhold {
namespace {

constexpr double k_most_lifts = 3.0;

bool stands(const FingerPose& pose, const HandSurroundings& hand, const Pose& wrist_bs,
            double stroll_m) {
    return pose.solved && pose.arrived && pose.solved_surroundings == hand.signature &&
           hand_way_m(pose.solved_wrist_bs, wrist_bs) < stroll_m;
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
    }
    pose.solved = false;
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

class HandCloser {
  public:
    HandCloser(const SweepFingersIo& io, const Tuning& tuning, SearchOrder order, StageStats& stats)
        : io_(io), tuning_(tuning), settings_(chain_settings(tuning.finger)), stats_(stats) {
        settings_.order = order;
    }

    void close(std::size_t place) {
        const HandSurroundings& hand = io_.hands[place];
        const GripSurface& surface = io_.surface.at(hand.hand);
        FingerPose& pose = io_.fingers.at(hand.hand);
        if (surface.triangle == GripSurface::k_none) {
            rest_fingers(*hand.rig, !hand.grips && io_.hand.at(hand.hand).pressed, pose);
            pose_unverified(hand, pose);
            return;
        }
        const Pose wrist_bs = inverse(hand.body_ws) * io_.palm.at(hand.hand).pose_ws;
        if (stands(pose, hand, wrist_bs, tuning_.finger.stroll_m)) {
            return;
        }
        if (!pose.solved || pose.solved_body != hand.body) {
            pose.seed_triangle.fill(GripSurface::k_none);
            pose.thumb_solved = false;
        }
        double depth_m = 0.0;
        pose.arrived = true;
        for (std::size_t f = 0; f < hand.rig->fingers.size(); ++f) {
            if (hand.rig->fingers[f].name != FingerName::thumb) {
                depth_m = std::max(depth_m, close_finger(place, f, wrist_bs, pose));
            }
        }
        const bool is_lifted = lift_if_sunk(hand, depth_m);  // then all close anew
        pose.solved = !is_lifted;
        pose.solved_body = hand.body;
        pose.solved_surroundings = hand.signature;
        pose.solved_wrist_bs = wrist_bs;
    }

  private:
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
            return false;
        }
        if (posed_depth_m(chain, posed->curl_rad, hand.meshes, io_.scratch) >
            tuning_.finger.search_depth_m) {
            if (has_arrived(io_.offset.at(hand.hand))) {  // on its way there it is no wonder
                stats_.count(Fallback::authored_finger_fitted);
            }
            return false;
        }
        pose.target[f] = *posed;
        return true;
    }

    static bool has_arrived(const PalmOffset& offset) {
        return offset.shown_m == offset.target_m && offset.shown_turn_rad == offset.target_turn_rad;
    }

    double close_finger(std::size_t place, std::size_t f, const Pose& wrist_bs, FingerPose& pose) {
        const HandSurroundings& hand = io_.hands[place];
        const HingeChain chain = finger_chain(hand.rig->fingers[f], 0.0, wrist_bs);
        if (take_posed(hand, f, chain, pose)) {
            return 0.0;
        }
        const ChainFit fit = close_on(hand, chain, f, wrist_bs, pose);
        pose.target[f].curl_rad = fit.angle_rad;
        pose.target[f].opposition_rad = 0.0;
        pose.arrived = pose.arrived && !fit.is_on_its_way;
        if (!io_.traces.empty()) {
            io_.traces[place][f] = {fit.discs,        fit.pops,     fit.walked,
                                    fit.contact_link, fit.fallback, fit.depth_m};
        }
        return fit.depth_m;
    }

    // Stays with the fit that the finger has, unless another is clearly less sunk.
    ChainFit close_on(const HandSurroundings& hand, const HingeChain& chain, std::size_t f,
                      const Pose& wrist_bs, FingerPose& pose) {
        if (!keeps_fit(pose, hand, wrist_bs)) {
            return close_anew(hand, chain, f, pose);
        }
        ChainRefitSettings refit;
        refit.most_turn_rad = io_.dt_s * tuning_.finger.close_radps;
        const ChainFit kept =
            refit_chain(chain, pose.target[f].curl_rad, hand.meshes, settings_, refit, io_.scratch);
        if (kept.depth_m <= settings_.open_depth_m) {
            return kept;
        }
        const ChainFit anew = close_anew(hand, chain, f, pose);
        return is_clearly_better(anew, kept, settings_) ? anew : kept;
    }

    ChainFit close_anew(const HandSurroundings& hand, const HingeChain& chain, std::size_t f,
                        FingerPose& pose) {
        const ChainSeed seed =
            chain_seed(hand, io_.surface.at(hand.hand), pose.seed_triangle[f], chain.base.position);
        const ChainFit fit = fit_chain(chain, hand.meshes, seed, settings_, io_.scratch);
        pose.seed_triangle[f] = fit.contact_triangle;
        count_fallback(fit.fallback, stats_);
        return fit;
    }

    // Not before the hand that is shown has come to where it is bound for: on its way there fingers
    // may well be sunk.
    bool lift_if_sunk(const HandSurroundings& hand, double depth_m) {
        PalmOffset& offset = io_.offset.at(hand.hand);
        if (!has_arrived(offset) || hand.authored != nullptr) {
            return false;
        }
        const double most_m = k_most_lifts * tuning_.palm.lift_m;
        if (depth_m > tuning_.palm.lift_from_depth_m && offset.lift_m < most_m) {
            offset.lift_m = std::min(offset.lift_m + tuning_.palm.lift_m, most_m);
            offset.lifted_at_bs = hand.wrist_bs;
            stats_.count(Fallback::palm_lifted);
            return true;
        }
        return false;
    }

    const SweepFingersIo& io_;
    const Tuning& tuning_;
    ChainFitSettings settings_;
    StageStats& stats_;
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
                follow_target(pose.target[f], io.dt_s * tuning.finger.close_radps, pose.shown[f]);
            }
        }
    }
}

}  // namespace handhold
