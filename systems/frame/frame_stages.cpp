#include "systems/frame/frame_stages.hpp"

#include "systems/body/calibrate_players.hpp"
#include "systems/frame/frame_slices.hpp"
#include "systems/frame/frame_stage_timer.hpp"
#include "systems/grab/anchor_grabs.hpp"
#include "systems/grab/pull_bodies.hpp"
#include "systems/grab/update_grabs.hpp"
#include "systems/input/read_paused_tracking.hpp"
#include "systems/input/read_tracking.hpp"
#include "systems/locomotion/locomote_players.hpp"
#include "systems/physics/animate_movers.hpp"
#include "systems/physics/build_constraints.hpp"
#include "systems/physics/discard_broken_results.hpp"
#include "systems/physics/find_contacts.hpp"
#include "systems/physics/finish_positions.hpp"
#include "systems/physics/group_joints.hpp"
#include "systems/physics/limit_velocities.hpp"
#include "systems/physics/place_colliders.hpp"
#include "systems/physics/predict_bodies.hpp"
#include "systems/physics/solve_phases.hpp"
#include "systems/physics/update_joints.hpp"
#include "systems/physics/update_velocities.hpp"

namespace handhold::stages {

// --- Input and intent ----------------------------------------------------------------------------

void read_tracking(const FrameContext& f) {
    const StageTimer timer(Stage::read_tracking, f.stats);
    World& w = f.w;
    const ReadTrackingIo io{
        f.input.players,  f.start_s(),     f.end_s(),       w.hand_owner,   w.controller_to_hand,
        w.recenter_guess, w.head_tracking, w.hand_tracking, w.hand_history, w.player_commands};
    for_slices(f, w.head_tracking.size(),
               [&](HandScratch::Slice& slice, std::size_t first, std::size_t last) {
                   handhold::read_tracking(io, first, last, f.tuning, slice.stats);
               });
}

void read_paused_tracking(const FrameContext& f) {
    const StageTimer timer(Stage::read_tracking, f.stats);
    World& w = f.w;
    handhold::read_paused_tracking({f.input.players,
                                    w.hand_owner,
                                    w.controller_to_hand,
                                    w.head_tracking,
                                    w.hand_tracking,
                                    w.hand_history,
                                    {default_controller_to_hand(HandSide::left, f.tuning.hand),
                                     default_controller_to_hand(HandSide::right, f.tuning.hand)}});
}

void calibrate_players(const FrameContext& f) {
    const StageTimer timer(Stage::calibrate_players, f.stats);
    World& w = f.w;
    handhold::calibrate_players({f.dt_s(), w.player_commands, w.head_tracking, w.hand_owner,
                                 w.hand_tracking, w.calibration, w.body_measures},
                                f.tuning.calibration);
}

void group_joints(const FrameContext& f) {
    const StageTimer timer(Stage::group_joints, f.stats);
    handhold::group_joints({f.w.joint, f.w.body, f.graph()}, f.tuning.phases);
}

// Runs twice per frame. Each run's time is added to `needed_by`, the stage that needs the
// colliders.
void place_colliders(const FrameContext& f, Stage needed_by) {
    const StageTimer timer(needed_by, f.stats);
    World& w = f.w;
    handhold::place_colliders({w.persistent_id, w.collider, w.body, w.body_pose, w.body_start,
                               w.player_origin, w.player_start, w.head_tracking, w.last_valid,
                               f.collision(), f.graph(), &w.filter, &w.body_velocity},
                              f.tuning.head);
}

GrabSearch grab_search(const FrameContext& f) {
    World& w = f.w;
    return {f.surfaces(),
            w.persistent_id,
            w.hand_owner,
            w.hand_tracking,
            w.player_origin,
            w.head_tracking,
            w.body,
            w.body_pose,
            f.graph().joint_groups,
            w.authored_grips,
            w.hand_pull,
            w.reference_velocity,
            w.hand_sight,
            w.grab,
            w.authored_hold,
            w.head_ignores,
            {&w.grab_rule, &w.grab_layers, &w.filter},
            &w.grab_order,
            f.start_s(),
            f.dt_s(),
            &w.render_pose,
            &w.body_measures,
            &w.body_hold};
}

void update_grabs(const FrameContext& f) {
    const StageTimer timer(Stage::update_grabs, f.stats);
    handhold::update_grabs(grab_search(f), f.tuning, f.stats);
}

void update_sights(const FrameContext& f) {
    const StageTimer timer(Stage::update_grabs, f.stats);
    handhold::update_sights(grab_search(f), f.tuning);
}

void locomote_players(const FrameContext& f) {
    const StageTimer timer(Stage::locomote_players, f.stats);
    World& w = f.w;
    handhold::locomote_players(
        {f.dt_s(), w.reference_velocity_mps, w.player_commands, w.head_tracking, w.hand_owner,
         w.hand_tracking, w.grab, w.body_pose, w.body_velocity, w.player_origin, w.player_velocity,
         w.reference_velocity, &w.body_hold},
        f.tuning.locomotion);
}

void pull_bodies(const FrameContext& f) {
    const StageTimer timer(Stage::locomote_players, f.stats);
    World& w = f.w;
    handhold::pull_bodies({f.dt_s(),
                           f.surfaces(),
                           w.persistent_id,
                           w.hand_owner,
                           w.hand_tracking,
                           w.grab,
                           w.hand_sight,
                           w.player,
                           w.player_origin,
                           w.body,
                           w.body_pose,
                           f.graph().joint_groups,
                           w.hand_pull,
                           w.body_velocity,
                           w.player_velocity,
                           {&w.grab_rule, &w.grab_layers, &w.filter}},
                          f.tuning, f.stats);
}

// --- Prediction ----------------------------------------------------------------------------------

void animate_movers(const FrameContext& f) {
    const StageTimer timer(Stage::animate_movers, f.stats);
    World& w = f.w;
    handhold::animate_movers({f.end_s(), w.mover, w.path_mover, w.leg_mover, w.body_pose,
                              w.body_start, w.body_velocity, &w.move_target, f.dt_s()});
}

void predict_bodies(const FrameContext& f) {
    const StageTimer timer(Stage::predict_bodies, f.stats);
    World& w = f.w;
    handhold::predict_bodies({f.dt_s(), w.body, w.player_velocity, w.body_pose, w.body_start,
                              w.body_velocity, w.player_origin, w.player_start, w.gravity_mps2,
                              &w.gravity_scale});
}

void anchor_grabs(const FrameContext& f) {
    const StageTimer timer(Stage::anchor_grabs, f.stats);
    World& w = f.w;
    handhold::anchor_grabs(
        {f.start_s(), f.end_s(), w.hand_owner, w.hand_tracking, w.hand_history, w.player_start,
         w.player_origin, w.head_tracking, w.body_start, w.body_pose, w.authored_hold, w.body,
         w.joint, w.joint_state, w.grab, &w.body_hold},
        f.tuning, f.stats);
}

// --- Constraints and solve -----------------------------------------------------------------------

void find_contacts(const FrameContext& f) {
    const StageTimer timer(Stage::find_contacts, f.stats);
    World& w = f.w;
    handhold::find_contacts({w.persistent_id, w.body, w.joint, w.head_tracking, w.hand_owner,
                             w.grab, f.collision(), w.head_ignores, f.graph()},
                            f.tuning.contact);
}

void build_constraints(const FrameContext& f) {
    const StageTimer timer(Stage::build_constraints, f.stats);
    World& w = f.w;
    handhold::build_constraints(
        {f.dt_s(), w.persistent_id, w.body, w.body_pose, w.body_velocity, w.joint, w.joint_state,
         w.player, w.player_origin, w.player_velocity, w.head_tracking, w.hand_owner, w.grab,
         f.graph(), &w.body_hold},
        f.tuning);
}

void solve_phases(const FrameContext& f) {
    const StageTimer timer(Stage::solve_phases, f.stats);
    handhold::solve_phases({f.collision(), f.graph()}, f.tuning, f.stats);
}

void finish_positions(const FrameContext& f) {
    const StageTimer timer(Stage::solve_phases, f.stats);
    World& w = f.w;
    handhold::finish_positions({f.collision(), f.graph(), w.body_pose, w.player_origin, w.grab,
                                f.dt_s(), w.head_tracking, w.player_velocity},
                               f.tuning.contact, f.tuning.head, f.stats);
}

void update_velocities(const FrameContext& f) {
    const StageTimer timer(Stage::update_velocities, f.stats);
    World& w = f.w;
    handhold::update_velocities(
        {w.head_tracking, f.graph(), w.body_velocity, w.player_velocity, w.last_valid}, f.tuning,
        f.stats);
}

void limit_velocities(const FrameContext& f) {
    const StageTimer timer(Stage::update_velocities, f.stats);
    World& w = f.w;
    handhold::limit_velocities(
        {w.hand_owner, w.reference_velocity, f.graph(), w.body_velocity, w.player_velocity, w.grab},
        f.tuning.locomotion, f.stats);
}

void update_joints(const FrameContext& f) {
    const StageTimer timer(Stage::update_joints, f.stats);
    handhold::update_joints({f.dt_s(), f.graph(), f.w.joint, f.w.joint_state});
}

void discard_broken_results(const FrameContext& f) {
    const StageTimer timer(Stage::update_joints, f.stats);
    World& w = f.w;
    handhold::discard_broken_results(
        {w.body_start, w.player_start, w.body_pose, w.body_velocity, w.player_origin,
         w.player_velocity, w.last_valid, w.joint_state, w.grab, f.graph()},
        f.stats);
}

}  // namespace handhold::stages
