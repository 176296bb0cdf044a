#include "tools/lab/lab_frame.hpp"

#include "systems/frame/frame_check.hpp"
#include "systems/frame/frame_stage_timer.hpp"
#include "systems/frame/frame_stages.hpp"

namespace handhold::lab {

void step_frame_with(PositionSolver solver, World& world, FrameCaches& caches, const Tuning& tuning,
                     const FrameInput& input, StageStats& stats) {
    check_frame(world, caches, tuning, input);
    stats.clear();
    using namespace stages;
    const FrameContext f{world, caches, tuning, input, stats};

    // Input and intent: what players do.
    read_tracking(f);
    calibrate_players(f);
    group_joints(f);
    place_colliders(f, Stage::update_grabs);
    update_grabs(f);
    locomote_players(f);
    pull_bodies(f);

    // Prediction: where bodies and players would go unconstrained.
    animate_movers(f);
    predict_bodies(f);
    anchor_grabs(f);

    // Constraints and solve: the poses and velocities of the frame.
    place_colliders(f, Stage::find_contacts);
    find_contacts(f);
    build_constraints(f);
    {
        const StageTimer timer(Stage::solve_phases, stats);
        solve_phases_with(solver, {f.collision(), f.graph()}, tuning, stats);
    }
    finish_positions(f);
    update_velocities(f);
    limit_velocities(f);
    update_joints(f);
    discard_broken_results(f);

    show_hands(f);
    show_bodies(f);
    publish(f);

    ++world.clock.frame;
    world.clock.t_s += input.dt_s;
}

}  // namespace handhold::lab
