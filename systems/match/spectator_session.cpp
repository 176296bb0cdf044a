#include "systems/match/spectator_session.hpp"

#include <algorithm>
#include <cmath>

#include "engine/core/check.hpp"
#include "systems/match/tick_pacer.hpp"

namespace handhold {

SpectatorSession::SpectatorSession(const MatchWorld& match) : match_(match) {
    HH_CHECK(match.player_count > 0 && match.player_count <= k_most_match_players,
             "a match has 1 to 16 players", match.player_count);
    HH_CHECK(now() <= k_last_start_tick, "a match begins before tick 2^32", now());
    for (InputHistory& history : histories()) {
        history.reset(now());
    }
}

std::optional<FileError> SpectatorSession::join(std::span<const std::byte> state,
                                                const SnapshotAssets& assets,
                                                const MissingHeads& heads) {
    std::uint8_t epoch = 0;
    if (std::optional<FileError> error =
            read_join_state(state, assets, heads, match_, histories(), epoch)) {
        counts_.refused[static_cast<std::size_t>(MatchRefusal::state)] += 1;
        return error;
    }
    // A state for a player has inputs of some slots that are not confirmed yet: all slots go on
    // together, and those inputs come again.
    for (InputHistory& history : histories()) {
        history.forget_after(now());
    }
    hashes_.forget();
    debt_ticks_ = 0.0;
    needs_state_ = false;
    return std::nullopt;
}

MatchRefusal SpectatorSession::receive(std::span<const std::byte> packet) {
    const MatchRefusal refusal = read_confirmed(packet, now(), histories(), hashes_);
    if (refusal != MatchRefusal::none) {
        counts_.refused[static_cast<std::size_t>(refusal)] += 1;
        needs_state_ = needs_state_ || refusal == MatchRefusal::window;
    }
    return refusal;
}

int SpectatorSession::ticks_due(double elapsed_s) {
    // The rate follows the ticks that wait; after a long pause they are made up at once.
    constexpr double k_rate_a_tick = 0.01;
    constexpr double k_most_change = 0.1;
    constexpr double k_too_many = 60.0;
    const double over = static_cast<double>(received() - now()) - k_behind_ticks;
    if (over > k_too_many) {
        debt_ticks_ = over;
    } else {
        const double rate = 1.0 + std::clamp(k_rate_a_tick * over, -k_most_change, k_most_change);
        debt_ticks_ += std::clamp(elapsed_s, 0.0, 1.0) * rate / match_.dt_s;
    }
    const double due =
        std::min(std::floor(debt_ticks_), static_cast<double>(TickPacer::k_most_ticks));
    debt_ticks_ = std::min(debt_ticks_ - due, k_too_many);
    return static_cast<int>(due);
}

bool SpectatorSession::advance(bool is_shown) {
    const MatchTick tick = now() + 1;
    if (tick > received()) {
        debt_ticks_ = 0.0;
        return false;
    }
    TickInputs inputs;
    for (std::size_t slot = 0; slot < match_.player_count; ++slot) {
        inputs.before[slot] = &histories_[slot].at(tick - 1);
        inputs.now[slot] = &histories_[slot].at(tick);
    }
    step_tick(match_, inputs, is_shown, scratch_, stats_);
    ++counts_.ticks;
    if (const std::optional<std::uint64_t> known = hashes_.at(tick)) {
        ++counts_.hashes;
        if (*known != hash()) {
            ++counts_.out_of_sync;
            needs_state_ = true;
        }
    }
    return true;
}

bool SpectatorSession::can_write_after(MatchTick after) const {
    return can_write_confirmed(histories(), after, now());
}

std::size_t SpectatorSession::write_watched(MatchTick after, MatchTick& until,
                                            std::span<std::byte> bytes) const {
    until = now();
    return write_confirmed(histories(), hashes_, after, until, bytes);
}

std::uint64_t SpectatorSession::hash() const {
    return match_hash(match_, hash_simulated(match_.world), hash_of_host(match_));
}

}  // namespace handhold
