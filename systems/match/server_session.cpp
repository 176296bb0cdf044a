#include "systems/match/server_session.hpp"

#include <algorithm>

#include "engine/core/check.hpp"
#include "systems/match/tick_pacer.hpp"

namespace handhold {
namespace {

std::uint8_t next_epoch(std::uint8_t epoch) { return static_cast<std::uint8_t>((epoch + 1U) % 4U); }

}  // namespace

void ServerSession::Waits::add(double wait_s) {
    if (count < 0) {
        now_s = before_s = wait_s;
        count = 0;
    } else if (++count > k_span) {
        before_s = now_s;
        now_s = wait_s;
        count = 0;
    }
    now_s = std::min(now_s, wait_s);
}

double ServerSession::Waits::least_s() const {
    return count < 0 ? TickPacer::k_target_s : std::min(now_s, before_s);
}

ServerSession::ServerSession(const MatchWorld& match, double start_s)
    : match_(match), start_s_(start_s), start_tick_(match.world.clock.frame) {
    HH_CHECK(match.player_count > 0 && match.player_count <= k_most_match_players,
             "a match has 1 to 16 players", match.player_count);
    HH_CHECK(start_tick_ <= k_last_start_tick, "a match begins before tick 2^32", start_tick_);
    for (std::size_t slot = 0; slot < match.player_count; ++slot) {
        histories_[slot].reset(start_tick_);
        sent_[slot].reset(start_tick_);
    }
    for (Peer& peer : peers_) {
        peer.known_until.fill(start_tick_);
        for (SendMarks& marks : peer.marks) {
            marks.reset(start_tick_);
        }
    }
}

void ServerSession::connect(std::size_t slot) {
    HH_CHECK(slot < match_.player_count, "no such slot", slot);
    peers_[slot].is_connected = true;
    peers_[slot].forget_lead();
}

MatchRefusal ServerSession::receive(std::size_t slot, std::span<const std::byte> packet,
                                    double now_s) {
    std::array<std::uint8_t, k_most_match_players> epochs{};
    for (std::size_t i = 0; i < match_.player_count; ++i) {
        epochs[i] = peers_[i].state_epoch;
    }
    const auto sender = static_cast<std::uint8_t>(slot);
    const MatchRefusal refusal =
        is_connected(slot) ? read_client_packet(packet, match_.player_count,
                                                {sender, histories(), sent_, epochs}, incoming_)
                           : MatchRefusal::sender;
    if (refusal != MatchRefusal::none) {
        counts_.refused[static_cast<std::size_t>(refusal)] += 1;
        return refusal;
    }
    Peer& peer = peers_[slot];
    for (std::size_t i = 0; i < match_.player_count; ++i) {
        peer.known_until[i] = std::max(peer.known_until[i], incoming_.known_until[i]);
    }
    if (incoming_.wants_state) {
        ask_for_state(peer);
    }
    compare_hash(peer, incoming_.hash_tick, incoming_.hash);
    InputHistory& sent = sent_[slot];
    if (incoming_.is_fresh && incoming_.own.base > sent.final_until() &&
        incoming_.own.base <= confirmed() + k_most_lead) {
        sent.reset(incoming_.own.base);
    }
    const MatchTick newest = incoming_.own.base + incoming_.own.count;
    if (newest > peer.newest && peer.lead_epoch != incoming_.lead_epoch) {
        peer.lead_epoch = incoming_.lead_epoch;
        peer.waits = {};
    }
    take_inputs(slot, incoming_.own, now_s);
    peer.newest = std::max(peer.newest, newest);
    return MatchRefusal::none;
}

void ServerSession::take_inputs(std::size_t slot, const StreamPart& part, double now_s) {
    InputHistory& history = histories_[slot];
    InputHistory& sent = sent_[slot];
    Peer& peer = peers_[slot];
    for (std::size_t i = 0; i < part.count; ++i) {
        const MatchTick tick = part.base + i + 1;
        if (tick <= sent.final_until()) {
            continue;  // received already
        }
        if (tick > confirmed() + k_most_lead) {
            return;  // too early: the player sends it again
        }
        const MatchInput& input = part.entries[i].input;
        sent.finish_next(input, InputKind::real);
        if (tick == history.final_until() + 1) {
            history.finish_next(input, InputKind::real);
        } else if (tick <= history.final_until()) {
            ++counts_.late;
        }
        // The newest input of a packet tells the lead. Older ones have come before, or packets were
        // lost. A client that puts several new ones into a packet takes that into account.
        if (tick > peer.newest && i + 1 == part.count) {
            peer.waits.add(deadline_s(tick) - now_s);
        }
    }
}

void ServerSession::compare_hash(Peer& peer, MatchTick tick, std::uint64_t hash) {
    const std::optional<std::uint64_t> own = hashes_.at(tick);
    if (!own || tick <= peer.compared_until) {
        return;
    }
    peer.compared_until = tick;
    ++counts_.hashes;
    if (*own != hash) {
        ++counts_.out_of_sync;
        ask_for_state(peer);
    }
}

// A peer that asks again at once gets nothing: states are a thousand times as large as requests.
void ServerSession::ask_for_state(Peer& peer) const {
    peer.needs_state = peer.needs_state || confirmed() >= peer.next_state_at;
}

bool ServerSession::is_complete(MatchTick tick) const {
    bool has_anybody = false;
    for (std::size_t slot = 0; slot < match_.player_count; ++slot) {
        if (peers_[slot].is_connected) {
            has_anybody = true;
            if (histories_[slot].final_until() < tick) {
                return false;
            }
        }
    }
    return has_anybody;
}

void ServerSession::confirm(MatchTick tick) {
    TickInputs inputs;
    for (std::size_t slot = 0; slot < match_.player_count; ++slot) {
        InputHistory& history = histories_[slot];
        if (history.final_until() < tick && sent_[slot].kind_at(tick) == InputKind::real) {
            history.finish_next(sent_[slot].at(tick), InputKind::real);
        } else if (history.final_until() < tick) {
            history.finish_next(predict_input(trend_of(history), tick), InputKind::filled);
            counts_.filled += peers_[slot].is_connected ? 1U : 0U;
        }
        inputs.before[slot] = &history.at(tick - 1);
        inputs.now[slot] = &history.at(tick);
    }
    step_tick(match_, inputs, false, scratch_, stats_);
    ++counts_.ticks;
    if (tick % k_hash_every_ticks == 0) {
        hashes_.set(tick, hash());
    }
}

void ServerSession::advance(double now_s, std::size_t most) {
    for (std::size_t i = 0; i < most; ++i) {
        const MatchTick tick = confirmed() + 1;
        const double early_s = deadline_s(tick) - now_s;
        if (early_s > k_most_early_s || (early_s > 0.0 && !is_complete(tick))) {
            return;
        }
        confirm(tick);
    }
}

std::size_t ServerSession::write_packet(std::size_t slot, std::span<std::byte> bytes) {
    Peer& peer = peers_[slot];
    ServerHeader header;
    header.slot = static_cast<std::uint8_t>(slot);
    header.state_epoch = peer.state_epoch;
    header.confirmed_until = confirmed();
    header.received_until = sent_[slot].final_until();
    header.wait_s = peer.waits.least_s();
    header.lead_epoch = peer.lead_epoch;
    constexpr MatchTick k_oldest = InputHistory::k_capacity - InputHistory::k_looks_back;
    std::array<StreamSource, k_most_match_players> streams;
    for (std::size_t i = 0; i < match_.player_count; ++i) {
        const MatchTick until = histories_[i].final_until();
        // The inputs that it lacks are forgotten.
        peer.needs_state = peer.needs_state || peer.known_until[i] + k_oldest < until;
        const MatchTick oldest = until > k_oldest ? until - k_oldest : 0;
        const MatchTick known = std::max(peer.known_until[i], oldest);
        streams[i] = {.history = &histories_[i],
                      .base = peer.marks[i].base(peer.packets, known, until),
                      .until = until,
                      .is_receivers_own = i == slot};
    }
    header.is_out_of_sync = peer.needs_state;
    const std::span<StreamSource> used = std::span(streams).first(match_.player_count);
    const std::size_t size = write_server_packet(header, match_.player_count, used, bytes);
    for (std::size_t i = 0; i < match_.player_count; ++i) {
        peer.marks[i].note(peer.packets, streams[i].until);
    }
    ++peer.packets;
    return size;
}

std::uint64_t ServerSession::hash() const {
    return match_hash(match_, hash_simulated(match_.world), hash_of_host(match_));
}

void ServerSession::preview_state(std::size_t slot, const SnapshotAssets& assets,
                                  std::vector<std::byte>& bytes) const {
    write_join_state(match_, assets, std::span(histories_).first(match_.player_count),
                     next_epoch(peers_[slot].state_epoch), bytes);
}

void ServerSession::write_state_to_watch(const SnapshotAssets& assets,
                                         std::vector<std::byte>& bytes) const {
    write_join_state(match_, assets, histories(), 0, bytes);
}

bool ServerSession::can_write_after(MatchTick after) const {
    return can_write_confirmed(histories(), after, confirmed());
}

std::size_t ServerSession::write_watched(MatchTick after, MatchTick& until,
                                         std::span<std::byte> bytes) const {
    until = confirmed();
    return write_confirmed(histories(), hashes_, after, until, bytes);
}

void ServerSession::write_state(std::size_t slot, const SnapshotAssets& assets,
                                std::vector<std::byte>& bytes) {
    preview_state(slot, assets, bytes);
    Peer& peer = peers_[slot];
    peer.state_epoch = next_epoch(peer.state_epoch);
    peer.needs_state = false;
    for (std::size_t i = 0; i < match_.player_count; ++i) {
        peer.known_until[i] = histories_[i].final_until();
        peer.marks[i].reset(histories_[i].final_until());
    }
    peer.compared_until = confirmed();
    peer.next_state_at = confirmed() + k_state_every_ticks;
    peer.forget_lead();
    sent_[slot].reset(confirmed());
}

}  // namespace handhold
