#pragma once

#include <string>
#include <string_view>

#include "engine/io/result.hpp"
#include "systems/rigs/body_clips.hpp"

namespace handhold {

// Reads clips as docs/reference/body_clips.md has them. Refused, with JSON pointer: unknown names,
// keys that do not rise, angles beyond the limits. `file` is for messages.
Result<BodyClips> parse_body_clips(std::string_view text, const std::string& file);

}  // namespace handhold
