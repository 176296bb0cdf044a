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
class LeastDistance {
  public:
    // `point` about the tree's origin; no corner is beyond `reach_m`.
    LeastDistance(const Vec3& point, double reach_m) {
        constexpr double k_rounding = 0x1p-20;  // more than ten roundings
        for (std::size_t i = 0; i < 3; ++i) {
            point_[i] = four_times(point[static_cast<Eigen::Index>(i)]);
        }
        spare_ = four_times(k_rounding * (reach_m + point.norm()));
    }

    FourFloats squared(const FourBoxes& four) const {
        const FourFloats zero = {};
        FourFloats sum = zero;
        for (std::size_t i = 0; i < 3; ++i) {
            const FourFloats out = higher(four.low[i] - point_[i], point_[i] - four.high[i]);
            const FourFloats gap = higher(out - spare_, zero);
            sum += gap * gap;
        }
        return lower(sum, k_most);
    }

    // Above a triangle's plane, and from there, in the plane, to a box around the triangle.
    FourFloats squared(const FourTriangles& four) const {
        const FourFloats zero = {};
        std::array<FourFloats, 3> low;
        std::array<FourFloats, 3> high;
        FourFloats height = zero;
        for (std::size_t i = 0; i < 3; ++i) {
            const FourFloats a = four.corner[0][i] - point_[i];
            const FourFloats b = four.corner[1][i] - point_[i];
            const FourFloats c = four.corner[2][i] - point_[i];
            low[i] = lower(lower(a, b), c);
            high[i] = higher(higher(a, b), c);
            height += four.normal[i] * a;
        }
        const FourFloats clear = higher(higher(height, -height) - spare_, zero);
        FourFloats sum = clear * clear;
        for (std::size_t i = 0; i < 3; ++i) {
            const FourFloats foot = height * four.normal[i];
            const FourFloats gap = higher(higher(low[i] - foot, foot - high[i]) - spare_, zero);
            sum += gap * gap;
        }
        return lower(sum, k_most);
    }

    // The distances themselves, but for roundings: dearer, and for what is left.
    FourFloats squared_closely(const FourTriangles& four) const {
        const FourFloats zero = {};
        std::array<FourVectors, 3> corner;
        for (std::size_t c = 0; c < 3; ++c) {
            for (std::size_t i = 0; i < 3; ++i) {
                corner[c][i] = four.corner[c][i] - point_[i];
            }
        }
        const FourFloats height = dot(four.normal, corner[0]);
        const FourFloats clear = higher(higher(height, -height) - spare_, zero);
        FourInts is_over = dot(four.normal, four.normal) > zero;
        FourFloats least = k_most;
        for (std::size_t c = 0; c < 3; ++c) {
            const FourVectors& from = corner[c];
            const FourVectors& to = corner[(c + 1) % 3];
            const FourVectors edge = {to[0] - from[0], to[1] - from[1], to[2] - from[2]};
            is_over &= dot(four.normal, cross(from, edge)) >= zero;
            least = lower(least, squared_to_edge(from, edge));
        }
        return lower(is_over ? clear * clear : least, k_most);
    }

    // What is nearer than the root of `squared` is no more than this: where that is infinite,
    // nothing is.
    static float limit(double squared) {
        return static_cast<float>(std::min(squared * k_slack, static_cast<double>(k_most[0])));
    }
    static constexpr double k_slack = 1.0 + 1e-5;  // floats round off less

  private:
    // Nothing is said to be farther: squares of floats are infinite soon.
    static constexpr FourFloats k_most = {
        std::numeric_limits<float>::max(), std::numeric_limits<float>::max(),
        std::numeric_limits<float>::max(), std::numeric_limits<float>::max()};

    FourFloats squared_to_edge(const FourVectors& from, const FourVectors& edge) const {
        const FourFloats zero = {};
        const FourFloats tiny = four_times(1e-30);
        const FourFloats share = -dot(from, edge) / higher(dot(edge, edge), tiny);
        const FourFloats on_edge = lower(higher(share, zero), four_times(1.0));
        FourFloats sum = zero;
        for (std::size_t i = 0; i < 3; ++i) {
            const FourFloats way = from[i] + on_edge * edge[i];
            const FourFloats gap = higher(higher(way, -way) - spare_, zero);
            sum += gap * gap;
        }
        return sum;
    }

    std::array<FourFloats, 3> point_ = {};  // each coordinate four times
    FourFloats spare_ = {};
};

}  // namespace handhold
