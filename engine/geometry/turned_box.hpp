#pragma once

#include <array>
#include <cmath>

#include "engine/math/four_floats.hpp"
#include "engine/math/math.hpp"

namespace handhold {

// A box that is turned anyhow: `middle` and `half` along its axes.
struct TurnedBox {
    std::array<Vec3, 3> axis = {Vec3::UnitX(), Vec3::UnitY(), Vec3::UnitZ()};  // square, unit
    Vec3 middle = Vec3::Zero();
    Vec3 half = Vec3::Zero();
};

// Tells upright boxes that may meet a turned one from those that surely do not: by its axes alone,
// in floats with room to spare for what they round off.
class TurnedBoxTest {
  public:
    // `reach_m`: no upright box has a coordinate beyond it.
    TurnedBoxTest(const TurnedBox& box, double reach_m) {
        constexpr double k_rounding = 0x1p-20;  // sixteen times what one operation rounds off
        for (int i = 0; i < 3; ++i) {
            const Vec3& axis = box.axis[static_cast<std::size_t>(i)];
            for (int along = 0; along < 3; ++along) {
                const auto part = static_cast<float>(axis[along]);
                axis_[static_cast<std::size_t>(along)][i] = part;
                steepness_[static_cast<std::size_t>(along)][i] = part < 0.0F ? -part : part;
            }
            const double spare_m =
                k_rounding * (reach_m + std::abs(box.middle[i]) + std::abs(box.half[i]));
            middle_twice_[i] = static_cast<float>(2.0 * box.middle[i]);
            half_twice_[i] = static_cast<float>(2.0 * (box.half[i] + spare_m));
        }
    }

    bool may_meet(const std::array<float, 3>& low, const std::array<float, 3>& high) const {
        const FourFloats away = axis_[0] * (low[0] + high[0]) + axis_[1] * (low[1] + high[1]) +
                                axis_[2] * (low[2] + high[2]) - middle_twice_;
        const FourFloats most = steepness_[0] * (high[0] - low[0]) +
                                steepness_[1] * (high[1] - low[1]) +
                                steepness_[2] * (high[2] - low[2]) + half_twice_;
        return !any_beyond(away, most) && !any_beyond(-away, most);
    }

  private:
    std::array<FourFloats, 3> axis_ = {};  // by coordinate, of each axis
    std::array<FourFloats, 3> steepness_ = {};
    FourFloats middle_twice_ = {};
    FourFloats half_twice_ = {};
};

}  // namespace handhold
