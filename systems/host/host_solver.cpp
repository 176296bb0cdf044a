// A step around a host's own solver (handhold/your_physics.h): first passes hand constraints to the
// host, then takes the solved poses.
#include <algorithm>

#include "components/play_space.hpp"
#include "systems/frame/frame_of_host.hpp"
#include "systems/host/host_samples.hpp"
#include "systems/host/host_step.hpp"
#include "systems/physics/shared/mass_shares.hpp"

namespace handhold {
namespace {

hh_hand_constraint constraint_of(const hh_world& host, const RowBlock& block, double dt_s) {
    const World& world = host.world;
    const Entity hand = world.grab.owners()[block.source];
    const Grab& grab = world.grab.elements()[block.source];
    const HandOwner& owner = world.hand_owner.at(hand);
    const Quat play_space = world.player_origin.at(owner.player).pose_ws.rotation;
    const Pose target{play_space * grab.target_ps.position,
                      (play_space * grab.target_ps.rotation).normalized()};
    const Pose& body_ws = world.body_pose.at(grab.body).pose_ws;
    hh_hand_constraint out{};
    out.player = id_of<hh_player>(owner.player);
    out.side = owner.side == HandSide::left ? HH_LEFT : HH_RIGHT;
    out.body = id_of<hh_body>(grab.body);
    out.rows = block.kind == RowKind::drive_weld        ? HH_ROWS_WELD
               : block.kind == RowKind::drive_direction ? HH_ROWS_DIRECTION
                                                        : HH_ROWS_POINT;
    out.anchor = to_c(to_host_bs(host, grab.body, grab.anchor_bs));
    out.target = to_c(target);
    out.velocity_mps = to_c(Vec3(play_space * grab.target_velocity_ps_mps));
    out.angular_velocity_radps = to_c(Vec3(play_space * grab.target_spin_ps_radps));
    const Quat body_rotation = block.kind == RowKind::drive_direction
                                   ? Quat(play_space * block.rotation_a_bs)
                                   : Quat(target.rotation * grab.anchor_bs.rotation.conjugate());
    const Pose frame_bs = to_host_bs(host, grab.body, {});  // library's frame in the host's
    out.body_rotation =
        to_c(Pose{Vec3::Zero(), (body_rotation * frame_bs.rotation.conjugate()).normalized()})
            .rotation;
    out.body_angular_velocity_radps = to_c(block.drive_spin_ws_radps);
    out.anchor_end = to_c(body_ws * grab.anchor_bs);
    const double driven_kg = grab.kind == GripKind::held ? world.body.at(grab.body).mass_kg
                                                         : world.player.at(owner.player).mass_kg;
    out.max_force_n = driven_kg * world.player_origin.at(owner.player).scale *
                      host.tuning.tracking.max_hand_speed_mps / dt_s;
    out.is_releasing = grab.phase == GrabPhase::releasing;
    return out;
}

hh_player_motion motion_of(const hh_world& host, Entity player) {
    const World& world = host.world;
    const double scale = world.player_origin.at(player).scale;
    const Quat play_space = world.player_origin.at(player).pose_ws.rotation;
    const HeadTracking& head = world.head_tracking.at(player);
    hh_player_motion out{};
    out.player = id_of<hh_player>(player);
    out.origin = to_c(world.player_start.at(player).pose_ws.position);
    out.velocity_mps = to_c(world.player_velocity.at(player).linear_mps);
    const FrameGraph& frame = host.caches.graph;
    out.mass_kg =
        mass_for_host_kg(frame, find_body(frame.graph, world.persistent_id.at(player).value),
                         world.player.at(player).mass_kg);
    out.head = to_c(Pose{play_space * head_center_ps(head, scale, host.tuning.head),
                         (play_space * head.pose_ps.rotation).normalized()});
    out.head_radius_m = scale * host.tuning.head.radius_m;
    return out;
}

hh_velocity_change change_of(const World& world, Entity body) {
    const BodyVelocity& velocity = world.body_velocity.at(body);
    return {id_of<hh_body>(body), to_c(velocity.linear_mps), to_c(velocity.angular_radps)};
}

void collect_begun_step(hh_world& host, double dt_s) {
    host.hand_constraints.clear();
    host.player_motions.clear();
    host.velocity_changes.clear();
    for (const RowBlock& block : host.caches.graph.hand_blocks) {
        if (host.world.body.contains(host.world.grab.elements()[block.source].body)) {
            host.hand_constraints.push_back(constraint_of(host, block, dt_s));
        }
    }
    for (const Entity player : host.world.player.owners()) {
        host.player_motions.push_back(motion_of(host, player));
    }
    for (const HandPull& pull : host.world.hand_pull.elements()) {
        if (host.world.body.contains(pull.body)) {
            host.velocity_changes.push_back(change_of(host.world, pull.body));
        }
    }
}

// Resets free bodies that the host did not place to their pose and velocity at the step's start:
// their predicted poses must not count as motion.
void keep_unplaced_bodies(hh_world& host) {
    World& world = host.world;
    for (std::size_t index = 0; index < world.body.size(); ++index) {
        if (world.body.elements()[index].kind == BodyKind::free && host.are_placed[index] == 0) {
            const Entity body = world.body.owners()[index];
            world.body_pose.at(body).pose_ws = world.body_start.at(body).pose_ws;
            world.body_velocity.at(body) = host.begun_velocities[index];
        }
    }
}

// Collects the bodies whose velocity differs from the result of the host's solver.
void collect_velocity_changes(hh_world& host) {
    const std::vector<BodyVelocity>& solved = host.solved_velocities;
    host.velocity_changes.clear();
    for (std::size_t index = 0; index < solved.size(); ++index) {
        const BodyVelocity& now = host.world.body_velocity.elements()[index];
        if (now.linear_mps != solved[index].linear_mps ||
            now.angular_radps != solved[index].angular_radps) {
            host.velocity_changes.push_back(
                change_of(host.world, host.world.body_velocity.owners()[index]));
        }
    }
}

// Fills host.solved_players. Nothing else changes.
void read_solved(hh_world& host, const hh_solved_player* players, std::size_t count) {
    require(host.is_stepping, HH_ERROR_STATE, "no step has begun: hh_world_begin_step comes first");
    require(count == 0 || players != nullptr, HH_ERROR_NULL, "the players are null");
    require_at_most(count, host.world.player.size(), "solved players", "players");
    std::vector<SolvedPlayer>& solved = host.solved_players;
    solved.clear();
    for (std::size_t i = 0; i < count; ++i) {
        const Entity player = player_of(host, players[i].player);
        require(std::ranges::find(solved, player, &SolvedPlayer::player) == solved.end(),
                HH_ERROR_VALUE,
                [&] { return "solved player " + std::to_string(i) + ": it is there twice"; });
        solved.push_back({player,
                          checked(players[i].origin, world_limits::k_max_coordinate_m,
                                  "a position beyond 1e9 m, or NaN"),
                          checked(players[i].velocity_mps, world_limits::k_max_speed_mps,
                                  "a velocity beyond 1e6 m/s, or NaN")});
    }
}

template <typename T>
hh_result list_of(const hh_world* world, const std::vector<T> hh_world::*list, const T** first,
                  std::size_t* count) {
    return call([&] {
        const hh_world& host = world_of(world);
        require(first != nullptr && count != nullptr, HH_ERROR_NULL, "an output is null");
        *first = (host.*list).data();
        *count = (host.*list).size();
    });
}

}  // namespace
}  // namespace handhold

using namespace handhold;

hh_result hh_world_begin_step(hh_world* world, double dt_s, const hh_player_input* inputs,
                              size_t input_count) {
    const hh_result result = call([&] {
        require_idle(world_of(world));
        require_no_match(*world);
        read_inputs(*world, dt_s, inputs, input_count);
    });
    if (result != HH_OK) {
        return result;
    }
    return call(
        [&] {
            hh_world& host = *world;
            begin_events(host);
            host.shows_hands = true;
            keep_early_samples(host, host.world.clock.t_s + dt_s);
            host.begun_velocities.clear();
            for (const Entity body : host.world.body.owners()) {
                host.begun_velocities.push_back(host.world.body_velocity.at(body));
            }
            host.are_placed.assign(host.world.body.size(), 0);
            begin_host_frame(host.world, host.caches, host.tuning, {dt_s, host.inputs}, host.stats);
            collect_begun_step(host, dt_s);
            host.begun_dt_s = dt_s;
            host.is_stepping = true;
        },
        HH_ERROR_INTERNAL);
}

hh_result hh_world_hand_constraints(const hh_world* world, const hh_hand_constraint** constraints,
                                    size_t* count) {
    return list_of(world, &hh_world::hand_constraints, constraints, count);
}

hh_result hh_world_player_motions(const hh_world* world, const hh_player_motion** motions,
                                  size_t* count) {
    return list_of(world, &hh_world::player_motions, motions, count);
}

hh_result hh_world_velocity_changes(const hh_world* world, const hh_velocity_change** changes,
                                    size_t* count) {
    return list_of(world, &hh_world::velocity_changes, changes, count);
}

hh_result hh_world_end_step(hh_world* world, const hh_solved_player* players, size_t count) {
    const hh_result result = call([&] { read_solved(world_of(world), players, count); });
    if (result != HH_OK) {
        return result;
    }
    return call(
        [&] {
            hh_world& host = *world;
            host.is_stepping = false;
            host.hand_constraints.clear();
            host.player_motions.clear();
            keep_unplaced_bodies(host);
            const auto velocities = host.world.body_velocity.elements();
            host.solved_velocities.assign(velocities.begin(), velocities.end());
            end_host_frame(host.world, host.caches, host.tuning, {host.begun_dt_s, {}},
                           host.solved_players, host.stats);
            collect_velocity_changes(host);
            finish_events(host);
            host.held_bodies.clear();
            finish_step(host);
        },
        HH_ERROR_INTERNAL);
}
