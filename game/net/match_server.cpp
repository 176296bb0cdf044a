#include "game/net/match_server.hpp"

#include <algorithm>
#include <stdexcept>
#include <utility>

namespace handhold {
namespace {

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
      seats_(players.size(), std::min(settings_.spectators, MatchSeats::k_most_spectators)),
      polled_s_(start_s_),
      joins_(settings_.joins,
             settings_.key ? settings_.joins_of_person : settings_.joins_of_address),
      metrics_left_(settings_.metrics.at_once) {
    settings_.offer.players = static_cast<std::uint8_t>(players.size());
    settings_.offer.wants_token = settings_.key.has_value();
    if (settings_.recorder != nullptr) {
        settings_.recorder->begin(match_.stats().tick, {});
    }
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
    if (settings_.recorder != nullptr) {
        settings_.recorder->follow(match_);
    }
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
        if (seats_.is_watching(slot)) {
            send_inputs(slot);
        } else if (match_.needs_state(static_cast<std::uint32_t>(slot)).value_or(false)) {
            ask_for_state(slot);
        } else if (match_.packet_to(static_cast<std::uint32_t>(slot), packet_)) {
            write_packet_message(packet_, message_);
            listener_.send(seat.link, Delivery::newest, message_);
        }
    }
}

void MatchServer::tend(double now_s) {
    const double elapsed_s = std::max(0.0, now_s - polled_s_);
    polled_s_ = now_s;
    joins_.refill(elapsed_s);
    metrics_left_ =
        std::min(metrics_left_ + elapsed_s * settings_.metrics.per_s, settings_.metrics.at_once);
    const double waited_s = std::min(elapsed_s, k_longest_counted_s);
    auto to_pack_bytes = static_cast<std::size_t>(elapsed_s * settings_.packed_bytes_per_s);
    for (std::size_t slot = 0; slot < seats_.count(); ++slot) {
        MatchSeat& seat = seats_.at(slot);
        seat.waited_s += waited_s;
        if (seat.needs_state && !is_packing()) {
            begin_state(slot);
        }
        if (seat.stage == SeatStage::joining && !seat.needs_state) {
            pack_state_of(seat, to_pack_bytes);
            send_state(seat, elapsed_s);
            const double to_send_s = static_cast<double>(seat.state.size()) / state_rate(seat);
            if (seat.waited_s > settings_.hello_within_s + to_send_s) {
                ++counts_.late;
                send_away(seat.link, NetBye::late);
            }
        } else if (seat.stage == SeatStage::playing && !seats_.is_watching(slot) &&
                   seat.waited_s > settings_.silent_after_s) {
            ++counts_.silent;
            send_away(seat.link, NetBye::silent);
        }
    }
    for (auto& [link, served] : links_) {
        served.waited_s += waited_s;
        if (served.waited_s > settings_.hello_within_s && !seats_.of_link(link)) {
            listener_.close(link);
        }
    }
}

// Over the connection's reliable stream, so nothing comes back.
void MatchServer::send_inputs(std::size_t place) {
    constexpr std::uint64_t k_ticks_a_message = 3;
    constexpr std::size_t k_most_inputs_queued = 32'768;  // the rest waits: nobody is slow for it
    MatchSeat& seat = seats_.at(place);
    while (seat.watched_until + k_ticks_a_message <= match_.stats().tick &&
           listener_.queued_bytes(seat.link) < k_most_inputs_queued) {
        const std::uint64_t before = seat.watched_until;
        if (!match_.confirmed_inputs(seat.watched_until, packet_) || seat.watched_until == before) {
            ask_for_state(place);  // The inputs are forgotten: the state took too long.
            return;
        }
        write_inputs_message(packet_, message_);
        listener_.send(seat.link, Delivery::reliable, message_);
    }
}

void MatchServer::failed(LinkId link, std::string_view what) {
    ++counts_.failed;
    log("failed", {{"link", std::to_string(link)}, {"why", std::string(what)}});
}

void MatchServer::opened(LinkId link, std::string_view address) {
    links_[link] = {std::string(address), 0.0};
    write_message(settings_.offer, message_);
    listener_.send(link, Delivery::reliable, message_);
}

void MatchServer::closed(LinkId link, LinkEnd why) {
    links_.erase(link);
    if (const std::optional<std::size_t> slot = seats_.of_link(link)) {
        log("left", {{"slot", seat_name(*slot)}, {"why", std::string(name_of(why))}});
        empty_seat(*slot, settings_.return_s);
    } else if (why != LinkEnd::closed) {
        log("cut_off", {{"link", std::to_string(link)}, {"why", std::string(name_of(why))}});
    }
}

void MatchServer::empty_seat(std::size_t slot, double reserved_s) {
    MatchSeat& seat = seats_.at(slot);
    if (!seats_.is_watching(slot)) {
        (void)match_.disconnect(static_cast<std::uint32_t>(slot));
    } else {
        seat.person.clear();
    }
    if (seats_.is_watching(slot) || !seat.has_played) {
        reserved_s = 0.0;  // Nobody reserves a seat without having played.
    }
    seat.stage = SeatStage::empty;
    seat.link = 0;
    seat.needs_state = false;
    seat.state = {};
    seat.packer.reset();
    seat.reserved_until_s = settings_.clock() + reserved_s;
}

void MatchServer::send_away(LinkId link, NetBye why) {
    if (const std::optional<std::size_t> slot = seats_.of_link(link)) {
        log("sent_away", {{"slot", seat_name(*slot)}, {"why", std::string(bye_text(why))}});
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
            log("left", {{"slot", seat_name(*slot)}, {"why", "leaving"}});
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
    if (!slot || seats_.is_watching(*slot)) {
        ++counts_.bad_messages;
        refuse_link(link, {NetRefusal::malformed});
        return;
    }
    if (seats_.at(*slot).stage != SeatStage::playing) {
        return;  // written before the last state arrived
    }
    if (match_.receive_from(static_cast<std::uint32_t>(*slot), settings_.clock(), packet)) {
        seats_.at(*slot).waited_s = 0.0;
    } else {
        ++counts_.bad_packets;
    }
}

void MatchServer::drain() {
    if (is_draining_) {
        return;
    }
    is_draining_ = true;
    log("drains", {{"players", std::to_string(seats_.taken())}});
    std::vector<LinkId> links;
    for (const auto& [link, served] : links_) {
        links.push_back(link);
    }
    for (const LinkId link : links) {
        send_away(link, NetBye::draining);
    }
}

}  // namespace handhold
