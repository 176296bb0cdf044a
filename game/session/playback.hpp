#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "components/tracking.hpp"
#include "game/session/recording.hpp"

namespace handhold {

// A recording as the runtime wants it: samples on the frame clock from 0, handed out frame by
// frame.
class Playback {
  public:
    explicit Playback(const Recording& recording);

    double duration_s() const { return duration_s_; }
    // The samples since the last call's end, up to frame_end_s, and, where none lies at that very
    // time, the one after it. Each sample before the frame's end is handed out once; frame_end_s
    // must not fall.
    std::span<const TrackingSample> window(double frame_end_s);
    // What sticks and buttons ask for as of the last sample that the last window has in its frame:
    // both menu buttons ask for calibration.
    PlayerCommands commands() const;

  private:
    std::vector<TrackingSample> samples_;
    std::vector<bool> calibrates_;  // by sample
    std::size_t next_ = 0;          // first sample not yet consumed
    double duration_s_ = 0.0;
};

}  // namespace handhold
