#pragma once

#include <string>

#include "game/scene/scene.hpp"

namespace handhold {

// A player's size as the runtime believes it, and why. Lengths are in the world's metres.
struct SizeStory {
    double eye_height_m;      // height above the floor when standing
    double arm_m;             // length from shoulder to wrist
    double shoulder_width_m;  // distance of the shoulder joints
    std::string reason;       // origin of these lengths, and for how long play was seen
};
// Precondition: `player` is a player.
SizeStory explain_size(const World& world, Entity player);

}  // namespace handhold
