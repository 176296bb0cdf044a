// How peers are admitted to a match, and get its state.
#include <algorithm>
#include <stdexcept>
#include <utility>

#include "game/net/match_server.hpp"

namespace handhold {
namespace {

// So many bytes of states wait in a queue at once, below the packets' share.
constexpr std::size_t k_most_state_queued = 2 * StatePiece::k_most_bytes;

}  // namespace

std::string MatchServer::seat_name(std::size_t seat) const {
    return seats_.is_watching(seat) ? "none" : std::to_string(seat);
}

std::optional<MatchRefused> MatchServer::check_hello(const MatchHello& hello,
                                                     std::string& person) const {
    if (hello.version != k_net_version) {
        return MatchRefused{NetRefusal::version, k_net_version};
    }
    if (is_draining_) {
        return MatchRefused{NetRefusal::draining};
    }
    person = "anonymous-" + std::to_string(hello.person);
    if (settings_.key) {
        if (hello.token.empty()) {
            return MatchRefused{NetRefusal::no_token};
        }
        const TokenCheck check = check_token(*settings_.key, hello.token, settings_.today());
        if (check.state == TokenState::bad) {
            return MatchRefused{NetRefusal::bad_token};
        }
        person = check.name;
        // Whoever plays may come back with the token that has expired meanwhile, from the same
        // machine: its number is a second secret, which the token does not have.
        if (check.state == TokenState::expired &&
            !seats_.has(person, hello.person, hello.watches, settings_.clock())) {
            return MatchRefused{NetRefusal::expired_token};
        }
    }
    if (const auto digest = first_difference(settings_.offer.digests, hello.digests)) {
        return MatchRefused{NetRefusal::level, static_cast<std::uint16_t>(*digest)};
    }
    return std::nullopt;
}

void MatchServer::refuse_link(LinkId link, const MatchRefused& refused) {
    counts_.refused.at(static_cast<std::size_t>(refused.reason)) += 1;
    log("refused", {{"link", std::to_string(link)}, {"why", refusal_text(refused)}});
    if (const std::optional<std::size_t> slot = seats_.of_link(link)) {
        empty_seat(*slot, settings_.return_s);
    }
    write_message(refused, message_);
    listener_.send(link, Delivery::reliable, message_);
    listener_.close(link);
}

void MatchServer::take_hello(LinkId link, std::span<const std::byte> message) {
    const std::optional<MatchHello> hello = read_hello(message);
    if (!hello) {
        ++counts_.bad_messages;
        refuse_link(link, {NetRefusal::malformed});
        return;
    }
    std::string person;
    if (const std::optional<MatchRefused> refused = check_hello(*hello, person)) {
        refuse_link(link, *refused);
        return;
    }
    const std::optional<std::size_t> slot =
        seats_.find_for(person, hello->watches, settings_.clock());
    if (!slot) {
        refuse_link(link, {NetRefusal::full});
        return;
    }
    if (!joins_.take(settings_.key ? person : links_[link].address)) {
        refuse_link(link, {NetRefusal::busy});
        return;
    }
    if (seats_.at(*slot).stage != SeatStage::empty) {
        send_away(seats_.at(*slot).link, NetBye::replaced);
    }
    seat(link, *slot, person, *hello);
}

void MatchServer::seat(LinkId link, std::size_t slot, const std::string& person,
                       const MatchHello& hello) {
    MatchSeat& seat = seats_.at(slot);
    const bool returns = seat.person == person;
    seat.has_played = seat.has_played && returns;
    ++counts_.joins;
    counts_.returns += returns ? 1U : 0U;
    seat.link = link;
    seat.person = person;
    seat.number = hello.person;
    seat.unpacks = hello.unpacks;
    const bool watches = seats_.is_watching(slot);
    write_message(MatchWelcome{watches ? MatchWelcome::k_no_slot : static_cast<std::uint8_t>(slot)},
                  message_);
    listener_.send(link, Delivery::reliable, message_);
    log("joins", {{"slot", seat_name(slot)},
                  {"person", settings_.key ? person : "anonymous"},
                  {"returns", returns ? "1" : "0"},
                  {"tick", std::to_string(match_.stats().tick)}});
    ask_for_state(slot);
}

// The inputs after a state are kept for five seconds from its begin. One state is packed at a time,
// so that no time passes while it waits for others: the largest then takes two seconds, and
// state_within_s to be sent.
void MatchServer::ask_for_state(std::size_t slot) {
    MatchSeat& seat = seats_.at(slot);
    seat.stage = SeatStage::joining;
    seat.needs_state = true;
    seat.packer.reset();
}

bool MatchServer::is_packing() const {
    for (std::size_t slot = 0; slot < seats_.count(); ++slot) {
        if (seats_.at(slot).packer != nullptr) {
            return true;
        }
    }
    return false;
}

void MatchServer::begin_state(std::size_t slot) {
    MatchSeat& seat = seats_.at(slot);
    const bool watches = seats_.is_watching(slot);
    if (!match_.state(watches ? HH_MATCH_NO_SLOT : static_cast<std::uint32_t>(slot), seat.state)) {
        throw std::runtime_error(hh_last_error());
    }
    if (arena_ != nullptr) {
        write_arena_state(arena_->state(), seat.state);
    }
    seat.watched_until = match_.stats().tick;
    seat.needs_state = false;
    seat.waited_s = 0.0;
    seat.state_sent = 0;
    seat.state_credit_bytes = static_cast<double>(StatePiece::k_most_bytes);
    ++seat.state_number;
    ++counts_.states;
    counts_.state_bytes += seat.state.size();
    seat.is_packed = seat.unpacks && has_packing();
    seat.packer.reset();
    if (seat.is_packed) {
        seat.packer = StatePacker::begin(std::exchange(seat.state, {}));
    } else {
        counts_.state_bytes_packed += seat.state.size();
    }
}

// `left_bytes`: what may still be packed in this poll, for all seats.
void MatchServer::pack_state_of(MatchSeat& seat, std::size_t& left_bytes) {
    if (seat.packer == nullptr || left_bytes == 0) {
        return;
    }
    left_bytes -= seat.packer->advance(left_bytes);
    if (seat.packer->is_done()) {
        seat.state = seat.packer->take();
        seat.packer.reset();
        counts_.state_bytes_packed += seat.state.size();
    }
}

// The inputs after the state are forgotten after five seconds, so it must arrive before.
double MatchServer::state_rate(const MatchSeat& seat) const {
    return std::max(settings_.state_bytes_per_s,
                    static_cast<double>(seat.state.size()) / settings_.state_within_s);
}

void MatchServer::send_state(MatchSeat& seat, double elapsed_s) {
    seat.state_credit_bytes = std::min(seat.state_credit_bytes + elapsed_s * state_rate(seat),
                                       static_cast<double>(k_most_state_queued));
    while (seat.state_sent < seat.state.size() && seat.state_credit_bytes > 0.0 &&
           listener_.queued_bytes(seat.link) < k_most_state_queued) {
        const auto left = std::span<const std::byte>(seat.state).subspan(seat.state_sent);
        StatePiece piece;
        piece.number = seat.state_number;
        piece.is_packed = seat.is_packed;
        piece.total = static_cast<std::uint32_t>(seat.state.size());
        piece.offset = static_cast<std::uint32_t>(seat.state_sent);
        piece.bytes = left.first(std::min(left.size(), StatePiece::k_most_bytes));
        write_message(piece, message_);
        listener_.send(seat.link, Delivery::reliable, message_);
        seat.state_sent += piece.bytes.size();
        seat.state_credit_bytes -= static_cast<double>(piece.bytes.size());
    }
}

void MatchServer::take_joined(LinkId link, std::span<const std::byte> message) {
    const std::optional<std::uint8_t> number = read_joined(message);
    const std::optional<std::size_t> slot = seats_.of_link(link);
    if (!number || !slot) {
        ++counts_.bad_messages;
        refuse_link(link, {NetRefusal::malformed});
        return;
    }
    MatchSeat& seat = seats_.at(*slot);
    if (seat.stage != SeatStage::joining || seat.needs_state || *number != seat.state_number ||
        seat.packer != nullptr || seat.state_sent < seat.state.size()) {
        return;
    }
    log(seats_.is_watching(*slot) ? "watches" : "plays",
        {{"slot", seat_name(*slot)},
         {"tick", std::to_string(match_.stats().tick)},
         {"state_bytes", std::to_string(seat.state.size())}});
    seat.stage = SeatStage::playing;
    seat.has_played = true;
    seat.state = {};
    seat.waited_s = 0.0;
    if (!seats_.is_watching(*slot)) {
        (void)match_.connect(static_cast<std::uint32_t>(*slot));
    }
}

}  // namespace handhold
