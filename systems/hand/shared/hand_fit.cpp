#include "systems/hand/shared/hand_fit.hpp"

#include <algorithm>
#include <cmath>

#include "systems/hand/shared/hand_objective.hpp"

namespace handhold {
namespace {

// Largest step of the wrist in one round. Gaps are linearised, so longer steps are not reliable.
constexpr double k_max_move_m = 0.02;
constexpr double k_max_turn_rad = 0.3;

// Minimises the objective by Gauss-Newton steps.
class Fitter {
  public:
    Fitter(const HandSurroundings& hand, const GripSurface& surface, const HandFitGoal& goal,
           const PalmTuning& tuning, std::vector<PenaltyRow>& rows)
        : rig_(*hand.rig),
          goal_(goal),
          pose_(goal.first),
          objective_(hand, surface, goal, tuning, rows, nullptr) {}

    HandFit run() {
        constexpr double k_gain = 1e-6;  // smaller relative gains do not count
        constexpr double k_gain_m2 = 1e-12;
        // Relative change of the cost that justifies a next round.
        constexpr double k_worthwhile_gain = 0.01;
        double cost = objective_.evaluate(pose_);
        HandFit best = described(cost);
        best.is_converged = true;
        for (std::int32_t round = 0; round < goal_.rounds; ++round) {
            step();
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

  private:
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

    // Moves the pose by the solution of the problem that the objective built there.
    void step() {
        Unknowns change = objective_.solve();
        const double move_m = change.head<3>().norm();
        const double turn_rad = change.segment<3>(3).norm();
        change *= std::min(k_max_move_m / std::max(k_max_move_m, move_m),
                           k_max_turn_rad / std::max(k_max_turn_rad, turn_rad));
        apply(change);
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
    const HandFitGoal& goal_;
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
