#pragma once

#include <cstdint>

namespace handhold {

// Converts a headset's display times to simulation frames of constant length: one per display
// refresh, even if pictures come late. Because the length is constant, a recorded session can be
// replayed at `hz`, bit for bit.
class HeadsetClock {
  public:
    // Returns the number of frames to simulate before drawing the picture that is displayed at
    // display_ns. 0 if that refresh already had its frame, and in the first call and the first call
    // after pause(). At most k_max_frames: beyond that, simulated time falls behind. The first
    // period_ns > 0 in such a first call sets the length of a frame.
    int advance(std::int64_t display_ns, std::int64_t period_ns);

    // Skips the time until the next advance(): the runtime was lost, or has a different clock now.
    void pause() { runs_ = false; }

    double hz() const { return hz_; }
    double dt_s() const { return 1.0 / hz_; }
    // Display time of one of the frames that advance() counted: 0: the last one, 1: the one before.
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
