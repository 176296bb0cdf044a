#pragma once

#include <string>
#include <string_view>

#include "engine/core/result.hpp"
#include "systems/rigs/body_clips.hpp"

namespace handhold {

// Reads clips in the format of docs/reference/body_clips.md. Errors, with the JSON pointer: unknown
// names, keys whose `at` does not increase, values outside their limits. `file` is used in
// messages.
Result<BodyClips> parse_body_clips(std::string_view text, const std::string& file);

}  // namespace handhold
