#pragma once

#include <array>
#include <vector>

#include "game/net/match_scene.hpp"
#include "systems/host/host_columns.hpp"
#include "tools/lab/socket_peer.hpp"

// Readings of a world of the game, by players and by the comparison.
namespace handhold::lab {

// The tracked hands of a player in play space, as the last tick got them.
inline std::array<HandNumbers, 2> own_hands(const Scene& scene, hh::Player player) {
    const World& world = scene.world();
    const Entity entity = player_entities(world, player).player;
    std::array<HandNumbers, 2> out{};
    for (std::size_t i = 0; i < world.hand_owner.size(); ++i) {
        const HandOwner& owner = world.hand_owner.elements()[i];
        if (owner.player == entity) {
            const Pose& pose = world.hand_tracking.at(world.hand_owner.owners()[i]).pose_ps;
            out[index_of(owner.side)] = {pose.position.x(), pose.position.y(), pose.position.z(),
                                         pose.rotation.x(), pose.rotation.y(), pose.rotation.z(),
                                         pose.rotation.w()};
        }
    }
    return out;
}

// Appends x, y, z of the left and the right tracked hand of each player, in the world.
inline void add_all_hands(const MatchScene& scene, std::vector<double>& out) {
    const World& world = scene.scene.world();
    for (const hh::Player player : scene.players) {
        const Pose& origin_ws =
            world.player_origin.at(player_entities(world, player).player).pose_ws;
        for (const HandNumbers& hand : own_hands(scene.scene, player)) {
            const Vec3 at = transform_point(origin_ws, Vec3(hand[0], hand[1], hand[2]));
            out.insert(out.end(), {at.x(), at.y(), at.z()});
        }
    }
}

}  // namespace handhold::lab
