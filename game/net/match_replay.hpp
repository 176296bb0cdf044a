#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <span>

#include <handhold/match.hpp>

#include "game/arena/arena_match.hpp"
#include "game/net/match_recording.hpp"

namespace handhold {

// Plays a recorded match again, in a world of its own.
class MatchReplay {
  public:
    // The world has the recording's level and players. World, arena and recording must outlive it.
    // `arena`: the rules of the scene; null: none.
    MatchReplay(hh::World& world, std::span<const hh::Player> players, ArenaGame* arena,
                const MatchRecording& recording, double tick_s);

    // Steps the next tick; false at the end. Error: the recording does not go on from there, or a
    // hash in it differs from the world's. `is_shown`: hands and bodies are placed for pictures.
    Result<bool> step(bool is_shown);

    std::uint64_t tick() const { return match_.stats().tick; }
    const hh::Match& match() const { return match_; }
    // Hashes of the recording that were compared, all equal.
    std::uint64_t compared() const { return match_.stats().hashes + (has_compared_end_ ? 1 : 0); }

  private:
    std::optional<FileError> take(const RecordedPart& part);
    std::optional<FileError> compare_end();

    const MatchRecording& recording_;
    std::unique_ptr<ArenaMatch> arena_;
    hh::Match match_;
    std::size_t next_ = 0;   // the part that is taken next
    std::size_t place_ = 0;  // offset of the last one in the file
    bool has_compared_end_ = false;
};

}  // namespace handhold
