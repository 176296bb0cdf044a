#include "game/net/match_server.hpp"

#include <algorithm>
#include <stdexcept>
#include <utility>

namespace handhold {
namespace {

// So many bytes of states wait in a queue at once, below the packets' share.
constexpr std::size_t k_most_state_queued = 2 * StatePiece::k_most_bytes;
// A longer time between two polls is the server's own pause.
constexpr double k_longest_counted_s = 0.1;

std::unique_ptr<ArenaMatch> make_rules(hh::World& world, ArenaGame* arena) {
    return arena != nullptr ? std::make_unique<ArenaMatch>(world, *arena) : nullptr;
}

hh::Match begin_match(hh::World& world, std::span<const hh::Player> players, ArenaMatch* rules,
                      double tick_s, double start_s) {
    hh_match_def def = hh::match_def();
    def.role = HH_MATCH_SERVER;
    def.tick_s = tick_s;
    def.start_s = start_s;
    const hh_match_game game = rules != nullptr ? rules->callbacks() : hh_default_match_game();
    hh::Match match(world, players, def, rules != nullptr ? &game : nullptr);
    if (!match.is_valid()) {
        throw std::runtime_error(hh_last_error());
    }
    return match;
}

std::string_view name_of(LinkEnd end) {
    switch (end) {
        case LinkEnd::message:
            return "message";
        case LinkEnd::flooding:
            return "flooding";
        case LinkEnd::slow:
            return "slow";
        case LinkEnd::closed:
            break;
    }
    return "closed";
}

}  // namespace

MatchServer::MatchServer(hh::World& world, std::span<const hh::Player> players,
                         MatchServerSettings settings, Listener& listener)
    : settings_(std::move(settings)),
      listener_(listener),
      start_s_(settings_.clock()),
      arena_(make_rules(world, settings_.arena)),
      match_(begin_match(world, players, arena_.get(), settings_.tick_s, start_s_)),
      seats_(players.size()),
      polled_s_(start_s_),
      joins_left_(settings_.joins_at_once) {
    settings_.offer.players = static_cast<std::uint8_t>(players.size());
    settings_.offer.wants_token = settings_.key.has_value();
}

void MatchServer::log(std::string_view event, std::initializer_list<NetField> fields) const {
    if (settings_.log) {
        settings_.log(log_line(event, fields));
    }
}

void MatchServer::poll() {
    const double now_s = settings_.clock();
    const double next_tick_s =
        start_s_ + static_cast<double>(match_.stats().ticks + 1) * settings_.tick_s;
    listener_.poll(std::clamp(next_tick_s - now_s, 0.0, settings_.longest_wait_s), *this);
    tend(settings_.clock());
    const std::uint32_t confirmed = match_.confirm(settings_.clock()).value_or(0);
    if (confirmed > 0 || settings_.clock() >= next_packets_s_) {
        next_packets_s_ = settings_.clock() + settings_.tick_s;
        send_packets();
    }
}

void MatchServer::send_packets() {
    for (std::size_t slot = 0; slot < seats_.count(); ++slot) {
        MatchSeat& seat = seats_.at(slot);
        if (seat.stage != SeatStage::playing) {
            continue;
        }
        if (match_.needs_state(static_cast<std::uint32_t>(slot)).value_or(false)) {
            begin_state(slot);
        } else if (match_.packet_to(static_cast<std::uint32_t>(slot), packet_)) {
            write_packet_message(packet_, message_);
            listener_.send(seat.link, Delivery::newest, message_);
        }
    }
}

void MatchServer::tend(double now_s) {
    const double elapsed_s = std::max(0.0, now_s - polled_s_);
    polled_s_ = now_s;
    joins_left_ =
        std::min(joins_left_ + elapsed_s * settings_.joins_per_s, settings_.joins_at_once);
    const double waited_s = std::min(elapsed_s, k_longest_counted_s);
    for (std::size_t slot = 0; slot < seats_.count(); ++slot) {
        MatchSeat& seat = seats_.at(slot);
        seat.waited_s += waited_s;
        if (seat.stage == SeatStage::joining) {
            send_state(seat, elapsed_s);
            if (seat.waited_s > settings_.hello_within_s) {
                ++counts_.late;
                send_away(seat.link, NetBye::late);
            }
        } else if (seat.stage == SeatStage::playing && seat.waited_s > settings_.silent_after_s) {
            ++counts_.silent;
            send_away(seat.link, NetBye::silent);
        }
    }
    for (auto& [link, link_waited_s] : links_) {
        link_waited_s += waited_s;
        if (link_waited_s > settings_.hello_within_s && !seats_.of_link(link)) {
            listener_.close(link);
        }
    }
}

void MatchServer::opened(LinkId link) {
    links_[link] = 0.0;
    write_message(settings_.offer, message_);
    listener_.send(link, Delivery::reliable, message_);
}

void MatchServer::closed(LinkId link, LinkEnd why) {
    links_.erase(link);
    if (const std::optional<std::size_t> slot = seats_.of_link(link)) {
        log("left", {{"slot", std::to_string(*slot)}, {"why", std::string(name_of(why))}});
        // Nobody reserves a seat without having played.
        const bool has_played = seats_.at(*slot).stage == SeatStage::playing;
        empty_seat(*slot, has_played ? settings_.return_s : 0.0);
    } else if (why != LinkEnd::closed) {
        log("cut_off", {{"link", std::to_string(link)}, {"why", std::string(name_of(why))}});
    }
}

void MatchServer::empty_seat(std::size_t slot, double reserved_s) {
    MatchSeat& seat = seats_.at(slot);
    (void)match_.disconnect(static_cast<std::uint32_t>(slot));
    seat.stage = SeatStage::empty;
    seat.link = 0;
    seat.state = {};
    seat.reserved_until_s = settings_.clock() + reserved_s;
}

void MatchServer::send_away(LinkId link, NetBye why) {
    if (const std::optional<std::size_t> slot = seats_.of_link(link)) {
        log("sent_away", {{"slot", std::to_string(*slot)}, {"why", std::string(bye_text(why))}});
        empty_seat(*slot, settings_.return_s);
    }
    write_message(why, message_);
    listener_.send(link, Delivery::reliable, message_);
    listener_.close(link);
}

void MatchServer::received(LinkId link, std::span<const std::byte> message) {
    const std::optional<NetKind> kind = kind_of(message);
    if (kind == NetKind::packet) {
        take_packet(link, packet_in(message));
    } else if (kind == NetKind::hello && !seats_.of_link(link)) {
        take_hello(link, message);
    } else if (kind == NetKind::joined) {
        take_joined(link, message);
    } else if (kind == NetKind::bye && read_bye(message) == NetBye::leaving) {
        if (const std::optional<std::size_t> slot = seats_.of_link(link)) {
            log("left", {{"slot", std::to_string(*slot)}, {"why", "leaving"}});
            empty_seat(*slot, 0.0);
        }
        listener_.close(link);
    } else {
        ++counts_.bad_messages;
        refuse_link(link, {NetRefusal::malformed});
    }
}

void MatchServer::take_packet(LinkId link, std::span<const std::byte> packet) {
    const std::optional<std::size_t> slot = seats_.of_link(link);
    if (!slot || seats_.at(*slot).stage != SeatStage::playing) {
        return;  // written before the last state arrived
    }
    if (match_.receive_from(static_cast<std::uint32_t>(*slot), settings_.clock(), packet)) {
        seats_.at(*slot).waited_s = 0.0;
    } else {
        ++counts_.bad_packets;
    }
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
        if (check.state != TokenState::good) {
            return MatchRefused{check.state == TokenState::expired ? NetRefusal::expired_token
                                                                   : NetRefusal::bad_token};
        }
        person = check.name;
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
    const std::optional<std::size_t> slot = seats_.find_for(person, settings_.clock());
    if (!slot) {
        refuse_link(link, {NetRefusal::full});
        return;
    }
    if (joins_left_ < 1.0) {
        refuse_link(link, {NetRefusal::busy});
        return;
    }
    joins_left_ -= 1.0;
    if (seats_.at(*slot).stage != SeatStage::empty) {
        send_away(seats_.at(*slot).link, NetBye::replaced);
    }
    seat(link, *slot, person);
}

void MatchServer::seat(LinkId link, std::size_t slot, const std::string& person) {
    MatchSeat& seat = seats_.at(slot);
    const bool returns = seat.person == person;
    ++counts_.joins;
    counts_.returns += returns ? 1U : 0U;
    seat.link = link;
    seat.person = person;
    write_message(MatchWelcome{static_cast<std::uint8_t>(slot)}, message_);
    listener_.send(link, Delivery::reliable, message_);
    log("joins", {{"slot", std::to_string(slot)},
                  {"person", settings_.key ? person : "anonymous"},
                  {"returns", returns ? "1" : "0"},
                  {"tick", std::to_string(match_.stats().tick)}});
    begin_state(slot);
}

void MatchServer::begin_state(std::size_t slot) {
    MatchSeat& seat = seats_.at(slot);
    if (!match_.state(static_cast<std::uint32_t>(slot), seat.state)) {
        throw std::runtime_error(hh_last_error());
    }
    if (arena_ != nullptr) {
        write_arena_state(arena_->state(), seat.state);
    }
    seat.stage = SeatStage::joining;
    seat.waited_s = 0.0;
    seat.state_sent = 0;
    seat.state_credit_bytes = static_cast<double>(StatePiece::k_most_bytes);
    ++seat.state_number;
    ++counts_.states;
    counts_.state_bytes += seat.state.size();
}

void MatchServer::send_state(MatchSeat& seat, double elapsed_s) {
    seat.state_credit_bytes =
        std::min(seat.state_credit_bytes + elapsed_s * settings_.state_bytes_per_s,
                 static_cast<double>(k_most_state_queued));
    while (seat.state_sent < seat.state.size() && seat.state_credit_bytes > 0.0 &&
           listener_.queued_bytes(seat.link) < k_most_state_queued) {
        const auto left = std::span<const std::byte>(seat.state).subspan(seat.state_sent);
        StatePiece piece;
        piece.number = seat.state_number;
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
    if (seat.stage != SeatStage::joining || *number != seat.state_number ||
        seat.state_sent < seat.state.size()) {
        return;
    }
    log("plays", {{"slot", std::to_string(*slot)},
                  {"tick", std::to_string(match_.stats().tick)},
                  {"state_bytes", std::to_string(seat.state.size())}});
    seat.stage = SeatStage::playing;
    seat.state = {};
    seat.waited_s = 0.0;
    (void)match_.connect(static_cast<std::uint32_t>(*slot));
}

void MatchServer::drain() {
    if (is_draining_) {
        return;
    }
    is_draining_ = true;
    log("drains", {{"players", std::to_string(seats_.taken())}});
    std::vector<LinkId> links;
    for (const auto& [link, link_waited_s] : links_) {
        links.push_back(link);
    }
    for (const LinkId link : links) {
        send_away(link, NetBye::draining);
    }
}

}  // namespace handhold
