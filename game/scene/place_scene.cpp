#include "game/scene/place_scene.hpp"

#include "systems/physics/place_colliders.hpp"

namespace handhold {

void place_scene(const Scene& scene, FrameCaches& caches) {
    const World& w = scene.world;
    place_colliders({.persistent_id = w.persistent_id,
                     .collider = w.collider,
                     .filter = w.filter,
                     .body = w.body,
                     .body_pose = w.body_pose,
                     .body_start = w.body_start,
                     .body_velocity = w.body_velocity,
                     .origin = w.player_origin,
                     .player_start = w.player_start,
                     .head = w.head_tracking,
                     .last_valid = w.last_valid,
                     .collision = caches.collision,
                     .frame = caches.graph},
                    scene.tuning.head);
}

}  // namespace handhold
