#pragma once

#include <array>
#include <cstddef>

#include "engine/anim/crawler_leg.hpp"
#include "game/levels/station.hpp"

// A robot that crawls over a hull, and that hull: meshes, legs, gait and path. Lengths in metres.
namespace handhold {

inline constexpr std::size_t k_robot_legs = 6;
inline constexpr double k_robot_height_m = 0.85;  // height of the torso's frame above the hull
inline constexpr double k_robot_upper_radius_m = 0.085;
inline constexpr double k_robot_lower_radius_m = 0.065;

// The torso in its body's frame: about 3 m (along Z) x 1.1 m x 0.5 m, head at -Z, rails and rungs
// on the back. Its spawn is above the back.
Structure make_robot_torso();
// The legs: first the left side, then the right, each from head to tail. In the gait, three legs
// stand while three swing.
std::array<CrawlerLeg, k_robot_legs> robot_legs();
CrawlerGait robot_gait();
// The visual of one bone. Its frame has the origin in the middle and the length along Y. The end of
// the lower bone is the foot's contact face.
Structure make_robot_bone(const CrawlerLeg& leg, LegBone bone);

// Hull plates flush with y = 0, 26 m x 20 m, with equipment inside and outside the robot's path.
Structure make_robot_hull();
// One lap of the robot's path. The poses face along the path. It starts in the middle of a straight
// that leads to -Z.
PosePath make_robot_path();

}  // namespace handhold
