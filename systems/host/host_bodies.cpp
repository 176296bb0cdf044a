// Bodies of the C interface (handhold/level.h).
#include "systems/host/host_bodies.hpp"

#include "components/world_edit.hpp"

namespace handhold {
namespace {

BodyKind kind_of(hh_body_kind kind) {
    require(kind == HH_STATIC || kind == HH_KINEMATIC || kind == HH_DYNAMIC, HH_ERROR_VALUE,
            "a body is HH_STATIC, HH_KINEMATIC or HH_DYNAMIC");
    return kind == HH_STATIC      ? BodyKind::fixed
           : kind == HH_KINEMATIC ? BodyKind::kinematic
                                  : BodyKind::free;
}

}  // namespace

void require_solid(const hh_world& host, ShapeId shape) {
    require(
        shape == k_no_shape || host.shapes.at(shape).kind != ShapeKind::mesh, HH_ERROR_VALUE,
        "a mesh is for static and kinematic bodies: a dynamic body needs a solid shape, such as "
        "a convex hull");
}

ShapeId shape_id_of(const hh_world& host, Entity body) {
    const Collider* const collider = host.world.collider.find(body);
    return collider != nullptr ? collider->shape : k_no_shape;
}

RigidBody rigid_body_of(const hh_world& host, const hh_body_def& def, ShapeId shape) {
    RigidBody body;
    body.kind = kind_of(def.kind);
    body.restitution = def.restitution;
    body.friction = def.friction;
    if (body.kind != BodyKind::free) {
        return body;
    }
    require_solid(host, shape);
    body.mass_kg = checked(def.mass_kg, world_limits::k_min_mass_kg, world_limits::k_max_mass_kg,
                           "a dynamic body needs a mass within 1e-12 to 1e15 kg");
    body.inertia_kgm2 = checked(def.inertia_kgm2, world_limits::k_max_inertia_kgm2,
                                "a moment of inertia beyond 1e18 kg m^2, or NaN");
    if (body.inertia_kgm2 == Vec3::Zero()) {
        require(shape != k_no_shape, HH_ERROR_VALUE,
                "without a shape a dynamic body needs an inertia");
        body.inertia_kgm2 = solid_inertia(host.shapes.at(shape), body.mass_kg);
    }
    return body;
}

Entity dynamic_body_of(const hh_world& host, hh_body body) {
    const Entity entity = body_of(host, body);
    require(host.world.body.at(entity).kind == BodyKind::free, HH_ERROR_STATE,
            "the body is not dynamic");
    return entity;
}

namespace {

void set_layers(hh_world& host, Entity entity, std::uint32_t layers, std::uint32_t mask) {
    host.world.filter.remove(entity);
    const CollisionFilter usual;
    if (layers != usual.layers || mask != usual.mask) {
        host.world.filter.add(entity, {layers, mask});
    }
}

void set_rule(hh_world& host, Entity entity, const GrabRule& rule) {
    host.world.grab_rule.remove(entity);
    const GrabRule usual;
    if (rule.left != usual.left || rule.right != usual.right || rule.two_hands != usual.two_hands ||
        rule.priority != usual.priority) {
        host.world.grab_rule.add(entity, rule);
    }
}

void set_gravity(hh_world& host, Entity entity, double scale) {
    host.world.gravity_scale.remove(entity);
    if (scale != GravityScale{}.scale) {
        host.world.gravity_scale.add(entity, {scale});
    }
}

constexpr const char* k_gravity_text = "a gravity scale beyond 1000, or NaN";

}  // namespace
}  // namespace handhold

using namespace handhold;

hh_result hh_default_body_def_sized(hh_body_def* filled, size_t size) {
    hh_body_def def{};
    def.pose = hh_identity_pose();
    def.mass_kg = 1.0;
    def.friction = RigidBody{}.friction;
    def.gravity_scale = 1.0;
    def.layers = CollisionFilter{}.layers;
    def.mask = CollisionFilter{}.mask;
    def.grab_left = def.grab_right = true;
    return write_default(filled, size, def);
}

hh_result hh_body_add(hh_world* world, const hh_body_def* wanted, hh_body* body) {
    return call([&] {
        hh_world& host = world_of(world);
        const hh_body_def def = read_def(wanted, hh_default_body_def());
        require(body != nullptr, HH_ERROR_NULL, "the output is null");
        const std::string name = new_name(host, def.name, "body");
        const double gravity =
            checked(def.gravity_scale, -GravityScale::k_max, GravityScale::k_max, k_gravity_text);
        BodyDescription description;
        description.name = name;
        description.shape = shape_of(host, def.shape);
        description.body = rigid_body_of(host, def, description.shape);
        description.pose_ws = checked(def.pose);
        if (description.shape != k_no_shape && host.host_shapes[description.shape.index].is_moved) {
            description.pose_ws =
                description.pose_ws * host.host_shapes[description.shape.index].frame;
        }
        description.velocity = {from_c(def.velocity_mps), from_c(def.angular_velocity_radps)};
        const Entity entity = add_body(host.world, description, host.shapes);
        set_gravity(host, entity, gravity);
        set_layers(host, entity, def.layers, def.mask);
        set_rule(
            host, entity,
            {def.grab_left != 0, def.grab_right != 0, def.grab_two_hands != 0, def.grab_priority});
        set_user_data(host, entity, def.user_data);
        *body = id_of<hh_body>(entity);
    });
}

hh_result hh_body_remove(hh_world* world, hh_body body) {
    return call([&] {
        hh_world& host = world_of(world);
        remove_entity(host, body_of(host, body));
    });
}

uint8_t hh_body_is_valid(const hh_world* world, hh_body body) {
    return world != nullptr && world->world.body.contains(entity_of(body));
}

hh_result hh_body_find(const hh_world* world, const char* name, hh_body* body) {
    return call([&] {
        const hh_world& host = world_of(world);
        require(name != nullptr && body != nullptr, HH_ERROR_NULL, "the name or output is null");
        const Entity entity = find_by_name(host.world, name);
        require(host.world.body.contains(entity), HH_ERROR_NAME, "no body has this name");
        *body = id_of<hh_body>(entity);
    });
}

hh_result hh_body_name(const hh_world* world, hh_body body, const char** name) {
    return call([&] {
        const hh_world& host = world_of(world);
        require(name != nullptr, HH_ERROR_NULL, "the output is null");
        const std::string_view found = name_of(host.world, body_of(host, body));
        *name =
            found.empty() ? "" : found.data();  // ends with 0, because it belongs to a std::string
    });
}

hh_result hh_world_bodies(const hh_world* world, hh_body* bodies, size_t capacity, size_t* count) {
    return call([&] {
        const hh_world& host = world_of(world);
        write_list(host.world.body.size(), bodies, capacity, count, [&](std::size_t index) {
            return id_of<hh_body>(host.world.body.owners()[index]);
        });
    });
}

hh_result hh_body_pose(const hh_world* world, hh_body body, hh_pose* pose) {
    return call([&] {
        const hh_world& host = world_of(world);
        require(pose != nullptr, HH_ERROR_NULL, "the output is null");
        *pose = to_c(host_pose_of(host, body_of(host, body)));
    });
}

hh_result hh_world_body_poses(const hh_world* world, const hh_body* bodies, size_t count,
                              hh_pose* poses) {
    return call([&] {
        const hh_world& host = world_of(world);
        require(count == 0 || (bodies != nullptr && poses != nullptr), HH_ERROR_NULL,
                "the ids or the buffer are null");
        for (std::size_t i = 0; i < count; ++i) {
            body_of(host, bodies[i]);
        }
        for (std::size_t i = 0; i < count; ++i) {
            poses[i] = to_c(host_pose_of(host, entity_of(bodies[i])));
        }
    });
}

hh_result hh_body_velocity(const hh_world* world, hh_body body, hh_vec3* velocity_mps,
                           hh_vec3* angular_velocity_radps) {
    return call([&] {
        const hh_world& host = world_of(world);
        const BodyVelocity& velocity = host.world.body_velocity.at(body_of(host, body));
        if (velocity_mps != nullptr) {
            *velocity_mps = to_c(velocity.linear_mps);
        }
        if (angular_velocity_radps != nullptr) {
            *angular_velocity_radps = to_c(velocity.angular_radps);
        }
    });
}

namespace handhold {
namespace {

constexpr const char* k_speed_text = "a velocity beyond 1e6 m/s or 1e4 rad/s, or NaN";

}  // namespace
}  // namespace handhold

hh_result hh_body_set_velocity(hh_world* world, hh_body body, hh_vec3 velocity_mps,
                               hh_vec3 angular_velocity_radps) {
    return call([&] {
        hh_world& host = world_of(world);
        const Entity entity = dynamic_body_of(host, body);
        const Vec3 linear = checked(velocity_mps, world_limits::k_max_speed_mps, k_speed_text);
        const Vec3 angular =
            checked(angular_velocity_radps, world_limits::k_max_spin_radps, k_speed_text);
        host.world.body_velocity.at(entity) = {linear, angular};
    });
}

hh_result hh_body_apply_impulse(hh_world* world, hh_body body, hh_vec3 impulse_ns, hh_vec3 point) {
    return call([&] {
        hh_world& host = world_of(world);
        const Entity entity = dynamic_body_of(host, body);
        constexpr double k_max_impulse_ns = 1e21;  // brings the heaviest body to the highest speed
        const Vec3 impulse =
            checked(impulse_ns, k_max_impulse_ns, "an impulse beyond 1e21 N s, or NaN");
        const Vec3 at = checked(point, world_limits::k_max_coordinate_m, "a point beyond 1e9 m");
        const RigidBody& rigid = host.world.body.at(entity);
        const Pose& pose_ws = host.world.body_pose.at(entity).pose_ws;
        BodyVelocity velocity = host.world.body_velocity.at(entity);
        velocity.linear_mps += impulse / rigid.mass_kg;
        const Vec3 spin_bs = (pose_ws.rotation.conjugate() * (at - pose_ws.position).cross(impulse))
                                 .cwiseQuotient(rigid.inertia_kgm2);
        velocity.angular_radps += pose_ws.rotation * spin_bs;
        checked(to_c(velocity.linear_mps), world_limits::k_max_speed_mps, k_speed_text);
        checked(to_c(velocity.angular_radps), world_limits::k_max_spin_radps, k_speed_text);
        host.world.body_velocity.at(entity) = velocity;
    });
}

hh_result hh_body_teleport(hh_world* world, hh_body body, hh_pose pose) {
    return call([&] {
        hh_world& host = world_of(world);
        const Entity entity = body_of(host, body);
        require_idle(host);
        teleport_body(host.world, entity, library_pose(host, entity, checked(pose)));
    });
}

hh_result hh_body_move_kinematic(hh_world* world, hh_body body, hh_pose pose) {
    return call([&] {
        hh_world& host = world_of(world);
        const Entity entity = body_of(host, body);
        require(host.world.body.at(entity).kind == BodyKind::kinematic, HH_ERROR_STATE,
                "the body is not kinematic");
        move_kinematic(host.world, entity, library_pose(host, entity, checked(pose)));
    });
}

hh_result hh_body_set_gravity_scale(hh_world* world, hh_body body, double scale) {
    return call([&] {
        hh_world& host = world_of(world);
        const Entity entity = body_of(host, body);
        set_gravity(host, entity,
                    checked(scale, -GravityScale::k_max, GravityScale::k_max, k_gravity_text));
    });
}

hh_result hh_body_set_layers(hh_world* world, hh_body body, uint32_t layers, uint32_t mask) {
    return call([&] {
        hh_world& host = world_of(world);
        set_layers(host, body_of(host, body), layers, mask);
    });
}

hh_result hh_body_set_grab_rule(hh_world* world, hh_body body, uint8_t left, uint8_t right,
                                uint8_t two_hands, int32_t priority) {
    return call([&] {
        hh_world& host = world_of(world);
        set_rule(host, body_of(host, body), {left != 0, right != 0, two_hands != 0, priority});
    });
}

hh_result hh_body_get_kind(const hh_world* world, hh_body body, hh_body_kind* kind) {
    return call([&] {
        const hh_world& host = world_of(world);
        require(kind != nullptr, HH_ERROR_NULL, "the output is null");
        const BodyKind found = host.world.body.at(body_of(host, body)).kind;
        *kind = found == BodyKind::fixed       ? HH_STATIC
                : found == BodyKind::kinematic ? HH_KINEMATIC
                                               : HH_DYNAMIC;
    });
}

hh_result hh_body_mass(const hh_world* world, hh_body body, double* mass_kg) {
    return call([&] {
        const hh_world& host = world_of(world);
        require(mass_kg != nullptr, HH_ERROR_NULL, "the output is null");
        const RigidBody& rigid = host.world.body.at(body_of(host, body));
        *mass_kg = rigid.kind == BodyKind::free ? rigid.mass_kg : 0.0;
    });
}

hh_result hh_body_material(const hh_world* world, hh_body body, double* friction,
                           double* restitution) {
    return call([&] {
        const hh_world& host = world_of(world);
        const RigidBody& rigid = host.world.body.at(body_of(host, body));
        if (friction != nullptr) {
            *friction = rigid.friction;
        }
        if (restitution != nullptr) {
            *restitution = rigid.restitution;
        }
    });
}

hh_result hh_body_shape(const hh_world* world, hh_body body, hh_shape* shape) {
    return call([&] {
        const hh_world& host = world_of(world);
        require(shape != nullptr, HH_ERROR_NULL, "the output is null");
        const ShapeId id = shape_id_of(host, body_of(host, body));
        // Shapes that a source embedder adds to the library have no entry.
        const bool is_known = id != k_no_shape && id.index < host.host_shapes.size();
        *shape = is_known ? hh_shape{id.index, host.host_shapes[id.index].generation} : hh_shape{};
    });
}

hh_result hh_body_set_user_data(hh_world* world, hh_body body, uint64_t user_data) {
    return call([&] {
        hh_world& host = world_of(world);
        set_user_data(host, body_of(host, body), user_data);
    });
}

hh_result hh_body_user_data(const hh_world* world, hh_body body, uint64_t* user_data) {
    return call([&] {
        const hh_world& host = world_of(world);
        require(user_data != nullptr, HH_ERROR_NULL, "the output is null");
        *user_data = user_data_of(host, body_of(host, body));
    });
}
