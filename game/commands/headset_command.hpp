#pragma once

#include "game/commands/play_command.hpp"

namespace handhold {

// `handhold play --xr`: as play_command, but in a headset (docs/guide/headset.md). Returns 3 after
// one line on standard error if there is no runtime, headset or renderer, or if the runtime was
// lost for good.
int headset_command(const PlayOptions& options);

}  // namespace handhold
