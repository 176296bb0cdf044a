#pragma once

#include <cstdint>

namespace handhold {

// Simulation frames for a headset's display: one per refresh, all of one length, even if pictures
// are late. A recorded session therefore replays at `hz` bit for bit.
class HeadsetClock {
  public:
    // Number of frames to simulate before a picture that is shown at display_ns. 0 if that refresh
    // already had its frame, in the first call, and in the first call after pause(). The first
    // period_ns > 0 determines the frame length. At most k_max_frames; if more are due, simulated
    // time lags behind.
    int advance(std::int64_t display_ns, std::int64_t period_ns);

    // No time passes until the next advance(): the runtime was gone, or has another clock.
    void pause() { runs_ = false; }

    double hz() const { return hz_; }
    double dt_s() const { return 1.0 / hz_; }
    // Display time of a frame of the last advance(), counted from its end; 0: its last frame.
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
