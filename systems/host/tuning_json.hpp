#pragma once

#include <string>
#include <string_view>

#include "components/tuning.hpp"
#include "engine/io/result.hpp"

namespace handhold {

// Reads {"hand": {"reach_m": 0.12}, ...} over the defaults: any subset of the numbers of
// visit_tuning. Refused, with JSON pointer: unknown names, wrong types, values out of range,
// kappa_heavy_kg not above kappa_light_kg. `file` is for messages.
Result<Tuning> parse_tuning(std::string_view text, const std::string& file);

// Every number, as parse_tuning reads it.
std::string tuning_to_json(const Tuning& tuning);

}  // namespace handhold
