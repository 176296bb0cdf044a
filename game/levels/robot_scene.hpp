#pragma once

#include "game/scene/scene.hpp"
#include "game/session/session_script.hpp"

namespace handhold {

// A robot of rigid colliders that crawls round a loop on a hull. In its session the player climbs
// along the walking robot's back, then rides on it into the bend.
Scene make_robot_scene();
// The session of the robot scene, planned in the frame of the robot's torso.
SessionScript robot_script();

}  // namespace handhold
