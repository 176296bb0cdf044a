#include "components/world.hpp"

#include <string>

#include "engine/core/check.hpp"

namespace handhold {
namespace {

void check_name_is_free(const World& world, std::string_view name) {
    const PersistentId id = persistent_id_from_name(name);
    HH_CHECK(is_null(find_by_id(world, id)), "the name is taken", id.value);
}

Entity add_named(World& world, std::string_view name) {
    check_name_is_free(world, name);
    const Entity entity = world.entities.create();
    world.persistent_id.add(entity, persistent_id_from_name(name));
    return entity;
}

}  // namespace

Entity add_body(World& world, const BodyDescription& description) {
    const RigidBody& body = description.body;
    HH_CHECK(is_valid(description.pose_ws), "the pose is not valid",
             description.pose_ws.rotation.norm());
    HH_CHECK(
        body.kind != BodyKind::free || (body.mass_kg > 0.0 && body.inertia_kgm2.minCoeff() > 0.0),
        "a free body needs a mass and moments of inertia", body.mass_kg);
    const Entity entity = add_named(world, description.name);
    world.body.add(entity, body);
    world.body_pose.add(entity, {description.pose_ws});
    world.body_start.add(entity, {description.pose_ws});
    world.body_velocity.add(entity, description.velocity);
    if (description.shape != k_no_shape) {
        world.collider.add(entity, {description.shape});
    }
    if (body.kind == BodyKind::free) {
        world.last_valid.add(entity, {description.pose_ws});
    }
    return entity;
}

Entity add_joint(World& world, const JointDescription& description) {
    const Joint& joint = description.joint;
    HH_CHECK(world.body.contains(joint.b), "a joint's second body must exist", joint.b.slot);
    HH_CHECK(is_null(joint.a) || world.body.contains(joint.a),
             "a joint's first body must exist, or be null for the world", joint.a.slot);
    HH_CHECK(joint.a != joint.b, "a joint needs two bodies", joint.b.slot);
    HH_CHECK(is_valid(joint.frame_a_bs) && is_valid(joint.frame_b_bs),
             "a joint's frame is not valid", joint.frame_a_bs.rotation.norm());
    HH_CHECK(joint.lower <= joint.upper, "a joint's lower limit is above its upper", joint.lower);
    HH_CHECK(joint.friction >= 0.0 && joint.detent_spacing >= 0.0 && joint.detent_strength >= 0.0 &&
                 joint.latch.catch_range >= 0.0 && joint.latch.strength >= 0.0,
             "friction, detents and latches are not negative", joint.friction);
    const Entity entity = add_named(world, description.name);
    world.joint.add(entity, joint);
    world.joint_state.add(entity);
    return entity;
}

Joint joint_at(const World& world, Joint joint, const Pose& frame_ws) {
    joint.frame_a_bs =
        is_null(joint.a) ? frame_ws : inverse(world.body_pose.at(joint.a).pose_ws) * frame_ws;
    joint.frame_b_bs = inverse(world.body_pose.at(joint.b).pose_ws) * frame_ws;
    return joint;
}

PlayerEntities add_player(World& world, const PlayerDescription& description) {
    HH_CHECK(is_valid(description.origin_ws), "the origin is not valid",
             description.origin_ws.rotation.norm());
    HH_CHECK(description.body.mass_kg > 0.0, "a player needs a mass", description.body.mass_kg);
    const std::string hand_names[k_hand_count] = {std::string(description.name) + "/left_hand",
                                                  std::string(description.name) + "/right_hand"};
    for (const std::string& name : hand_names) {
        check_name_is_free(world, name);
    }
    PlayerEntities made;
    made.player = add_named(world, description.name);
    world.player.add(made.player, description.body);
    world.player_origin.add(made.player, {description.origin_ws});
    world.player_start.add(made.player, {description.origin_ws});
    world.player_velocity.add(made.player, {description.velocity_mps});
    world.player_commands.add(made.player);
    world.reference_velocity.add(made.player, {world.reference_velocity_mps, k_no_entity});
    world.head_tracking.add(made.player);
    world.head_ignores.add(made.player);
    world.collider.add(made.player, {description.head_shape});
    world.last_valid.add(made.player, {description.origin_ws, false});
    world.render_pose.add(made.player);
    world.body_measures.add(made.player, description.measures);
    world.calibration.add(made.player);
    world.arm_memory.add(made.player);
    world.arm_estimate.add(made.player);
    world.arm_pose.add(made.player);
    world.spine_memory.add(made.player);
    world.spine_pose.add(made.player);
    world.body_clip_state.add(made.player);
    for (const HandSide side : {HandSide::left, HandSide::right}) {
        const Entity hand = add_named(world, hand_names[index_of(side)]);
        made.hands[index_of(side)] = hand;
        world.hand_owner.add(hand, {made.player, side});
        world.hand_tracking.add(hand);
        world.hand_history.add(hand);
        world.grab.add(hand);
        world.hand_sight.add(hand);
        world.grip_surface.add(hand);
        world.palm_offset.add(hand);
        world.palm_pose.add(hand);
        world.finger_pose.add(hand);
    }
    return made;
}

bool destroy(World& world, Entity entity) {
    if (!world.entities.is_alive(entity)) {
        return false;
    }
    if (world.player.contains(entity)) {
        for (std::size_t row = world.hand_owner.size(); row-- > 0;) {
            if (world.hand_owner.rows()[row].player == entity) {
                destroy(world, world.hand_owner.owners()[row]);
            }
        }
    }
    if (world.body.contains(entity)) {
        for (std::size_t row = world.joint.size(); row-- > 0;) {
            const Joint& joint = world.joint.rows()[row];
            if (joint.a == entity || joint.b == entity) {
                destroy(world, world.joint.owners()[row]);
            }
        }
    }
    visit_columns(world, [entity](const char*, auto& column) { column.remove(entity); });
    return world.entities.destroy(entity);
}

Entity find_by_id(const World& world, PersistentId id) {
    for (std::size_t row = 0; row < world.persistent_id.size(); ++row) {
        if (world.persistent_id.rows()[row] == id) {
            return world.persistent_id.owners()[row];
        }
    }
    return k_no_entity;
}

}  // namespace handhold
