#pragma once

#include <array>

#include "engine/io/json.hpp"

// Ranges of numbers in scene files and station descriptions.
namespace handhold {

inline constexpr NumberRange k_coordinate_m = {-1e6, 1e6, false};
inline constexpr NumberRange k_mass_kg = {1e-6, 1e12, false};
inline constexpr NumberRange k_brightness = {0.0, 1e3, false};

// Linear red, green, blue.
std::array<float, 3> read_color(const JsonValue& value, const NumberRange& range);

}  // namespace handhold
