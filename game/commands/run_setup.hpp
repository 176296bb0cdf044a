#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "engine/core/result.hpp"
#include "game/commands/run_command.hpp"
#include "game/run/session_run.hpp"
#include "game/scene/scene.hpp"
#include "game/session/recording.hpp"

// What `handhold run` prepares before the first frame: recordings, start places and players.
namespace handhold {

// The recordings that a run plays.
struct RunSession {
    std::optional<Recording> recording;
    std::vector<Recording> more;  // recordings of the second player, the third, ...
    std::string name;             // names of the files, "built-in <name>", or empty: no session
};

// Loads the players' recordings: those of --input, else the scene's session, else none.
Result<RunSession> load_session(const RunOptions& options, const Scene& scene);

// Limits the session's length. Times in a recording are arbitrary: two samples may be years apart.
std::optional<FileError> check_length(const RunOptions& options, const std::string& name,
                                      double length_s);

// A start of the play space. The name is for the report.
struct StartPlace {
    hh::Pose origin_ws = hh::k_origin;
    std::string name;
};

// `spawn`: see RunOptions::spawn.
Result<StartPlace> choose_place(const RunOptions& options, const std::string& spawn, Scene& scene,
                                const Recording* recording);

// The number of players who have recordings; the first player counts even without one.
std::size_t recorded_players(const RunSession& session);

// Start places of players with recordings: `first`, then those of --spawn, then the scene's next
// spawns. Returns fewer places than recordings if the scene has no more spawns.
Result<std::vector<StartPlace>> choose_places(const RunOptions& options, const StartPlace& first,
                                              Scene& scene, const RunSession& session);

// Adds the scene's own players if there are enough of them and neither --spawn nor --players was
// given. Otherwise adds the first players at `places` and spreads the others over the scene.
Result<std::vector<PlayerEntities>> add_players(Scene& scene, const std::vector<StartPlace>& places,
                                                const RunOptions& options,
                                                const RunSession& session);

// Chooses the settings for a session of `players` players. Climbers need jets to return to a hold,
// so a scene without jets gets weak ones.
RunSettings choose_settings(const RunOptions& options, const RunSession& session,
                            std::size_t players, Scene& scene);

// Warns on standard error of bodies and players that penetrate at the start.
void warn_of_overlaps(Scene& scene, const std::vector<PlayerEntities>& players);

}  // namespace handhold
