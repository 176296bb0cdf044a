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

// One fit of wrist, fingers and thumb to the surfaces around a hand: the stage behind fit_hands.
//
//   minimise   |p - p0|^2 + (arm |r|)^2             palm's centre p and rotation vector r from the
//                                                   tracked wrist (p0, 0)
//            + touch  sum gap^2 / (1 + gap^2 / g^2)  each digit's smallest gap; a digit that is far
//                                                   off is let go
//            + tip    gap^2                         of the thumb's tip
//            + first  sum (l (q - q_closed))^2      angles q of a digit that touched something when
//                                                   the hand closed
//            + alike  sum (l (q_f - q_f+1))^2       neighbouring fingers bend alike
//            + fan    sum (l (d_f - d_f+1))^2       and point alike; d: direction from the knuckle
//                                                   to the tip, linear in the angles. Both weigh
//                                                   more, the farther one of the two is from any
//                                                   surface: a finger that reaches nothing goes
//                                                   with its neighbours
//            + roll   sum (l (q_2 - q_1))^2         fingers bend in the middle as at the knuckle
//            + couple sum (l (q_3 - 2/3 q_2))^2     the last hinge bends 2/3 as far as its parent
//            + rest   sum (l (q - q_rest))^2        keeps every angle determined
//   subject to every capsule's gap >= 0, gaps between thumb and fingers >= 0, joint limits, the
//   palm's limits on height and tilt, total bends up to 158 degrees, neighbours' total bends within
//   92 degrees of each other and their directions within 29 degrees
//
// l = 5 cm, g = 2 cm if the closing found a contact, else 8 mm. The inequalities are penalties,
// stiffer in this order: bends, palm, joints, gaps; what cannot be met is shared. Each round
// queries the gaps (hand_spheres.hpp), linearises and solves (engine/math/penalty_quadratic.hpp).
// Sources: Santello, Flanders, Soechting, Postural hand synergies for tool use, 1998 (fingers bend
// alike); Rijpkema, Girard, Computer animation of knowledge-based human grasping, 1991 (2/3).
namespace handhold {

struct HandFitGoal {
    HandPose first;  // where the rounds start; from the closing, or last frame's fit
    // Angles from the closing, which stated the digits' contacts.
    std::array<FingerAngles, k_finger_count> closed;
    std::array<bool, k_finger_count> touches = {};   // the closing found a contact
    std::array<bool, k_finger_count> is_clear = {};  // HandSpheres: `first` is outside solids
    std::array<bool, k_finger_count> is_fixed = {};  // the angles are kept, as in authored poses
    bool is_wrist_fixed = false;                     // the wrist is kept
    std::int32_t rounds = 0;                         // at most
    double max_flex_rad = 0.4;                       // largest step of an angle in one round
};

struct HandFit {
    HandPose pose;               // of the cheapest round; `first` if none was cheaper
    double cost = 0.0;           // of the objective, m^2
    double penetration_m = 0.0;  // of the deepest sphere; at least 0
    // By finger: smallest gap, below 0 if penetrating; infinity: nothing within reach.
    std::array<double, k_finger_count> gap_m = {};
    bool is_converged = false;  // the last round gained nothing
};

// Deterministic. `rows` is scratch memory; it allocates once. Never costs more than `goal.first`.
// Precondition: the hand has meshes, and `surface` is on the first one.
HandFit fit_hand(const HandSurroundings& hand, const GripSurface& surface, const HandFitGoal& goal,
                 const PalmTuning& tuning, std::vector<PenaltyRow>& rows);

// The objective's terms at `goal.first`, whose sum is the cost of a fit without rounds. Same
// preconditions.
FitTerms fit_terms(const HandSurroundings& hand, const GripSurface& surface,
                   const HandFitGoal& goal, const PalmTuning& tuning);

}  // namespace handhold
