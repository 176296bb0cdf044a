#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "engine/math/float4.hpp"
#include "engine/math/vec2.hpp"

// What a plane cuts out of four triangles, in floats, side by side. A cut is off by some roundings
// of the triangles' largest coordinates: as if the plane were as much to one side.
namespace handhold {

// By coordinate in the plane.
struct Segments4 {
    std::array<Float4, 2> a = {};
    std::array<Float4, 2> b = {};
    Int4 is_near = {};  // there is one, and it comes near the origin

    Vec2 end(std::size_t i, std::uint32_t lane) const {
        const auto& from = i == 0 ? a : b;
        return {static_cast<double>(from[0][lane]), static_cast<double>(from[1][lane])};
    }
};

// The plane `offset_m` along the third axis, and of it what is no farther than `radius_m` from the
// origin.
class PlaneCut4 {
  public:
    PlaneCut4(double offset_m, double radius_m)
        : offset_(splat4(offset_m)), squared_radius_(splat4(radius_m * radius_m)) {}

    // Of those that are asked for.
    Segments4 of(const Corners4& corner, const Int4& is_asked) const {
        Segments4 found;
        const std::array<Int4, 3> over = {corner[0][2] >= offset_, corner[1][2] >= offset_,
                                          corner[2][2] >= offset_};
        found.is_near = is_asked & ((over[0] ^ over[1]) | (over[0] ^ over[2]));
        if (!any_of(found.is_near)) {
            return found;
        }
        // Of the three corners one is alone on its side: both cut edges begin there.
        const std::array<Int4, 3> is_alone = {~(over[1] ^ over[2]), ~(over[0] ^ over[2]),
                                              ~(over[0] ^ over[1])};
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
        found.is_near &= nearest_squared(found.a, found.b) <= squared_radius_;
        return found;
    }

  private:
    // Of a segment's points the one nearest to the origin: how far that is, squared.
    static Float4 nearest_squared(const std::array<Float4, 2>& a, const std::array<Float4, 2>& b) {
        constexpr Float4 k_tiny = {1e-30F, 1e-30F, 1e-30F, 1e-30F};
        constexpr Float4 k_one = {1.0F, 1.0F, 1.0F, 1.0F};
        const std::array<Float4, 2> way = {b[0] - a[0], b[1] - a[1]};
        const Float4 squared = way[0] * way[0] + way[1] * way[1];
        const Float4 share = -(a[0] * way[0] + a[1] * way[1]) / higher(squared, k_tiny);
        const Float4 on_way = lower(higher(share, Float4{}), k_one);
        const Float4 x = a[0] + on_way * way[0];
        const Float4 y = a[1] + on_way * way[1];
        return x * x + y * y;
    }

    Float4 offset_;
    Float4 squared_radius_;
};

}  // namespace handhold
