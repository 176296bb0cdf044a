#pragma once

#include <cstddef>
#include <deque>
#include <vector>

#include "game/desktop/desktop_session.hpp"
#include "systems/snapshot.hpp"

namespace handhold {

// The last seconds of a session, for rewinding to any frame bit for bit: snapshots about every
// tenth of a second, and the input of each frame since. Frames between two snapshots are replayed.
class SessionHistory {
  public:
    static constexpr std::size_t k_frames_a_snapshot = 10;

    // Drops the oldest snapshots beyond this many bytes; keeps at least two.
    explicit SessionHistory(const DesktopSession& session,
                            std::size_t most_bytes = std::size_t{64} << 20U);

    // Steps the session by a frame and records it.
    void step(DesktopSession& session, const DesktopInput& input);
    // Rewinds by so many frames, or as many as are recorded, and forgets the frames after. Returns
    // the number of frames. The present tuning stays; replayed frames use the tuning they had.
    std::size_t rewind(DesktopSession& session, std::size_t frames);

    std::size_t frames() const;  // frames that it can rewind
    std::size_t bytes() const { return bytes_; }

  private:
    struct Stretch {
        DesktopState state;  // at the start of the stretch
        Tuning tuning;
        std::vector<DesktopInput> inputs;
    };
    void drop_oldest();
    void play_again(DesktopSession& session, const Stretch& stretch) const;

    SnapshotAssets assets_;
    std::size_t most_bytes_;
    std::size_t bytes_ = 0;  // of the snapshots
    std::deque<Stretch> stretches_;
};

}  // namespace handhold
