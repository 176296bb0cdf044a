#pragma once

#include "game/commands/play_command.hpp"

namespace handhold {

// `handhold play --xr`: as play_command, but in a headset (docs/guide/headset.md). 3 after one line
// on standard error where there is no runtime, no headset, nothing to draw with, or where the
// runtime was lost and does not come back.
int headset_command(const PlayOptions& options);

}  // namespace handhold
