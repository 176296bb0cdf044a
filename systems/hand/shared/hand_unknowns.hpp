#pragma once

#include <array>
#include <cstddef>

#include "components/hand_rig.hpp"
#include "engine/math/penalty_quadratic.hpp"

namespace handhold {

// Indices of the unknowns in the fit of a hand: 0 to 2 are the translation and 3 to 5 the rotation
// vector about the palm's centre. Then come each digit's hinges, followed by its opposition angle
// if it has one.
class HandUnknowns {
  public:
    explicit HandUnknowns(const HandRig& rig);

    int hinge(std::size_t finger, std::size_t link) const {
        return first_[finger] + static_cast<int>(link);
    }
    int opposition(std::size_t finger) const { return opposition_[finger]; }  // -1: none
    // Number of the digit's unknowns, which are next to each other from hinge(finger, 0) on.
    int count_of(std::size_t finger) const {
        return static_cast<int>(rig_.fingers[finger].link_count) +
               (opposition_[finger] >= 0 ? 1 : 0);
    }
    std::size_t count() const { return count_; }
    int end() const { return static_cast<int>(count_); }

    // Coefficients of the finger's total bend (sum of its hinges): `sign` for each hinge.
    Unknowns bend(std::size_t finger, double sign) const;
    // Coefficients of the direction from the knuckle to the tip of a nearly straight finger: for
    // each hinge, `sign` times the share of its angle by which that direction turns (length beyond
    // the hinge / whole length).
    Unknowns direction(std::size_t finger, double sign) const;

  private:
    const HandRig& rig_;
    std::array<int, k_finger_count> first_ = {};
    std::array<int, k_finger_count> opposition_ = {};
    std::size_t count_ = 6;
};

// `value` at one place, 0 at all others.
Unknowns unit(int place, double value = 1.0);

}  // namespace handhold
