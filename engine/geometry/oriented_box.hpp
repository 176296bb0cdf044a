#pragma once

#include <array>
#include <cmath>
#include <cstddef>

#include "engine/geometry/shapes4.hpp"
#include "engine/math/float4.hpp"
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
        for (std::size_t i = 0; i < 3; ++i) {
            for (std::size_t along = 0; along < 3; ++along) {
                const double part = box.axis[i][static_cast<Eigen::Index>(along)];
                axis_[i][along] = four_times(part);
                steepness_[i][along] = four_times(std::abs(part));
            }
            const auto at = static_cast<Eigen::Index>(i);
            const double spare_m =
                k_rounding * (reach_m + std::abs(box.middle[at]) + std::abs(box.half[at]));
            middle_twice_[i] = four_times(2.0 * box.middle[at]);
            half_twice_[i] = four_times(2.0 * (box.half[at] + spare_m));
        }
    }

    // Of four boxes at once.
    FourInts may_meet(const FourBoxes& boxes) const {
        std::array<FourFloats, 3> middle_twice;
        std::array<FourFloats, 3> size;
        for (std::size_t along = 0; along < 3; ++along) {
            middle_twice[along] = boxes.low[along] + boxes.high[along];
            size[along] = boxes.high[along] - boxes.low[along];
        }
        FourInts is_apart = {};
        for (std::size_t i = 0; i < 3; ++i) {
            const FourFloats away = axis_[i][0] * middle_twice[0] + axis_[i][1] * middle_twice[1] +
                                    axis_[i][2] * middle_twice[2] - middle_twice_[i];
            const FourFloats most = steepness_[i][0] * size[0] + steepness_[i][1] * size[1] +
                                    steepness_[i][2] * size[2] + half_twice_[i];
            is_apart |= higher(away, -away) > most;
        }
        return ~is_apart;
    }

  private:
    // By axis, and by coordinate where there are two; each number four times.
    std::array<std::array<FourFloats, 3>, 3> axis_;
    std::array<std::array<FourFloats, 3>, 3> steepness_;
    std::array<FourFloats, 3> middle_twice_;
    std::array<FourFloats, 3> half_twice_;
};

}  // namespace handhold
