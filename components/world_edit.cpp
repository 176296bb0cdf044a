#include "components/world_edit.hpp"

#include <cmath>

#include "components/hand_indices.hpp"
#include "engine/core/check.hpp"

namespace handhold {
namespace {

void check_place(const char* caller, const Pose& pose_ws) {
    const bool is_near = pose_ws.position.cwiseAbs().maxCoeff() <= world_limits::k_max_coordinate_m;
    if (!is_valid(pose_ws) || !is_near) {
        fail_precondition(caller, "the pose is not valid", std::to_string(pose_ws.position.norm()));
    }
}

void let_go(World& world, std::size_t index) {
    const Entity hand = world.grab.owners()[index];
    world.grab.elements()[index] = {};
    world.authored_hold.remove(hand);
    world.body_hold.remove(hand);
    world.hand_pull.remove(hand);
}

void let_go_of(World& world, Entity gripped, Entity keeper) {
    for (std::size_t index = 0; index < world.grab.size(); ++index) {
        const Entity player = world.hand_owner.at(world.grab.owners()[index]).player;
        if (world.grab.elements()[index].body == gripped && player != keeper) {
            let_go(world, index);
        }
    }
}

void place_body(World& world, Entity body, const Pose& pose_ws) {
    world.body_pose.at(body).pose_ws = pose_ws;
    world.body_start.at(body).pose_ws = pose_ws;
    if (LastValidPose* const valid = world.last_valid.find(body)) {
        *valid = {pose_ws, true};
    }
    if (MoveTarget* const target = world.move_target.find(body)) {
        target->pose_ws = pose_ws;
    }
}

bool is_carried(const World& world, const Grab& grab) {
    return grab.kind == GripKind::held && world.body.contains(grab.body) &&
           world.joints_by_body.of(grab.body).empty();
}

}  // namespace

void move_kinematic(World& world, Entity body, const Pose& pose_ws) {
    HH_CHECK(world.body.contains(body), "no body with this handle", body.slot);
    HH_CHECK(world.body.at(body).kind == BodyKind::kinematic, "the body is not kinematic",
             body.slot);
    HH_CHECK(!world.mover.contains(body) && !world.path_mover.contains(body) &&
                 !world.leg_mover.contains(body),
             "the body has a mover", body.slot);
    check_place(__func__, pose_ws);
    if (MoveTarget* const target = world.move_target.find(body)) {
        target->pose_ws = pose_ws;
    } else {
        world.move_target.add(body, {pose_ws});
    }
}

void teleport_body(World& world, Entity body, const Pose& pose_ws) {
    HH_CHECK(world.body.contains(body), "no body with this handle", body.slot);
    check_place(__func__, pose_ws);
    let_go_of(world, body, k_no_entity);
    for (HandSight& sight : world.hand_sight.elements()) {
        if (sight.frame == body) {
            sight = {};  // the hand does not move: its sight is found again
        }
    }
    place_body(world, body, pose_ws);
}

void teleport_player(World& world, Entity player, const Pose& origin_ws) {
    HH_CHECK(world.player.contains(player), "no player with this handle", player.slot);
    check_place(__func__, origin_ws);
    sync_index(world);
    const Pose moved = origin_ws * inverse(world.player_origin.at(player).pose_ws);
    let_go_of(world, player, k_no_entity);
    Entity carried_before = k_no_entity;
    for (std::size_t index = 0; index < world.grab.size(); ++index) {
        const Entity hand = world.grab.owners()[index];
        if (world.hand_owner.at(hand).player != player) {
            continue;
        }
        world.hand_sight.at(hand) = {};  // the hand is repositioned: no wall test on the path
        const Grab& grab = world.grab.elements()[index];
        if (!is_carried(world, grab)) {
            let_go(world, index);
            continue;
        }
        const Entity body = grab.body;
        if (body != carried_before) {  // not twice if both hands hold it
            let_go_of(world, body, player);
            place_body(world, body, moved * world.body_pose.at(body).pose_ws);
            BodyVelocity& velocity = world.body_velocity.at(body);
            velocity = {world.reference_velocity_mps, moved.rotation * velocity.angular_radps};
            carried_before = body;
        }
    }
    world.player_origin.at(player).pose_ws = origin_ws;
    world.player_start.at(player).pose_ws = origin_ws;
    world.player_velocity.at(player).linear_mps = world.reference_velocity_mps;
    world.reference_velocity.at(player) = {world.reference_velocity_mps, k_no_entity};
    world.last_valid.at(player).known = false;
}

Entity hand_of(const World& world, Entity player, HandSide side) {
    HH_CHECK(world.player.contains(player), "no player with this handle", player.slot);
    for (std::size_t index = 0; index < world.hand_owner.size(); ++index) {
        const HandOwner& owner = world.hand_owner.elements()[index];
        if (owner.player == player && owner.side == side) {
            return world.hand_owner.owners()[index];
        }
    }
    fail_precondition(__func__, "the player has no such hand", std::to_string(player.slot));
}

}  // namespace handhold
