// handhold-lab: measures the runtime from outside.
#include <cstdio>
#include <string>

#include <CLI/CLI.hpp>
#include <handhold/version.hpp>

#include "tools/lab/body_command.hpp"
#include "tools/lab/grip_command.hpp"
#include "tools/lab/hands_picture.hpp"
#include "tools/lab/lab_scene.hpp"
#include "tools/lab/solve_command.hpp"

namespace {

namespace lab = handhold::lab;

constexpr int k_exit_usage = 1;

std::vector<std::string> strings(const std::vector<std::string_view>& views) {
    return {views.begin(), views.end()};
}

void add_solve_options(CLI::App& solve, lab::SolveOptions& options) {
    solve.add_option("--scene", options.scene, "What is solved")
        ->required()
        ->check(CLI::IsMember(strings(lab::scene_names())));
    solve.add_option("--links", options.links, "Links of chains and rings, arms of the hub")
        ->check(CLI::Range(2, 4096));
    solve.add_option("--masses", options.masses, "Of the links")
        ->check(CLI::IsMember(strings(lab::mass_patterns())));
    solve.add_option("--holder", options.holder, "Whose the hand is")
        ->check(CLI::IsMember(std::vector<std::string>{"kinematic", "player"}));
    solve.add_option("--solver", options.solver, "The runtime's, or one to compare it with")
        ->check(CLI::IsMember(lab::solver_names()));
    solve.add_option("--frames", options.frames, "How many")->check(CLI::Range(1, 1000000));
    solve.add_option("--hz", options.hz, "Frames a second")->check(CLI::Range(10.0, 1000.0));
    solve
        .add_option("--residuals", options.residual_frame,
                    "Also write the residual after each iteration of this frame")
        ->check(CLI::Range(0, 999999));
    solve.add_option("--json", options.json, "The figures")->required();
    solve.add_option("--csv", options.csv, "Every pose of every frame");
}

void add_grip_options(CLI::App& grip, lab::GripOptions& options) {
    const auto one_of = [](std::vector<std::string> names) {
        return CLI::IsMember(std::move(names));
    };
    grip.add_option("--mesh", options.mesh, "glTF of what is gripped")->required();
    grip.add_option("--rig", options.rig,
                    "\"builtin\", or a skinned hand with WebXR's joint names");
    grip.add_option("--hand", options.hand, "Which one")->check(one_of({"left", "right"}));
    grip.add_option("--placements", options.placements, "Tracked wrists, JSON lines")->required();
    grip.add_option("--out", options.out, "Posed hands, JSON lines")->required();
    grip.add_option("--sync", options.sync, "Whether the palm moves to its limits")
        ->check(one_of({"on", "off"}));
    grip.add_option("--search", options.search, "How a finger's disc finds the surface")
        ->check(one_of({"astar", "bfs", "flood"}));
    grip.add_option("--palm", options.palm, "Which surface the palm is held to")
        ->check(one_of({"least", "ray"}));
    grip.add_option("--fingers", options.fingers,
                    "How fingers close: the runtime's sweep; the talk taken literally, palm "
                    "included; or spheres on the bones in 50 steps")
        ->check(one_of({"sweep", "talk", "spheres"}));
    grip.add_option("--grip-edge-mm", options.grip_edge_mm, "Edges of the search detail")
        ->check(CLI::Range(1.0, 1000.0));
    grip.add_option("--rig-json", options.rig_json, "Also write the rig's figures");
    grip.add_option(
            "--warm-frames", options.warm_frames,
            "Also let each hand slide for so many frames of 1/90 s, then stand: their times")
        ->check(CLI::Range(0, 100000));
    grip.add_option("--slid-out", options.slid_out,
                    "Hands as they are at the end of their slide, JSON lines");
    grip.add_option("--warm-json", options.warm_json, "Every warm frame's figures, JSON");
    grip.add_option("--speed-mps", options.speed_mps, "Of hands that slide")
        ->check(CLI::Range(0.0, 10.0));
}

void add_hands_picture_options(CLI::App& picture, lab::HandsPictureOptions& options) {
    picture.add_option("--mesh", options.mesh, "glTF of what is gripped")->required();
    picture.add_option("--hands", options.hands, "Posed hands: the JSON lines of `grip`")
        ->required();
    picture.add_option("--out", options.out, "The sheet, as a PNG")->required();
    picture.add_option("--ids", options.ids, "Which hands; else some spread over the file")
        ->delimiter(',');
    picture.add_option("--count", options.count, "How many without --ids")
        ->check(CLI::Range(1, 400));
    picture.add_option("--columns", options.columns, "Pictures in a row")->check(CLI::Range(1, 20));
    picture.add_option("--width", options.width_px, "Of one picture")->check(CLI::Range(64, 4096));
    picture.add_option("--height", options.height_px, "Of one picture")
        ->check(CLI::Range(64, 4096));
}

void add_body_options(CLI::App& body, lab::BodyOptions& options) {
    body.add_option("--in", options.in, "Heads and hands over time")->required();
    body.add_option("--calib", options.calib, "Who they belong to")->required();
    body.add_option("--out", options.out, "Chest, shoulders and elbows")->required();
    body.add_option("--estimator", options.estimator, "The runtime's, or one to compare it with")
        ->check(CLI::IsMember(lab::estimator_names()));
}

}  // namespace

// NOLINTNEXTLINE(bugprone-exception-escape): without memory there is no message to print either
int main(int argc, char** argv) {
    CLI::App app{"Handhold's laboratory: the runtime measured from outside"};
    app.set_version_flag("--version", "handhold-lab " HANDHOLD_VERSION_TEXT);
    app.require_subcommand(1);
    lab::SolveOptions options;
    CLI::App* const solve =
        app.add_subcommand("solve", "Errors, cost and momentum of one scene under one solver");
    add_solve_options(*solve, options);
    lab::GripOptions grip_options;
    CLI::App* const grip =
        app.add_subcommand("grip", "Hands posed on a mesh, one for each placement");
    add_grip_options(*grip, grip_options);
    lab::HandsPictureOptions picture_options;
    CLI::App* const picture =
        app.add_subcommand("hands-picture", "Posed hands on a mesh as a sheet of pictures");
    add_hands_picture_options(*picture, picture_options);
    lab::BodyOptions body_options;
    CLI::App* const body =
        app.add_subcommand("body", "Chest, shoulders and elbows from recorded heads and hands");
    add_body_options(*body, body_options);
    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
        if (error.get_exit_code() == 0) {
            return app.exit(error);  // --help
        }
        const CLI::App& asked = solve->parsed()     ? *solve
                                : grip->parsed()    ? *grip
                                : picture->parsed() ? *picture
                                : body->parsed()    ? *body
                                                    : app;
        std::fprintf(stderr, "%s\n%s", error.what(), asked.help().c_str());
        return k_exit_usage;
    }
    if (picture->parsed()) {
        return lab::hands_picture_command(picture_options);
    }
    if (body->parsed()) {
        return lab::body_command(body_options);
    }
    return grip->parsed() ? lab::grip_command(grip_options) : lab::solve_command(options);
}
