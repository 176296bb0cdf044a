#include "systems/host/host_world.hpp"

#include "systems/host/host_hooks.hpp"

hh_world::hh_world(const hh_world_def& def)
    : settings(def), caches(shapes, def.fits_hands ? &grip_meshes : nullptr), surfaces(world) {
    handhold::head_shape(*this, tuning.head.radius_m);
    ++handhold::world_count();
}

hh_world::~hh_world() { --handhold::world_count(); }

namespace handhold {

ShapeId shape_of(const hh_world& host, hh_shape shape) {
    if (shape.generation == 0) {
        return k_no_shape;
    }
    require(host.shapes.has({shape.index}) && shape.index < host.host_shapes.size() &&
                host.host_shapes[shape.index].generation == shape.generation,
            HH_ERROR_HANDLE, "no shape with this id");
    return {shape.index};
}

const HostShape* moved_shape_of(const hh_world& host, Entity body) {
    const Collider* const collider = host.world.collider.find(body);
    if (collider == nullptr || collider->shape == k_no_shape) {
        return nullptr;
    }
    // Shapes that a source embedder adds to the library have no entry.
    const std::size_t index = collider->shape.index;
    return index < host.host_shapes.size() && host.host_shapes[index].is_moved
               ? &host.host_shapes[index]
               : nullptr;
}

Pose host_pose_of(const hh_world& host, Entity body) {
    return host_pose_of(host, body, host.world.body_pose.at(body).pose_ws);
}
Pose host_pose_of(const hh_world& host, Entity body, const Pose& library_pose_ws) {
    const HostShape* const shape = moved_shape_of(host, body);
    return shape == nullptr ? library_pose_ws : library_pose_ws * inverse(shape->frame);
}

Pose library_pose(const hh_world& host, Entity body, const Pose& host_pose_ws) {
    const HostShape* const shape = moved_shape_of(host, body);
    return shape == nullptr ? host_pose_ws : host_pose_ws * shape->frame;
}

Pose to_host_bs(const hh_world& host, Entity body, const Pose& pose_bs) {
    const HostShape* const shape = moved_shape_of(host, body);
    return shape == nullptr ? pose_bs : shape->frame * pose_bs;
}

Pose from_host_bs(const hh_world& host, Entity body, const Pose& pose_bs) {
    const HostShape* const shape = moved_shape_of(host, body);
    return shape == nullptr ? pose_bs : inverse(shape->frame) * pose_bs;
}

std::string new_name(const hh_world& host, const char* name, const char* kind) {
    require_idle(host);  // allowed only between steps, because an entity is added
    std::string made;
    if (name != nullptr) {
        made = name;
    } else {
        const EntityPool& pool = host.world.entities;
        const std::size_t slot =
            pool.free_slots().empty() ? pool.generations().size() : pool.free_slots().back();
        const std::uint32_t generation =
            slot < pool.generations().size() ? pool.generations()[slot] + 1 : 1;
        made = std::string(kind) + "/" + std::to_string(slot) + "." + std::to_string(generation);
    }
    require(is_null(find_by_name(host.world, made)), HH_ERROR_NAME,
            [&] { return "the name " + made + " is taken"; });
    return made;
}

void remove_entity(hh_world& host, Entity entity) {
    require_idle(host);
    const auto forget = [&host](Entity gone) {
        host.user_data.remove(gone);
        host.body_rigs.remove(gone);
        host.hands.remove(gone);
        host.joints.remove(gone);
        host.spaces.remove(gone);
        host.caches.body_surfaces.remove(gone);
    };
    sync_index(host.world);
    for (const Entity joint : host.world.joints_by_body.of(entity)) {
        forget(joint);
    }
    for (std::size_t index = 0; index < host.world.hand_owner.size(); ++index) {
        if (host.world.hand_owner.elements()[index].player == entity) {
            forget(host.world.hand_owner.owners()[index]);
        }
    }
    forget(entity);
    destroy(host.world, entity);
}

void set_user_data(hh_world& host, Entity entity, std::uint64_t value) {
    if (UserData* const data = host.user_data.find(entity)) {
        data->value = value;
        return;
    }
    if (value != 0) {
        host.user_data.add(entity, {value});
    }
}

std::uint64_t user_data_of(const hh_world& host, Entity entity) {
    const UserData* const data = host.user_data.find(entity);
    return data != nullptr ? data->value : 0;
}

}  // namespace handhold
