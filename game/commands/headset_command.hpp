#pragma once

#include "game/desktop/play_options.hpp"

namespace handhold {

// `handhold play --xr`: plays in a headset (docs/guide/headset.md). Exit statuses are those of
// play_command. 3 also means that there is no XR runtime or headset, or that the XR runtime was
// lost permanently.
int headset_command(const PlayOptions& options);

}  // namespace handhold
