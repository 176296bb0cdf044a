#pragma once

#include "game/scene/scene.hpp"
#include "game/session/session_script.hpp"

namespace handhold {

// A robot of rigid colliders crawls round a loop on a hull. Its session climbs along the robot's
// back while it walks, and rides on it into the bend.
Scene make_robot_scene();
// Planned in the frame of the robot's torso.
SessionScript robot_script();

}  // namespace handhold
