#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "engine/math/float4.hpp"
#include "engine/math/vec2.hpp"

// Cuts four triangles with a plane, in floats. Rounding errors have the effect of a shift of the
// plane by a few roundings of the largest coordinate.
namespace handhold {

// The segments in which a plane cuts four triangles: [in-plane coordinate][triangle].
struct Segments4 {
    std::array<Float4, 2> a = {};
    std::array<Float4, 2> b = {};
    Int4 is_near = {};  // true if the triangle is cut within the radius

    Vec2 end(std::size_t i, std::uint32_t lane) const {
        const auto& from = i == 0 ? a : b;
        return {static_cast<double>(from[0][lane]), static_cast<double>(from[1][lane])};
    }
};

// Cuts triangles with the plane at `offset_m` along the third axis. Ignores cuts that lie farther
// than `radius_m` from the plane's origin.
class PlaneCut4 {
  public:
    PlaneCut4(double offset_m, double radius_m)
        : offset_(splat4(offset_m)), squared_radius_(splat4(radius_m * radius_m)) {}

    // Cuts only the triangles in `is_wanted`.
    Segments4 of(const Corners4& corner, const Int4& is_wanted) const {
        Segments4 found;
        const std::array<Int4, 3> above = {corner[0][2] >= offset_, corner[1][2] >= offset_,
                                           corner[2][2] >= offset_};
        found.is_near = is_wanted & ((above[0] ^ above[1]) | (above[0] ^ above[2]));
        if (!any_of(found.is_near)) {
            return found;
        }
        // One corner is alone on its side of the plane. Both cut edges begin there.
        const std::array<Int4, 3> is_alone = {~(above[1] ^ above[2]), ~(above[0] ^ above[2]),
                                              ~(above[0] ^ above[1])};
        const auto beside_alone = [&](std::size_t i, std::size_t axis) -> Float4 {
            return is_alone[0]
                       ? corner[i][axis]
                       : (is_alone[1] ? corner[(1 + i) % 3][axis] : corner[(2 + i) % 3][axis]);
        };
        const std::array<Float4, 3> from = {beside_alone(0, 0), beside_alone(0, 1),
                                            beside_alone(0, 2)};
        for (std::size_t i = 0; i < 2; ++i) {
            const Float4 share = (offset_ - from[2]) / (beside_alone(1 + i, 2) - from[2]);
            for (std::size_t axis = 0; axis < 2; ++axis) {
                (i == 0 ? found.a : found.b)[axis] =
                    from[axis] + share * (beside_alone(1 + i, axis) - from[axis]);
            }
        }
        found.is_near &= squared_distance_to_origin(found.a, found.b) <= squared_radius_;
        return found;
    }

  private:
    // Squared distance from the origin to a segment.
    static Float4 squared_distance_to_origin(const std::array<Float4, 2>& a,
                                             const std::array<Float4, 2>& b) {
        constexpr Float4 k_tiny = {1e-30F, 1e-30F, 1e-30F, 1e-30F};
        constexpr Float4 k_one = {1.0F, 1.0F, 1.0F, 1.0F};
        const std::array<Float4, 2> along = {b[0] - a[0], b[1] - a[1]};
        const Float4 squared = along[0] * along[0] + along[1] * along[1];
        const Float4 share = -(a[0] * along[0] + a[1] * along[1]) / higher(squared, k_tiny);
        const Float4 on_segment = lower(higher(share, Float4{}), k_one);
        const Float4 x = a[0] + on_segment * along[0];
        const Float4 y = a[1] + on_segment * along[1];
        return x * x + y * y;
    }

    Float4 offset_;
    Float4 squared_radius_;
};

}  // namespace handhold
