#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "engine/math/math.hpp"

// Points that are one point to a tolerance, found over a grid.
namespace handhold {

// Places in `points` by nearness: each point joins the nearest earlier representative as near as
// both their reaches, or becomes one itself: no chain grows, whatever the density. Reaches: one a
// point, metres, >= 0; NaN or negative: joins nothing. Result: the representative's index, for each
// point; its own for representatives and for points that are not finite.
std::vector<std::uint32_t> find_representatives(std::span<const Vec3> points,
                                                std::span<const double> reaches_m);

}  // namespace handhold
