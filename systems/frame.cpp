#include "systems/frame.hpp"

#include "engine/core/check.hpp"
#include "engine/core/profile.hpp"
#include "systems/arm/estimate_arms.hpp"
#include "systems/arm/pose_arms.hpp"
#include "systems/body/calibrate_players.hpp"
#include "systems/body/layer_additives.hpp"
#include "systems/body/propagate_spine.hpp"
#include "systems/body/publish_body.hpp"
#include "systems/body/publish_pose.hpp"
#include "systems/hand/constrain_palms.hpp"
#include "systems/hand/gather_surroundings.hpp"
#include "systems/hand/pose_thumb.hpp"
#include "systems/hand/search_grip.hpp"
#include "systems/hand/sweep_fingers.hpp"
#include "systems/input/read_tracking.hpp"
#include "systems/locomotion/anchor_grabs.hpp"
#include "systems/locomotion/locomote_players.hpp"
#include "systems/locomotion/pull_bodies.hpp"
#include "systems/locomotion/update_grabs.hpp"
#include "systems/physics/animate_movers.hpp"
#include "systems/physics/build_constraints.hpp"
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

constexpr double k_shortest_frame_s = 1e-6;
constexpr double k_longest_frame_s = 10.0;

// Times a stage and gives it a zone in traces.
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

void place(World& w, FrameCaches& caches, const Tuning& tuning) {
    place_colliders(
        {w.persistent_id, w.collider, w.body, w.body_pose, w.body_start, w.player_origin,
         w.head_tracking, w.last_valid, caches.collision, caches.graph},
        tuning.head);
}

// What players do, and where they and all bodies would go if nothing were in the way.
void predict(World& w, FrameCaches& caches, const Tuning& tuning, const FrameInput& input,
             StageStats& stats) {
    const double start_s = w.clock.t_s;
    const double end_s = start_s + input.dt_s;
    FrameGraph& graph = caches.graph;
    {
        const StageTimer timer(Stage::read_tracking, stats);
        read_tracking({input.players, start_s, end_s, w.hand_owner, w.controller_to_hand,
                       w.head_tracking, w.hand_tracking, w.hand_history, w.player_commands},
                      tuning, stats);
    }
    {
        const StageTimer timer(Stage::calibrate_players, stats);
        calibrate_players({input.dt_s, w.player_commands, w.head_tracking, w.hand_owner,
                           w.hand_tracking, w.calibration, w.body_measures},
                          tuning.calibration);
    }
    {
        const StageTimer timer(Stage::group_joints, stats);
        group_joints({w.joint, w.body, graph}, tuning.phases);
    }
    {
        const StageTimer timer(Stage::update_grabs, stats);
        place(w, caches, tuning);
        update_grabs({caches.collision, w.persistent_id, w.hand_owner, w.hand_tracking,
                      w.player_origin, w.head_tracking, w.body, w.body_pose, graph.joint_groups,
                      w.authored_grips, w.hand_pull, w.reference_velocity, w.hand_sight, w.grab,
                      w.authored_hold, w.head_ignores},
                     tuning, stats);
    }
    {
        const StageTimer timer(Stage::locomote_players, stats);
        locomote_players({input.dt_s, w.reference_velocity_mps, w.player_commands, w.head_tracking,
                          w.hand_owner, w.hand_tracking, w.grab, w.body_pose, w.body_velocity,
                          w.player_origin, w.player_velocity, w.reference_velocity},
                         tuning.locomotion);
        pull_bodies({input.dt_s, caches.collision, w.persistent_id, w.hand_owner, w.hand_tracking,
                     w.grab, w.hand_sight, w.player, w.player_origin, w.body, w.body_pose,
                     graph.joint_groups, w.hand_pull, w.body_velocity, w.player_velocity},
                    tuning, stats);
    }
    {
        const StageTimer timer(Stage::animate_movers, stats);
        animate_movers({end_s, w.mover, w.path_mover, w.leg_mover, w.body_pose, w.body_start,
                        w.body_velocity});
    }
    {
        const StageTimer timer(Stage::predict_bodies, stats);
        predict_bodies({input.dt_s, w.body, w.player_velocity, w.body_pose, w.body_start,
                        w.body_velocity, w.player_origin, w.player_start});
    }
    {
        const StageTimer timer(Stage::anchor_grabs, stats);
        anchor_grabs({start_s, end_s, w.hand_owner, w.hand_tracking, w.hand_history, w.player_start,
                      w.player_origin, w.head_tracking, w.body_start, w.body_pose, w.authored_hold,
                      w.body, w.joint, w.joint_state, w.grab},
                     tuning, stats);
    }
}

// What is in the way, and what holds together.
void solve(World& w, FrameCaches& caches, const Tuning& tuning, const FrameInput& input,
           StageStats& stats) {
    FrameGraph& graph = caches.graph;
    {
        const StageTimer timer(Stage::find_contacts, stats);
        place(w, caches, tuning);
        find_contacts({w.persistent_id, w.body, w.joint, w.head_tracking, w.hand_owner, w.grab,
                       caches.collision, w.head_ignores, graph},
                      tuning.contact);
    }
    {
        const StageTimer timer(Stage::build_constraints, stats);
        build_constraints({input.dt_s, w.persistent_id, w.body, w.body_pose, w.body_velocity,
                           w.joint, w.joint_state, w.player, w.player_origin, w.player_velocity,
                           w.head_tracking, w.hand_owner, w.grab, graph},
                          tuning);
    }
    {
        const StageTimer timer(Stage::solve_phases, stats);
        solve_phases({caches.collision, graph}, tuning, stats);
        finish_positions({caches.collision, graph, w.body_pose, w.player_origin, w.grab},
                         tuning.contact, stats);
    }
    {
        const StageTimer timer(Stage::update_velocities, stats);
        update_velocities({w.hand_owner, w.reference_velocity, w.head_tracking, graph,
                           w.body_velocity, w.player_velocity, w.grab, w.last_valid},
                          tuning, stats);
    }
    {
        const StageTimer timer(Stage::update_joints, stats);
        update_joints({input.dt_s, graph, w.joint, w.joint_state});
    }
}

// What the hands that are shown hold, and how.
void fit_hands(World& w, FrameCaches& caches, const Tuning& tuning, const FrameInput& input,
               StageStats& stats) {
    HandScratch& hands = caches.hands;
    {
        const StageTimer timer(Stage::gather_surroundings, stats);
        gather_surroundings(
            {caches.meshes_for_hands, caches.hand_rigs, caches.graph, w.persistent_id, w.hand_owner,
             w.hand_tracking, w.grab, w.player_origin, w.head_tracking, w.body_pose, w.collider,
             w.authored_hold, hands.surroundings},
            stats);
        hands.traces.assign(hands.surroundings.size(), {});
    }
    {
        const StageTimer timer(Stage::search_grip, stats);
        search_grip({input.dt_s, hands.surroundings, w.grip_surface, hands.search}, tuning, stats);
    }
    {
        const StageTimer timer(Stage::constrain_palms, stats);
        constrain_palms(
            {input.dt_s, hands.surroundings, w.grip_surface, w.palm_offset, w.palm_pose}, tuning);
    }
    {
        const StageTimer timer(Stage::sweep_fingers, stats);
        sweep_fingers({input.dt_s, hands.surroundings, w.hand_tracking, w.grip_surface, w.palm_pose,
                       w.palm_offset, w.finger_pose, hands.traces, hands.fit},
                      tuning, stats);
    }
    {
        const StageTimer timer(Stage::pose_thumb, stats);
        pose_thumb({input.dt_s, hands.surroundings, w.hand_tracking, w.grip_surface, w.palm_offset,
                    w.finger_pose, hands.traces, hands.fit},
                   tuning, stats);
    }
}

// What follows the head and the hands that are shown.
void follow(World& w, FrameCaches& caches, const Tuning& tuning, const FrameInput& input,
            StageStats& stats) {
    {
        const StageTimer timer(Stage::estimate_arms, stats);
        estimate_arms({input.dt_s, w.player_origin, w.head_tracking, w.body_measures, w.hand_owner,
                       w.palm_pose, w.arm_memory, w.arm_estimate},
                      tuning.arm);
    }
    {
        const StageTimer timer(Stage::layer_additives, stats);
        layer_clavicles({caches.body_clips, w.body_measures, w.arm_estimate}, tuning.additive,
                        tuning.arm);
    }
    {
        const StageTimer timer(Stage::pose_arms, stats);
        pose_arms({w.player_origin, w.body_measures, w.hand_owner, w.palm_pose, w.arm_estimate,
                   w.arm_pose});
    }
    {
        const StageTimer timer(Stage::propagate_spine, stats);
        propagate_spine({input.dt_s, w.clock.t_s + input.dt_s, w.player_origin, w.player_velocity,
                         w.reference_velocity, w.body_measures, w.arm_estimate, w.spine_memory,
                         w.spine_pose, &caches.collision, &w.head_tracking, &w.persistent_id},
                        tuning.spine);
    }
    {
        const StageTimer timer(Stage::layer_additives, stats);
        layer_additives({input.dt_s, caches.body_clips, w.head_tracking, w.player_velocity,
                         w.reference_velocity, w.hand_owner, w.grab, w.arm_estimate,
                         w.body_clip_state, w.spine_pose},
                        tuning.additive);
    }
    {
        const StageTimer timer(Stage::publish_pose, stats);
        publish_pose(
            {caches.graph, w.persistent_id, w.player_origin, w.head_tracking, w.hand_owner,
             w.hand_tracking, w.grab, w.palm_pose, w.finger_pose, w.authored_hold, w.render_pose},
            tuning);
        publish_body({w.arm_pose, w.spine_pose, w.render_pose});
    }
}

}  // namespace

void step_frame(World& w, FrameCaches& caches, const Tuning& tuning, const FrameInput& input,
                StageStats& stats) {
    HH_CHECK(input.dt_s >= k_shortest_frame_s && input.dt_s <= k_longest_frame_s,
             "dt_s must lie between 1e-6 and 10", input.dt_s);
    stats = {};
    predict(w, caches, tuning, input, stats);
    solve(w, caches, tuning, input, stats);
    fit_hands(w, caches, tuning, input, stats);
    follow(w, caches, tuning, input, stats);
    ++w.clock.frame;
    w.clock.t_s += input.dt_s;
}

}  // namespace handhold
