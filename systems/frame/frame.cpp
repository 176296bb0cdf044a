#include "systems/frame/frame.hpp"

#include "components/scaled_tuning.hpp"
#include "systems/frame/frame_check.hpp"
#include "systems/frame/frame_of_host.hpp"
#include "systems/frame/frame_stages.hpp"

namespace handhold::stages {

// --- The stages of a frame, in order -------------------------------------------------------------
// step_frame runs the five parts below, from top to bottom. Other kinds of frames leave parts out,
// or put a few stages of their own in place of a part. The first four parts read and write
// simulated columns only; the last reads those and writes the shown ones. Nothing else decides the
// order of stages.

// Input: what devices and hosts say about players.
void read_input(const FrameContext& f) {
    read_tracking(f);
    calibrate_players(f);
    estimate_sizes(f);
}

// Everything before the solve.
void prepare_solve(const FrameContext& f, Contacts contacts) {
    // Intent: grabs, pulls and locomotion of players.
    group_joints(f);
    place_colliders(f, Stage::update_grabs);
    pose_grippable_bodies(f, k_no_entity);
    update_grabs(f);
    locomote_players(f);
    pull_bodies(f);

    // Prediction: where bodies and players would go unconstrained.
    animate_movers(f);
    predict_bodies(f);
    anchor_grabs(f);

    // Constraints between bodies, players and hands.
    place_colliders(f, Stage::find_contacts);
    if (contacts == Contacts::searched) {
        find_contacts(f);
    } else {
        clear_contacts(f);
    }
    build_constraints(f);
}

// The poses and velocities of the frame.
void solve(const FrameContext& f) {
    solve_phases(f);
    finish_positions(f);
    solve_velocities(f);
    book_momentum(f);
    record_valid_poses(f);
}

// Limits the solution, whoever found it: this solver or a host's.
void finish_solve(const FrameContext& f) {
    limit_velocities(f);
    update_joints(f);
    discard_broken_results(f);
}

// The simulated stages of a frame whose contacts the library finds and solves.
void simulate(const FrameContext& f) {
    read_input(f);
    prepare_solve(f, Contacts::searched);
    solve(f);
    finish_solve(f);
}

// The hands and bodies that players see.
void show(const FrameContext& f) {
    // Poses palms and fingers on what the hands hold.
    gather_surroundings(f);
    search_grip(f);
    constrain_palms(f);
    sweep_fingers(f);
    fit_hands(f);

    // Poses arms, spine and legs so that they connect head and hands.
    estimate_arms(f);
    layer_clavicles(f);
    pose_arms(f);
    propagate_spine(f);
    layer_additives(f);
    limit_pelvis(f);
    limit_feet(f);
    clear_arms(f);

    // Writes the poses that hosts draw.
    publish_pose(f);
    publish_body(f);
}

// --- Before and after the stages -----------------------------------------------------------------

FrameContext begin_frame(World& world, FrameCaches& caches, const Tuning& tuning,
                         const FrameInput& input, StageStats& stats) {
    check_frame(world, caches, tuning, input);
    stats.clear();
    return {.w = world, .caches = caches, .tuning = tuning, .input = input, .stats = stats};
}

void advance_clock(const FrameContext& f) {
    f.w.clock.t_s = f.end_s();
    ++f.w.clock.frame;
}

}  // namespace handhold::stages

namespace handhold {

// --- Kinds of frames -----------------------------------------------------------------------------

void step_frame(World& world, FrameCaches& caches, const Tuning& tuning, const FrameInput& input,
                StageStats& stats) {
    using namespace stages;
    const FrameContext f = begin_frame(world, caches, tuning, input, stats);
    simulate(f);
    show(f);
    advance_clock(f);
}

void step_simulated(World& world, FrameCaches& caches, const Tuning& tuning,
                    const FrameInput& input, StageStats& stats) {
    using namespace stages;
    const FrameContext f = begin_frame(world, caches, tuning, input, stats);
    simulate(f);
    advance_clock(f);
}

void step_pose_only(World& world, FrameCaches& caches, const Tuning& tuning,
                    const FrameInput& input, StageStats& stats) {
    using namespace stages;
    const FrameContext f = begin_frame(world, caches, tuning, input, stats);
    read_paused_tracking(f);
    place_colliders(f, Stage::find_contacts);
    show(f);
}

void begin_host_frame(World& world, FrameCaches& caches, const Tuning& tuning,
                      const FrameInput& input, StageStats& stats) {
    using namespace stages;
    const FrameContext f = begin_frame(world, caches, tuning, input, stats);
    read_input(f);
    prepare_solve(f, Contacts::from_host);
}

void end_host_frame(World& world, FrameCaches& caches, const Tuning& tuning,
                    const FrameInput& input, std::span<const SolvedPlayer> solved,
                    StageStats& stats) {
    using namespace stages;
    const FrameContext f{
        .w = world, .caches = caches, .tuning = tuning, .input = input, .stats = stats};
    accept_solution(f, solved);
    finish_solve(f);
    show(f);
    advance_clock(f);
}

void show_host_frame(World& world, FrameCaches& caches, const Tuning& tuning,
                     const FrameInput& input, StageStats& stats) {
    using namespace stages;
    const FrameContext f = begin_frame(world, caches, tuning, input, stats);
    read_input(f);
    place_colliders(f, Stage::gather_surroundings);
    update_sights(f);
    clear_solution(f);
    keep_holds(f);
    show(f);
    advance_clock(f);
}

// --- Queries -------------------------------------------------------------------------------------

std::optional<GrabTarget> find_grip(World& world, FrameCaches& caches, const Tuning& tuning,
                                    Entity hand, StageStats& stats) {
    using namespace stages;
    const FrameInput no_input;
    const FrameContext f{
        .w = world, .caches = caches, .tuning = tuning, .input = no_input, .stats = stats};
    // Bodies and shapes may have been added, removed or moved since the last step.
    group_joints(f);
    place_colliders(f, Stage::update_grabs);
    pose_grippable_bodies(f, hand);
    const HandTracking& tracking = world.hand_tracking.at(hand);
    const PlayerOrigin& origin = world.player_origin.at(world.hand_owner.at(hand).player);
    const Pose hand_ws = origin.pose_ws * tracking.pose_ps;
    TuningOfPlayers tunings(tuning);
    return find_grab_target(grab_search(f), hand, hand_ws, k_no_entity, tunings.of(origin), stats)
        .target;
}

}  // namespace handhold
