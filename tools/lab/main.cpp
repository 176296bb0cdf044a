// handhold-lab: measures the runtime from outside.
#include <cstdio>
#include <string>

#include <CLI/CLI.hpp>

#include "tools/lab/body_command.hpp"
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
    app.require_subcommand(1);
    lab::SolveOptions options;
    CLI::App* const solve =
        app.add_subcommand("solve", "Errors, cost and momentum of one scene under one solver");
    add_solve_options(*solve, options);
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
        const CLI::App& asked = solve->parsed() ? *solve : body->parsed() ? *body : app;
        std::fprintf(stderr, "%s\n%s", error.what(), asked.help().c_str());
        return k_exit_usage;
    }
    return body->parsed() ? lab::body_command(body_options) : lab::solve_command(options);
}
