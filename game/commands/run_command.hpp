#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "game/render/player_models.hpp"

namespace handhold {

// `handhold run`, as given on the command line.
struct RunOptions {
    std::string scene;
    std::string input;                     // empty: the scene's own session, if it has one
    std::vector<std::string> more_inputs;  // of the second player, the third...
    std::string spawn;                     // empty: the scene's first; "auto"
    std::vector<std::string> more_spawns;  // of the second player, the third...; none: the scene's
                                           // second, third..., then places apart from each other
    std::string trace;                     // empty: none
    std::string out;                       // empty: no files
    std::string shots;  // a list of shots: those of this scene into `out`, and no report
    int shot_width_px = 960;
    int shot_height_px = 540;
    PictureQuality shot_quality = PictureQuality::fine;
    bool distance_grab = false;  // as in play
    std::string snapshot;        // file; empty: none
    double snapshot_at_s = 0.0;  // when it is taken: after the first frame that ends then or later
    std::string resume;  // a snapshot of this scene and these players; empty: from the start
    double hz = 90.0;
    double seconds = 0.0;    // 0: as long as the session
    int players = 0;         // 0: the scene's own, or one and the scene's climbers
    std::uint64_t seed = 1;  // of places and climbers
    bool climbers = false;   // also the first player climbs instead of playing the session
    int threads = 1;
    PlayerModelFiles models;
    bool pictures = true;
};

// Plays, writes what was asked for, and prints the summary; the last line is "state_hash 0x<16 hex
// digits>". Returns the exit status: 0, or 2 after one line on standard error where a file is
// refused or cannot be written.
int run_command(const RunOptions& options);

}  // namespace handhold
