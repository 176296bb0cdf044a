#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "engine/math/math.hpp"

// Merges points within a tolerance, using a grid.
namespace handhold {

// Each point joins the nearest earlier representative within both points' reaches, or becomes a
// representative itself. Chains of points therefore never collapse, whatever their density.
// `reaches_m`: one per point, metres, >= 0; a negative or NaN reach joins nothing. Returns each
// point's representative; its own index for representatives and non-finite points.
std::vector<std::uint32_t> find_representatives(std::span<const Vec3> points,
                                                std::span<const double> reaches_m);

}  // namespace handhold
