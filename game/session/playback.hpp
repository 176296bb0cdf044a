#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include <handhold/handhold.hpp>

#include "game/session/recording.hpp"

namespace handhold {

// Gives a recording's samples to the runtime frame by frame, on a clock that starts at 0.
class Playback {
  public:
    explicit Playback(const Recording& recording);

    double duration_s() const { return duration_s_; }
    // The samples since the last call, up to `frame_end_s`. Unless one lies exactly at
    // `frame_end_s`, also the first sample after it, which the next call returns again.
    // Precondition: `frame_end_s` does not decrease.
    std::span<const hh::Sample> window(double frame_end_s);
    // The commands at the last sample of the frame: calibration while both menu buttons are down.
    hh_commands commands() const;

  private:
    std::vector<hh::Sample> samples_;
    std::vector<bool> calibrates_;  // indexed by index in samples_
    std::size_t next_ = 0;          // first sample not yet returned
    double duration_s_ = 0.0;
};

}  // namespace handhold
