#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "components/hand.hpp"
#include "components/hand_surroundings.hpp"
#include "components/tuning.hpp"
#include "engine/math/penalty_quadratic.hpp"
#include "systems/hand/shared/fit_terms.hpp"
#include "systems/hand/shared/hand_spheres.hpp"

// Fits wrist, fingers and thumb of one hand to the surfaces around it. fit_hands calls it.
//
//   minimise
//     |p - p0|^2 + (arm |r|)^2               p: palm's centre, p0: tracked one, r: rotation vector
//                                            from the tracked wrist; arm = k_fit_arm_m
//   + 2   sum_d pull(gap_d)                  nearest sphere of each digit d that touched something
//                                            when the hand closed, or is within k_sphere_reach_m
//   + 0.7 pull(gap_p)                        nearest sphere of the palm, within k_sphere_reach_m
//   + 1   sum_f pull(tip_f)                  each finger's tip; fingers f are without the thumb
//   + tip_t^2                                the thumb's tip; beyond k_tip_reach_m as at it
//   + 0.05 l^2 |pad_t + away_t|^2            the thumb's pad faces the surface: pad_t: unit normal
//                                            of its last link's pad, away_t: unit, out of the
//                                            surface at the tip; beyond the tip's reach 0.2 l^2
//   + 0.3 sum_f (l (d_f - d_f+1))^2          fan: neighbours point alike; d: direction from knuckle
//                                            to tip, linear in the angles
//   + 0.3 sum_f s |l (q_f - q_f+1)|^2        alike: neighbours bend alike if one of them touches
//                                            nothing: s = gap^2 / (gap^2 + 1 mm^2), larger gap
//   + 0.1 sum_f (l (q3 - 2/3 q2))^2          couple: the last hinge follows the middle one
//   + 0.15 (l (q3 - q2))^2                   the same for the thumb's last two hinges
//   + 0.01 sum_f (l (q2 - q1))^2             roll: the middle bends as far as the knuckle
//   + 0.02 (l (o - o_rest))^2                opposition: the thumb stays near its rest pose
//   + 0.2 sum_f (l s_f)^2                    spread: fingers stay in their planes; s: turn about
//                                            the normal of the flat hand at the knuckle
//   + 2e-5 sum (l (q - q_rest))^2            rest: keeps every angle determined; 0.002 for a thumb
//                                            that touched nothing when the hand closed
//   subject to
//     every sphere's gap >= a margin of less than a millimetre
//     gaps between thumb and fingers >= 0
//     joint limits; the range of s shrinks to k_bent_spread_share while its knuckle bends to
//     k_bent_spread_rad
//     q1 >= 0.6 q2 - k_claw_rad             claw: no stretched knuckle with a bent middle
//     q1 + q2 + q3 <= k_max_bend_rad         bend: no finger folded into itself
//     neighbours' total bends within k_max_apart_rad, and directions within k_max_fan_rad;
//     their spreads converge by at most k_max_converging_rad
//     the palm's limits on height and tilt (PalmTuning)
//
// A finger whose angles are fixed (HandFitGoal::is_fixed) has no fan and no alike term with its
// neighbours. pull(x) = x^2 / (1 + x^2 / g^2) is bounded by g^2, so distant surfaces hardly attract
// a digit; g = k_let_go_m; l = k_fit_lever_m. Hinges q1, q2, q3 are numbered from the knuckle. Gaps
// beyond the reach of their sphere do not count (hand_spheres.hpp); tips have a larger reach. Costs
// are half of these sums. The inequalities are penalties, stiffer in this order: bends, directions,
// claw, palm, joints, gaps; if they contradict each other, the fit divides the violation among
// them. Each round queries the gaps (hand_spheres.hpp), linearises and solves
// (engine/math/penalty_quadratic.hpp). Sources: Santello, Flanders, Soechting, Postural hand
// synergies for tool use, 1998 (fingers bend alike); Rijpkema, Girard, Computer animation of
// knowledge-based human grasping, 1991 (2/3). The weights follow 694 labels of posed hands
// (docs/decisions).
namespace handhold {

inline constexpr double k_fit_arm_m = 0.05;
inline constexpr double k_fit_lever_m = 0.05;
inline constexpr double k_let_go_m = 0.03;
inline constexpr double k_max_fan_rad = 0.5;
inline constexpr double k_max_apart_rad = 1.6;
inline constexpr double k_max_bend_rad = 2.75;
inline constexpr double k_claw_rad = 20.0 * k_degree;
inline constexpr double k_max_converging_rad = 4.0 * k_degree;
inline constexpr double k_bent_spread_rad = 90.0 * k_degree;
inline constexpr double k_bent_spread_share = 0.4;
inline constexpr std::uint32_t k_thumb_tries = 6;

// True for a thumb with a range of opposition.
inline bool can_oppose(const FingerRig& finger) {
    return finger.name == FingerName::thumb &&
           finger.lower_opposition_rad < finger.upper_opposition_rad;
}

struct HandFitGoal {
    HandPose first;  // where the rounds start: the closing's result, or the last fit's
    double rest_opposition_rad = 0.0;               // o_rest
    std::array<bool, k_finger_count> touches = {};  // the closing found a contact
    // `first` is known to be outside solids (see HandSpheres)
    std::array<bool, k_finger_count> is_clear = {};
    std::array<bool, k_finger_count> is_fixed = {};  // the angles do not change (authored poses)
    bool is_wrist_fixed = false;                     // the wrist does not move
    std::int32_t rounds = 0;                         // maximum number of rounds
    // After the rounds, others start from a thumb at this opposition, of k_thumb_tries; < 0: none.
    std::int32_t thumb_try = -1;
    double max_flex_rad = 0.4;  // largest step of an angle in one round
};

struct HandFit {
    HandPose pose;               // pose of the cheapest round; `first` if none was cheaper
    double cost = 0.0;           // value of the objective, m^2
    double penetration_m = 0.0;  // depth of the deepest sphere, palm included; >= 0
    // By digit: smallest gap, below 0 if penetrating; infinity: nothing within reach.
    std::array<double, k_finger_count> gap_m = {};
    bool is_converged = false;  // the last round did not lower the cost; true without rounds
};

// Deterministic. `rows` is scratch memory; it allocates once. The result never costs more than
// `goal.first`.
// Precondition: the hand has meshes, and `surface` is on the first one.
HandFit fit_hand(const HandSurroundings& hand, const GripSurface& surface, const HandFitGoal& goal,
                 const PalmTuning& tuning, std::vector<PenaltyRow>& rows);

// The objective's terms at `goal.first`, whose sum is the cost of a fit without rounds. Same
// preconditions.
FitTerms fit_terms(const HandSurroundings& hand, const GripSurface& surface,
                   const HandFitGoal& goal, const PalmTuning& tuning);

}  // namespace handhold
