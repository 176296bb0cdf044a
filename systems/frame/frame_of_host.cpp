#include "systems/frame/frame_of_host.hpp"

#include "systems/frame/frame_check.hpp"
#include "systems/frame/frame_stages.hpp"
#include "systems/grab/keep_holds.hpp"

namespace handhold {

void begin_host_frame(World& world, FrameCaches& caches, const Tuning& tuning,
                      const FrameInput& input, StageStats& stats) {
    check_frame(world, caches, tuning, input);
    stats.clear();
    using namespace stages;
    const FrameContext f{world, caches, tuning, input, stats};

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
    caches.graph.contacts.clear();  // the host finds them
    build_constraints(f);
}

void end_host_frame(World& world, FrameCaches& caches, const Tuning& tuning,
                    const FrameInput& input, std::span<const SolvedPlayer> solved,
                    StageStats& stats) {
    using namespace stages;
    const FrameContext f{world, caches, tuning, input, stats};
    stats.hand_error_m =
        accept_solution({solved, world.body_pose, world.body_velocity, caches.graph,
                         world.player_origin, world.player_velocity, world.grab, world.last_valid});
    limit_velocities(f);
    update_joints(f);
    discard_broken_results(f);

    show_hands(f);
    show_bodies(f);
    publish(f);

    ++world.clock.frame;
    world.clock.t_s += input.dt_s;
}

void show_host_frame(World& world, FrameCaches& caches, const Tuning& tuning,
                     const FrameInput& input, StageStats& stats) {
    check_frame(world, caches, tuning, input);
    stats.clear();
    using namespace stages;
    const FrameContext f{world, caches, tuning, input, stats};

    read_tracking(f);
    calibrate_players(f);
    place_colliders(f, Stage::gather_surroundings);
    update_sights(f);
    caches.graph.contacts.clear();
    caches.graph.graph.blocks.clear();
    caches.graph.push_backs.clear();
    keep_holds({.scene_velocity_mps = world.reference_velocity_mps,
                .owner = world.hand_owner,
                .hand = world.hand_tracking,
                .body = world.body,
                .body_pose = world.body_pose,
                .body_velocity = world.body_velocity,
                .origin = world.player_origin,
                .grab = world.grab,
                .reference = world.reference_velocity});

    show_hands(f);
    show_bodies(f);
    publish(f);

    ++world.clock.frame;
    world.clock.t_s += input.dt_s;
}

std::optional<GrabTarget> find_grip(World& world, FrameCaches& caches, const Tuning& tuning,
                                    Entity hand, StageStats& stats) {
    const FrameInput no_input;
    const stages::FrameContext f{world, caches, tuning, no_input, stats};
    // Bodies and shapes may have been added, removed or moved since the last step.
    stages::group_joints(f);
    stages::place_colliders(f, Stage::update_grabs);
    const HandTracking& tracking = world.hand_tracking.at(hand);
    const Pose hand_ws =
        world.player_origin.at(world.hand_owner.at(hand).player).pose_ws * tracking.pose_ps;
    return find_grab_target(stages::grab_search(f), hand, hand_ws, k_no_entity, tuning, stats)
        .target;
}

}  // namespace handhold
