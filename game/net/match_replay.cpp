#include "game/net/match_replay.hpp"

#include <stdexcept>
#include <string>

namespace handhold {

MatchReplay::MatchReplay(hh::World& world, std::span<const hh::Player> players, ArenaGame* arena,
                         const MatchRecording& recording, double tick_s)
    : recording_(recording),
      arena_(arena != nullptr ? std::make_unique<ArenaMatch>(world, *arena) : nullptr) {
    hh_match_def def = hh::match_def();
    def.role = HH_MATCH_SPECTATOR;
    def.tick_s = tick_s;
    const hh_match_game game = arena_ != nullptr ? arena_->callbacks() : hh_default_match_game();
    match_ = hh::Match(world, players, def, arena_ != nullptr ? &game : nullptr);
    if (!match_.is_valid()) {
        throw std::runtime_error(hh_last_error());
    }
}

std::optional<FileError> MatchReplay::take(const RecordedPart& part) {
    place_ = part.place;
    const auto refuse = [&](const std::string& expected) {
        return FileError{recording_.file, "byte " + std::to_string(part.place),
                         "expected " + expected};
    };
    if (part.kind == RecordedKind::inputs) {
        const std::uint64_t refused = match_.stats().refused[HH_MATCH_REFUSED_GAP];
        const hh::Status taken = match_.receive(part.bytes);
        if (!taken || match_.stats().refused[HH_MATCH_REFUSED_GAP] != refused) {
            return refuse("inputs that go on after tick " + std::to_string(tick()));
        }
        return std::nullopt;
    }
    const std::optional<JoinedState> state = split_join_state(part.bytes, arena_ != nullptr);
    if (!state) {
        return refuse("the state of the scene's rules");
    }
    if (const hh::Status joined = match_.join(state->of_match); !joined) {
        return refuse("a state that can be restored: " + printable(joined.text()));
    }
    if (arena_ != nullptr) {
        arena_->set(state->of_rules);
    }
    return std::nullopt;
}

std::optional<FileError> MatchReplay::compare_end() {
    if (recording_.last_hash == 0) {
        return std::nullopt;  // not known when it was recorded
    }
    if (tick() != recording_.last_tick || *match_.hash(tick()) != recording_.last_hash) {
        return FileError{recording_.file, "",
                         "expected the hash of the last tick, " +
                             std::to_string(recording_.last_tick) + ", found another at tick " +
                             std::to_string(tick())};
    }
    has_compared_end_ = true;
    return std::nullopt;
}

Result<bool> MatchReplay::step(bool is_shown) {
    hh_match_input input = hh::match_input({});
    input.is_hidden = is_shown ? 0 : 1;
    for (;;) {
        const hh::Maybe<bool> advanced = match_.advance(input);
        if (!advanced) {
            throw std::runtime_error(hh_last_error());
        }
        if (*advanced) {
            if (match_.needs_state(0).value_or(false)) {
                return FileError{recording_.file, "byte " + std::to_string(place_),
                                 "expected the hash of tick " + std::to_string(tick()) +
                                     " in the recording, found another in the world"};
            }
            return true;
        }
        if (next_ == recording_.parts.size()) {
            if (auto error = compare_end()) {
                return *error;
            }
            return false;
        }
        if (auto error = take(recording_.parts[next_++])) {
            return *error;
        }
    }
}

}  // namespace handhold
