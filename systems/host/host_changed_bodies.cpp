// Changes of bodies of the C interface while hands hold them (handhold/level.h): mass, material,
// kind and shape.
#include <algorithm>
#include <limits>

#include "components/play_space.hpp"
#include "components/scaled_tuning.hpp"
#include "components/world_edit.hpp"
#include "engine/collision/shape_query.hpp"
#include "systems/host/host_bodies.hpp"

namespace handhold {
namespace {

// A body as it becomes with this kind and mass.
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

double distance_m(const Shape& shape, const Vec3& point) {
    if (shape.kind != ShapeKind::mesh) {
        return closest_on_shape(shape, point).distance_m;
    }
    double nearest_m = std::numeric_limits<double>::infinity();
    for (const auto& triangle : shape.mesh->triangles) {
        Corners corners;
        for (std::size_t i = 0; i < corners.size(); ++i) {
            corners[i] = shape.mesh->positions[triangle[i]].cwiseProduct(shape.scale);
        }
        nearest_m = std::min(nearest_m, (closest_on_triangle(point, corners) - point).norm());
    }
    return nearest_m;
}

// Hands on the body that would not find its new surface when they close.
void release_far_hands(hh_world& host, Entity body, ShapeId shape) {
    TuningOfPlayers tunings(host.tuning);
    for (std::size_t index = 0; index < host.world.grab.size(); ++index) {
        const Grab& grab = host.world.grab.elements()[index];
        if (grab.kind == GripKind::none || grab.body != body) {
            continue;
        }
        const Entity hand = host.world.grab.owners()[index];
        const HandOwner& owner = host.world.hand_owner.at(hand);
        const HandTuning& tuning = tunings.of(host.world.player_origin.at(owner.player)).hand;
        const double reach_m = std::max(tuning.ray_length_m - tuning.ray_back_m, tuning.reach_m);
        const Vec3 palm_bs = palm_ray(grab.anchor_bs, owner.side, tuning).palm_ws;
        if (shape == k_no_shape || distance_m(host.shapes.at(shape), palm_bs) > reach_m) {
            host.world.grab_order.remove(hand);
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
        check_rigid_body(rigid, __func__);
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
