#include "components/world_edit.hpp"

#include <cmath>

#include "components/hand_indices.hpp"
#include "engine/core/check.hpp"

namespace handhold {
namespace {

void check_place(const char* caller, const Pose& pose_ws) {
    const bool is_near = pose_ws.position.cwiseAbs().maxCoeff() <= world_limits::k_max_coordinate_m;
    if (!is_valid(pose_ws) || !is_near) {
        fail_precondition(caller, "the pose is not valid", number_text(pose_ws.position.norm()));
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
        *target = {.pose_ws = pose_ws};
    }
}

bool is_carried(const World& world, const Grab& grab) {
    return grab.kind == GripKind::held && world.body.contains(grab.body) &&
           world.joints_by_body.of(grab.body).empty();
}

// Poses in a body's frame, in a new frame that lies at `frame` in the old one.
struct Reframed {
    Pose old_in_new;

    void operator()(Pose& pose_bs) const { pose_bs = old_in_new * pose_bs; }
    void operator()(Vec3& point_bs) const { point_bs = transform_point(old_in_new, point_bs); }
};

void reframe_joints(World& world, Entity body, const Reframed& reframe) {
    sync_index(world);
    for (const Entity entity : world.joints_by_body.of(body)) {
        Joint& joint = world.joint.at(entity);
        reframe(joint.a == body ? joint.frame_a_bs : joint.frame_b_bs);
    }
}

void reframe_hands(World& world, Entity body, const Reframed& reframe) {
    for (Grab& grab : world.grab.elements()) {
        if (grab.kind != GripKind::none && grab.body == body) {
            reframe(grab.anchor_bs);
            reframe(grab.hit_bs);
            grab.hit_normal_bs = reframe.old_in_new.rotation * grab.hit_normal_bs;
        }
    }
    for (AuthoredHold& hold : world.authored_hold.elements()) {
        if (hold.body == body) {
            reframe(hold.hand.wrist_bs);
        }
    }
    for (HandSight& sight : world.hand_sight.elements()) {
        if (sight.frame == body) {
            reframe(sight.outside_bs);
        }
    }
    for (ReferenceVelocity& reference : world.reference_velocity.elements()) {
        if (reference.body == body) {
            reframe(reference.point_bs);
        }
    }
    if (AuthoredGrips* const grips = world.authored_grips.find(body)) {
        for (AuthoredGrip& grip : grips->grips) {
            for (AuthoredHand& hand : grip.hands) {
                reframe(hand.wrist_bs);
            }
        }
    }
}

bool has_mover(const World& world, Entity body) {
    return world.mover.contains(body) || world.path_mover.contains(body) ||
           world.leg_mover.contains(body);
}

}  // namespace

void forget_surface(World& world, Entity body) {
    for (std::size_t index = 0; index < world.grip_surface.size(); ++index) {
        GripSurface& surface = world.grip_surface.elements()[index];
        FingerPose& fingers = world.finger_pose.at(world.grip_surface.owners()[index]);
        if (surface.body == body) {
            surface = {};
        }
        if (fingers.closed_body == body || fingers.fitted_body == body) {
            fingers.closed_body = fingers.fitted_body = k_no_entity;
            fingers.fitted_signature = 0;
            fingers.is_converged = false;
        }
    }
}

void change_body(World& world, Entity entity, const RigidBody& body) {
    HH_CHECK(world.body.contains(entity), "no body with this handle", entity.slot);
    check_rigid_body(body, __func__);
    const BodyKind before = world.body.at(entity).kind;
    world.body.at(entity) = body;
    if (body.kind == before) {
        return;
    }
    const Pose pose_ws = world.body_pose.at(entity).pose_ws;
    world.body_start.at(entity).pose_ws = pose_ws;
    world.last_valid.remove(entity);
    if (body.kind == BodyKind::free) {
        world.last_valid.add(entity, {pose_ws, true});
    } else {
        world.body_velocity.at(entity) = {};
    }
    if (before == BodyKind::kinematic) {
        world.move_target.remove(entity);
        world.mover.remove(entity);
        world.path_mover.remove(entity);
        world.leg_mover.remove(entity);
    }
}

void change_shape(World& world, Entity body, ShapeId shape, const Pose& frame) {
    HH_CHECK(world.body.contains(body), "no body with this handle", body.slot);
    check_place(__func__, frame);
    const Pose old_ws = world.body_pose.at(body).pose_ws;
    const Pose new_ws = old_ws * frame;
    check_place(__func__, new_ws);
    const bool is_moved = frame.position != Vec3::Zero() || frame.rotation.vec() != Vec3::Zero();
    HH_CHECK(!is_moved || !has_mover(world, body), "the body has a mover", body.slot);
    const Collider* const before = world.collider.find(body);
    if (!is_moved && (before == nullptr ? k_no_shape : before->shape) == shape) {
        return;
    }
    world.collider.remove(body);
    if (shape != k_no_shape) {
        world.collider.add(body, {shape});
    }
    forget_surface(world, body);
    if (!is_moved) {
        return;
    }
    const Reframed reframe{inverse(frame)};
    reframe_joints(world, body, reframe);
    reframe_hands(world, body, reframe);
    BodyVelocity& velocity = world.body_velocity.at(body);
    const Vec3 offset_m = new_ws.position - old_ws.position;
    velocity.linear_mps += velocity.angular_radps.cross(offset_m);
    world.body_pose.at(body).pose_ws = new_ws;
    Pose& start_ws = world.body_start.at(body).pose_ws;
    start_ws = start_ws * frame;
    if (LastValidPose* const valid = world.last_valid.find(body)) {
        valid->pose_ws = valid->pose_ws * frame;
    }
    if (MoveTarget* const target = world.move_target.find(body)) {
        target->pose_ws = target->pose_ws * frame;
        for (MoveTarget::Move& move : target->moves) {
            move.moved_m += move.turned_rad.cross(offset_m);
        }
    }
}

void move_kinematic(World& world, Entity body, const Pose& pose_ws) {
    HH_CHECK(world.body.contains(body), "no body with this handle", body.slot);
    HH_CHECK(world.body.at(body).kind == BodyKind::kinematic, "the body is not kinematic",
             body.slot);
    HH_CHECK(!has_mover(world, body), "the body has a mover", body.slot);
    check_place(__func__, pose_ws);
    if (MoveTarget* const target = world.move_target.find(body)) {
        target->pose_ws = pose_ws;
    } else {
        world.move_target.add(body, {.pose_ws = pose_ws});
    }
}

void teleport_body(World& world, Entity body, const Pose& pose_ws) {
    HH_CHECK(world.body.contains(body), "no body with this handle", body.slot);
    check_place(__func__, pose_ws);
    let_go_of(world, body, k_no_entity);
    for (HandSight& sight : world.hand_sight.elements()) {
        if (sight.frame == body) {
            sight = {};  // outside_bs moved with the body, but the hand did not
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
    // Players and their pairs of hands have the same order unless some were removed, so the search
    // begins there: hosts ask for each hand of each player in every frame.
    const std::size_t hands = world.hand_owner.size();
    const std::size_t begin = 2 * world.player.find_index(player);
    for (std::size_t i = 0; i < hands; ++i) {
        const std::size_t index = (begin + i) % hands;
        const HandOwner& owner = world.hand_owner.elements()[index];
        if (owner.player == player && owner.side == side) {
            return world.hand_owner.owners()[index];
        }
    }
    fail_precondition(__func__, "the player has no such hand", std::to_string(player.slot));
}

}  // namespace handhold
