#pragma once

#include <array>
#include <cmath>
#include <cstddef>

#include "engine/geometry/shapes4.hpp"
#include "engine/math/float4.hpp"
#include "engine/math/math.hpp"

namespace handhold {

// A box in any orientation. `centre` and `half_extents` are coordinates along the box's own axes.
struct OrientedBox {
    std::array<Vec3, 3> axis = {Vec3::UnitX(), Vec3::UnitY(), Vec3::UnitZ()};  // orthonormal
    Vec3 centre = Vec3::Zero();
    Vec3 half_extents = Vec3::Zero();
};

// Conservative test of axis-aligned boxes against an oriented box. Tests only the oriented box's
// axes, in floats with a rounding margin.
class OrientedBoxTest {
  public:
    // No coordinate of the axis-aligned boxes may exceed `reach_m`.
    OrientedBoxTest(const OrientedBox& box, double reach_m) {
        constexpr double k_rounding = 0x1p-20;  // sixteen times the rounding error of one operation
        for (std::size_t i = 0; i < 3; ++i) {
            for (std::size_t along = 0; along < 3; ++along) {
                const double part = box.axis[i][static_cast<Eigen::Index>(along)];
                axis_[i][along] = splat4(part);
                steepness_[i][along] = splat4(std::abs(part));
            }
            const auto at = static_cast<Eigen::Index>(i);
            const double rounding_margin_m =
                k_rounding * (reach_m + std::abs(box.centre[at]) + std::abs(box.half_extents[at]));
            middle_twice_[i] = splat4(2.0 * box.centre[at]);
            half_twice_[i] = splat4(2.0 * (box.half_extents[at] + rounding_margin_m));
        }
    }

    // Tests four boxes at once.
    Int4 may_meet(const Boxes4& boxes) const {
        std::array<Float4, 3> middle_twice;
        std::array<Float4, 3> size;
        for (std::size_t along = 0; along < 3; ++along) {
            middle_twice[along] = boxes.low[along] + boxes.high[along];
            size[along] = boxes.high[along] - boxes.low[along];
        }
        Int4 is_apart = {};
        for (std::size_t i = 0; i < 3; ++i) {
            const Float4 separation = axis_[i][0] * middle_twice[0] +
                                      axis_[i][1] * middle_twice[1] +
                                      axis_[i][2] * middle_twice[2] - middle_twice_[i];
            const Float4 max_separation = steepness_[i][0] * size[0] + steepness_[i][1] * size[1] +
                                          steepness_[i][2] * size[2] + half_twice_[i];
            is_apart |= higher(separation, -separation) > max_separation;
        }
        return ~is_apart;
    }

  private:
    // [axis of the oriented box][coordinate]; each number is in all lanes.
    std::array<std::array<Float4, 3>, 3> axis_;
    std::array<std::array<Float4, 3>, 3> steepness_;
    std::array<Float4, 3> middle_twice_;
    std::array<Float4, 3> half_twice_;
};

}  // namespace handhold
