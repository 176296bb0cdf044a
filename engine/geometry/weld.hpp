#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "engine/math/math.hpp"

// Merges points within a tolerance, using a grid.
namespace handhold {

// Each point joins the nearest earlier representative that is within both points' reaches, or
// becomes a representative itself. So a dense chain of points does not collapse into one.
// `reaches_m`: one per point, metres, >= 0; a point with a negative or NaN reach is not merged.
// Returns each point's representative; for representatives and non-finite points, their own index.
std::vector<std::uint32_t> find_representatives(std::span<const Vec3> points,
                                                std::span<const double> reaches_m);

}  // namespace handhold
