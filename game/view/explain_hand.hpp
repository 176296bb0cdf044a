#pragma once

#include <optional>
#include <string>
#include <vector>

#include "engine/collision/collision_world.hpp"
#include "game/scene/scene.hpp"

namespace handhold {

// Explains in words, with the deciding figures, why a hand grips its body or why it grips nothing.
struct HandStory {
    std::string headline;
    std::vector<std::string> reasons;
};
// Preconditions: `hand` is a player's hand, and every collider of `collision` is at its current
// pose.
HandStory explain_hand(const Scene& scene, const CollisionWorld& collision, Entity hand);

// The hand nearest to a line of sight, within about 5 degrees of it; nullopt if there is none.
std::optional<Entity> hand_pointed_at(const World& world, const Vec3& eye_ws, const Vec3& look_ws);

// A body's name in its scene, "left hand" or "right hand", "player 0" or "joint of ..."; for other
// entities the persistent id, for none "nobody".
std::string name_of_entity(const Scene& scene, Entity entity);

}  // namespace handhold
