#pragma once

#include <cstddef>
#include <deque>
#include <vector>

#include "game/desktop/desktop_session.hpp"
#include "systems/snapshot.hpp"

namespace handhold {

// The last seconds of a session, to go back to any of their frames bit for bit: a snapshot every
// tenth of a second or so, and what was asked for in each frame since. What lies between two
// snapshots is played again.
class SessionHistory {
  public:
    static constexpr std::size_t k_frames_a_snapshot = 10;

    // Forgets the oldest where snapshots take more than so many bytes; at least two are kept.
    explicit SessionHistory(const DesktopSession& session,
                            std::size_t most_bytes = std::size_t{64} << 20U);

    // Plays a frame of the session, and remembers it.
    void step(DesktopSession& session, const DesktopInput& input);
    // Goes back by so many frames, or as far as it remembers, and forgets what came after. The
    // number it went. Tuning stays as it is; frames that are played again have what was theirs.
    std::size_t rewind(DesktopSession& session, std::size_t frames);

    std::size_t frames() const;  // that it can go back by
    std::size_t bytes() const { return bytes_; }

  private:
    struct Stretch {
        DesktopState state;  // at its beginning
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
