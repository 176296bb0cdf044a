#include "systems/hand/shared/hand_fit.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "systems/hand/shared/hand_objective.hpp"

namespace handhold {
namespace {

// Largest step of the wrist in one round. Gaps are linearised, so longer steps are not reliable.
constexpr double k_max_move_m = 0.02;
constexpr double k_max_turn_rad = 0.3;

constexpr int k_thumb_bends = 4;
constexpr double k_thumb_flex_rad = 0.4;       // largest step of an angle in a round
constexpr double k_change_thumb_share = 0.95;  // another thumb must cost less than this share
constexpr double k_thumb_bend_share = 0.25;  // step between bends, as a share of the hinges' range
constexpr std::int32_t k_thumb_rounds = 6;   // rounds of the thumb alone, then of the hand
// A round is not expected to divide a cost by more than this. Of 3,215 tries in a crowd, half of
// the rounds were not worthwhile by this rule, which dropped 3 % of the tries that ended cheaper.
constexpr double k_round_gain = 3.0;

// Minimises the objective by Gauss-Newton steps.
class Fitter {
  public:
    Fitter(const HandSurroundings& hand, const GripSurface& surface, const HandFitGoal& goal,
           const PalmTuning& tuning, std::vector<PenaltyRow>& rows)
        : rig_(*hand.rig),
          goal_(goal),
          pose_(goal.first),
          objective_(hand, surface, goal_, tuning, rows, nullptr) {}

    HandFit run() {
        HandFit best = descend(goal_.rounds, std::numeric_limits<double>::infinity());
        for (std::size_t f = 0; goal_.thumb_try >= 0 && f < rig_.fingers.size(); ++f) {
            if (can_oppose(rig_.fingers[f]) && !goal_.is_fixed[f]) {
                try_thumb(f, best);
            }
        }
        return best;
    }

  private:
    // Rounds from the present pose. Gives up once the cost exceeds `wanted` times k_round_gain for
    // each round left but one.
    HandFit descend(std::int32_t rounds, double wanted) {
        constexpr double k_gain = 1e-6;  // smaller relative gains do not count
        constexpr double k_gain_m2 = 1e-12;
        // Relative change of the cost that justifies a next round.
        constexpr double k_worthwhile_gain = 0.01;
        double cost = objective_.evaluate(pose_);
        HandFit best = described(cost);
        best.is_converged = true;
        double most = wanted;  // greatest cost from which the next round is worthwhile
        for (std::int32_t round = 1; round < rounds; ++round) {
            most *= k_round_gain;
        }
        for (std::int32_t round = 0; round < rounds && cost <= most; ++round) {
            most /= k_round_gain;
            apply(limited(objective_.solve()));
            const double before = cost;
            const double now = objective_.evaluate(pose_);
            const bool is_gain = now < cost - k_gain * cost - k_gain_m2;
            if (is_gain) {
                cost = now;
                best = described(cost);
            }
            best.is_converged = !(cost < before);
            if (std::abs(now - before) < k_worthwhile_gain * before) {
                break;
            }
        }
        return best;
    }

    // A thumb has several minima: on this side of a rail, beyond it, beside it. Starts at the
    // cheapest of a few bends with the rest of the hand at `best`: the thumb moves alone, then the
    // whole hand.
    void try_thumb(std::size_t t, HandFit& best) {
        const HandPose hand = best.pose;
        goal_.max_flex_rad = k_thumb_flex_rad;
        FingerAngles cheapest;
        double least = std::numeric_limits<double>::infinity();
        for (int bend = 0; bend < k_thumb_bends; ++bend) {
            pose_ = hand;
            pose_.fingers[t] = thumb_at(rig_.fingers[t], (goal_.thumb_try + 0.5) / k_thumb_tries,
                                        bend * k_thumb_bend_share);
            const double cost = objective_.evaluate_thumb(pose_, t);
            if (cost < least) {
                least = cost;
                cheapest = pose_.fingers[t];
            }
        }
        pose_.fingers[t] = cheapest;
        move_thumb(t);
        const HandFit fit = descend(k_thumb_rounds, best.cost);
        if (fit.cost < k_change_thumb_share * best.cost) {
            best = fit;
        }
    }

    // Shares of the ranges of the opposition and, from straight on, of the hinges.
    static FingerAngles thumb_at(const FingerRig& thumb, double opposition, double bend) {
        FingerAngles angles;
        angles.opposition_rad =
            thumb.lower_opposition_rad +
            opposition * (thumb.upper_opposition_rad - thumb.lower_opposition_rad);
        for (std::size_t i = 0; i < thumb.link_count; ++i) {
            const double straight_rad = std::clamp(0.0, thumb.lower_rad[i], thumb.upper_rad[i]);
            angles.curl_rad[i] = straight_rad + bend * (thumb.upper_rad[i] - straight_rad);
        }
        return angles;
    }

    // Rounds of the thumb alone. Ends at the cheapest.
    void move_thumb(std::size_t t) {
        double cost = objective_.evaluate_thumb(pose_, t);
        for (std::int32_t round = 0; round < k_thumb_rounds; ++round) {
            const FingerAngles before = pose_.fingers[t];
            apply(objective_.solve_thumb(t));
            const double now = objective_.evaluate_thumb(pose_, t);
            if (!(now < cost)) {
                pose_.fingers[t] = before;
                return;
            }
            cost = now;
        }
    }

    HandFit described(double cost) const {
        HandFit fit;
        fit.cost = cost;
        fit.pose = pose_;
        fit.penetration_m = objective_.penetration_m();
        for (std::size_t f = 0; f < rig_.fingers.size(); ++f) {
            fit.gap_m[f] = objective_.gap_m(f);
        }
        return fit;
    }

    static Unknowns limited(Unknowns change) {
        const double move_m = change.head<3>().norm();
        const double turn_rad = change.segment<3>(3).norm();
        change *= std::min(k_max_move_m / std::max(k_max_move_m, move_m),
                           k_max_turn_rad / std::max(k_max_turn_rad, turn_rad));
        return change;
    }

    void apply(const Unknowns& change) {
        if (!goal_.is_wrist_fixed) {
            Pose& wrist = pose_.wrist_bs;
            wrist.rotation =
                (rotation_from_vector(change.segment<3>(3)) * wrist.rotation).normalized();
            wrist.position =
                objective_.center() + change.head<3>() - wrist.rotation * rig_.palm_center_hs;
        }
        for (std::size_t f = 0; f < rig_.fingers.size(); ++f) {
            if (goal_.is_fixed[f]) {
                continue;
            }
            const FingerRig& finger = rig_.fingers[f];
            FingerAngles& angles = pose_.fingers[f];
            for (std::size_t i = 0; i < finger.link_count; ++i) {
                const double flex_rad = std::clamp(change[objective_.layout().hinge(f, i)],
                                                   -goal_.max_flex_rad, goal_.max_flex_rad);
                angles.curl_rad[i] = std::clamp(angles.curl_rad[i] + flex_rad, finger.lower_rad[i],
                                                finger.upper_rad[i]);
            }
            if (const int place = objective_.layout().opposition(f); place >= 0) {
                const double turn_rad =
                    std::clamp(change[place], -goal_.max_flex_rad, goal_.max_flex_rad);
                const double share = opposition_share(finger, angles.curl_rad[0]);
                angles.opposition_rad = std::clamp(angles.opposition_rad + turn_rad,
                                                   share * finger.lower_opposition_rad,
                                                   share * finger.upper_opposition_rad);
            }
        }
    }

    const HandRig& rig_;
    HandFitGoal goal_;
    HandPose pose_;
    HandObjective objective_;
};

}  // namespace

HandFit fit_hand(const HandSurroundings& hand, const GripSurface& surface, const HandFitGoal& goal,
                 const PalmTuning& tuning, std::vector<PenaltyRow>& rows) {
    return Fitter(hand, surface, goal, tuning, rows).run();
}

FitTerms fit_terms(const HandSurroundings& hand, const GripSurface& surface,
                   const HandFitGoal& goal, const PalmTuning& tuning) {
    FitTerms terms;
    std::vector<PenaltyRow> rows;
    HandObjective objective(hand, surface, goal, tuning, rows, &terms);
    objective.evaluate(goal.first);
    for (std::size_t f = 0; f < hand.rig->fingers.size(); ++f) {
        terms.gap_m[f] = objective.gap_m(f);
    }
    return terms;
}

}  // namespace handhold
