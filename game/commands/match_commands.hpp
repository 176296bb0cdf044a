#pragma once

#include <cstdint>
#include <string>

#include "game/net/transport.hpp"

namespace handhold {

// Options of `handhold serve`.
struct ServeOptions {
    std::string scene;
    std::string address = "127.0.0.1";
    int port = 0;  // 0: any that is free
    int players = 4;
    std::uint64_t seed = 1;  // seed of the places where players begin
    std::string token_key;   // file with a secret; empty: everybody is admitted
    double return_s = 60.0;  // MatchServerSettings::return_s
    double seconds = 0.0;    // 0: until a signal
    int spectators = 8;      // places for them
    std::string record;      // file of the match; empty: none
    bool agones = false;     // tells Agones' sidecar on this machine
    // Files in PEM, for QUIC; empty: ListenerSettings::certificate.
    std::string certificate;
    std::string key;
};
// What such a server listens by. One address alone cannot take all of its connections.
ListenerSettings listener_settings(const ServeOptions& options);
// Runs a match for peers that join over a network. Prints lines of a log. After SIGTERM or SIGINT,
// or `seconds`, tells the peers and ends with 0; k_exit_bad_file, after one line on standard error,
// if it cannot begin.
int serve_command(const ServeOptions& options);

// Options of `handhold run --join` and `handhold bots`.
struct JoinOptions {
    std::string url;
    std::string scene;       // empty: the built-in scene that the server names
    std::string input;       // recorded session; empty: a scripted climber
    std::string token;       // file with a token for each peer, one a line; empty: none
    int peers = 1;           // each with a world of its own
    bool watches = false;    // a spectator
    std::string record;      // file of the match; empty: none. With one peer only
    std::uint64_t seed = 1;  // seed of the climbers
    double seconds = 0.0;    // 0: until a signal, or until the server ends
};
// Plays in a match without a window. Prints lines of a log; the last ones have the hash of each
// peer's last confirmed tick. Returns 0, or k_exit_bad_file after one line on standard error: no
// server, not admitted, or cut off. A server that ends is no error.
int join_command(const JoinOptions& options);

// Options of `handhold run --match`.
struct ReplayOptions {
    std::string file;      // the recording
    std::string scene;     // empty: the built-in scene that the recording names
    double seconds = 0.0;  // 0: to its end
};
struct RunOptions;
// Plays a recorded match again, without a network and as fast as it can. The last line on standard
// output is "state_hash 0x<16 hex digits>". Returns 0, or k_exit_bad_file after one line on
// standard error; k_exit_interrupted after a signal.
// `drawn`: RunOptions::shots, if not empty, are saved in RunOptions::out, and the recording is
// played to the last one's end.
int replay_command(const ReplayOptions& options, const RunOptions& drawn);

// Options of `handhold token`.
struct TokenOptions {
    std::string key;   // file with the server's secret
    std::string name;  // the person's name
    double minutes = 10.0;
};
// Prints a token for `handhold run --join --token`.
int token_command(const TokenOptions& options);

}  // namespace handhold
