#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <limits>

#include "engine/geometry/shapes4.hpp"
#include "engine/math/float4.hpp"
#include "engine/math/math.hpp"

namespace handhold {

// No more than the distances of boxes and triangles from a point, squared; in floats.
class DistanceLowerBound {
  public:
    // `point` about the tree's origin; no corner is beyond `reach_m`.
    DistanceLowerBound(const Vec3& point, double reach_m) {
        constexpr double k_rounding = 0x1p-20;  // more than ten roundings
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

    // Above a triangle's plane, and from there, in the plane, to a box around the triangle.
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

    // The distances themselves, but for roundings: dearer, and for what is left.
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
        Float4 least = k_max_float;
        for (std::size_t c = 0; c < 3; ++c) {
            const Vectors4& from = corner[c];
            const Vectors4& to = corner[(c + 1) % 3];
            const Vectors4 edge = {to[0] - from[0], to[1] - from[1], to[2] - from[2]};
            is_over &= dot(four.normal, cross(from, edge)) >= zero;
            least = lower(least, squared_to_edge(from, edge));
        }
        return lower(is_over ? clear * clear : least, k_max_float);
    }

    // What is nearer than the root of `squared` is no more than this: where that is infinite,
    // nothing is.
    static float limit(double squared) {
        return static_cast<float>(std::min(squared * k_slack, static_cast<double>(k_max_float[0])));
    }
    static constexpr double k_slack = 1.0 + 1e-5;  // floats round off less

  private:
    // Nothing is said to be farther: squares of floats are infinite soon.
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
            const Float4 way = from[i] + on_edge * edge[i];
            const Float4 gap = higher(higher(way, -way) - rounding_margin_, zero);
            sum += gap * gap;
        }
        return sum;
    }

    std::array<Float4, 3> point_ = {};  // each coordinate four times
    Float4 rounding_margin_ = {};
};

}  // namespace handhold
