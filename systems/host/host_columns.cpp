#include "systems/host/host_columns.hpp"

#include "components/world_edit.hpp"
#include "systems/host/host_world.hpp"

namespace handhold {

HostColumns columns_of(hh_world* world) {
    world->has_placed_colliders = false;
    return {world->world, world->tuning, world->shapes, world->grip_meshes, world->caches};
}

ConstHostColumns columns_of(const hh_world* world) {
    return {world->world,       world->tuning, world->shapes,
            world->grip_meshes, world->caches, world->stats};
}

PlayerEntities player_entities(const World& world, hh_player player) {
    const Entity entity = entity_of(player);
    return {entity,
            {hand_of(world, entity, HandSide::left), hand_of(world, entity, HandSide::right)}};
}

}  // namespace handhold
