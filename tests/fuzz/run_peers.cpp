#include <map>
#include <memory>
#include <string>
#include <utility>

#include "game/net/match_peer.hpp"
#include "game/net/match_server.hpp"
#include "game/net/send_queue.hpp"
#include "tests/fuzz/match_bed.hpp"

// A server and a peer of game/net, over connections that carry whatever the fuzzer says.
namespace handhold::fuzz {
namespace {

double g_now_s = 0.0;  // the clock of both

class FuzzListener final : public Listener {
  public:
    int port() const override { return 0; }
    void poll(double /*wait_s*/, ListenerHandler& /*handler*/) override {}
    void send(LinkId link, Delivery /*delivery*/, std::span<const std::byte> message) override {
        if (links.contains(link)) {
            links[link] += message.size();
        }
    }
    std::size_t queued_bytes(LinkId /*link*/) const override { return 0; }
    void close(LinkId link) override { closing.push_back(link); }
    const ListenerCounts& counts() const override { return counts_; }

    std::map<LinkId, std::size_t> links;  // bytes that were sent
    std::vector<LinkId> closing;

  private:
    ListenerCounts counts_;
};

class FuzzLink final : public Link {
  public:
    void poll(double /*wait_s*/, LinkHandler& /*handler*/) override {}
    void send(Delivery /*delivery*/, std::span<const std::byte> /*message*/) override {}
    std::size_t queued_bytes() const override { return 0; }
    void close() override {}
};

// No connection has two seats, and no player's person two slots.
bool is_everybody_seated_once(const MatchSeats& seats) {
    for (std::size_t a = 0; a < seats.count(); ++a) {
        for (std::size_t b = 0; b < a; ++b) {
            const bool both_taken =
                seats.at(a).stage != SeatStage::empty && seats.at(b).stage != SeatStage::empty;
            const bool both_play = !seats.is_watching(a) && !seats.is_watching(b);
            if (both_taken && (seats.at(a).link == seats.at(b).link ||
                               (both_play && seats.at(a).person == seats.at(b).person))) {
                return false;
            }
        }
    }
    return true;
}

struct FuzzServer {
    BedWorld bed;
    FuzzListener listener;
    MatchServer server;
    LinkId last = 0;

    FuzzServer() : server(bed.world, bed.players, settings(), listener) {}
    static MatchServerSettings settings() {
        MatchServerSettings out;
        out.offer.scene = "bed";
        out.clock = [] { return g_now_s; };
        out.today = [] { return std::int64_t{0}; };
        out.joins = out.joins_of_address = {100.0, 100.0};
        return out;
    }
    void open() {
        constexpr std::size_t k_most = 6;
        if (listener.links.size() < k_most) {
            listener.links[++last] = 0;
            server.opened(last, "127.0.0.1");
        }
    }
    void end(LinkId link) {
        if (listener.links.erase(link) > 0) {
            server.closed(link, LinkEnd::closed);
        }
    }
    LinkId pick(std::uint8_t number) const {
        return listener.links.empty()
                   ? 0
                   : std::next(listener.links.begin(),
                               static_cast<std::ptrdiff_t>(number % listener.links.size()))
                         ->first;
    }
    void pass(double seconds) {
        g_now_s += seconds;
        server.poll();
        for (const LinkId link : std::exchange(listener.closing, {})) {
            end(link);
        }
    }
};

// Reads the fuzzer's bytes.
class Script {
  public:
    explicit Script(Bytes bytes) : bytes_(bytes) {}
    bool is_at_end() const { return bytes_.empty(); }
    std::uint8_t take() {
        const std::uint8_t value = bytes_.empty() ? std::uint8_t{0} : bytes_[0];
        bytes_ = bytes_.subspan(bytes_.empty() ? 0 : 1);
        return value;
    }
    Bytes take_some() {
        const std::size_t size = std::min<std::size_t>(take(), bytes_.size());
        const Bytes some = bytes_.first(size);
        bytes_ = bytes_.subspan(size);
        return some;
    }

  private:
    Bytes bytes_;
};

// A message of either side: a known one, changed, or the script's bytes.
FuzzBytes next_message(Script& script, std::uint8_t what) {
    const BedMessages& bed = BedMessages::get();
    const std::uint8_t number = script.take();
    FuzzBytes message;
    if (what == 0) {
        write_message(
            MatchHello{.person = number, .watches = number % 3 == 2, .digests = {}, .token = {}},
            message);
    } else if (what == 1) {
        write_joined(number, message);
    } else if (what == 2) {
        write_packet_message(BedMessages::pick(bed.of_clients, number), message);
    } else if (what == 3) {
        write_packet_message(BedMessages::pick(bed.of_server, number), message);
    } else if (what == 4) {
        write_inputs_message(BedMessages::pick(bed.of_watched, number), message);
    } else if (what == 5) {
        MatchOffer offer{.players = k_bed_players, .digests = {}, .scene = "bed"};
        write_message(offer, message);
    } else if (what == 6) {
        write_message(MatchWelcome{static_cast<std::uint8_t>(number % 3 == 2 ? 255 : number % 3)},
                      message);
    } else if (what == 7) {
        write_message(static_cast<NetBye>(number % 5 + 1), message);
    }
    if (message.empty()) {
        const auto raw = std::as_bytes(script.take_some());
        message.assign(raw.begin(), raw.end());
        return message;
    }
    return patched_bytes(std::move(message), script.take_some());
}

void run_server(Script& script) {
    static std::unique_ptr<FuzzServer> server;
    static int uses = 0;
    if (server == nullptr || ++uses % 64 == 0) {
        server.reset();
        server = std::make_unique<FuzzServer>();
    }
    for (int i = 0; i < 64 && !script.is_at_end(); ++i) {
        const std::uint8_t command = script.take();
        if (command % 8 == 0) {
            server->open();
        } else if (command % 8 == 1) {
            server->end(server->pick(script.take()));
        } else if (command % 8 == 2) {
            server->pass(script.take() * 0.002);
        } else if (command % 8 == 3) {
            (void)server->server.get(command == 3 ? "/metrics" : "/health");
        } else {
            const LinkId link = server->pick(script.take());
            const FuzzBytes message = next_message(script, command / 8 % 10);
            if (link != 0 && message.size() <= 1500) {
                server->server.received(link, message);
            }
        }
    }
    server->pass(0.02);
    promise(is_everybody_seated_once(server->server.seats()), "nobody has two seats");
    while (!server->listener.links.empty()) {
        server->end(server->listener.links.begin()->first);
    }
    promise(server->server.seats().taken() == 0 && server->server.seats().watching() == 0,
            "who has gone has no seat");
}

void send_state(const FuzzBytes& state, std::uint8_t number, MatchPeer& peer) {
    for (std::size_t at = 0; at < state.size(); at += StatePiece::k_most_bytes) {
        const auto rest = std::span<const std::byte>(state).subspan(at);
        const StatePiece piece{number, static_cast<std::uint32_t>(state.size()),
                               static_cast<std::uint32_t>(at),
                               rest.first(std::min(rest.size(), StatePiece::k_most_bytes))};
        FuzzBytes message;
        write_message(piece, message);
        peer.received(message);
    }
}

void run_peer(Script& script, bool watches) {
    static std::array<std::unique_ptr<BedWorld>, 2> beds;
    std::unique_ptr<BedWorld>& bed = beds[watches ? 1 : 0];
    if (bed == nullptr) {
        bed = std::make_unique<BedWorld>();
    }
    MatchPeerSettings settings;
    settings.clock = [] { return g_now_s; };
    settings.watches = watches;
    MatchPeer peer(bed->world, bed->players, settings);
    peer.connect(std::make_unique<FuzzLink>());
    for (int i = 0; i < 64 && !script.is_at_end(); ++i) {
        const std::uint8_t command = script.take();
        if (command % 4 == 0) {
            g_now_s += script.take() * 0.001;
            (void)peer.poll(0.0, [](double, PeerInput&) {});
        } else if (command % 4 == 1) {
            const auto& states = BedMessages::get().states;
            const std::uint8_t number = script.take();
            send_state(patched_bytes(states[number % 2], script.take_some()), number, peer);
        } else {
            peer.received(next_message(script, command / 4 % 10));
        }
    }
    promise(peer.stage() != PeerStage::ended || !peer.why().empty(), "an end has a reason");
}

}  // namespace

// The first byte chooses the machine, the rest is what happens to it.
void run_peers(Bytes bytes) {
    if (bytes.empty()) {
        return;
    }
    Script script(bytes.subspan(1));
    if (bytes[0] % 3 == 0) {
        run_server(script);
    } else {
        run_peer(script, bytes[0] % 3 == 2);
    }
}

}  // namespace handhold::fuzz
