#include "game/scene/place_scene.hpp"

#include "systems/physics/place_colliders.hpp"

namespace handhold {

void place_scene(const Scene& scene, FrameCaches& caches) {
    const World& w = scene.world;
    place_colliders(
        {w.persistent_id, w.collider, w.body, w.body_pose, w.body_start, w.player_origin,
         w.player_start, w.head_tracking, w.last_valid, caches.collision, caches.graph},
        scene.tuning.head);
}

}  // namespace handhold
