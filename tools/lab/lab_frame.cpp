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
    animate_movers(f);
    predict_bodies(f);
    anchor_grabs(f);
    place_colliders(f, Stage::find_contacts);
    find_contacts(f);
    build_constraints(f);
    {
        const StageTimer timer(Stage::solve_phases, stats);
        solve_phases_with(solver, {.collision = f.collision(), .frame = f.graph()}, tuning, stats);
    }
    finish_positions(f);
    solve_velocities(f);
    book_momentum(f);
    record_valid_poses(f);
    limit_velocities(f);
    update_joints(f);
    discard_broken_results(f);
    gather_surroundings(f);
    search_grip(f);
    constrain_palms(f);
    sweep_fingers(f);
    fit_hands(f);
    estimate_arms(f);
    layer_clavicles(f);
    pose_arms(f);
    propagate_spine(f);
    layer_additives(f);
    publish_pose(f);
    publish_body(f);

    ++world.clock.frame;
    world.clock.t_s += input.dt_s;
}

}  // namespace handhold::lab
