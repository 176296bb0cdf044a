// Changes of bodies of the C interface while hands hold them (handhold/level.h): mass, material,
// kind and shape.
#include <algorithm>

#include "components/play_space.hpp"
#include "components/scaled_tuning.hpp"
#include "components/world_edit.hpp"
#include "engine/collision/shape_query.hpp"
#include "systems/host/host_bodies.hpp"

namespace handhold {
namespace {

// Returns the body with this kind and mass, and its present restitution and friction.
RigidBody changed_body(const hh_world& host, Entity entity, hh_body_kind kind, double mass_kg,
                       const hh_vec3& inertia_kgm2) {
    const RigidBody& now = host.world.body.at(entity);
    hh_body_def def = hh_default_body_def();
    def.kind = kind;
    def.mass_kg = mass_kg;
    def.inertia_kgm2 = inertia_kgm2;
    def.restitution = now.restitution;
    def.friction = now.friction;
    return rigid_body_of(host, def, shape_id_of(host, entity));
}

bool is_in_reach(const hh_world& host, ShapeId id, const Vec3& point, double reach_m) {
    const Shape& shape = host.shapes.at(id);
    if (shape.kind != ShapeKind::mesh) {
        return closest_on_shape(shape, point).distance_m <= reach_m;
    }
    if (host.grip_meshes.has(id)) {
        return host.grip_meshes.shared_at(id)
            ->contact_bvh.closest_point(point, reach_m)
            .has_value();
    }
    return std::ranges::any_of(shape.mesh->triangles, [&](const auto& triangle) {
        Corners corners;
        for (std::size_t i = 0; i < corners.size(); ++i) {
            corners[i] = shape.mesh->positions[triangle[i]].cwiseProduct(shape.scale);
        }
        return (closest_on_triangle(point, corners) - point).norm() <= reach_m;
    });
}

// Hands on the body that would not find its new surface when they close. An order that the host has
// given for the next step stays.
void release_far_hands(hh_world& host, Entity body, ShapeId shape) {
    TuningOfPlayers tunings(host.tuning);
    for (std::size_t index = 0; index < host.world.grab.size(); ++index) {
        const Grab& grab = host.world.grab.elements()[index];
        const Entity hand = host.world.grab.owners()[index];
        if (grab.kind == GripKind::none || grab.body != body ||
            host.world.grab_order.contains(hand)) {
            continue;
        }
        const HandOwner& owner = host.world.hand_owner.at(hand);
        const HandTuning& tuning = tunings.of(host.world.player_origin.at(owner.player)).hand;
        const double reach_m = std::max(tuning.ray_length_m - tuning.ray_back_m, tuning.reach_m);
        const Vec3 palm_bs = palm_ray(grab.anchor_bs, owner.side, tuning).palm_ws;
        if (shape == k_no_shape || !is_in_reach(host, shape, palm_bs, reach_m)) {
            host.world.grab_order.add(hand, {k_no_entity});
        }
    }
}

}  // namespace
}  // namespace handhold

using namespace handhold;

hh_result hh_body_set_mass(hh_world* world, hh_body body, double mass_kg, hh_vec3 inertia_kgm2) {
    return call([&] {
        hh_world& host = world_of(world);
        const Entity entity = dynamic_body_of(host, body);
        change_body(host.world, entity,
                    changed_body(host, entity, HH_DYNAMIC, mass_kg, inertia_kgm2));
    });
}

hh_result hh_body_set_material(hh_world* world, hh_body body, double friction, double restitution) {
    return call([&] {
        hh_world& host = world_of(world);
        const Entity entity = body_of(host, body);
        RigidBody rigid = host.world.body.at(entity);
        rigid.friction = friction;
        rigid.restitution = restitution;
        change_body(host.world, entity, rigid);
    });
}

hh_result hh_body_set_kind(hh_world* world, hh_body body, hh_body_kind kind, double mass_kg,
                           hh_vec3 inertia_kgm2) {
    return call([&] {
        hh_world& host = world_of(world);
        require_idle(host);
        const Entity entity = body_of(host, body);
        change_body(host.world, entity, changed_body(host, entity, kind, mass_kg, inertia_kgm2));
    });
}

hh_result hh_body_set_shape(hh_world* world, hh_body body, hh_shape shape) {
    return call([&] {
        hh_world& host = world_of(world);
        require_idle(host);
        const Entity entity = body_of(host, body);
        const ShapeId id = shape_of(host, shape);
        RigidBody rigid = host.world.body.at(entity);
        if (rigid.kind == BodyKind::free) {
            require_solid(host, id);
            require(id != k_no_shape, HH_ERROR_VALUE, "a dynamic body needs a shape");
            rigid.inertia_kgm2 = solid_inertia(host.shapes.at(id), rigid.mass_kg);
        }
        check_rigid_body(rigid, "hh_body_set_shape");
        const Pose frame = id == k_no_shape ? Pose{} : host.host_shapes[id.index].frame;
        const HostShape* const old = moved_shape_of(host, entity);
        change_shape(host.world, entity, id,
                     (old == nullptr ? Pose{} : inverse(old->frame)) * frame);
        change_body(host.world, entity, rigid);
        if (id != k_no_shape) {
            host.caches.body_surfaces.remove(entity);
        }
        release_far_hands(host, entity, id);
    });
}
