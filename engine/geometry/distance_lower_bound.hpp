#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <limits>

#include "engine/geometry/shapes4.hpp"
#include "engine/math/float4.hpp"
#include "engine/math/math.hpp"

namespace handhold {

// Lower bounds on the squared distances of boxes and triangles from a point, in floats.
class DistanceLowerBound {
  public:
    // `point` is relative to the tree's origin. No coordinate of the tree may exceed `reach_m`.
    DistanceLowerBound(const Vec3& point, double reach_m) {
        constexpr double k_rounding = 0x1p-20;  // 2^-20 allows for ten float roundings of 2^-24
        for (std::size_t i = 0; i < 3; ++i) {
            point_[i] = splat4(point[static_cast<Eigen::Index>(i)]);
        }
        rounding_margin_ = splat4(k_rounding * (reach_m + point.norm()));
    }

    Float4 squared(const Boxes4& four) const {
        const Float4 zero = {};
        Float4 sum = zero;
        for (std::size_t i = 0; i < 3; ++i) {
            const Float4 out = higher(four.low[i] - point_[i], point_[i] - four.high[i]);
            const Float4 gap = higher(out - rounding_margin_, zero);
            sum += gap * gap;
        }
        return lower(sum, k_max_float);
    }

    // Combines the height above the triangle's plane with the in-plane distance to its bounding
    // box.
    Float4 squared(const Triangles4& four) const {
        const Float4 zero = {};
        std::array<Float4, 3> low;
        std::array<Float4, 3> high;
        Float4 height = zero;
        for (std::size_t i = 0; i < 3; ++i) {
            const Float4 a = four.corner[0][i] - point_[i];
            const Float4 b = four.corner[1][i] - point_[i];
            const Float4 c = four.corner[2][i] - point_[i];
            low[i] = lower(lower(a, b), c);
            high[i] = higher(higher(a, b), c);
            height += four.normal[i] * a;
        }
        const Float4 clear = higher(higher(height, -height) - rounding_margin_, zero);
        Float4 sum = clear * clear;
        for (std::size_t i = 0; i < 3; ++i) {
            const Float4 projected = height * four.normal[i];
            const Float4 gap =
                higher(higher(low[i] - projected, projected - high[i]) - rounding_margin_, zero);
            sum += gap * gap;
        }
        return lower(sum, k_max_float);
    }

    // Tight bound: equal to the distance up to rounding. More expensive, so it is used for the
    // remaining candidates.
    Float4 squared_tight(const Triangles4& four) const {
        const Float4 zero = {};
        std::array<Vectors4, 3> corner;
        for (std::size_t c = 0; c < 3; ++c) {
            for (std::size_t i = 0; i < 3; ++i) {
                corner[c][i] = four.corner[c][i] - point_[i];
            }
        }
        const Float4 height = dot(four.normal, corner[0]);
        const Float4 clear = higher(higher(height, -height) - rounding_margin_, zero);
        Int4 is_over = dot(four.normal, four.normal) > zero;
        Float4 min_squared = k_max_float;
        for (std::size_t c = 0; c < 3; ++c) {
            const Vectors4& from = corner[c];
            const Vectors4& to = corner[(c + 1) % 3];
            const Vectors4 edge = {to[0] - from[0], to[1] - from[1], to[2] - from[2]};
            is_over &= dot(four.normal, cross(from, edge)) >= zero;
            min_squared = lower(min_squared, squared_to_edge(from, edge));
        }
        return lower(is_over ? clear * clear : min_squared, k_max_float);
    }

    // Items whose squared lower bound exceeds the returned value are farther away than
    // sqrt(`squared`). Infinite input is clamped to the largest float.
    static float limit(double squared) {
        return static_cast<float>(std::min(squared * k_slack, static_cast<double>(k_max_float[0])));
    }
    static constexpr double k_slack = 1.0 + 1e-5;  // exceeds the float rounding

  private:
    // Bounds are clamped to this: squares of floats overflow easily.
    static constexpr Float4 k_max_float = {
        std::numeric_limits<float>::max(), std::numeric_limits<float>::max(),
        std::numeric_limits<float>::max(), std::numeric_limits<float>::max()};

    Float4 squared_to_edge(const Vectors4& from, const Vectors4& edge) const {
        const Float4 zero = {};
        const Float4 tiny = splat4(1e-30);
        const Float4 share = -dot(from, edge) / higher(dot(edge, edge), tiny);
        const Float4 on_edge = lower(higher(share, zero), splat4(1.0));
        Float4 sum = zero;
        for (std::size_t i = 0; i < 3; ++i) {
            const Float4 offset = from[i] + on_edge * edge[i];
            const Float4 gap = higher(higher(offset, -offset) - rounding_margin_, zero);
            sum += gap * gap;
        }
        return sum;
    }

    std::array<Float4, 3> point_ = {};  // each coordinate in all lanes
    Float4 rounding_margin_ = {};
};

}  // namespace handhold
