#pragma once

#include <string>
#include <string_view>

#include "components/tuning.hpp"
#include "engine/core/result.hpp"

namespace handhold {

// Parses {"hand": {"reach_m": 0.12}, ...}: any subset of the numbers of visit_tuning, over the
// defaults. Errors, with JSON pointer: unknown names, wrong types, values out of range,
// kappa_heavy_kg not above kappa_light_kg. `file` is used in messages.
Result<Tuning> parse_tuning(std::string_view text, const std::string& file);

// All numbers, in the format of parse_tuning.
std::string tuning_to_json(const Tuning& tuning);

}  // namespace handhold
