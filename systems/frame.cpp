#include "systems/frame.hpp"

#include "engine/core/profile.hpp"
#include "systems/arm/estimate_arms.hpp"
#include "systems/arm/pose_arms.hpp"
#include "systems/body/calibrate_players.hpp"
#include "systems/body/layer_additives.hpp"
#include "systems/body/propagate_spine.hpp"
#include "systems/body/publish_body.hpp"
#include "systems/body/publish_pose.hpp"
#include "systems/frame_check.hpp"
#include "systems/hand/constrain_palms.hpp"
#include "systems/hand/fit_hands.hpp"
#include "systems/hand/gather_surroundings.hpp"
#include "systems/hand/search_grip.hpp"
#include "systems/hand/sweep_fingers.hpp"
#include "systems/input/read_paused_tracking.hpp"
#include "systems/input/read_tracking.hpp"
#include "systems/locomotion/anchor_grabs.hpp"
#include "systems/locomotion/locomote_players.hpp"
#include "systems/locomotion/pull_bodies.hpp"
#include "systems/locomotion/update_grabs.hpp"
#include "systems/physics/animate_movers.hpp"
#include "systems/physics/build_constraints.hpp"
#include "systems/physics/discard_broken_results.hpp"
#include "systems/physics/find_contacts.hpp"
#include "systems/physics/finish_positions.hpp"
#include "systems/physics/group_joints.hpp"
#include "systems/physics/place_colliders.hpp"
#include "systems/physics/predict_bodies.hpp"
#include "systems/physics/solve_phases.hpp"
#include "systems/physics/update_joints.hpp"
#include "systems/physics/update_velocities.hpp"

namespace handhold {
namespace {

// Adds a scope's time to its stage, and marks the scope as a zone in traces.
class StageTimer {
  public:
    StageTimer(Stage stage, StageStats& stats)
        : zone_(name_of(stage)),
          stage_us_(stats.stage_us[static_cast<std::size_t>(stage)]),
          begin_ns_(stage_now_ns()) {}
    ~StageTimer() { stage_us_ += 1e-3 * static_cast<double>(stage_now_ns() - begin_ns_); }
    StageTimer(const StageTimer&) = delete;
    StageTimer& operator=(const StageTimer&) = delete;

  private:
    Zone zone_;
    double& stage_us_;
    std::int64_t begin_ns_;
};

// Everything that stages may need. Below, one function per stage selects the columns that it gets.
struct FrameContext {
    World& w;
    FrameCaches& caches;
    const Tuning& tuning;
    const FrameInput& input;
    StageStats& stats;

    double dt_s() const { return input.dt_s; }
    double start_s() const { return w.clock.t_s; }
    double end_s() const { return w.clock.t_s + input.dt_s; }
    FrameGraph& graph() const { return caches.graph; }
    CollisionWorld& collision() const { return caches.collision; }
    HandScratch& hands() const { return caches.hands; }
};

// --- Input and intent ----------------------------------------------------------------------------

void read_tracking(const FrameContext& f) {
    const StageTimer timer(Stage::read_tracking, f.stats);
    World& w = f.w;
    handhold::read_tracking(
        {f.input.players, f.start_s(), f.end_s(), w.hand_owner, w.controller_to_hand,
         w.head_tracking, w.hand_tracking, w.hand_history, w.player_commands},
        f.tuning, f.stats);
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

// Runs twice a frame; its time counts for the stage that needs the colliders.
void place_colliders(const FrameContext& f, Stage needed_by) {
    const StageTimer timer(needed_by, f.stats);
    World& w = f.w;
    handhold::place_colliders(
        {w.persistent_id, w.collider, w.body, w.body_pose, w.body_start, w.player_origin,
         w.player_start, w.head_tracking, w.last_valid, f.collision(), f.graph(), &w.filter},
        f.tuning.head);
}

void update_grabs(const FrameContext& f) {
    const StageTimer timer(Stage::update_grabs, f.stats);
    World& w = f.w;
    handhold::update_grabs({f.collision(),
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
                            f.start_s()},
                           f.tuning, f.stats);
}

void locomote_players(const FrameContext& f) {
    const StageTimer timer(Stage::locomote_players, f.stats);
    World& w = f.w;
    handhold::locomote_players(
        {f.dt_s(), w.reference_velocity_mps, w.player_commands, w.head_tracking, w.hand_owner,
         w.hand_tracking, w.grab, w.body_pose, w.body_velocity, w.player_origin, w.player_velocity,
         w.reference_velocity},
        f.tuning.locomotion);
}

void pull_bodies(const FrameContext& f) {
    const StageTimer timer(Stage::locomote_players, f.stats);
    World& w = f.w;
    handhold::pull_bodies({f.dt_s(),
                           f.collision(),
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
    handhold::anchor_grabs({f.start_s(), f.end_s(), w.hand_owner, w.hand_tracking, w.hand_history,
                            w.player_start, w.player_origin, w.head_tracking, w.body_start,
                            w.body_pose, w.authored_hold, w.body, w.joint, w.joint_state, w.grab},
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
         f.graph()},
        f.tuning);
}

void solve_phases(const FrameContext& f) {
    const StageTimer timer(Stage::solve_phases, f.stats);
    handhold::solve_phases({f.collision(), f.graph()}, f.tuning, f.stats);
}

void finish_positions(const FrameContext& f) {
    const StageTimer timer(Stage::solve_phases, f.stats);
    World& w = f.w;
    handhold::finish_positions({f.collision(), f.graph(), w.body_pose, w.player_origin, w.grab},
                               f.tuning.contact, f.stats);
}

void update_velocities(const FrameContext& f) {
    const StageTimer timer(Stage::update_velocities, f.stats);
    World& w = f.w;
    handhold::update_velocities({w.hand_owner, w.reference_velocity, w.head_tracking, f.graph(),
                                 w.body_velocity, w.player_velocity, w.grab, w.last_valid},
                                f.tuning, f.stats);
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

// --- Shown hands ---------------------------------------------------------------------------------

void gather_surroundings(const FrameContext& f) {
    const StageTimer timer(Stage::gather_surroundings, f.stats);
    World& w = f.w;
    handhold::gather_surroundings(
        {f.caches.meshes_for_hands, f.caches.hand_rigs, f.graph(), w.persistent_id, w.hand_owner,
         w.hand_tracking, w.grab, w.player_origin, w.head_tracking, w.body_pose, w.collider,
         w.authored_hold, f.hands().surroundings, &w.hand_rig, f.caches.more_hand_rigs},
        f.stats);
    f.hands().traces.assign(f.hands().surroundings.size(), {});
}

void search_grip(const FrameContext& f) {
    const StageTimer timer(Stage::search_grip, f.stats);
    handhold::search_grip({f.dt_s(), f.hands().surroundings, f.w.grip_surface, f.hands().search},
                          f.tuning, f.stats);
}

void constrain_palms(const FrameContext& f) {
    const StageTimer timer(Stage::constrain_palms, f.stats);
    handhold::constrain_palms({f.hands().surroundings, f.w.grip_surface, f.w.palm_offset},
                              f.tuning);
}

void sweep_fingers(const FrameContext& f) {
    const StageTimer timer(Stage::sweep_fingers, f.stats);
    World& w = f.w;
    handhold::sweep_fingers({f.hands().surroundings, w.grip_surface, w.palm_offset, w.finger_pose,
                             f.hands().traces, f.hands().fit},
                            f.tuning, f.stats);
}

void fit_hands(const FrameContext& f) {
    const StageTimer timer(Stage::fit_hands, f.stats);
    World& w = f.w;
    handhold::fit_hands({f.dt_s(), f.hands().surroundings, w.hand_tracking, w.grip_surface,
                         w.palm_offset, w.finger_pose, w.palm_pose},
                        f.tuning, f.stats);
}

// --- Shown body ----------------------------------------------------------------------------------

void estimate_arms(const FrameContext& f) {
    const StageTimer timer(Stage::estimate_arms, f.stats);
    World& w = f.w;
    handhold::estimate_arms({f.dt_s(), w.player_origin, w.head_tracking, w.body_measures,
                             w.hand_owner, w.palm_pose, w.arm_memory, w.arm_estimate},
                            f.tuning.arm);
}

void layer_clavicles(const FrameContext& f) {
    const StageTimer timer(Stage::layer_additives, f.stats);
    handhold::layer_clavicles({f.caches.body_clips, f.w.body_measures, f.w.arm_estimate},
                              f.tuning.additive, f.tuning.arm);
}

void pose_arms(const FrameContext& f) {
    const StageTimer timer(Stage::pose_arms, f.stats);
    World& w = f.w;
    handhold::pose_arms(
        {w.player_origin, w.body_measures, w.hand_owner, w.palm_pose, w.arm_estimate, w.arm_pose});
}

void propagate_spine(const FrameContext& f) {
    const StageTimer timer(Stage::propagate_spine, f.stats);
    World& w = f.w;
    handhold::propagate_spine(
        {f.dt_s(), f.end_s(), w.player_origin, w.player_velocity, w.reference_velocity,
         w.body_measures, w.arm_estimate, w.spine_memory, w.spine_pose, &f.collision(),
         &w.head_tracking, &w.persistent_id},
        f.tuning.spine);
}

void layer_additives(const FrameContext& f) {
    const StageTimer timer(Stage::layer_additives, f.stats);
    World& w = f.w;
    handhold::layer_additives(
        {f.dt_s(), f.caches.body_clips, w.head_tracking, w.player_velocity, w.reference_velocity,
         w.hand_owner, w.grab, w.arm_estimate, w.body_clip_state, w.spine_pose},
        f.tuning.additive);
}

void publish_pose(const FrameContext& f) {
    const StageTimer timer(Stage::publish_pose, f.stats);
    World& w = f.w;
    handhold::publish_pose(
        {f.graph(), w.persistent_id, w.player_origin, w.head_tracking, w.hand_owner,
         w.hand_tracking, w.grab, w.palm_pose, w.finger_pose, w.authored_hold, w.render_pose},
        f.tuning);
}

void publish_body(const FrameContext& f) {
    const StageTimer timer(Stage::publish_pose, f.stats);
    handhold::publish_body({f.w.arm_pose, f.w.spine_pose, f.w.render_pose});
}

}  // namespace

void step_frame(World& world, FrameCaches& caches, const Tuning& tuning, const FrameInput& input,
                StageStats& stats) {
    check_frame(world, caches, tuning, input);
    stats.clear();
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
    update_velocities(f);
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
    const FrameContext f{world, caches, tuning, input, stats};
    {
        const StageTimer timer(Stage::read_tracking, stats);
        read_paused_tracking({input.players,
                              world.hand_owner,
                              world.controller_to_hand,
                              world.head_tracking,
                              world.hand_tracking,
                              world.hand_history,
                              {default_controller_to_hand(HandSide::left, tuning.hand),
                               default_controller_to_hand(HandSide::right, tuning.hand)}});
    }
    place_colliders(f, Stage::find_contacts);

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
}

}  // namespace handhold
