#include "tools/lab/socket_match.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <filesystem>
#include <optional>
#include <vector>

#include <fcntl.h>

#include "game/commands/match_commands.hpp"
#include "game/commands/match_entry.hpp"
#include "game/net/match_replay.hpp"
#include "game/session/interrupt.hpp"
#include "tools/lab/child_process.hpp"
#include "tools/lab/socket_peer.hpp"
#include "tools/lab/socket_world.hpp"

namespace handhold::lab {
namespace {

constexpr double k_load_within_s = 60.0;
constexpr double k_end_within_s = 30.0;

// A new folder, gone with this object.
class TemporaryFolder {
  public:
    TemporaryFolder() {
        std::string name =
            (std::filesystem::temp_directory_path() / "handhold-match-XXXXXX").string();
        if (::mkdtemp(name.data()) != nullptr) {
            path_ = name;
        }
    }
    ~TemporaryFolder() {
        std::error_code ignored;
        std::filesystem::remove_all(path_, ignored);
    }
    TemporaryFolder(const TemporaryFolder&) = delete;
    TemporaryFolder& operator=(const TemporaryFolder&) = delete;
    const std::filesystem::path& path() const { return path_; }

  private:
    std::filesystem::path path_;
};

FileError failure(const std::string& what) { return {what, "", "expected it to work"}; }

// An address of the server: TRANSPORT://127.0.0.1:PORT, and what follows.
struct ServerAddress {
    int port = 0;
    std::string rest;  // "#FINGERPRINT" of quic

    std::string through(const std::string& transport, int proxy_port) const {
        return transport + "://127.0.0.1:" + std::to_string(proxy_port) + rest;
    }
};
// That of the server that logs there; nullopt: it has not begun in time, or has none.
std::optional<ServerAddress> address_in(const std::filesystem::path& log,
                                        const std::string& transport) {
    const std::string before = transport + "://127.0.0.1:";
    const double until_s = steady_now_s() + k_load_within_s;
    while (steady_now_s() < until_s) {
        const Result<std::string> text = read_file(log, std::size_t{1} << 20U);
        const std::size_t serves = text ? text.value().find("event=serves") : std::string::npos;
        const std::size_t end = text ? text.value().find('\n', serves) : std::string::npos;
        if (end == std::string::npos) {
            ::usleep(10000);
            continue;
        }
        const std::string line = text.value().substr(serves, end - serves);
        const std::size_t at = line.find(before);
        if (at == std::string::npos) {
            return std::nullopt;
        }
        const std::string found = line.substr(at + before.size());
        const std::size_t digits = std::min(found.find_first_not_of("0123456789"), found.size());
        const std::string rest = found.substr(digits);
        return ServerAddress{std::atoi(found.c_str()), rest.substr(0, rest.find_first_of(" \""))};
    }
    return std::nullopt;
}

int serve_into(const ServeOptions& options, const std::filesystem::path& log) {
    const Descriptor file(::open(log.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600));
    if (::dup2(file.get(), STDOUT_FILENO) < 0) {
        return 1;
    }
    return serve_command(options);
}

int run_proxy(SocketProxy& proxy, const std::filesystem::path& counts) {
    const InterruptGuard interrupts;
    constexpr double k_look_s = 0.01;
    while (!is_interrupted()) {
        proxy.poll(k_look_s);
    }
    std::FILE* const file = std::fopen(counts.c_str(), "wb");
    if (file == nullptr) {
        return 1;
    }
    const bool is_written = std::fwrite(&proxy.counts(), sizeof(ProxyCounts), 1, file) == 1;
    return std::fclose(file) == 0 && is_written ? 0 : 1;
}
std::optional<ProxyCounts> read_counts(const std::filesystem::path& path) {
    const Result<std::string> text = read_file(path, sizeof(ProxyCounts));
    if (!text || text.value().size() != sizeof(ProxyCounts)) {
        return std::nullopt;
    }
    ProxyCounts counts;
    std::memcpy(&counts, text.value().data(), sizeof(counts));
    return counts;
}

struct PlayedMatch {
    std::vector<PeerNotes> peers;
    ProxyCounts proxy;
};

std::filesystem::path notes_in(const std::filesystem::path& folder, int peer) {
    return folder / ("peer" + std::to_string(peer));
}
std::filesystem::path recording_in(const std::filesystem::path& folder) {
    return folder / "match.hhm";
}

std::vector<ChildProcess> start_peers(const SocketMatchOptions& options,
                                      const std::filesystem::path& folder, const std::string& url) {
    std::vector<ChildProcess> peers;
    for (int i = 0; i < options.peers; ++i) {
        SocketPeerTask task;
        task.scene = options.scene;
        task.url = url;
        task.seed = options.seed + static_cast<std::uint64_t>(i);
        task.seconds = options.seconds;
        task.freeze_at_s = 0.5 * options.seconds;
        task.freeze_s = i + 1 == options.peers ? options.freeze_s : 0.0;
        task.notes = notes_in(folder, i);
        peers.emplace_back([&task] { return run_socket_peer(task); });
    }
    return peers;
}

// All processes, from the first to the last.
Result<PlayedMatch> play(const SocketMatchOptions& options, const std::filesystem::path& folder) {
    ServeOptions serve;
    serve.scene = options.scene;
    serve.players = options.peers;
    serve.port = 0;
    serve.seed = options.seed;
    serve.record = recording_in(folder).string();
    const std::filesystem::path log = folder / "server.log";
    ChildProcess server([&] { return serve_into(serve, log); });
    const std::optional<ServerAddress> address = address_in(log, options.transport);
    if (!address) {
        return failure("a server with " + options.transport);
    }
    Result<std::unique_ptr<SocketProxy>> proxy =
        open_proxy(options.transport == "quic" ? ProxyKind::udp : ProxyKind::tcp, address->port,
                   options.network, options.seed);
    if (!proxy) {
        return proxy.error();
    }
    ChildProcess between([&] { return run_proxy(*proxy.value(), folder / "proxy"); });
    std::vector<ChildProcess> peers =
        start_peers(options, folder, address->through(options.transport, proxy.value()->port()));
    const double until_s = steady_now_s() + options.seconds + k_load_within_s;
    bool is_well = true;
    for (ChildProcess& peer : peers) {
        is_well = peer.ends_well_within(until_s - steady_now_s()) && is_well;
    }
    server.interrupt();
    is_well = server.ends_well_within(k_end_within_s) && is_well;
    between.interrupt();
    is_well = between.ends_well_within(k_end_within_s) && is_well;
    if (!is_well) {
        return failure("a process of the match");
    }
    PlayedMatch played;
    for (int i = 0; i < options.peers; ++i) {
        Result<PeerNotes> notes = load_peer_notes(notes_in(folder, i));
        if (!notes) {
            return notes.error();
        }
        played.peers.push_back(std::move(notes.value()));
    }
    played.proxy = read_counts(folder / "proxy").value_or(ProxyCounts{});
    return played;
}

// What was confirmed in one tick.
struct ConfirmedTick {
    std::uint64_t hash = 0;
    std::vector<std::array<HandNumbers, 2>> own;  // indexed by slot
    std::vector<double> hands;                    // layout of PeerNotes::others
};
struct Confirmed {
    std::uint64_t first = 0;
    std::vector<ConfirmedTick> ticks;
    HoldsCount holds;

    const ConfirmedTick* find(std::uint64_t tick) const {
        return tick >= first && tick - first < ticks.size() ? &ticks[tick - first] : nullptr;
    }
};

Result<Confirmed> play_again(const std::filesystem::path& file) {
    const Result<MatchRecording> recording = load_match_recording(file);
    if (!recording) {
        return recording.error();
    }
    Result<MatchScene> scene = load_entry_scene({file.string(), recording.value().level.scene, ""},
                                                recording.value().level);
    if (!scene) {
        return scene.error();
    }
    auto& arena = scene.value().scene.arena;
    MatchReplay replay(scene.value().scene.host, scene.value().players, arena ? &*arena : nullptr,
                       recording.value(), k_match_tick_s);
    Confirmed out;
    for (;;) {
        const Result<bool> stepped = replay.step(false);
        if (!stepped) {
            return stepped.error();
        }
        if (!stepped.value()) {
            return out;
        }
        out.first = out.ticks.empty() ? replay.tick() : out.first;
        ConfirmedTick& tick = out.ticks.emplace_back();
        tick.hash = replay.match().hash(replay.tick()).value_or(0);
        for (const hh::Player player : scene.value().players) {
            tick.own.push_back(own_hands(scene.value().scene, player));
        }
        add_all_hands(scene.value(), tick.hands);
        out.holds.add(std::as_const(scene.value().scene).world());
    }
}

auto bits_of(const std::array<HandNumbers, 2>& hands) {
    return std::bit_cast<std::array<std::uint64_t, sizeof(hands) / sizeof(std::uint64_t)>>(hands);
}

class Comparison {
  public:
    Comparison(const SocketMatchOptions& options, const PlayedMatch& played,
               const Confirmed& confirmed)
        : options_(options), played_(played), confirmed_(confirmed) {}

    SocketMatchFigures run() {
        figures_.confirmed_ticks = confirmed_.ticks.size();
        figures_.holds = confirmed_.holds;
        figures_.proxy = played_.proxy;
        for (const PeerNotes& peer : played_.peers) {
            const bool is_frozen = &peer == &frozen();
            add_counts(peer, is_frozen);
            compare_hashes(peer);
            compare_ticks(peer);
            add_frames(peer);
            if (!is_frozen) {
                add_frames_of_others(peer);
            }
        }
        return std::move(figures_);
    }

  private:
    const PeerNotes& frozen() const { return played_.peers.back(); }

    void add_counts(const PeerNotes& peer, bool is_frozen) {
        figures_.ticks += peer.end.ticks;
        figures_.stalls += peer.end.stalls;
        figures_.states += peer.end.states;
        figures_.rollbacks += peer.end.rollbacks;
        figures_.join_s.add(peer.end.join_s);
        if (is_frozen && options_.freeze_s > 0.0) {
            figures_.frozen_filled += peer.end.filled;
        } else {
            figures_.filled += peer.end.filled - peer.end.early_filled;
            figures_.asked += peer.end.ticks - peer.end.early_ticks;
        }
        for (const PeerSecond& second : peer.seconds) {
            const double overhead = options_.network.overhead_bytes;
            figures_.up_kbps.add(8e-3 * (second.up_bytes + overhead * second.up_messages));
            figures_.down_kbps.add(8e-3 * (second.down_bytes + overhead * second.down_messages));
        }
    }
    void compare_hashes(const PeerNotes& peer) {
        for (const PeerHash& noted : peer.hashes) {
            if (const ConfirmedTick* const tick = confirmed_.find(noted.tick)) {
                ++figures_.hashes_compared;
                figures_.hashes_different += tick->hash != noted.hash ? 1U : 0U;
            }
        }
    }
    void compare_ticks(const PeerNotes& peer) {
        const std::size_t numbers = peer.ticks.empty() ? 0 : peer.others.size() / peer.ticks.size();
        std::uint64_t different = 0;
        for (std::size_t i = 0; i < peer.ticks.size(); ++i) {
            const ConfirmedTick* const tick = confirmed_.find(peer.ticks[i].tick);
            if (tick == nullptr) {
                continue;
            }
            ++figures_.own_hand_ticks;
            different += bits_of(tick->own[peer.end.slot]) != bits_of(peer.ticks[i].own) ? 1U : 0U;
            compare_others(std::span(peer.others).subspan(i * numbers, numbers), *tick,
                           peer.end.slot);
        }
        figures_.own_hand_different += different;
        figures_.own_hand_unexplained += different - std::min(different, peer.end.filled);
    }
    void compare_others(std::span<const double> seen, const ConfirmedTick& tick, std::size_t slot) {
        constexpr std::size_t k_numbers = 3;  // coordinates of a hand
        for (std::size_t at = 0; at + k_numbers <= seen.size(); at += k_numbers) {
            if (at / (2 * k_numbers) != slot) {
                figures_.others_hand_m.add(
                    (Vec3(seen[at], seen[at + 1], seen[at + 2]) -
                     Vec3(tick.hands[at], tick.hands[at + 1], tick.hands[at + 2]))
                        .norm());
            }
        }
    }
    void add_frames(const PeerNotes& peer) {
        for (const PeerFrame& frame : peer.frames) {
            figures_.client_us.add(frame.us);
            if (frame.again > 0.0) {
                figures_.rollback_ticks.add(frame.again);
                figures_.rollback_us.add(frame.us);
            }
        }
    }
    void add_frames_of_others(const PeerNotes& peer) {
        const double from_s = frozen().end.begin_s + 0.5 * options_.seconds;
        double ticks = 0.0;
        for (const PeerFrame& frame : peer.frames) {
            const double at_s = peer.end.begin_s + frame.at_s - from_s;
            const bool is_in_freeze = at_s > 0.0 && at_s < options_.freeze_s;
            (is_in_freeze ? figures_.others_frame_in_freeze_s : figures_.others_frame_s)
                .add(frame.gap_s);
            ticks += is_in_freeze ? frame.ticks : 0.0;
        }
        if (options_.freeze_s > 0.0) {
            figures_.others_ticks_per_s_in_freeze +=
                ticks / options_.freeze_s / static_cast<double>(played_.peers.size() - 1);
        }
    }

    const SocketMatchOptions& options_;
    const PlayedMatch& played_;
    const Confirmed& confirmed_;
    SocketMatchFigures figures_;
};

}  // namespace

Result<SocketMatchFigures> run_socket_match(const SocketMatchOptions& options) {
    const TemporaryFolder folder;
    try {
        const Result<PlayedMatch> played = play(options, folder.path());
        if (!played) {
            return played.error();
        }
        const Result<Confirmed> confirmed = play_again(recording_in(folder.path()));
        if (!confirmed) {
            return confirmed.error();
        }
        return Comparison(options, played.value(), confirmed.value()).run();
    } catch (const NoProcess& error) {
        return FileError{"a process of the match", "", error.what()};
    }
}

}  // namespace handhold::lab
