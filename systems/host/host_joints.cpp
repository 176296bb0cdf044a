// Joints of the C interface (handhold/level.h).
#include "systems/host/host_world.hpp"

namespace handhold {
namespace {

JointKind joint_kind_of(hh_joint_kind kind) {
    switch (kind) {
        case HH_BALL:
            return JointKind::ball;
        case HH_HINGE:
            return JointKind::hinge;
        case HH_SLIDER:
            return JointKind::slider;
        case HH_FIXED:
            return JointKind::fixed;
        case HH_DISTANCE:
            return JointKind::distance;
        case HH_JOINT_KIND_32_BITS:
            break;
    }
    throw HostError{HH_ERROR_VALUE, "no such kind of joint"};
}

Joint read_joint(const hh_world& host, const hh_joint_def& def) {
    Joint joint;
    joint.kind = joint_kind_of(def.kind);
    joint.b = body_of(host, def.body_b);
    if (def.body_a.generation != 0) {
        joint.a = body_of(host, def.body_a);
    }
    require(joint.a != joint.b, HH_ERROR_VALUE, "a joint needs two bodies");
    joint = joint_at(host.world, joint, checked(def.frame));
    if (joint.kind == JointKind::distance) {
        const Vec3 point_ws =
            checked(def.point_b, world_limits::k_max_coordinate_m, "a point beyond 1e9 m, or NaN");
        joint.frame_b_bs.position =
            inverse_transform_point(host.world.body_pose.at(joint.b).pose_ws, point_ws);
    }
    joint.collides = def.collides != 0;
    joint.limited = def.limited != 0;
    joint.lower = def.lower;
    joint.upper = def.upper;
    joint.friction = def.friction;
    joint.detent_spacing = def.detent_spacing;
    joint.detent_strength = def.detent_strength;
    joint.latch.at = def.latch_at;
    joint.latch.catch_range = def.latch_range;
    joint.latch.strength = def.latch_strength;
    joint.latch.handle_at = def.latch_handle_at;
    if (def.latch_handle.generation != 0) {
        joint.latch.handle = joint_of(host, def.latch_handle);
    }
    return joint;
}

// Changes a joint's numbers, or throws and changes nothing.
template <typename Change>
void change_joint(hh_world& host, hh_joint joint, const Change& change) {
    require_idle(host);
    const Entity entity = joint_of(host, joint);
    Joint changed = host.world.joint.at(entity);
    change(changed);
    check_joint_numbers(changed);
    host.world.joint.at(entity) = changed;
}

}  // namespace
}  // namespace handhold

using namespace handhold;

hh_result hh_default_joint_def_sized(hh_joint_def* filled, size_t size) {
    hh_joint_def def{};
    def.frame = hh_identity_pose();
    return write_default(filled, size, def);
}

hh_result hh_joint_add(hh_world* world, const hh_joint_def* wanted, hh_joint* joint) {
    return call([&] {
        hh_world& host = world_of(world);
        const hh_joint_def def = read_def(wanted, hh_default_joint_def());
        require(joint != nullptr, HH_ERROR_NULL, "the output is null");
        const std::string name = new_name(host, def.name, "joint");
        *joint = id_of<hh_joint>(add_joint(host.world, {name, read_joint(host, def)}));
    });
}

hh_result hh_default_motor_def_sized(hh_motor_def* filled, size_t size) {
    hh_motor_def def{};
    def.time_s = JointMotor{}.time_s;
    return write_default(filled, size, def);
}

hh_result hh_joint_set_motor(hh_world* world, hh_joint joint, const hh_motor_def* wanted) {
    return call([&] {
        hh_world& host = world_of(world);
        const hh_motor_def def = read_def(wanted, hh_default_motor_def());
        require(def.kind >= HH_MOTOR_NONE && def.kind <= HH_MOTOR_POSITION, HH_ERROR_VALUE,
                "no such kind of motor");
        change_joint(host, joint, [&](Joint& changed) {
            changed.motor = {.kind = static_cast<MotorKind>(def.kind),
                             .speed = def.speed,
                             .position = def.position,
                             .time_s = def.time_s,
                             .strength = def.strength};
        });
    });
}

hh_result hh_joint_set_limits(hh_world* world, hh_joint joint, uint8_t limited, double lower,
                              double upper) {
    return call([&] {
        change_joint(world_of(world), joint, [&](Joint& changed) {
            changed.limited = limited != 0;
            changed.lower = lower;
            changed.upper = upper;
        });
    });
}

hh_result hh_joint_set_latch(hh_world* world, hh_joint joint, double at, double range,
                             double strength) {
    return call([&] {
        hh_world& host = world_of(world);
        JointState& state = host.world.joint_state.at(joint_of(host, joint));
        const bool is_moved = host.world.joint.at(joint_of(host, joint)).latch.at != at;
        change_joint(host, joint, [&](Joint& changed) {
            changed.latch.at = at;
            changed.latch.catch_range = range;
            changed.latch.strength = strength;
        });
        state.latched = state.latched && range > 0.0 && !is_moved;
    });
}

hh_result hh_joint_set_friction(hh_world* world, hh_joint joint, double friction) {
    return call([&] {
        change_joint(world_of(world), joint, [&](Joint& changed) { changed.friction = friction; });
    });
}

hh_result hh_joint_remove(hh_world* world, hh_joint joint) {
    return call([&] {
        hh_world& host = world_of(world);
        remove_entity(host, joint_of(host, joint));
    });
}

uint8_t hh_joint_is_valid(const hh_world* world, hh_joint joint) {
    return world != nullptr && world->world.joint.contains(entity_of(joint));
}

hh_result hh_body_joints(const hh_world* world, hh_body body, hh_joint* joints, size_t capacity,
                         size_t* count) {
    return call([&] {
        const hh_world& host = world_of(world);
        const Entity entity = body_of(host, body);
        std::vector<Entity> found;
        for (std::size_t index = 0; index < host.world.joint.size(); ++index) {
            const Joint& joint = host.world.joint.elements()[index];
            if (joint.a == entity || joint.b == entity) {
                found.push_back(host.world.joint.owners()[index]);
            }
        }
        write_list(found.size(), joints, capacity, count,
                   [&](std::size_t i) { return id_of<hh_joint>(found[i]); });
    });
}

hh_result hh_joint_state(const hh_world* world, hh_joint joint, double* coordinate, double* speed,
                         uint8_t* latched) {
    return call([&] {
        const hh_world& host = world_of(world);
        const JointState& state = host.world.joint_state.at(joint_of(host, joint));
        if (coordinate != nullptr) {
            *coordinate = state.coordinate;
        }
        if (speed != nullptr) {
            *speed = state.speed;
        }
        if (latched != nullptr) {
            *latched = state.latched;
        }
    });
}
