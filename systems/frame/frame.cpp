#include "systems/frame/frame.hpp"

#include "systems/frame/frame_check.hpp"
#include "systems/frame/frame_stages.hpp"

namespace handhold {

void step_frame(World& world, FrameCaches& caches, const Tuning& tuning, const FrameInput& input,
                StageStats& stats) {
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
    solve_phases(f);
    finish_positions(f);
    solve_velocities(f);
    book_momentum(f);
    record_valid_poses(f);
    limit_velocities(f);
    update_joints(f);
    discard_broken_results(f);

    // Shown hands: palms and fingers on what they hold.
    gather_surroundings(f);
    search_grip(f);
    constrain_palms(f);
    sweep_fingers(f);
    fit_hands(f);

    // Shown body: arms, spine and legs between head and hands.
    estimate_arms(f);
    layer_clavicles(f);
    pose_arms(f);
    propagate_spine(f);
    layer_additives(f);

    // Output.
    publish_pose(f);
    publish_body(f);

    ++world.clock.frame;
    world.clock.t_s += input.dt_s;
}

void step_pose_only(World& world, FrameCaches& caches, const Tuning& tuning,
                    const FrameInput& input, StageStats& stats) {
    check_frame(world, caches, tuning, input);
    stats.clear();
    using namespace stages;
    const FrameContext f{world, caches, tuning, input, stats};
    read_paused_tracking(f);
    place_colliders(f, Stage::find_contacts);

    show_hands(f);
    show_bodies(f);
    publish(f);
}

}  // namespace handhold
