#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "game/render/player_models.hpp"

namespace handhold {

// `handhold run`: its command line.
struct RunOptions {
    std::string scene;
    std::string input;                     // empty: the scene's own session, if it has one
    std::vector<std::string> more_inputs;  // of the second player, the third, ...
    std::string spawn;                     // empty: the scene's first; "auto": search
    std::vector<std::string> more_spawns;  // of the second player, the third, ...; if shorter: the
                                           // scene's next spawns, then spread
    std::string trace;                     // empty: none
    std::string out;                       // empty: no files
    std::string shots;  // a list of shots: draws those of this scene into `out`, without a report
    int shot_width_px = 960;
    int shot_height_px = 540;
    PictureQuality shot_quality = PictureQuality::fine;
    bool distance_grab = false;  // as in play
    std::string snapshot;        // file; empty: none
    double snapshot_at_s = 0.0;  // taken after the first frame that ends at or after this time
    std::string resume;  // a snapshot of this scene and these players; empty: start of the scene
    double hz = 90.0;
    double seconds = 0.0;    // 0: as long as the session
    int players = 0;         // 0: the scene's own, else one for each input and the scene's climbers
    std::uint64_t seed = 1;  // of places and climbers
    bool climbers = false;   // the first player climbs too instead of playing the session
    int threads = 1;
    PlayerModelFiles models;
    bool pictures = true;
};

// Plays, writes the files, and prints the summary, whose last line is "state_hash 0x<16 hex
// digits>". Returns the exit status: 0; 2 after one line on standard error if a file is refused or
// cannot be written; k_exit_interrupted after a signal, with whole files of the frames played so
// far.
int run_command(const RunOptions& options);

}  // namespace handhold
