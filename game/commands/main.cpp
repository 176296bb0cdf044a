// handhold: the prototype game's command line.
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <functional>
#include <map>
#include <new>
#include <string>
#include <system_error>
#include <vector>

#include <CLI/CLI.hpp>
#include <handhold/version.hpp>

#include "engine/core/printable.hpp"
#include "game/commands/body_export.hpp"
#include "game/commands/build_station_command.hpp"
#include "game/commands/climb_command.hpp"
#include "game/commands/flag_checks.hpp"
#include "game/commands/grip_command.hpp"
#include "game/commands/hand_export.hpp"
#include "game/commands/match_options.hpp"
#include "game/commands/picture_command.hpp"
#include "game/commands/play_command.hpp"
#include "game/commands/run_command.hpp"
#include "game/levels/built_in_scenes.hpp"
#include "game/play/exit_status.hpp"
#include "game/scene/scene.hpp"

namespace {

using handhold::add_choice;
using handhold::number_in;
using handhold::whole_number;

constexpr int k_exit_usage = 1;

void add_model_options(CLI::App& command, handhold::PlayerModelFiles& files) {
    command
        .add_option("--hand-rig", files.hands,
                    "Two skinned hands with WebXR's joint names (.glb), left and right; default: "
                    "the robot's")
        ->expected(2);
    CLI::Option* const body =
        command.add_option("--body", files.body, "A humanoid figure (.glb); default: the robot's");
    command
        .add_option("--body-map", files.body_map,
                    "How the figure's joints are called (.json), where their names do not tell")
        ->needs(body);
    command.add_option("--controllers", files.controllers,
                       "Show controllers in empty hands: builtin, or a profile (.json), whose "
                       "controller-to-hand joint the hands then have");
}

// Adds an option that may be repeated. The first value goes to `first`, the others to `more`.
void first_and_more(CLI::App& command, const char* name, std::string& first,
                    std::vector<std::string>& more, const char* what) {
    command
        .add_option_function<std::vector<std::string>>(
            name,
            [&first, &more](const std::vector<std::string>& values) {
                first = values.front();
                more.assign(values.begin() + 1, values.end());
            },
            what)
        ->allow_extra_args(false);
}

const std::map<std::string, handhold::PictureQuality> k_qualities = {
    {"plain", handhold::PictureQuality::plain},
    {"quick", handhold::PictureQuality::quick},
    {"fine", handhold::PictureQuality::fine}};

void add_run_options(CLI::App& run, handhold::RunOptions& options) {
    run.add_option("--scene", options.scene,
                   "A built-in scene, a scene file (.json) or a level (.glb, .gltf); needed "
                   "without --join or --match");
    first_and_more(run, "--input", options.input, options.more_inputs,
                   "A recorded session (.csv), once for each player; default: the scene's own");
    run.add_option("--hz", options.hz, "Frames a second")->check(number_in(10.0, 1000.0));
    run.add_option("--players", options.players,
                   "Players: the first plays the session, the others are scripted climbers")
        ->check(CLI::Range(1, 1000));
    run.add_flag("--climbers", options.climbers, "The first player is a climber too");
    run.add_option("--seed", options.seed, "Of the climbers and where they begin")
        ->check(whole_number());
    run.add_option("--threads", options.threads, "Threads; the result does not depend on them")
        ->check(CLI::Range(1, 256));
    run.add_option("--seconds", options.seconds,
                   "Stop after so many seconds; default: with the session")
        ->check(number_in(0.01, 1e6));
    first_and_more(run, "--spawn", options.spawn, options.more_spawns,
                   "A spawn of the scene, or auto: where most of the session's grabs begin with "
                   "the palm towards a near surface; once for each --input");
    run.add_option("--trace", options.trace,
                   "Write stage zones as a Chrome trace (Perfetto reads it)");
    CLI::Option* const out =
        run.add_option("--out", options.out,
                       "Write frames.csv, report.json, report.html, pictures and a video here");
    CLI::Option* const snapshot = run.add_option(
        "--snapshot", options.snapshot, "Save the state to this file, at the time --snapshot-at");
    snapshot->needs(
        run.add_option("--snapshot-at", options.snapshot_at_s, "When to save the state, seconds")
            ->check(number_in(0.0, 1e6))
            ->needs(snapshot));
    run.add_option("--resume", options.resume,
                   "Go on from a saved state of the same scene and players");
    CLI::Option* const shots =
        run.add_option("--shots", options.shots,
                       "Draw the shots of this scene in a list (.json) into --out, and no report");
    shots->needs(out);
    run.add_option("--shot-width", options.shot_width_px, "Pixels")
        ->check(CLI::Range(16, 8192))
        ->needs(shots);
    run.add_option("--shot-height", options.shot_height_px, "Pixels")
        ->check(CLI::Range(16, 8192))
        ->needs(shots);
    add_choice(run, "--shot-quality", options.shot_quality, k_qualities, "plain, quick or fine")
        ->needs(shots);
    run.add_flag("--distance-grab", options.distance_grab, "As in play, to see a session again");
    add_model_options(run, options.models);
    run.add_flag_callback(
        "--no-pictures", [&options] { options.pictures = false; },
        "With --out: files only, no pictures and no video");
}

void add_climb_options(CLI::App& climb, handhold::ClimbOptions& options) {
    climb.add_option("--scene", options.scene, "As for run")->required();
    climb.add_option("--spawn", options.spawn, "A spawn of the scene; default: its first");
    climb.add_option("--seconds", options.seconds, "How long he climbs")
        ->check(number_in(0.1, 1e5));
    climb.add_option("--seed", options.seed, "Of the climber's decisions")->check(whole_number());
    climb.add_option("--out", options.out, "The recording (.csv)")->required();
}

void add_picture_options(CLI::App& pictures, handhold::PictureOptions& options) {
    pictures.add_option("--scene", options.scene, "As of run")->required();
    pictures.add_option("--out", options.out, "A folder for <spawn>.png")->required();
    pictures.add_option("--spawn", options.spawn, "Only this one");
    pictures
        .add_option("--yaw", options.yaw_deg, "Degrees to the left of the direction of the spawn")
        ->check(number_in(-3600.0, 3600.0));
    pictures.add_option("--pitch", options.pitch_deg, "Degrees up")
        ->check(number_in(-3600.0, 3600.0));
    pictures.add_option("--seconds", options.seconds, "After so many seconds without a player")
        ->check(number_in(0.0, 1e4));
    add_choice(pictures, "--hands", options.hands, {"open", "fist"},
               "Hold both hands before the eyes");
    pictures.add_option("--grips-of", options.grips_of,
                        "A body: hands in its authored grips, from four sides");
    add_model_options(pictures, options.models);
    pictures.add_option("--width", options.width_px, "Pixels")->check(CLI::Range(16, 8192));
    pictures.add_option("--height", options.height_px, "Pixels")->check(CLI::Range(16, 8192));
}

void add_play_options(CLI::App& play, handhold::PlayOptions& options) {
    play.add_option("--scene", options.scene, "As of run; default: station");
    play.add_option("--spawn", options.spawn, "A spawn of the scene; default: its first");
    play.add_flag("--xr", options.xr, "In a headset, through the machine's OpenXR runtime");
    play.add_flag("--xr-headless", options.xr_headless,
                  "As --xr, but poses and buttons only: no pictures");
    play.add_option("--eye-scale", options.eye_scale,
                    "With --xr: of the size of picture that the headset recommends")
        ->check(number_in(0.05, 2.0));
    play.add_flag_callback(
        "--no-mirror", [&options] { options.mirror = false; },
        "With --xr: no window with the left eye's view");
    play.add_option("--record", options.record,
                    "Save the session (.csv): run --input plays it again");
    play.add_flag("--jets", options.jets, "Small jets: the keys push as well as pull");
    play.add_flag("--distance-grab", options.distance_grab,
                  "A hand that closes on nothing pulls what its palm points at");
    play.add_option("--picture", options.picture, "Save the last picture (.png)");
    play.add_option("--report", options.report,
                    "Save what was climbed and what it cost (.json) at the end");
    play.add_option("--status", options.status,
                    "Write a line of how it stands every tenth of a second (.jsonl)");
    add_choice(play, "--quality", options.settings.quality, k_qualities,
               "plain (no graphics card), quick, or fine (four samples a pixel)");
    const std::map<std::string, handhold::TurnKind> turns = {
        {"snap", handhold::TurnKind::snap}, {"smooth", handhold::TurnKind::smooth}};
    add_choice(play, "--turn", options.settings.turn, turns, "snap or smooth: how Z and C turn");
    play.add_option("--vignette", options.settings.vignette,
                    "How much the edges darken at speed, 0 to 1")
        ->check(number_in(0.0, 1.0));
    play.add_flag("--inspector", options.panels.inspector, "Open the inspector at once (F2)");
    add_choice(play, "--page", options.page,
               {"Frame", "Hands", "Bodies", "Tuning", "Entities", "Gizmos"},
               "The inspector's page that is open");
    play.add_flag_callback(
        "--gizmos", [&options] { options.gizmos.fill(true); }, "Show what every stage did");
    const std::map<std::string, handhold::PlayerViewpoint> viewpoints = {
        {"eyes", handhold::PlayerViewpoint::eyes},
        {"mirror", handhold::PlayerViewpoint::mirror},
        {"behind", handhold::PlayerViewpoint::behind}};
    add_choice(play, "--view", options.viewpoint, viewpoints, "eyes, mirror or behind (F4)");
    play.add_flag("--menu", options.panels.menu, "Open scenes and settings at once (F3)");
    play.add_option("--seconds", options.seconds, "Stop after so many; default: never")
        ->check(number_in(0.01, 1e6));
    add_model_options(play, options.models);
    play.add_option("--width", options.width_px, "Pixels")->check(CLI::Range(16, 8192));
    play.add_option("--height", options.height_px, "Pixels")->check(CLI::Range(16, 8192));
    handhold::add_play_join_options(play, options);
}

void add_export_grip_options(CLI::App& command, handhold::ExportGripOptions& options) {
    command.add_option("--scene", options.scene, "As of run")->required();
    command.add_option("--body", options.body, "Of the scene")->required();
    command.add_option("--grip", options.grip, "An authored grip's name, or that of a new one")
        ->required();
    add_choice(command, "--hand", options.hand, {"right", "left"}, "Which hand");
    command
        .add_option("--wrist", options.wrist,
                    "Of a new grip: where the hand closes, x y z and a quaternion x y z w in the "
                    "frame of the body's shape")
        ->expected(7)
        ->check(number_in(-1e6, 1e6));
    command.add_option("--controllers", options.controllers,
                       "The controller in the hand: builtin, or a profile's .json");
    command.add_option("--out", options.out, "The .glb")->required();
}

int list_scenes() {
    for (const std::string_view name : handhold::built_in_scenes()) {
        const auto scene = handhold::make_built_in_scene(name);
        std::printf("%-10s %s\n", scene->name.c_str(), scene->description.c_str());
    }
    return 0;
}

// The command line: the options of every command, and the function that runs the chosen command.
struct Program {
    CLI::App app{"Handhold: a prototype game of zero-G hands"};
    handhold::RunOptions run;
    handhold::PlayOptions play;
    handhold::ClimbOptions climb;
    handhold::PictureOptions pictures;
    handhold::BuildStationOptions station;
    handhold::ExportGripOptions grip;
    handhold::ServeOptions serve;
    handhold::JoinOptions join;
    handhold::ReplayOptions replay;
    handhold::JoinOptions bots;
    handhold::TokenOptions token;
    std::string hands_folder;
    std::string hands_controllers;
    std::string body_file;
    std::string grip_file;
    std::string grip_json;
    std::function<int()> chosen;

    CLI::App& add(const char* name, const char* description, std::function<int()> command) {
        CLI::App* const added = app.add_subcommand(name, description);
        added->callback([this, command = std::move(command)] { chosen = command; });
        return *added;
    }
};

int run_or_join(const handhold::RunOptions& run, handhold::JoinOptions join,
                handhold::ReplayOptions replay) {
    if (!replay.file.empty()) {
        replay.scene = run.scene;
        replay.seconds = run.seconds;
        return handhold::replay_command(replay, run);
    }
    if (join.url.empty()) {
        return handhold::run_command(run);
    }
    join.scene = run.scene;
    join.input = run.input;
    join.seed = run.seed;
    join.seconds = run.seconds;
    return handhold::join_command(join);
}

// Commands that play or draw a scene.
void add_scene_commands(Program& program) {
    Program& p = program;
    CLI::App& run = p.add("run", "Play a session without a window, as fast as it can",
                          [&p] { return run_or_join(p.run, p.join, p.replay); });
    add_run_options(run, p.run);
    handhold::add_join_options(run, p.join);
    handhold::add_replay_options(run, p.replay);
    run.parse_complete_callback([&p] {
        if (p.run.scene.empty() && p.join.url.empty() && p.replay.file.empty()) {
            throw CLI::RequiredError("--scene");
        }
        if (!p.replay.file.empty() && !p.run.out.empty() && p.run.shots.empty()) {
            throw CLI::RequiredError("--shots, with --match and --out");
        }
    });
    add_play_options(
        p.add("play", "Play in a window with keyboard, mouse or gamepad, or in a headset",
              [&p] { return handhold::play_command(p.play); }),
        p.play);
    add_climb_options(p.add("climb", "Record a session of a scripted climber who wanders",
                            [&p] { return handhold::climb_command(p.climb); }),
                      p.climb);
    add_picture_options(p.add("pictures", "Draw what is seen from each spawn of a scene",
                              [&p] { return handhold::picture_command(p.pictures); }),
                        p.pictures);
    p.add("scenes", "List the built-in scenes", list_scenes);
}

// Commands of matches over a network.
void add_match_commands(Program& program) {
    Program& p = program;
    handhold::add_serve_options(p.add("serve", "Run a match that others join over a network",
                                      [&p] { return handhold::serve_command(p.serve); }),
                                p.serve);
    handhold::add_bots_options(p.add("bots", "Join a match with scripted climbers",
                                     [&p] { return handhold::join_command(p.bots); }),
                               p.bots);
    handhold::add_token_options(p.add("token", "Sign a token that admits a player to a match",
                                      [&p] { return handhold::token_command(p.token); }),
                                p.token);
}

// Commands that read and write assets.
void add_asset_commands(Program& program) {
    Program& p = program;
    CLI::App& build_station =
        p.add("build-station", "Write a station's scene file and its models from a description",
              [&p] { return handhold::build_station_command(p.station); });
    build_station.add_option("description", p.station.description,
                             "A .json; default: the game's own station");
    build_station.add_option("--out", p.station.out, "A folder")->required();
    CLI::App& export_hands =
        p.add("export-hands", "Write the robot's hands for an animation package",
              [&p] { return handhold::export_hands_command(p.hands_folder, p.hands_controllers); });
    export_hands.add_option("--controllers", p.hands_controllers,
                            "Controllers in them: builtin, or a profile's .json");
    export_hands.add_option("--out", p.hands_folder, "A folder")->required();
    p.add("export-body", "Write the robot's body for an animation package",
          [&p] { return handhold::export_body_command(p.body_file); })
        .add_option("--out", p.body_file, "A file (.glb)")
        ->required();
    add_export_grip_options(
        p.add("export-grip", "Write a hand in an authored grip, and what it holds, as a .glb",
              [&p] { return handhold::export_grip_command(p.grip); }),
        p.grip);
    CLI::App& import_grip =
        p.add("import-grip", "Read such a .glb as a grip for a scene file's \"grips\"",
              [&p] { return handhold::import_grip_command(p.grip_file, p.grip_json); });
    import_grip.add_option("file", p.grip_file, "The .glb")->required();
    import_grip.add_option("--out", p.grip_json, "A .json; default: standard output");
}

// Parses the command line and runs the command. Returns the exit status.
int run_program(int argc, char** argv) {
    Program program;
    CLI::App& app = program.app;
    app.set_version_flag("--version", "handhold " HANDHOLD_VERSION_TEXT);
    app.require_subcommand(1);
    add_scene_commands(program);
    add_match_commands(program);
    add_asset_commands(program);
    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
        if (error.get_exit_code() == 0) {
            return app.exit(error);  // --help, --version
        }
        std::fprintf(stderr, "%s\n%s", handhold::printable(error.what()).c_str(),
                     app.help().c_str());
        return k_exit_usage;
    }
    return program.chosen();
}

// Flushes standard output and reports a failure. Returns the exit status.
int flush_output(int status) {
    const bool failed_before = std::ferror(stdout) != 0;
    if (std::fflush(stdout) == 0 && !failed_before) {
        return status;
    }
    std::fprintf(stderr, "standard output: %s\n", std::generic_category().message(errno).c_str());
    return status != 0 ? status : handhold::k_exit_bad_file;
}

// Called for exceptions that no handler can catch, such as one thrown by a destructor.
[[noreturn]] void end_without_handler() {
    std::fputs("handhold: out of memory, or an internal error\n", stderr);
    std::_Exit(handhold::k_exit_internal);
}

int report_exception(const char* what) {
    std::fprintf(stderr, "handhold: %s\n", what);
    return handhold::k_exit_internal;
}

}  // namespace

int main(int argc, char** argv) {
    std::set_terminate(end_without_handler);
#ifdef SIGXFSZ
    std::signal(SIGXFSZ, SIG_IGN);  // exceeding the file size limit is then a write error
#endif
#ifdef SIGPIPE
    std::signal(SIGPIPE, SIG_IGN);  // files are completed even if nobody reads the summary
#endif
    try {
        return flush_output(run_program(argc, argv));
    } catch (const std::bad_alloc&) {
        return report_exception("out of memory");
    } catch (const std::exception& error) {
        return report_exception(handhold::printable(error.what()).c_str());
    }
}
