#include "systems/match/client_session.hpp"

#include <algorithm>

#include "engine/core/check.hpp"

namespace handhold {
namespace {

// The ring of sent inputs forgets inputs that the server has not received for so long.
constexpr MatchTick k_most_unreceived = InputHistory::k_capacity - InputHistory::k_looks_back - 16;

}  // namespace

ClientSession::ClientSession(const MatchWorld& match, std::size_t slot)
    : match_(match), slot_(slot) {
    HH_CHECK(match.player_count > 0 && match.player_count <= k_most_match_players,
             "a match has 1 to 16 players", match.player_count);
    HH_CHECK(slot < match.player_count, "no such slot", slot);
    HH_CHECK(now() <= k_last_start_tick, "a match begins before tick 2^32", now());
    for (InputHistory& history : histories()) {
        history.reset(now());
    }
    start_here();
}

// Begins at the world's tick; all inputs up to it are final.
void ClientSession::start_here() {
    trend_of_until_.fill(~MatchTick{0});
    is_start_kept_ = false;
    oldest_state_ = now();
    has_wrong_ = false;
    sent_.reset(now());
    received_until_ = now();
    marks_.reset(now());
    pacer_ = {};
    sent_until_ = now();
    had_two_.fill(false);
    hash_tick_ = 0;
    hashes_.forget();
    needs_state_ = false;
    shown_.forget();
}

std::optional<FileError> ClientSession::join(std::span<const std::byte> state,
                                             const SnapshotAssets& assets,
                                             const MissingHeads& heads) {
    if (std::optional<FileError> error =
            read_join_state(state, assets, heads, match_, histories(), state_epoch_)) {
        counts_.refused[static_cast<std::size_t>(MatchRefusal::state)] += 1;
        return error;
    }
    start_here();
    return std::nullopt;
}

MatchTick ClientSession::confirmed() const {
    MatchTick tick = histories_[0].final_until();
    for (std::size_t slot = 1; slot < match_.player_count; ++slot) {
        tick = std::min(tick, histories_[slot].final_until());
    }
    return tick;
}

MatchTick ClientSession::final_state() const {
    const MatchTick tick = std::min(now(), confirmed());
    return has_wrong_ ? std::min(tick, first_wrong_ - 1) : tick;
}

MatchRefusal ClientSession::receive(std::span<const std::byte> packet) {
    const MatchRefusal refusal = read_server_packet(packet, match_.player_count,
                                                    {histories(), slot_, state_epoch_}, incoming_);
    if (refusal != MatchRefusal::none) {
        counts_.refused[static_cast<std::size_t>(refusal)] += 1;
        return refusal;
    }
    counts_.refused[static_cast<std::size_t>(MatchRefusal::gap)] += incoming_.gaps;
    needs_state_ = needs_state_ || incoming_.is_out_of_sync;
    for (std::size_t slot = 0; slot < match_.player_count; ++slot) {
        take_stream(slot, incoming_.streams[slot]);
    }
    received_until_ = std::clamp(incoming_.received_until, received_until_, sent_.final_until());
    if (incoming_.confirmed_until > now()) {
        pacer_.hear_behind(static_cast<double>(incoming_.confirmed_until - now()));
    } else {
        // The server reports the newest input of each packet; the other one is due a tick earlier.
        const bool has_two = std::ranges::count(had_two_, true) > 1;
        const double earlier_s = has_two ? match_.dt_s : 0.0;
        pacer_.hear(incoming_.wait_s - earlier_s, incoming_.lead_epoch, match_.dt_s);
    }
    return MatchRefusal::none;
}

void ClientSession::take_stream(std::size_t slot, const StreamPart& part) {
    InputHistory& history = histories_[slot];
    for (std::size_t i = 0; i < part.count; ++i) {
        const StreamPart::Entry& entry = part.entries[i];
        const MatchTick tick = part.base + i + 1;
        if (tick <= history.final_until()) {
            continue;  // known already
        }
        if (tick > now() + InputHistory::k_capacity / 2) {
            return;  // too far ahead: the server sends it again
        }
        if (entry.is_filled) {
            counts_.filled += slot == slot_ ? 1U : 0U;
            finish_tick(slot, predict_input(trend_of(history), tick), InputKind::filled);
        } else if (entry.is_sent) {
            finish_tick(slot, entry.input, InputKind::real);
        } else if (history.kind_at(tick) == InputKind::own) {
            finish_tick(slot, history.at(tick), InputKind::real);
        } else {
            needs_state_ = true;  // an input that this machine has not sent
            return;
        }
    }
}

void ClientSession::finish_tick(std::size_t slot, const MatchInput& input, InputKind kind) {
    InputHistory& history = histories_[slot];
    const MatchTick tick = history.final_until() + 1;
    if (tick <= now() && !(history.at(tick) == input)) {
        first_wrong_ = has_wrong_ ? std::min(first_wrong_, tick) : tick;
        has_wrong_ = true;
    }
    history.finish_next(input, kind);
}

// Fills in what is used in the next tick.
void ClientSession::choose_inputs(MatchTick tick) {
    for (std::size_t slot = 0; slot < match_.player_count; ++slot) {
        InputHistory& history = histories_[slot];
        const InputKind kind = history.kind_at(tick);
        if (tick <= history.final_until() || kind == InputKind::own) {
            continue;
        }
        if (trend_of_until_[slot] != history.final_until()) {
            trends_[slot] = trend_of(history);
            trend_of_until_[slot] = history.final_until();
        }
        history.set(tick, predict_input(trends_[slot], tick), InputKind::predicted);
    }
}

void ClientSession::keep_state() {
    const std::size_t place = now() % k_window;
    states_[place].keep(match_.world);
    host_hashes_[place] = hash_of_host(match_);
    if (match_.host.keep != nullptr) {
        match_.host.keep(match_.host.context, place);
    }
}

void ClientSession::step_once(bool is_shown) {
    const MatchTick tick = now() + 1;
    choose_inputs(tick);
    TickInputs inputs;
    for (std::size_t slot = 0; slot < match_.player_count; ++slot) {
        inputs.before[slot] = &histories_[slot].at(tick - 1);
        inputs.now[slot] = &histories_[slot].at(tick);
    }
    step_tick(match_, inputs, is_shown, scratch_, stats_);
    keep_state();
    oldest_state_ = std::max(oldest_state_, tick >= k_window ? tick - k_window + 1 : 0);
}

// Returns to the state before the first wrong tick and steps again to the present.
void ClientSession::go_back() {
    const MatchTick present = now();
    if (!has_wrong_ || first_wrong_ > present) {
        return;
    }
    if (first_wrong_ <= oldest_state_) {
        needs_state_ = true;
        return;
    }
    has_wrong_ = false;
    shown_.begin_correction(match_);
    const std::size_t place = (first_wrong_ - 1) % k_window;
    states_[place].restore(match_.world);
    if (match_.host.restore != nullptr) {
        match_.host.restore(match_.host.context, place);
    }
    while (now() < present) {
        step_once(false);
    }
    shown_.end_correction(match_);
    const std::uint64_t depth = present - first_wrong_ + 1;
    ++counts_.rollbacks;
    counts_.steps_again += depth;
    counts_.deepest = std::max(counts_.deepest, depth);
}

bool ClientSession::advance(const MatchInput& own, bool is_shown) {
    if (!is_start_kept_) {
        is_start_kept_ = true;
        keep_state();
    }
    go_back();
    const MatchTick tick = now() + 1;
    if (tick > confirmed() + k_window - 2) {
        ++counts_.waits;
        return false;
    }
    const MatchInput input = normalised(own);
    sent_.finish_next(input, InputKind::real);
    InputHistory& history = histories_[slot_];
    if (tick > history.final_until()) {
        history.set(tick, input, InputKind::own);
    }
    step_once(is_shown);
    shown_.advance(match_.dt_s);
    ++counts_.ticks;
    note_hash();
    return true;
}

// Hashes the newest confirmed tick of those that all machines compare.
void ClientSession::note_hash() {
    const MatchTick tick = final_state() / k_hash_every_ticks * k_hash_every_ticks;
    if (tick > hash_tick_ && tick >= oldest_state_ && tick > 0) {
        hash_tick_ = tick;
        hashes_.set(tick, hash_at(tick));
    }
}

bool ClientSession::can_write_after(MatchTick after) const {
    // The history also has the predicted inputs of later ticks. They overwrite its oldest inputs.
    return after + k_oldest_confirmed >= now() &&
           can_write_confirmed(histories(), after, final_state());
}

std::size_t ClientSession::write_watched(MatchTick after, MatchTick& until,
                                         std::span<std::byte> bytes) const {
    until = final_state();
    return write_confirmed(histories(), hashes_, after, until, bytes);
}

std::size_t ClientSession::write_packet(std::span<std::byte> bytes) {
    ClientHeader header;
    header.slot = static_cast<std::uint8_t>(slot_);
    header.state_epoch = state_epoch_;
    for (std::size_t slot = 0; slot < match_.player_count; ++slot) {
        header.known_until[slot] = histories_[slot].final_until();
    }
    header.wants_state = needs_state_;
    constexpr std::uint64_t k_hash_packets = 16;
    if (packets_ % k_hash_packets == 0) {
        header.hash_tick = hash_tick_;
        header.hash = hashes_.at(hash_tick_).value_or(0);
    }
    header.lead_epoch = pacer_.epoch();
    StreamSource own{.history = &sent_, .until = sent_.final_until()};
    own.is_fresh = received_until_ + k_most_unreceived < own.until;
    own.base = own.is_fresh ? own.until - StreamPart::k_most / 2
                            : marks_.base(packets_, received_until_, own.until);
    header.is_fresh = own.is_fresh;
    const std::size_t size = write_client_packet(header, match_.player_count, own, bytes);
    had_two_[packets_ % had_two_.size()] = own.until > sent_until_ + 1;
    sent_until_ = own.until;
    marks_.note(packets_++, own.until);
    return size;
}

}  // namespace handhold
