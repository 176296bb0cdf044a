#include "systems/frame/frame_stages.hpp"

#include "systems/body/pose_grippable_bodies.hpp"
#include "systems/frame/frame_stage_timer.hpp"
#include "systems/grab/anchor_grabs.hpp"
#include "systems/grab/keep_holds.hpp"
#include "systems/grab/pull_bodies.hpp"
#include "systems/grab/shared/grab_sight.hpp"
#include "systems/grab/update_grabs.hpp"
#include "systems/locomotion/locomote_players.hpp"
#include "systems/physics/animate_movers.hpp"
#include "systems/physics/book_momentum.hpp"
#include "systems/physics/build_constraints.hpp"
#include "systems/physics/discard_broken_results.hpp"
#include "systems/physics/find_contacts.hpp"
#include "systems/physics/finish_positions.hpp"
#include "systems/physics/group_joints.hpp"
#include "systems/physics/limit_velocities.hpp"
#include "systems/physics/place_colliders.hpp"
#include "systems/physics/predict_bodies.hpp"
#include "systems/physics/record_valid_poses.hpp"
#include "systems/physics/solve_phases.hpp"
#include "systems/physics/solve_velocities.hpp"
#include "systems/physics/update_joints.hpp"

namespace handhold::stages {

// --- Input and intent ----------------------------------------------------------------------------

void group_joints(const FrameContext& f) {
    const StageTimer timer(Stage::group_joints, f.stats);
    handhold::group_joints({.joint = f.w.joint, .body = f.w.body, .frame = f.graph()},
                           f.tuning.phases);
}

// Runs twice per step_frame. Each run's time is added to `needed_by`, the stage that needs the
// colliders.
void place_colliders(const FrameContext& f, Stage needed_by) {
    const StageTimer timer(needed_by, f.stats);
    World& w = f.w;
    handhold::place_colliders({.persistent_id = w.persistent_id,
                               .collider = w.collider,
                               .filter = w.filter,
                               .body = w.body,
                               .body_pose = w.body_pose,
                               .body_start = w.body_start,
                               .body_velocity = w.body_velocity,
                               .origin = w.player_origin,
                               .player_start = w.player_start,
                               .head = w.head_tracking,
                               .last_valid = w.last_valid,
                               .collision = f.collision(),
                               .frame = f.graph()},
                              f.tuning.head);
}

namespace {

GrabRules grab_rules(const World& w) {
    return {.rule = w.grab_rule, .layers = w.grab_layers, .filter = w.filter};
}

}  // namespace

void pose_grippable_bodies(const FrameContext& f, Entity asking) {
    const StageTimer timer(Stage::update_grabs, f.stats);
    World& w = f.w;
    handhold::pose_grippable_bodies({.origin = w.player_origin,
                                     .head = w.head_tracking,
                                     .measures = w.body_measures,
                                     .owner = w.hand_owner,
                                     .hand = w.hand_tracking,
                                     .grab = w.grab,
                                     .body_hold = w.body_hold,
                                     .pull = w.hand_pull,
                                     .asking = asking,
                                     .bodies = f.graph().grippable_bodies,
                                     .players = f.graph().grippable_players},
                                    f.tuning);
}

GrabSearch grab_search(const FrameContext& f) {
    World& w = f.w;
    return {.start_s = f.start_s(),
            .dt_s = f.dt_s(),
            .surfaces = f.surfaces(),
            .persistent_id = w.persistent_id,
            .owner = w.hand_owner,
            .hand = w.hand_tracking,
            .origin = w.player_origin,
            .head = w.head_tracking,
            .body = w.body,
            .body_pose = w.body_pose,
            .joint_groups = f.graph().joint_groups,
            .authored_grips = w.authored_grips,
            .rules = grab_rules(w),
            .grippable = f.graph().grippable_bodies,
            .measures = w.body_measures,
            .pull = w.hand_pull,
            .reference = w.reference_velocity,
            .sight = w.hand_sight,
            .grab = w.grab,
            .authored_hold = w.authored_hold,
            .head_ignores = w.head_ignores,
            .body_hold = w.body_hold,
            .order = w.grab_order,
            .closing = f.caches.closing_hands};
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
    handhold::locomote_players({.dt_s = f.dt_s(),
                                .start_s = f.start_s(),
                                .scene_velocity_mps = w.reference_velocity_mps,
                                .commands = w.player_commands,
                                .head = w.head_tracking,
                                .owner = w.hand_owner,
                                .hand = w.hand_tracking,
                                .grab = w.grab,
                                .body_pose = w.body_pose,
                                .body_velocity = w.body_velocity,
                                .move_target = w.move_target,
                                .origin = w.player_origin,
                                .velocity = w.player_velocity,
                                .reference = w.reference_velocity,
                                .body_hold = w.body_hold},
                               f.tuning.locomotion);
}

void pull_bodies(const FrameContext& f) {
    const StageTimer timer(Stage::locomote_players, f.stats);
    World& w = f.w;
    handhold::pull_bodies({.dt_s = f.dt_s(),
                           .surfaces = f.surfaces(),
                           .persistent_id = w.persistent_id,
                           .owner = w.hand_owner,
                           .hand = w.hand_tracking,
                           .grab = w.grab,
                           .sight = w.hand_sight,
                           .player = w.player,
                           .origin = w.player_origin,
                           .body = w.body,
                           .body_pose = w.body_pose,
                           .joint_groups = f.graph().joint_groups,
                           .rules = grab_rules(w),
                           .pull = w.hand_pull,
                           .body_velocity = w.body_velocity,
                           .player_velocity = w.player_velocity},
                          f.tuning, f.stats);
}

// --- Prediction ----------------------------------------------------------------------------------

void animate_movers(const FrameContext& f) {
    const StageTimer timer(Stage::animate_movers, f.stats);
    World& w = f.w;
    handhold::animate_movers({.dt_s = f.dt_s(),
                              .end_s = f.end_s(),
                              .mover = w.mover,
                              .path_mover = w.path_mover,
                              .leg_mover = w.leg_mover,
                              .target = w.move_target,
                              .body_pose = w.body_pose,
                              .body_start = w.body_start,
                              .velocity = w.body_velocity},
                             f.tuning.tracking);
}

void predict_bodies(const FrameContext& f) {
    const StageTimer timer(Stage::predict_bodies, f.stats);
    World& w = f.w;
    handhold::predict_bodies({.dt_s = f.dt_s(),
                              .gravity_mps2 = w.gravity_mps2,
                              .gravity_scale = w.gravity_scale,
                              .body = w.body,
                              .player_velocity = w.player_velocity,
                              .body_pose = w.body_pose,
                              .body_start = w.body_start,
                              .body_velocity = w.body_velocity,
                              .origin = w.player_origin,
                              .player_start = w.player_start});
}

void anchor_grabs(const FrameContext& f) {
    const StageTimer timer(Stage::anchor_grabs, f.stats);
    World& w = f.w;
    handhold::anchor_grabs({.start_s = f.start_s(),
                            .end_s = f.end_s(),
                            .owner = w.hand_owner,
                            .hand = w.hand_tracking,
                            .hand_history = w.hand_history,
                            .player_start = w.player_start,
                            .origin = w.player_origin,
                            .head = w.head_tracking,
                            .body_start = w.body_start,
                            .body_pose = w.body_pose,
                            .authored_hold = w.authored_hold,
                            .body = w.body,
                            .joint = w.joint,
                            .joint_state = w.joint_state,
                            .body_hold = w.body_hold,
                            .grab = w.grab},
                           f.tuning, f.stats);
}

// --- Constraints and solve -----------------------------------------------------------------------

void find_contacts(const FrameContext& f) {
    const StageTimer timer(Stage::find_contacts, f.stats);
    World& w = f.w;
    handhold::find_contacts({.persistent_id = w.persistent_id,
                             .body = w.body,
                             .joint = w.joint,
                             .owner = w.hand_owner,
                             .grab = w.grab,
                             .collision = f.collision(),
                             .head_ignores = w.head_ignores,
                             .frame = f.graph()},
                            f.tuning.contact);
}

void clear_contacts(const FrameContext& f) { f.graph().contacts.clear(); }

void build_constraints(const FrameContext& f) {
    const StageTimer timer(Stage::build_constraints, f.stats);
    World& w = f.w;
    handhold::build_constraints({.dt_s = f.dt_s(),
                                 .persistent_id = w.persistent_id,
                                 .body = w.body,
                                 .body_pose = w.body_pose,
                                 .body_velocity = w.body_velocity,
                                 .joint = w.joint,
                                 .joint_state = w.joint_state,
                                 .player = w.player,
                                 .origin = w.player_origin,
                                 .player_velocity = w.player_velocity,
                                 .head = w.head_tracking,
                                 .owner = w.hand_owner,
                                 .grab = w.grab,
                                 .body_hold = w.body_hold,
                                 .frame = f.graph()},
                                f.tuning);
}

void solve_phases(const FrameContext& f) {
    const StageTimer timer(Stage::solve_phases, f.stats);
    handhold::solve_phases({.collision = f.collision(), .frame = f.graph()}, f.tuning, f.stats);
}

void finish_positions(const FrameContext& f) {
    const StageTimer timer(Stage::solve_phases, f.stats);
    World& w = f.w;
    handhold::finish_positions({.dt_s = f.dt_s(),
                                .head = w.head_tracking,
                                .player_velocity = w.player_velocity,
                                .collision = f.collision(),
                                .frame = f.graph(),
                                .body_pose = w.body_pose,
                                .origin = w.player_origin,
                                .grab = w.grab},
                               f.tuning.contact, f.tuning.head, f.stats);
}

void solve_velocities(const FrameContext& f) {
    const StageTimer timer(Stage::solve_velocities, f.stats);
    handhold::solve_velocities({.reference = f.w.reference_velocity,
                                .origin = f.w.player_origin,
                                .frame = f.graph(),
                                .body_velocity = f.w.body_velocity,
                                .player_velocity = f.w.player_velocity},
                               f.tuning, f.stats);
}

void book_momentum(const FrameContext& f) {
    const StageTimer timer(Stage::book_momentum, f.stats);
    handhold::book_momentum(f.graph().graph, f.stats.ledger);
}

void record_valid_poses(const FrameContext& f) {
    const StageTimer timer(Stage::record_valid_poses, f.stats);
    handhold::record_valid_poses(
        {.head = f.w.head_tracking, .frame = f.graph(), .last_valid = f.w.last_valid});
}

void limit_velocities(const FrameContext& f) {
    const StageTimer timer(Stage::solve_velocities, f.stats);
    World& w = f.w;
    handhold::limit_velocities({.owner = w.hand_owner,
                                .reference = w.reference_velocity,
                                .origin = w.player_origin,
                                .frame = f.graph(),
                                .body_velocity = w.body_velocity,
                                .player_velocity = w.player_velocity,
                                .grab = w.grab},
                               f.tuning.locomotion, f.stats);
}

void update_joints(const FrameContext& f) {
    const StageTimer timer(Stage::update_joints, f.stats);
    handhold::update_joints(
        {.dt_s = f.dt_s(), .frame = f.graph(), .joint = f.w.joint, .state = f.w.joint_state});
}

void discard_broken_results(const FrameContext& f) {
    const StageTimer timer(Stage::update_joints, f.stats);
    World& w = f.w;
    handhold::discard_broken_results({.body_start = w.body_start,
                                      .player_start = w.player_start,
                                      .body_pose = w.body_pose,
                                      .body_velocity = w.body_velocity,
                                      .player_origin = w.player_origin,
                                      .player_velocity = w.player_velocity,
                                      .last_valid = w.last_valid,
                                      .joint_state = w.joint_state,
                                      .grab = w.grab,
                                      .frame = f.graph()},
                                     f.stats);
}

// --- Frames that a host solves -------------------------------------------------------------------

void accept_solution(const FrameContext& f, std::span<const SolvedPlayer> solved) {
    World& w = f.w;
    f.stats.hand_error_m = handhold::accept_solution({.players = solved,
                                                      .body_pose = w.body_pose,
                                                      .body_velocity = w.body_velocity,
                                                      .frame = f.graph(),
                                                      .origin = w.player_origin,
                                                      .velocity = w.player_velocity,
                                                      .grab = w.grab,
                                                      .last_valid = w.last_valid});
}

void clear_solution(const FrameContext& f) {
    clear_contacts(f);
    f.graph().graph.blocks.clear();
    f.graph().push_backs.clear();
}

void keep_holds(const FrameContext& f) {
    World& w = f.w;
    handhold::keep_holds({.scene_velocity_mps = w.reference_velocity_mps,
                          .owner = w.hand_owner,
                          .hand = w.hand_tracking,
                          .body = w.body,
                          .body_pose = w.body_pose,
                          .body_velocity = w.body_velocity,
                          .origin = w.player_origin,
                          .grab = w.grab,
                          .reference = w.reference_velocity});
}

}  // namespace handhold::stages
