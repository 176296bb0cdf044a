#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "engine/core/text_file.hpp"

// One player of `handhold-lab match --sockets`, in a process of its own, and what it writes down.
namespace handhold::lab {

struct SocketPeerTask {
    std::string scene;
    std::string url;
    std::uint64_t seed = 1;
    double seconds = 30.0;     // time from the first tick on
    double freeze_at_s = 0.0;  // the process sleeps then, for freeze_s
    double freeze_s = 0.0;
    std::filesystem::path notes;  // output
};

// Players find their lead in this time: what is filled in it is counted apart.
inline constexpr double k_warm_s = 2.0;

// A pose of a tracked hand in play space: position, then the rotation's x, y, z, w.
using HandNumbers = std::array<double, 7>;

struct PeerTick {
    std::uint64_t tick = 0;
    std::array<HandNumbers, 2> own{};  // hands as this machine stepped them first
};
struct PeerHash {
    std::uint64_t tick = 0;  // confirmed
    std::uint64_t hash = 0;
};
// A look at the network in which ticks were stepped.
struct PeerFrame {
    double at_s = 0.0;   // since the first tick
    double gap_s = 0.0;  // since the frame before
    double us = 0.0;     // CPU time of its ticks and packets
    double ticks = 0.0;
    double again = 0.0;  // ticks stepped again
};
struct PeerSecond {
    double up_bytes = 0.0;
    double down_bytes = 0.0;
    double up_messages = 0.0;
    double down_messages = 0.0;
};
struct PeerEnd {
    std::uint64_t slot = 0;
    double join_s = 0.0;  // time from opening the connection to the first tick
    std::uint64_t ticks = 0;
    std::uint64_t stalls = 0;
    std::uint64_t filled = 0;
    // Of both, those of the first k_warm_s.
    std::uint64_t early_ticks = 0;
    std::uint64_t early_filled = 0;
    std::uint64_t rollbacks = 0;
    std::uint64_t states = 0;
    double begin_s = 0.0;  // time of the first tick, on a clock that all processes share
};

struct PeerNotes {
    PeerEnd end;
    std::vector<PeerTick> ticks;  // ascending
    std::vector<double>
        others;  // positions for each tick: x, y, z of all players' hands, in the world
    std::vector<PeerHash> hashes;  // ascending
    std::vector<PeerFrame> frames;
    std::vector<PeerSecond> seconds;  // joining is in none
};
Result<PeerNotes> load_peer_notes(const std::filesystem::path& path);

// Plays as a climber. Returns the exit status; an error is one line on standard error.
int run_socket_peer(const SocketPeerTask& task);

}  // namespace handhold::lab
