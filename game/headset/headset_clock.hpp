#pragma once

#include <cstdint>

namespace handhold {

// Counts simulation frames for a headset's display: one per refresh, all of the same length, even
// if pictures are late. A recorded session therefore replays at hz() bit for bit.
class HeadsetClock {
  public:
    // Number of frames to simulate before a picture that is shown at display_ns. 0 if that refresh
    // already had its frame, in the first call, and in the first call after pause(). The first
    // period_ns > 0 determines the frame length. At most k_max_frames; if more are due, simulated
    // time lags behind.
    int advance(std::int64_t display_ns, std::int64_t period_ns);

    // Call after the runtime was reopened: the time until the next advance() is not simulated, and
    // the runtime's clock may have changed.
    void pause() { runs_ = false; }

    double hz() const { return hz_; }
    double dt_s() const { return 1.0 / hz_; }
    // Display time of a frame of the last advance(). `before_last`: number of frames after it.
    std::int64_t frame_ns(int before_last) const;

    static constexpr int k_max_frames = 9;

  private:
    double hz_ = 90.0;
    bool has_hz_ = false;
    bool runs_ = false;
    std::int64_t begin_ns_ = 0;  // display time of frame 0
    std::int64_t done_ = 0;      // number of frames counted so far
};

}  // namespace handhold
