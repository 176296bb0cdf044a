#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "components/tracking.hpp"
#include "game/session/recording.hpp"

namespace handhold {

// A recording as the runtime takes it: samples on the frame clock, from 0, frame by frame.
class Playback {
  public:
    explicit Playback(const Recording& recording);

    double duration_s() const { return duration_s_; }
    // The samples since the last call, up to frame_end_s, and, unless one lies exactly there, the
    // first after it. Each sample before frame_end_s is returned once. frame_end_s must not
    // decrease.
    std::span<const TrackingSample> window(double frame_end_s);
    // Commands as of the last sample within the frame of the last window: both menu buttons ask for
    // calibration.
    PlayerCommands commands() const;

  private:
    std::vector<TrackingSample> samples_;
    std::vector<bool> calibrates_;  // by sample
    std::size_t next_ = 0;          // first sample not yet returned
    double duration_s_ = 0.0;
};

}  // namespace handhold
