#pragma once

#include <optional>
#include <string>
#include <vector>

#include "engine/collision/collision_world.hpp"
#include "game/scene/scene.hpp"

namespace handhold {

// Why a hand holds what it holds, or nothing: in words, with the figures that decided it.
struct HandStory {
    std::string headline;
    std::vector<std::string> reasons;
};
// Precondition: `hand` is a player's hand. `collision` has the colliders where they are.
HandStory explain_hand(const Scene& scene, const CollisionWorld& collision, Entity hand);

// The hand that is nearest to a line of sight, within about 5 degrees of it.
std::optional<Entity> hand_pointed_at(const World& world, const Vec3& eye_ws, const Vec3& look_ws);

// A body's name in its scene, a player's or hand's as "player" and "left hand"; else its id.
std::string name_of_entity(const Scene& scene, Entity entity);

}  // namespace handhold
