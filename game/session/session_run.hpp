#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "game/scene/scene.hpp"
#include "game/session/playback.hpp"
#include "game/session/recording.hpp"
#include "game/session/run_log.hpp"
#include "systems/frame.hpp"

namespace handhold {

struct RunSettings {
    double hz = 90.0;      // (0, 1000]
    double seconds = 0.0;  // 0: as long as the recording; 10 without one
    int threads = 1;
    // Players from this one on are climbers who wander; those before it play the recording.
    std::size_t climbers_from = std::numeric_limits<std::size_t>::max();
    std::uint64_t seed = 1;   // of the climbers
    bool keep_frames = true;  // false: the log has the last frame only; memory does not grow
    // What the second player, the third... plays. Players beyond the last play the first recording.
    std::vector<const Recording*> more_recordings;
    // Asked after each frame: true ends the run there. Null: never.
    bool (*should_stop)() = nullptr;
};

// How long run_session will play, seconds: as long as the longest recording, unless the settings
// say. `recording` may be null.
double session_length_s(const Recording* recording, const RunSettings& settings);

// Called after each frame: for pictures.
using FrameObserver = std::function<void(const Scene&, const FrameLog&)>;

// Plays recordings in a scene without a window, as fast as it can: every player who is no climber
// plays one. Players must be in the world already. Begins at the world's
// clock: a world that was saved in the middle goes on there. Leaves the world at the last frame.
RunLog run_session(Scene& scene, FrameCaches& caches, const std::vector<PlayerEntities>& players,
                   const Recording* recording, const RunSettings& settings,
                   const FrameObserver& observe = {});

}  // namespace handhold
