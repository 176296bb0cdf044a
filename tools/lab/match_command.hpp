#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

// `handhold-lab match`: a server and its peers in one process over a simulated network, or as
// processes over sockets.
namespace handhold::lab {

struct MatchOptions {
    std::string scene = "crawl";
    int peers = 8;
    std::vector<std::filesystem::path> inputs;  // recorded sessions, for scene "recorded"
    int first_pair = 0;                         // MatchSetting::first_pair
    double rtt_ms = 100.0;                      // round trip without jitter
    double jitter_ms = 20.0;                    // largest extra delay, in each direction
    double loss = 0.0;                          // share of packets, in each direction
    double burst_loss = 0.0;       // share of packets that begin a burst of eight lost ones
    double duplicate = 0.0;        // share of packets
    double kbps = 0.0;             // rate of each direction of each peer; 0: unlimited
    double packets = 1.0;          // packets a tick, 1 or 0.5
    double overhead_bytes = 28.0;  // headers of UDP and IPv4
    double seconds = 30.0;
    std::uint64_t seed = 1;
    int threads = 1;
    std::string sockets;  // a scene of the game, played by processes; empty: in this process
    std::string transport = "ws";  // SocketMatchOptions::transport
    double freeze_s = 2.0;         // SocketMatchOptions::freeze_s
    std::filesystem::path json;
};

// Exit status: 0; 1 for wrong flags; 2 with one line on standard error if a file cannot be read or
// written; 3 if a hash differs, or if the run proves nothing: nobody gripped, went back or compared
// a hash, or scene "together" lacks a throw, a shared hold, or a held player where its pairs should
// have them. With sockets: socket_match_command.
int match_command(const MatchOptions& options);

}  // namespace handhold::lab
