#pragma once

#include <array>
#include <cstddef>

#include "engine/anim/crawler_leg.hpp"
#include "game/levels/station.hpp"

// A robot that crawls over a hull, and the hull: visuals and geometry. Lengths in metres.
namespace handhold {

inline constexpr std::size_t k_robot_legs = 6;
inline constexpr double k_robot_height_m = 0.85;  // of the torso's frame above the hull
inline constexpr double k_robot_upper_radius_m = 0.085;
inline constexpr double k_robot_lower_radius_m = 0.065;

// About 3 m (along Z) x 1.1 m x 0.5 m, head at -Z, rails and rungs on its back. In its body's
// frame; the spawn is above its back.
Structure make_robot_torso();
// The left legs first, each side from head to tail. The gait alternates: three legs stand while
// three swing.
std::array<CrawlerLeg, k_robot_legs> robot_legs();
CrawlerGait robot_gait();
// One bone: the origin is its middle, its length is along Y, and the foot's contact face is the end
// of the lower bone.
Structure make_robot_bone(const CrawlerLeg& leg, LegBone bone);

// Hull plates flush with y = 0, 26 m x 20 m, with equipment inside and outside the robot's path.
Structure make_robot_hull();
// One lap of the robot's path, heading along it. Starts in the middle of a straight that leads to
// -Z.
PosePath make_robot_path();

}  // namespace handhold
