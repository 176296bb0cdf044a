#include "game/net/match_peer.hpp"

#include <algorithm>
#include <chrono>
#include <stdexcept>
#include <thread>
#include <utility>

#include "game/net/pack_state.hpp"

namespace handhold {
namespace {

double seconds_now() {
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch())
        .count();
}

// Waits for a connection's first message.
class OfferReader final : public LinkHandler {
  public:
    std::optional<MatchOffer> offer;
    std::optional<std::string> why;

    void opened() override {}
    void received(std::span<const std::byte> message) override {
        if (!offer && !why) {
            offer = read_offer(message);
            if (!offer) {
                why = "this is no server of matches";
            }
        }
    }
    void closed(std::string_view reason) override { why = std::string(reason); }
};

}  // namespace

Result<MatchOffer> fetch_offer(const std::string& url, double within_s) {
    Result<std::unique_ptr<Link>> link = open_link(url);
    if (!link) {
        return link.error();
    }
    OfferReader reader;
    const double until_s = seconds_now() + within_s;
    while (!reader.offer && !reader.why && seconds_now() < until_s) {
        link.value()->poll(0.05, reader);
    }
    if (!reader.offer) {
        return FileError{url, "", "no server: " + reader.why.value_or("no answer")};
    }
    if (reader.offer->version != k_net_version) {
        return FileError{url, "", refusal_text({NetRefusal::version, reader.offer->version})};
    }
    return std::move(*reader.offer);
}

MatchPeer::MatchPeer(hh::World& world, std::span<const hh::Player> players,
                     MatchPeerSettings settings)
    : world_(world), players_(players.begin(), players.end()), settings_(std::move(settings)) {}

void MatchPeer::connect(std::unique_ptr<Link> link) {
    link_ = std::move(link);
    is_linked_ = true;
    stage_ = PeerStage::connecting;
    heard_s_ = settings_.clock();
    why_.clear();
    may_return_ = false;
    bye_.reset();
    state_.clear();
}

void MatchPeer::end(std::string why, bool may_return) {
    if (stage_ == PeerStage::ended) {
        return;
    }
    stage_ = PeerStage::ended;
    why_ = std::move(why);
    may_return_ = may_return;
    if (link_ != nullptr) {
        link_->close();
    }
}

void MatchPeer::leave() {
    if (stage_ != PeerStage::ended) {
        write_message(NetBye::leaving, message_);
        link_->send(Delivery::reliable, message_);
        end("left");
    }
}

void MatchPeer::closed(std::string_view why) {
    is_linked_ = false;
    const bool was_there = stage_ == PeerStage::playing || stage_ == PeerStage::joining;
    end((was_there ? "" : "no server: ") + std::string(why), true);
}

void MatchPeer::received(std::span<const std::byte> message) {
    if (stage_ == PeerStage::ended) {
        return;
    }
    heard_s_ = settings_.clock();
    const std::optional<NetKind> kind = kind_of(message);
    const NetKind wanted = settings_.watches ? NetKind::inputs : NetKind::packet;
    if (kind == wanted) {
        if (stage_ == PeerStage::playing) {
            (void)match_.receive(packet_in(message));  // refused ones are counted there
        }
    } else if (kind == NetKind::offer && stage_ == PeerStage::connecting) {
        take_offer(message);
    } else if (kind == NetKind::refused) {
        const std::optional<MatchRefused> refused = read_refused(message);
        end(refused ? refusal_text(*refused) : "the server's message is damaged",
            refused && refused->reason == NetRefusal::busy);
    } else if (kind == NetKind::welcome && stage_ == PeerStage::offered) {
        take_welcome(message);
    } else if ((kind == NetKind::state || kind == NetKind::packed) &&
               (stage_ == PeerStage::joining || stage_ == PeerStage::playing)) {
        take_piece(message);
    } else if (kind == NetKind::bye) {
        bye_ = read_bye(message);
        end(bye_ ? std::string(bye_text(*bye_)) : "the server's message is damaged",
            bye_ == NetBye::silent || bye_ == NetBye::late);
    } else {
        end("the server's message is damaged, or out of order");
    }
}

void MatchPeer::take_offer(std::span<const std::byte> message) {
    offer_ = read_offer(message);
    if (!offer_) {
        end("this is no server of matches");
        return;
    }
    if (offer_->version != k_net_version) {
        end(refusal_text({NetRefusal::version, offer_->version}));
        return;
    }
    MatchHello hello;
    hello.person = settings_.person;
    hello.watches = settings_.watches;
    hello.unpacks = settings_.unpacks && has_packing();
    hello.digests = settings_.digests;
    hello.token = settings_.token.substr(0, k_most_text_bytes);
    write_message(hello, message_);
    link_->send(Delivery::reliable, message_);
    stage_ = PeerStage::offered;
}

void MatchPeer::take_welcome(std::span<const std::byte> message) {
    const std::optional<MatchWelcome> welcome = read_welcome(message);
    const bool is_right = welcome && (settings_.watches ? welcome->slot == MatchWelcome::k_no_slot
                                                        : welcome->slot < players_.size());
    if (!is_right) {
        end("the server's message is damaged");
        return;
    }
    if (!match_.is_valid() || slot_ != welcome->slot) {
        begin_match(welcome->slot);
    }
    stage_ = PeerStage::joining;
}

void MatchPeer::begin_match(std::size_t slot) {
    if (settings_.recorder != nullptr) {
        settings_.recorder->pause(match_);
    }
    match_ = hh::Match();  // ends the one before: a world has one match
    slot_ = slot;
    hh_match_def def = hh::match_def();
    def.role = settings_.watches ? HH_MATCH_SPECTATOR : HH_MATCH_CLIENT;
    def.slot = static_cast<std::uint32_t>(slot);
    def.tick_s = settings_.tick_s;
    if (settings_.arena != nullptr) {
        arena_ = std::make_unique<ArenaMatch>(world_, *settings_.arena);
    }
    const hh_match_game game = arena_ != nullptr ? arena_->callbacks() : hh_default_match_game();
    match_ = hh::Match(world_, players_, def, arena_ != nullptr ? &game : nullptr);
    if (!match_.is_valid()) {
        throw std::runtime_error(hh_last_error());
    }
}

// Memory grows with the bytes that arrive, not with what they say.
void MatchPeer::take_piece(std::span<const std::byte> message) {
    const std::optional<StatePiece> piece = read_state_piece(message);
    if (piece && piece->offset == 0) {
        state_.clear();
        state_number_ = piece->number;
    }
    if (!piece || piece->offset != state_.size() || piece->number != state_number_) {
        end("the server's message is damaged");
        return;
    }
    state_.insert(state_.end(), piece->bytes.begin(), piece->bytes.end());
    if (state_.size() == piece->total) {
        take_state(*piece);
    }
}

void MatchPeer::take_state(const StatePiece& last) {
    if (last.is_packed) {
        std::optional<std::vector<std::byte>> state =
            unpack_state(state_, StatePiece::k_most_total);
        if (!state) {
            end("the server's state cannot be unpacked");
            return;
        }
        state_ = std::move(*state);
    }
    join(last.number);
}

void MatchPeer::join(std::uint8_t number) {
    const std::optional<JoinedState> state = split_join_state(state_, arena_ != nullptr);
    if (!state) {
        end("the server's state cannot be restored: the rules' state is damaged");
        return;
    }
    MatchRecorder* const recorder = settings_.recorder;
    if (recorder != nullptr) {
        recorder->follow(match_, true);
    }
    if (const hh::Status joined = match_.join(state->of_match); !joined) {
        end("the server's state cannot be restored: " + printable(joined.text()));
        return;
    }
    if (arena_ != nullptr) {
        arena_->set(state->of_rules);
    }
    if (recorder != nullptr) {
        recorder->begin(match_.stats().tick, state_);
    }
    state_ = {};
    ++states_;
    stage_ = PeerStage::playing;
    stepped_s_ = settings_.clock();
    write_joined(number, message_);
    link_->send(Delivery::reliable, message_);
}

std::uint32_t MatchPeer::poll(double wait_s, const PeerHands& hands) {
    if (!is_linked_) {
        std::this_thread::sleep_for(std::chrono::duration<double>(wait_s));
        return 0;
    }
    link_->poll(wait_s, *this);
    check_silence();
    return stage_ == PeerStage::playing ? step(hands) : 0;
}

// A connection may be dead without either side being told.
void MatchPeer::check_silence() {
    constexpr double k_more_to_connect = 3.0;
    const double limit_s =
        settings_.silent_after_s * (stage_ == PeerStage::connecting ? k_more_to_connect : 1.0);
    if (stage_ != PeerStage::ended && settings_.clock() - heard_s_ > limit_s) {
        end("nothing was heard of the server for long", true);
    }
}

std::uint32_t MatchPeer::step(const PeerHands& hands) {
    const double now_s = settings_.clock();
    const std::uint32_t due = match_.ticks_due(std::max(0.0, now_s - stepped_s_)).value_or(0);
    stepped_s_ = now_s;
    std::uint32_t advanced = 0;
    for (std::uint32_t i = 0; i < due; ++i) {
        input_.samples.clear();
        input_.later_ticks = due - i - 1;
        if (!settings_.watches) {
            hands(world_.time_s() + settings_.tick_s, input_);
        }
        hh_match_input input = hh::match_input(input_.samples, input_.buttons);
        input.commands = input_.commands;
        input.is_hidden = i + 1 < due ? 1 : 0;
        const hh::Maybe<bool> result = match_.advance(input);
        if (!result) {
            throw std::runtime_error(hh_last_error());
        }
        if (!*result) {
            break;
        }
        ++advanced;
    }
    if (settings_.recorder != nullptr) {
        settings_.recorder->follow(match_);
    }
    if (settings_.watches) {
        if (match_.needs_state(0).value_or(false)) {
            end("this world differs from the server's", true);
        }
    } else if (due > 0 && match_.packet(packet_)) {
        write_packet_message(packet_, message_);
        link_->send(Delivery::newest, message_);
    }
    return advanced;
}

}  // namespace handhold
