#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "game/view/player_models.hpp"

namespace handhold {

// Options of `handhold run`.
struct RunOptions {
    std::string scene;
    // The first player's recording; empty: the scene's own session, if it has one.
    std::string input;
    std::vector<std::string> more_inputs;  // recordings of the second player, the third, ...
    // Spawn of the first player; empty: the scene's first; "auto": see find_spawn.
    std::string spawn;
    // Spawns of the second player, the third, ... Players without one get the scene's next
    // spawns, then spread places.
    std::vector<std::string> more_spawns;
    std::string trace;  // file for a Chrome trace of the stages; empty: none
    std::string out;    // folder; empty: no files
    std::string shots;  // file of shots; draws those of this scene into `out` and writes no report
    int shot_width_px = 960;
    int shot_height_px = 540;
    PictureQuality shot_quality = PictureQuality::fine;
    bool distance_grab = false;  // see PlayOptions
    std::string snapshot;        // file; empty: none
    double snapshot_at_s = 0.0;  // taken after the first frame that ends at or after this time
    std::string resume;  // snapshot to start from, of this scene and these players; empty: none
    double hz = 90.0;
    double seconds = 0.0;  // length of the run; 0: as long as the session
    // Number of players. 0: the scene's own players if there are enough; else one per
    // recording, but at least 1 + Scene::climbers.
    int players = 0;
    std::uint64_t seed = 1;  // seed of start places and climbers
    bool climbers = false;   // all players climb; no recording is played
    int threads = 1;
    PlayerModelFiles models;
    bool pictures = true;
};

// Plays the session, writes the files, and prints a summary. Its last line is "state_hash 0x<16 hex
// digits>". Returns the exit status: 0; 2, after one line on standard error, if a file is invalid
// or cannot be written; k_exit_interrupted after a signal. An interrupted run writes complete files
// of the frames played so far.
int run_command(const RunOptions& options);

}  // namespace handhold
