#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "components/hand_rig.hpp"

// The objective of a hand's fit, term by term and digit by digit: why a hand looks as it does.
namespace handhold {

// The terms of hand_fit.hpp and what each one costs for. Those from `penetration` on are penalties
// for inequalities.
enum class FitTerm : std::uint8_t {
    sync,         // the palm is away from where it is tracked
    touch,        // the nearest point of a digit or the palm is off the surface
    tip,          // a digit's tip is off the surface
    pad,          // a thumb's pad does not face the surface
    opposition,   // a thumb has left the opposition of its rest pose
    spread,       // a finger has left its plane
    rest,         // an angle of a digit is away from its rest pose
    alike,        // neighbouring fingers bend differently
    fan,          // neighbouring fingers point differently
    roll,         // a finger bends in the middle more or less than at the knuckle
    couple,       // the last hinge bends more or less than its parent asks for
    penetration,  // a capsule is in a surface, or closer than the contacts' margin
    overlap,      // thumb and finger are in each other
    joints,       // an angle is outside its joint's limits
    bend,         // a finger is folded into itself
    claw,         // a knuckle is stretched and the middle joint bent
    apart,        // neighbours bend or point too differently, or cross
    palm_limits,  // the palm is outside its limits on height and tilt
    count
};

inline constexpr std::size_t k_fit_term_count = static_cast<std::size_t>(FitTerm::count);

struct FitTerms {
    static constexpr std::size_t k_palm = k_finger_count;
    static constexpr std::size_t k_part_count = k_finger_count + 1;
    using Costs = std::array<double, k_fit_term_count>;

    // Costs by part: the digits by index into HandRig::fingers, then the palm. At least 0, in m^2:
    // a palm moved by x costs x^2 / 2. A cost that belongs to two digits is counted half for each.
    std::array<Costs, k_part_count> cost_m2 = {};
    // Smallest gap of each digit, see HandFit::gap_m.
    std::array<double, k_finger_count> gap_m = {};
};

const char* name_of(FitTerm term);
double sum_of(const FitTerms::Costs& cost_m2);
double sum_of(const FitTerms& terms);  // the whole objective, equal to HandFit::cost
FitTerm largest_of(const FitTerms::Costs& cost_m2);

}  // namespace handhold
