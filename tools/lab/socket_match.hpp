#pragma once

#include <cstdint>
#include <string>

#include "engine/core/text_file.hpp"
#include "tools/lab/holds_count.hpp"
#include "tools/lab/measure.hpp"
#include "tools/lab/socket_proxy.hpp"

// A match of processes: `handhold serve`, its players and a proxy between them, over sockets of the
// loopback interface.
namespace handhold::lab {

struct SocketMatchOptions {
    std::string scene;             // a built-in scene of the game
    int peers = 4;                 // climbers
    std::string transport = "ws";  // or another that the server's log has an address of: "quic"
    NetworkTraits network;         // traits of the proxy, which is UDP for quic
    double seconds = 30.0;         // time that each player plays
    double freeze_s = 2.0;  // the last player's process sleeps so long in the middle of its time
    std::uint64_t seed = 1;
};

// Figures of all players. What was confirmed is taken from the server's recording, played again in
// a world of its own after the match.
struct SocketMatchFigures {
    std::uint64_t ticks = 0;
    std::uint64_t confirmed_ticks = 0;
    std::uint64_t hashes_compared = 0;
    std::uint64_t hashes_different = 0;
    std::uint64_t stalls = 0;
    std::uint64_t states = 0;  // states sent: one for each player, unless inputs were lost for good
    std::uint64_t rollbacks = 0;
    // Inputs that came too late after k_warm_s, and ticks then, of players who did not freeze.
    std::uint64_t filled = 0;
    std::uint64_t asked = 0;
    std::uint64_t frozen_filled = 0;  // inputs of the player who did
    // Ticks whose own hands, as first stepped, were compared with the confirmed ones, bit by bit;
    // those that differ; and by how many the latter are more than the inputs that were filled, 0
    // unless a machine's own hands are wrong.
    std::uint64_t own_hand_ticks = 0;
    std::uint64_t own_hand_different = 0;
    std::uint64_t own_hand_unexplained = 0;
    HoldsCount holds;
    Series rollback_ticks;  // depth of each frame that went back
    Series rollback_us;
    Series client_us;  // CPU time of each frame, its ticks and packets
    Series up_kbps;    // rate of each player in each second, with overhead_bytes a message
    Series down_kbps;
    Series others_hand_m;   // tracked hands of others, as first stepped, against the confirmed ones
    Series join_s;          // time from opening the connection to the first tick
    Series others_frame_s;  // time between frames of players who did not freeze
    Series others_frame_in_freeze_s;
    double others_ticks_per_s_in_freeze = 0.0;  // mean of those players
    ProxyCounts proxy;
};

// Error: a process failed; its own line is on standard error.
Result<SocketMatchFigures> run_socket_match(const SocketMatchOptions& options);

}  // namespace handhold::lab
