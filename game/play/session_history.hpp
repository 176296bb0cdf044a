#pragma once

#include <cstddef>
#include <deque>
#include <vector>

#include "game/play/desktop_session.hpp"

namespace handhold {

// The last seconds of a session, for rewinding to any frame, bit for bit. Keeps snapshots about
// every tenth of a second and the input of each frame. Frames between two snapshots are replayed.
class SessionHistory {
  public:
    static constexpr std::size_t k_frames_a_snapshot = 10;

    // Drops the oldest snapshots beyond this many bytes; keeps at least two.
    explicit SessionHistory(std::size_t most_bytes = std::size_t{64} << 20U)
        : most_bytes_(most_bytes) {}

    // Steps the session by a frame and records it.
    void step(DesktopSession& session, const DesktopInput& input);
    // Rewinds by `frames`, or by as many as are recorded, and forgets the later ones. Returns the
    // number of frames rewound. The session keeps its current tuning; replayed frames use the
    // tuning of their time.
    std::size_t rewind(DesktopSession& session, std::size_t frames);

    std::size_t frames() const;  // number of frames that can be rewound
    std::size_t bytes() const { return bytes_; }

  private:
    // A snapshot and the inputs of the frames after it.
    struct Stretch {
        DesktopState state;          // state before the first input
        std::vector<double> tuning;  // hh::World::tuning_numbers
        std::vector<DesktopInput> inputs;
    };
    void drop_oldest();
    static void play_again(DesktopSession& session, const Stretch& stretch);

    std::size_t most_bytes_;
    std::size_t bytes_ = 0;  // size of all snapshots
    std::deque<Stretch> stretches_;
};

}  // namespace handhold
