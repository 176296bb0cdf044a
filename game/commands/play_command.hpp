#pragma once

#include "game/desktop/play_options.hpp"

namespace handhold {

// Plays scenes in a window with keyboard, mouse and gamepad, in real time. If drawing takes too
// long, simulated time runs slower. Output files describe the scene that was played last. Returns
// the exit status: 0; 2, after one line on standard error, if a file is invalid or cannot be
// written; 3 if there is no window or renderer. The last line on standard output is "state_hash
// 0x<16 hex digits>".
int play_command(const PlayOptions& options);

}  // namespace handhold
