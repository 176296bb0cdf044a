#include "game/report/state_size.hpp"

#include <cstdint>
#include <type_traits>

#include "systems/host/host_columns.hpp"

namespace handhold {

std::size_t state_bytes(const hh::World& world, hh::Player player) {
    const World& columns = columns_of(world.get()).world;
    const PlayerEntities entities = player_entities(columns, player);
    std::size_t bytes = 0;
    visit_columns(columns, [&](const char*, const auto& column) {
        using StateElement = typename std::decay_t<decltype(column)>::Element;
        constexpr std::size_t k_place = sizeof(Entity) + sizeof(std::uint32_t);
        for (const Entity entity : {entities.player, entities.hands[0], entities.hands[1]}) {
            bytes += column.contains(entity) ? sizeof(StateElement) + k_place : 0;
        }
    });
    return bytes;
}

}  // namespace handhold
