#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <span>
#include <string>
#include <vector>

#include "game/run/run_log.hpp"
#include "game/scene/scene.hpp"
#include "game/session/playback.hpp"
#include "game/session/recording.hpp"

namespace handhold {

struct RunSettings {
    double hz = 90.0;      // (0, 1000]
    double seconds = 0.0;  // 0: as long as the longest recording; 10 if there is no recording
    int threads = 1;
    // Players from this index on are wandering climbers; those before it play recordings.
    std::size_t climbers_from = std::numeric_limits<std::size_t>::max();
    std::uint64_t seed = 1;   // random seed of the climbers
    bool keep_frames = true;  // false: keep the last frame only, so memory does not grow
    // Recordings of the second player, the third, and so on. Further players play the first
    // recording.
    std::vector<const Recording*> more_recordings = {};
    // Called after each frame; the run ends if it returns true. Null: never.
    bool (*should_stop)() = nullptr;
};

// The duration of run_session: settings.seconds or, if that is 0, the length of the longest
// recording. `recording` may be null.
double session_length_s(const Recording* recording, const RunSettings& settings);

// Called after each frame, for pictures.
using FrameObserver = std::function<void(const Scene&, const FrameLog&)>;

// Plays recordings in a scene without a window, as fast as possible. The world must contain
// `players`. Starts at the world's current time, so that a restored world continues. Leaves the
// world at the last frame.
RunLog run_session(Scene& scene, std::span<const hh::Player> players, const Recording* recording,
                   const RunSettings& settings, const FrameObserver& observe = {});

}  // namespace handhold
