#pragma once

#include <CLI/CLI.hpp>

#include "game/commands/flag_checks.hpp"
#include "game/commands/match_commands.hpp"
#include "game/desktop/play_options.hpp"

// Command-line options of matches over a network.
namespace handhold {

inline void add_serve_options(CLI::App& serve, ServeOptions& options) {
    serve.add_option("--scene", options.scene, "As of run")->required();
    serve
        .add_option("--port", options.port,
                    "Of TCP (WebSocket) and UDP (QUIC); 0: any that is free, which the log says")
        ->check(CLI::Range(0, 65535));
    serve.add_option(
        "--address", options.address,
        "Of the interface; default: 127.0.0.1, this machine only; 0.0.0.0: all, by IPv4; "
        "::, all, by IPv6 and IPv4");
    CLI::Option* const certificate =
        serve.add_option("--cert", options.certificate,
                         "A file with a certificate in PEM, for QUIC; default: one is made, which "
                         "peers know by the fingerprint in the address that the log says");
    CLI::Option* const key =
        serve.add_option("--key", options.key, "A file with the certificate's key in PEM");
    certificate->needs(key);
    key->needs(certificate);
    serve.add_option("--players", options.players, "Slots of the match; default: 4")
        ->check(CLI::Range(1, 16));
    serve.add_option("--seed", options.seed, "Of the places where players begin")
        ->check(whole_number());
    serve.add_option("--token-key", options.token_key,
                     "A file with a secret of at least 32 bytes: only peers with a token signed by "
                     "it are admitted (handhold token)");
    serve
        .add_option("--return-seconds", options.return_s,
                    "How long a slot waits for a player who was cut off; default: 60")
        ->check(number_in(0.0, 3600.0));
    serve.add_option("--spectators", options.spectators, "Places for those who watch; default: 8")
        ->check(CLI::Range(0, 64));
    serve.add_option("--record", options.record,
                     "Save the match (.hhm): run --match plays it again");
    serve.add_flag("--agones", options.agones,
                   "Tell Agones' sidecar on this machine when the server is ready, played, and "
                   "ends (AGONES_SDK_HTTP_PORT, or 9358)");
    serve.add_option("--seconds", options.seconds, "Stop after so many; default: never")
        ->check(number_in(0.01, 1e9));
}

inline void add_peer_options(CLI::App& command, JoinOptions& options) {
    command.add_option("--token", options.token,
                       "A file with a token for each peer, one a line, for servers that want one");
}

// `run --join`: a player of somebody else's match. Call after the other options of `run`.
inline void add_join_options(CLI::App& run, JoinOptions& options) {
    CLI::Option* const join = run.add_option(
        "--join", options.url,
        "Play in a match, in real time, without a window: ws://HOST:PORT, wss://HOST:PORT or "
        "quic://HOST:PORT#FINGERPRINT; without --input a scripted climber plays");
    for (const char* const own : {"--hz", "--players", "--climbers", "--spawn", "--trace", "--out",
                                  "--snapshot", "--resume", "--distance-grab"}) {
        join->excludes(run.get_option(own));
    }
    add_peer_options(run, options);
    run.get_option("--token")->needs(join);
    run.add_flag("--watch", options.watches, "With --join: watch, without a slot")
        ->needs(join)
        ->excludes(run.get_option("--input"));
    run.add_option("--record", options.record,
                   "With --join: save the match (.hhm), as it is confirmed here")
        ->needs(join);
}

// `run --match`: a recorded match. Call after add_join_options.
inline void add_replay_options(CLI::App& run, ReplayOptions& options) {
    CLI::Option* const match = run.add_option(
        "--match", options.file,
        "Play a recorded match (.hhm) again, without a network; with --shots and --out "
        "it is drawn");
    for (const char* const own :
         {"--hz", "--players", "--climbers", "--spawn", "--trace", "--snapshot", "--resume",
          "--distance-grab", "--input", "--seed", "--join"}) {
        match->excludes(run.get_option(own));
    }
}

// `play --join`. Call after the other options of `play`.
inline void add_play_join_options(CLI::App& play, PlayOptions& options) {
    CLI::Option* const join = play.add_option(
        "--join", options.join,
        "Play in a match: ws://HOST:PORT, wss://HOST:PORT or quic://HOST:PORT#FINGERPRINT; its "
        "server names the scene");
    for (const char* const own : {"--xr", "--xr-headless", "--spawn", "--jets", "--distance-grab",
                                  "--inspector", "--page", "--controllers"}) {
        join->excludes(play.get_option(own));
    }
    play.add_option("--token", options.token, "A file with a token, for servers that want one")
        ->needs(join);
    play.add_flag("--watch", options.watches,
                  "With --join: watch, without a slot, with a camera that flies")
        ->needs(join)
        ->excludes(play.get_option("--record"));
    play.parse_complete_callback([&play, &options] {
        if (!options.join.empty() && play.get_option("--scene")->count() == 0) {
            options.scene.clear();
        }
    });
}

inline void add_bots_options(CLI::App& bots, JoinOptions& options) {
    bots.add_option("count", options.peers, "Scripted climbers, each with a world of its own")
        ->required()
        ->check(CLI::Range(1, 16));
    bots.add_option("--join", options.url,
                    "The server: ws://HOST:PORT, wss://HOST:PORT or quic://HOST:PORT#FINGERPRINT")
        ->required();
    bots.add_option("--scene", options.scene,
                    "The server's scene, if it is not built in; default: the one that it names");
    bots.add_option("--seed", options.seed, "Of the climbers")->check(whole_number());
    bots.add_option("--seconds", options.seconds, "Stop after so many; default: with the server")
        ->check(number_in(0.01, 1e9));
    add_peer_options(bots, options);
}

inline void add_token_options(CLI::App& token, TokenOptions& options) {
    token.add_option("--token-key", options.key, "The server's file")->required();
    token.add_option("--name", options.name, "Of the person: 1 to 32 letters, digits, - and _")
        ->required();
    token.add_option("--minutes", options.minutes, "How long it may be used; default: 10")
        ->check(number_in(0.0, 525600.0));
}

}  // namespace handhold
