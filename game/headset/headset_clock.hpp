#pragma once

#include <cstdint>

namespace handhold {

// The times at which a headset shows its pictures, as frames of the simulation: one for every
// refresh of the display, however late a picture comes, all of one length. A session that was
// recorded then plays again at `hz` bit for bit.
class HeadsetClock {
  public:
    // Frames that are due until a picture that will be seen at display_ns; 0 where that refresh had
    // its frame. The first call, and the first after pause(), has none due. The first
    // period_ns > 0 decides how long a frame is. Later than k_max_frames, time goes slower.
    int advance(std::int64_t display_ns, std::int64_t period_ns);

    // Until the next advance() no time passes: the runtime was away, or its clock is another.
    void pause() { runs_ = false; }

    double hz() const { return hz_; }
    double dt_s() const { return 1.0 / hz_; }
    // Of the n-th last of the frames that advance() gave, 0 being the last: when it is seen.
    std::int64_t frame_ns(int before_last) const;

    static constexpr int k_max_frames = 9;

  private:
    double hz_ = 90.0;
    bool has_hz_ = false;
    bool runs_ = false;
    std::int64_t begin_ns_ = 0;  // display time of frame 0
    std::int64_t done_ = 0;      // frames
};

}  // namespace handhold
