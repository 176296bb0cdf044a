// handhold-lab: measures the runtime from outside.
#include <algorithm>
#include <cstdio>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <handhold/version.hpp>

#include "game/commands/flag_checks.hpp"
#include "game/levels/built_in_scenes.hpp"
#include "tools/lab/body_command.hpp"
#include "tools/lab/grip_command.hpp"
#include "tools/lab/hands_picture.hpp"
#include "tools/lab/lab_scene.hpp"
#include "tools/lab/match_command.hpp"
#include "tools/lab/match_film.hpp"
#include "tools/lab/match_hands.hpp"
#include "tools/lab/recorded_grips.hpp"
#include "tools/lab/shown_body_command.hpp"
#include "tools/lab/socket_match_command.hpp"
#include "tools/lab/solve_command.hpp"

namespace {

namespace lab = handhold::lab;
using handhold::number_in;

constexpr int k_exit_usage = 1;

std::vector<std::string> strings(const std::vector<std::string_view>& views) {
    return {views.begin(), views.end()};
}

void add_solve_options(CLI::App& solve, lab::SolveOptions& options) {
    solve.add_option("--scene", options.scene, "Scene to solve")
        ->required()
        ->check(CLI::IsMember(strings(lab::scene_names())));
    solve
        .add_option("--links", options.links,
                    "Links of chains and rings, arms of the hub, crates of the heap")
        ->check(CLI::Range(2, 4096));
    solve.add_option("--masses", options.masses, "Masses of the links")
        ->check(CLI::IsMember(strings(lab::mass_patterns())));
    solve.add_option("--holder", options.holder, "What holds the hand")
        ->check(CLI::IsMember(std::vector<std::string>{"kinematic", "player"}));
    solve.add_option("--solver", options.solver, "The runtime's solver or a baseline")
        ->check(CLI::IsMember(lab::solver_names()));
    solve.add_option("--frames", options.frames, "Number of frames")->check(CLI::Range(1, 1000000));
    solve.add_option("--hz", options.hz, "Frames per second")->check(number_in(10.0, 1000.0));
    solve
        .add_option("--residuals", options.residual_frame,
                    "Also write the residual after each iteration of this frame")
        ->check(CLI::Range(0, 999999));
    solve.add_option("--json", options.json, "Output: figures")->required();
    solve.add_option("--csv", options.csv, "Output: every pose of every frame");
}

void add_grip_options(CLI::App& grip, lab::GripOptions& options) {
    const auto one_of = [](std::vector<std::string> names) {
        return CLI::IsMember(std::move(names));
    };
    grip.add_option("--mesh", options.mesh, "glTF of the gripped mesh")->required();
    grip.add_option("--rig", options.rig,
                    "\"builtin\", or a skinned hand with WebXR's joint names");
    grip.add_option("--hand", options.hand, "Hand")->check(one_of({"left", "right"}));
    grip.add_option("--placements", options.placements, "Tracked wrists, JSON lines")->required();
    grip.add_option("--out", options.out, "Posed hands, JSON lines")->required();
    grip.add_option("--sync", options.sync, "Whether the palm moves to its limits")
        ->check(one_of({"on", "off"}));
    grip.add_option("--search", options.search, "How a disc of --fingers talk finds the surface")
        ->check(one_of({"astar", "bfs", "flood"}));
    grip.add_option("--palm", options.palm, "How the palm's surface is chosen")
        ->check(one_of({"least", "ray"}));
    grip.add_option("--fingers", options.fingers,
                    "How fingers close: the runtime's sweep; the talk taken literally, including "
                    "its palm; or spheres on the bones in 50 steps")
        ->check(one_of({"fit", "closing", "talk", "spheres"}));
    grip.add_option("--grip-edge-mm", options.grip_edge_mm, "Edge length of the search detail")
        ->check(number_in(1.0, 1000.0));
    grip.add_option("--shown-after", options.shown_after,
                    "Write the shown hand this many frames of 1/90 s after an empty hand at rest "
                    "begins to grip; 0: the hand at its target")
        ->check(CLI::Range(0, 100000));
    grip.add_option("--rig-json", options.rig_json, "Also write the rig");
    CLI::Option* const motions = grip.add_option(
        "--motions", options.motions, "Wrists of recorded grips: the lines of `recorded-grips`");
    grip.add_option("--warm-frames", options.warm_frames,
                    "Also measure each hand warm: this many frames of a recorded grip's motion, "
                    "then standing")
        ->check(CLI::Range(0, 100000))
        ->needs(motions);
    grip.add_option("--moved-out", options.moved_out,
                    "Hands at the end of their motion, JSON lines");
    grip.add_option("--warm-json", options.warm_json, "Every warm frame's figures, JSON");
}

void add_hands_picture_options(CLI::App& picture, lab::HandsPictureOptions& options) {
    picture.add_option("--mesh", options.mesh, "glTF of the gripped mesh")->required();
    picture.add_option("--hands", options.hands, "Posed hands: the JSON lines of `grip`")
        ->required();
    picture.add_option("--out", options.out, "Output: the sheet, as PNG")->required();
    picture.add_option("--ids", options.ids, "Hands to draw; else some spread over the file")
        ->delimiter(',');
    picture.add_option("--count", options.count, "Number of hands without --ids")
        ->check(CLI::Range(1, 400));
    picture.add_option("--style", options.style, "Draws capsules or the game's hand")
        ->check(CLI::IsMember({"capsules", "skin"}));
    picture.add_option("--hand", options.hand, "Side of the game's hand")
        ->check(CLI::IsMember({"left", "right"}));
    picture.add_option("--views", options.views, "Pictures of each hand, from different sides")
        ->check(CLI::Range(1, 2));
    picture.add_option("--columns", options.columns, "Pictures in a row")->check(CLI::Range(1, 20));
    picture.add_option("--width", options.width_px, "Width of one picture")
        ->check(CLI::Range(64, 4096));
    picture.add_option("--height", options.height_px, "Height of one picture")
        ->check(CLI::Range(64, 4096));
}

void add_body_options(CLI::App& body, lab::BodyOptions& options) {
    body.add_option("--in", options.in, "Heads and hands over time")->required();
    body.add_option("--calib", options.calib, "Body measures by clip")->required();
    body.add_option("--out", options.out, "Output: chest, shoulders and elbows")->required();
    body.add_option("--looks", options.looks, "Output: how the shown body looks (.json)");
    body.add_option("--estimator", options.estimator, "The runtime's estimator or a baseline")
        ->check(CLI::IsMember(lab::estimator_names()));
}

void add_shown_body_options(CLI::App& shown, lab::ShownBodyOptions& options) {
    shown.add_option("--scene", options.scene,
                     "A built-in scene with a session; with --input also a scene file or level");
    shown.add_option("--input", options.input, "A recorded session (.csv)");
    shown.add_option("--hz", options.hz, "Frames per second")->check(number_in(10.0, 1000.0));
    shown.add_option("--hang", options.hang, "Overrides spine.hang")->check(number_in(0.0, 10.0));
    shown.add_option("--json", options.json, "Output: figures")->required();
    shown.add_option("--csv", options.csv, "Output: depths and looks in every frame");
}

void add_recorded_grips_options(CLI::App& recorded, lab::RecordedGripsOptions& options) {
    recorded.add_option("--scene", options.scene, "A scene or level, as of `handhold run`")
        ->required();
    recorded.add_option("--input", options.inputs, "Recorded sessions (.csv)")->required();
    recorded.add_option("--out", options.out, "Output: one grip a line, JSON")->required();
}

void add_match_options(CLI::App& match, lab::MatchOptions& options) {
    const CLI::Validator share = number_in(0.0, 1.0);
    match.add_option("--scene", options.scene, "What the players do")
        ->check(CLI::IsMember(strings(lab::match_scene_names())));
    match.add_option("--peers", options.peers, "Players")->check(CLI::Range(1, 16));
    match.add_option("--input", options.inputs,
                     "With --scene recorded: recorded sessions (.csv), one a player");
    match.add_option("--first-pair", options.first_pair, "With --scene together: its task, 0 to 3")
        ->check(CLI::Range(0, 3));
    match.add_option("--rtt-ms", options.rtt_ms, "Round trip without jitter")
        ->check(number_in(0.0, 1000.0));
    match.add_option("--jitter-ms", options.jitter_ms, "Largest extra delay, each way")
        ->check(number_in(0.0, 500.0));
    match.add_option("--loss", options.loss, "Share of lost packets")->check(share);
    match
        .add_option("--burst-loss", options.burst_loss,
                    "Share of packets that begin a burst of eight lost ones")
        ->check(share);
    match.add_option("--duplicate", options.duplicate, "Share of doubled packets")->check(share);
    match.add_option("--kbps", options.kbps, "Rate of each peer, each way; 0: unlimited")
        ->check(number_in(0.0, 1e6));
    match.add_option("--packets", options.packets, "Packets a tick, 1 or 0.5")
        ->check(number_in(0.5, 1.0));
    match.add_option("--overhead-bytes", options.overhead_bytes, "Headers of a packet")
        ->check(number_in(0.0, 200.0));
    match.add_option("--seconds", options.seconds, "Duration")->check(number_in(3.0, 3600.0));
    match.add_option("--seed", options.seed, "Seed of the network");
    match.add_option("--threads", options.threads, "Threads of a step")->check(CLI::Range(1, 64));
    match
        .add_option("--sockets", options.sockets,
                    "Plays this scene of the game instead: a server and climbers as processes, "
                    "through a proxy with --rtt-ms, --jitter-ms and --loss")
        ->check(CLI::IsMember(strings(handhold::built_in_scenes())));
    match.add_option("--transport", options.transport, "With --sockets: ws, or quic over UDP")
        ->check(CLI::IsMember(std::vector<std::string>{"ws", "quic"}));
    match
        .add_option("--freeze-s", options.freeze_s,
                    "With --sockets: the last player sleeps so long")
        ->check(number_in(0.0, 4.0));
    match.add_option("--json", options.json, "Output: figures")->required();
}

void add_match_film_options(CLI::App& film, lab::MatchFilmOptions& options) {
    film.add_option("--scene", options.scene, "A built-in scene, a scene file or a level");
    film.add_option("--input", options.inputs, "Two recorded sessions (.csv)")
        ->required()
        ->expected(2);
    film.add_option("--out", options.out, "Output: a folder for pictures")
        ->required()
        ->check(CLI::ExistingDirectory);
    film.add_option("--rtt-ms", options.rtt_ms, "Round trip without jitter")
        ->check(number_in(0.0, 1000.0));
    film.add_option("--jitter-ms", options.jitter_ms, "Largest extra delay, each way")
        ->check(number_in(0.0, 500.0));
    film.add_option("--loss", options.loss, "Share of lost packets")->check(number_in(0.0, 1.0));
    film.add_option("--from-s", options.from_s, "Time of the first picture")
        ->check(number_in(1.0, 3600.0));
    film.add_option("--seconds", options.seconds, "Length")->check(number_in(0.1, 600.0));
    film.add_option("--ticks", options.ticks_a_picture, "Ticks between two pictures")
        ->check(CLI::Range(1, 90));
    film.add_flag("!--as-stepped", options.hides_corrections,
                  "Draws players where they were stepped, without hiding corrections");
    film.add_option("--camera", options.from_m,
                    "Metres to the right of, above and before the player")
        ->delimiter(',');
    film.add_option("--fov", options.fov_deg, "Vertical, degrees")->check(number_in(5.0, 120.0));
    film.add_option("--width", options.width_px, "Of a picture")->check(CLI::Range(64, 4096));
    film.add_option("--height", options.height_px, "Of a picture")->check(CLI::Range(64, 4096));
    film.add_option("--seed", options.seed, "Seed of the network");
}

void add_proxy_options(CLI::App& proxy, lab::ProxyOptions& options) {
    const CLI::Validator share = number_in(0.0, 1.0);
    proxy.add_option("--to", options.server_port, "Port of the server on 127.0.0.1")
        ->required()
        ->check(CLI::Range(1, 65535));
    proxy.add_flag("--udp", options.is_udp, "Datagrams; else TCP");
    const auto add_time = [&proxy](const char* name, double& seconds, double factor,
                                   const char* what) {
        proxy
            .add_option_function<double>(
                name, [&seconds, factor](double ms) { seconds = factor * ms; }, what)
            ->check(number_in(0.0, 1000.0));
    };
    add_time("--rtt-ms", options.network.delay_s, 0.0005, "Round trip without jitter");
    add_time("--jitter-ms", options.network.jitter_s, 0.001, "Largest extra delay, each way");
    proxy.add_option("--loss", options.network.loss, "Share of lost pieces")->check(share);
    proxy.add_option("--burst-loss", options.network.burst_loss, "UDP: begins of bursts of eight")
        ->check(share);
    proxy.add_option("--duplicate", options.network.duplication, "UDP: share of doubled datagrams")
        ->check(share);
    proxy.add_option("--seed", options.seed, "Seed of the network");
}

struct Command {
    CLI::App* parser;
    std::function<int()> run;
};

// `add_options` gives the parser the options that `run` gets.
template <typename Options>
Command make_command(CLI::App& app, const char* name, const char* description,
                     void (&add_options)(CLI::App&, Options&), int (&run)(const Options&)) {
    const auto options = std::make_shared<Options>();
    CLI::App* const parser = app.add_subcommand(name, description);
    add_options(*parser, *options);
    return {parser, [options, &run] { return run(*options); }};
}

std::vector<Command> make_commands(CLI::App& app) {
    return {make_command(app, "solve", "Errors, cost and momentum of one scene with one solver",
                         add_solve_options, lab::solve_command),
            make_command(app, "grip", "Poses a hand on a mesh for each placement", add_grip_options,
                         lab::grip_command),
            make_command(app, "hands-picture", "Draws posed hands on a mesh as a sheet of pictures",
                         add_hands_picture_options, lab::hands_picture_command),
            make_command(app, "body",
                         "Estimates chest, shoulders and elbows from recorded heads and hands",
                         add_body_options, lab::body_command),
            make_command(app, "shown-body", "Measures the shown body in a session",
                         add_shown_body_options, lab::shown_body_command),
            make_command(app, "recorded-grips",
                         "Measures gripping wrists and the cost of hands in recorded sessions",
                         add_recorded_grips_options, lab::recorded_grips_command),
            make_command(
                app, "match",
                "A match over a simulated network: equal hashes, bytes, rollbacks and their cost",
                add_match_options, lab::match_command),
            make_command(app, "match-film",
                         "Draws a player at the same ticks as two machines of a match show them",
                         add_match_film_options, lab::match_film_command),
            make_command(app, "proxy", "Delays and drops what passes between two programs",
                         add_proxy_options, lab::proxy_command)};
}

}  // namespace

// NOLINTNEXTLINE(bugprone-exception-escape): without memory there is no message to print either
int main(int argc, char** argv) {
    CLI::App app{"Handhold's lab: measures the runtime from outside"};
    app.set_version_flag("--version", "handhold-lab " HANDHOLD_VERSION_TEXT);
    app.require_subcommand(1);
    const std::vector<Command> commands = make_commands(app);
    const auto chosen = [&commands] {
        return std::ranges::find_if(commands,
                                    [](const Command& each) { return each.parser->parsed(); });
    };
    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
        if (error.get_exit_code() == 0) {
            return app.exit(error);  // --help
        }
        const CLI::App& parser = chosen() != commands.end() ? *chosen()->parser : app;
        std::fprintf(stderr, "%s\n%s", error.what(), parser.help().c_str());
        return k_exit_usage;
    }
    return chosen()->run();
}
