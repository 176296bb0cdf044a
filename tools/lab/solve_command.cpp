#include "tools/lab/solve_command.hpp"

#include <cstdio>
#include <functional>
#include <optional>

#include "engine/core/profile.hpp"
#include "engine/core/text_file.hpp"
#include "game/play/progress.hpp"
#include "tools/lab/bullet_run.hpp"
#include "tools/lab/exit_status.hpp"
#include "tools/lab/gauss_seidel.hpp"
#include "tools/lab/measure.hpp"
#include "tools/lab/residual_probe.hpp"
#include "tools/lab/runtime_run.hpp"
#include "tools/lab/scene_files.hpp"

namespace handhold::lab {
namespace {

PositionSolver position_solver(const std::string& name) {
    if (name == "plain") {
        return &solve_plain;
    }
    return name == "sweep" ? &solve_sweep : &solve_positions;
}

// Returns the reason why these options do not fit together; empty if they do.
std::string find_objection(const SolveOptions& options, const LabScene& scene) {
    if (options.holder == "kinematic" && scene.needs_player) {
        return "scene " + scene.name +
               ": the hand moves beyond the held body's range, so it needs --holder player";
    }
    if (options.solver == "bullet" && !scene.beyond_bullet.empty()) {
        return "scene " + scene.name + ": Bullet cannot express " + scene.beyond_bullet;
    }
    return {};
}

struct Outcome {
    Measure measure;
    FrameCsv csv;
    ResidualCurve curve;
};

void run_frames(const SolveOptions& options, const std::function<void(int, FrameRecord&)>& step,
                Outcome& outcome) {
    Progress progress("solve");
    FrameRecord record;
    for (int frame = 0; frame < options.frames; ++frame) {
        step(frame, record);
        outcome.measure.take(record);
        if (!options.csv.empty()) {
            outcome.csv.take(frame, record);
        }
        progress.show(static_cast<double>(frame + 1) / options.frames);
    }
}

void run_runtime(const SolveOptions& options, const LabScene& scene, Holder holder,
                 Outcome& outcome) {
    PositionSolver solver = position_solver(options.solver);
    const bool probes = options.residual_frame >= 0;
    solver = probes ? probe_residuals(solver) : solver;
    RuntimeRun run(scene, holder, options.hz, solver);
    run.warm_up();
    run_frames(
        options,
        [&](int frame, FrameRecord& record) {
            if (frame == options.residual_frame) {
                arm_probe();
            }
            run.step(record);
        },
        outcome);
    if (probes) {
        outcome.curve = {options.residual_frame, probed_residuals()};
    }
}

void run_bullet(const SolveOptions& options, const LabScene& scene, Holder holder,
                Outcome& outcome) {
    BulletRun run(scene, holder, options.hz);
    run_frames(
        options, [&run](int, FrameRecord& record) { run.step(record); }, outcome);
    if (options.residual_frame >= 0) {
        outcome.curve = {options.residual_frame,
                         bullet_residuals(scene, holder, options.hz, options.residual_frame)};
    }
}

}  // namespace

std::vector<std::string> solver_names() { return {"direct", "sweep", "plain", "bullet"}; }

int solve_command(const SolveOptions& options) {
    const Holder holder = options.holder == "player" ? Holder::player : Holder::kinematic;
    const LabScene scene = make_scene(
        options.scene,
        {options.links, options.masses, options.frames / options.hz, options.hz, holder});
    if (const std::string objection = find_objection(options, scene); !objection.empty()) {
        std::fprintf(stderr, "handhold-lab: %s\n", objection.c_str());
        return k_exit_usage;
    }
    set_stage_clock(StageClock::thread_cpu);
    Outcome outcome{Measure(scene, holder), FrameCsv(scene), {}};
    if (options.solver == "bullet") {
        run_bullet(options, scene, holder, outcome);
    } else {
        run_runtime(options, scene, holder, outcome);
    }
    const RunLabels labels{options.solver, options.masses, options.holder,
                           options.hz,     options.frames, options.links};
    if (!options.csv.empty()) {
        if (const auto error = write_file_atomically(options.csv, outcome.csv.text())) {
            return refuse(*error);
        }
    }
    const std::string json = scene_json(scene, holder, labels, outcome.measure, outcome.curve);
    if (const auto error = write_file_atomically(options.json, json)) {
        return refuse(*error);
    }
    return 0;
}

}  // namespace handhold::lab
