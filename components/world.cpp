#include "components/world.hpp"

#include <algorithm>
#include <functional>
#include <string>
#include <vector>

#include "engine/core/check.hpp"

namespace handhold {

void sync_index(World& world) {
    if (world.entity_by_id.size() != world.persistent_id.size()) {
        world.entity_by_id.clear();
        for (std::size_t index = 0; index < world.persistent_id.size(); ++index) {
            world.entity_by_id.add(world.persistent_id.elements()[index],
                                   world.persistent_id.owners()[index]);
        }
    }
    if (world.joints_by_body.size() != world.joint.size()) {
        world.joints_by_body.clear();
        for (std::size_t index = 0; index < world.joint.size(); ++index) {
            const Joint& joint = world.joint.elements()[index];
            world.joints_by_body.add(world.joint.owners()[index], joint.a, joint.b);
        }
    }
}

namespace {

void check_name_is_unique(const World& world, std::string_view name) {
    const PersistentId id = persistent_id_from_name(name);
    HH_CHECK(is_null(find_by_id(world, id)), "the name is used already", id.value);
}

// Precondition: no entity has this name.
Entity add_named(World& world, std::string_view name) {
    sync_index(world);
    const PersistentId id = persistent_id_from_name(name);
    const Entity entity = world.entities.create();
    world.persistent_id.add(entity, id);
    world.entity_by_id.add(id, entity);
    // Names outlive their entities, because a snapshot may restore a destroyed entity. Once most
    // names belong to destroyed entities, those names are dropped.
    if (world.name_of_id.size() > 2 * world.persistent_id.size() + 64) {
        std::erase_if(world.name_of_id, [&world](const auto& named) {
            return is_null(world.entity_by_id.find({named.first}));
        });
    }
    world.name_of_id.insert_or_assign(id.value, std::string(name));
    return entity;
}

bool is_in(double value, double low, double high) { return value >= low && value <= high; }

// Returns the first coordinate that is NaN or outside [-limit, limit]; 0 if there is none.
double beyond(const Vec3& v, double limit) {
    for (const double x : v) {
        if (!is_in(x, -limit, limit)) {
            return x;
        }
    }
    return 0.0;
}

bool is_within(const Vec3& v, double limit) {
    return beyond(v, limit) == 0.0;  // also false if a coordinate is NaN
}

bool is_in_world(const Pose& pose) {
    return is_valid(pose) && is_within(pose.position, world_limits::k_max_coordinate_m);
}

double wrong_number_of(const Pose& pose) {
    return is_within(pose.position, world_limits::k_max_coordinate_m)
               ? pose.rotation.norm()
               : beyond(pose.position, world_limits::k_max_coordinate_m);
}

}  // namespace

void check_rigid_body(const RigidBody& body, const char* caller) {
    const auto check = [caller](bool is_good, const char* what, double value) {
        if (!is_good) {
            fail_precondition(caller, what, number_text(value));
        }
    };
    const bool is_free = body.kind == BodyKind::free;
    check(is_in(body.mass_kg, is_free ? world_limits::k_min_mass_kg : 0.0,
                world_limits::k_max_mass_kg),
          "a free body needs a mass within 1e-12 to 1e15 kg", body.mass_kg);
    for (const double inertia : body.inertia_kgm2) {
        check(is_in(inertia, is_free ? world_limits::k_min_inertia_kgm2 : 0.0,
                    world_limits::k_max_inertia_kgm2),
              "a free body needs moments of inertia within 1e-24 to 1e18 kg m^2", inertia);
    }
    check(is_in(body.restitution, 0.0, 1.0), "the restitution must lie in [0, 1]",
          body.restitution);
    check(is_in(body.friction, 0.0, world_limits::k_max_friction),
          "the friction must lie in [0, 1e6]", body.friction);
}

namespace {

void check_body(const World& world, const BodyDescription& description, const char* caller) {
    const auto check = [caller](bool is_good, const char* what, double value) {
        if (!is_good) {
            fail_precondition(caller, what, number_text(value));
        }
    };
    check(is_in_world(description.pose_ws), "the pose is not valid",
          wrong_number_of(description.pose_ws));
    check_rigid_body(description.body, caller);
    const BodyVelocity& velocity = description.velocity;
    check(is_within(velocity.linear_mps, world_limits::k_max_speed_mps),
          "the velocity is beyond 1e6 m/s",
          beyond(velocity.linear_mps, world_limits::k_max_speed_mps));
    check(is_within(velocity.angular_radps, world_limits::k_max_spin_radps),
          "the spin is beyond 1e4 rad/s",
          beyond(velocity.angular_radps, world_limits::k_max_spin_radps));
    check_name_is_unique(world, description.name);
}

const Shape& known_shape(ShapeId shape, const ShapeLibrary& shapes, const char* caller) {
    if (!shapes.has(shape)) {
        fail_precondition(caller, "no shape with this id", std::to_string(shape.index));
    }
    return shapes.at(shape);
}

}  // namespace

Entity add_body(World& world, const BodyDescription& description) {
    check_body(world, description, __func__);
    const RigidBody& body = description.body;
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

Entity add_body(World& world, const BodyDescription& description, const ShapeLibrary& shapes) {
    if (description.shape != k_no_shape) {
        const Shape& shape = known_shape(description.shape, shapes, __func__);
        HH_CHECK(description.body.kind != BodyKind::free || shape.kind != ShapeKind::mesh,
                 "a free body cannot have a mesh", description.shape.index);
    }
    return add_body(world, description);
}

namespace {

void check_numbers_of(const Joint& joint, const char* caller) {
    const auto check = [caller](bool is_good, const char* what, double value) {
        if (!is_good) {
            fail_precondition(caller, what, number_text(value));
        }
    };
    const auto is_coordinate = [](double number) {
        return is_in(number, -world_limits::k_max_joint_coordinate,
                     world_limits::k_max_joint_coordinate);
    };
    const JointLatch& latch = joint.latch;
    for (const double coordinate : {joint.lower, joint.upper, latch.at, latch.handle_at}) {
        check(is_coordinate(coordinate), "a joint's coordinates must lie within 1e9", coordinate);
    }
    check(joint.lower <= joint.upper, "a joint's lower limit is above its upper", joint.lower);
    for (const double number : {joint.friction, joint.detent_spacing, joint.detent_strength,
                                latch.catch_range, latch.strength}) {
        check(is_in(number, 0.0, world_limits::k_max_joint_strength),
              "friction, detents and latches must lie in [0, 1e15]", number);
    }
    const JointMotor& motor = joint.motor;
    check(motor.kind == MotorKind::none || joint.kind == JointKind::hinge ||
              joint.kind == JointKind::slider,
          "only hinges and sliders have motors", static_cast<double>(joint.kind));
    for (const double number : {motor.speed, motor.position}) {
        check(is_coordinate(number), "a motor's speed and position must lie within 1e9", number);
    }
    check(is_in(motor.time_s, 0.0, world_limits::k_max_joint_coordinate),
          "a motor's time must lie in [0, 1e9] s", motor.time_s);
    check(is_in(motor.strength, 0.0, world_limits::k_max_joint_strength),
          "a motor's strength must lie in [0, 1e15]", motor.strength);
}

}  // namespace

void check_joint_numbers(const Joint& joint) { check_numbers_of(joint, __func__); }

Entity add_joint(World& world, const JointDescription& description) {
    const Joint& joint = description.joint;
    HH_CHECK(world.body.contains(joint.b), "a joint's second body does not exist", joint.b.slot);
    HH_CHECK(is_null(joint.a) || world.body.contains(joint.a),
             "a joint's first body must exist, or be null for the world", joint.a.slot);
    HH_CHECK(joint.a != joint.b, "a joint needs two bodies", joint.b.slot);
    HH_CHECK(is_in_world(joint.frame_a_bs), "a joint's frame is not valid",
             wrong_number_of(joint.frame_a_bs));
    HH_CHECK(is_in_world(joint.frame_b_bs), "a joint's frame is not valid",
             wrong_number_of(joint.frame_b_bs));
    check_numbers_of(joint, __func__);
    HH_CHECK(is_null(joint.latch.handle) || world.joint.contains(joint.latch.handle),
             "a latch's handle must be a joint, or null", joint.latch.handle.slot);
    check_name_is_unique(world, description.name);
    const Entity entity = add_named(world, description.name);
    world.joint.add(entity, joint);
    world.joint_state.add(entity);
    world.joints_by_body.add(entity, joint.a, joint.b);
    return entity;
}

Joint joint_at(const World& world, Joint joint, const Pose& frame_ws) {
    joint.frame_a_bs =
        is_null(joint.a) ? frame_ws : inverse(world.body_pose.at(joint.a).pose_ws) * frame_ws;
    joint.frame_b_bs = inverse(world.body_pose.at(joint.b).pose_ws) * frame_ws;
    return joint;
}

PlayerEntities add_player(World& world, const PlayerDescription& description) {
    HH_CHECK(is_in_world(description.origin_ws), "the origin is not valid",
             wrong_number_of(description.origin_ws));
    HH_CHECK(
        is_in(description.body.mass_kg, world_limits::k_min_mass_kg, world_limits::k_max_mass_kg),
        "a player needs a mass within 1e-12 to 1e15 kg", description.body.mass_kg);
    HH_CHECK(is_within(description.velocity_mps, world_limits::k_max_speed_mps),
             "the velocity is beyond 1e6 m/s",
             beyond(description.velocity_mps, world_limits::k_max_speed_mps));
    HH_CHECK(is_in(description.scale, PlayerOrigin::k_min_scale, PlayerOrigin::k_max_scale),
             "a player's scale must lie within 0.01 to 100", description.scale);
    const WrongMeasure wrong = wrong_measure(description.measures, 1.0);
    HH_CHECK(wrong.name == nullptr,
             (std::string(wrong.name) + " must lie within 0.05 to 5 m").c_str(), wrong.value_m);
    check_name_is_unique(world, description.name);
    const std::string hand_names[k_hand_count] = {std::string(description.name) + "/left_hand",
                                                  std::string(description.name) + "/right_hand"};
    for (const std::string& name : hand_names) {
        check_name_is_unique(world, name);
    }
    PlayerEntities made;
    made.player = add_named(world, description.name);
    world.player.add(made.player, description.body);
    world.player_origin.add(made.player, {description.origin_ws, description.scale});
    world.player_start.add(made.player, {description.origin_ws});
    world.player_velocity.add(made.player, {description.velocity_mps});
    world.player_commands.add(made.player);
    world.reference_velocity.add(made.player, {world.reference_velocity_mps, k_no_entity});
    world.head_tracking.add(made.player);
    world.head_ignores.add(made.player);
    if (description.head_shape != k_no_shape) {
        world.collider.add(made.player, {description.head_shape});
    }
    world.last_valid.add(made.player, {description.origin_ws, false});
    world.render_pose.add(made.player);
    world.body_measures.add(made.player, scaled(description.measures, description.scale));
    world.calibration.add(made.player);
    world.size_estimate.add(made.player, {.is_measured = description.is_measured});
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

PlayerEntities add_player(World& world, const PlayerDescription& description,
                          const ShapeLibrary& shapes) {
    if (description.head_shape != k_no_shape) {
        const Shape& shape = known_shape(description.head_shape, shapes, __func__);
        HH_CHECK(shape.kind == ShapeKind::sphere, "a head's shape must be a sphere",
                 description.head_shape.index);
    }
    return add_player(world, description);
}

bool destroy(World& world, Entity entity) {
    if (!world.entities.is_alive(entity)) {
        return false;
    }
    sync_index(world);
    if (world.player.contains(entity)) {
        for (std::size_t index = world.hand_owner.size(); index-- > 0;) {
            if (world.hand_owner.elements()[index].player == entity) {
                destroy(world, world.hand_owner.owners()[index]);
            }
        }
    }
    const std::span<const Entity> listed = world.joints_by_body.of(entity);
    std::vector<Entity> joints(listed.begin(), listed.end());
    // Destroys joints from the last to the first, so that the order in which slots become free does
    // not depend on the cache.
    std::ranges::sort(joints, std::ranges::greater(),
                      [&world](Entity joint) { return world.joint.find_index(joint); });
    for (const Entity joint : joints) {
        destroy(world, joint);
    }
    if (const Joint* const joint = world.joint.find(entity)) {
        world.joints_by_body.remove(entity, joint->a, joint->b);
    }
    if (const PersistentId* const id = world.persistent_id.find(entity)) {
        world.entity_by_id.remove(*id);
    }
    visit_columns(world, [entity](const char*, auto& column) { column.remove(entity); });
    return world.entities.destroy(entity);
}

Entity find_by_name(const World& world, std::string_view name) {
    return find_by_id(world, persistent_id_from_name(name));
}

std::string_view name_of(const World& world, Entity entity) {
    const PersistentId* const id = world.persistent_id.find(entity);
    const auto found = id != nullptr ? world.name_of_id.find(id->value) : world.name_of_id.end();
    return found != world.name_of_id.end() ? std::string_view(found->second) : std::string_view();
}

Entity find_by_id(const World& world, PersistentId id) {
    if (world.entity_by_id.size() == world.persistent_id.size()) {
        return world.entity_by_id.find(id);
    }
    for (std::size_t index = 0; index < world.persistent_id.size(); ++index) {
        if (world.persistent_id.elements()[index] == id) {
            return world.persistent_id.owners()[index];
        }
    }
    return k_no_entity;
}

}  // namespace handhold
