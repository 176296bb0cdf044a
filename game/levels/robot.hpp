#pragma once

#include <array>
#include <cstddef>

#include "engine/anim/crawler_leg.hpp"
#include "game/levels/station.hpp"

// A robot that crawls over a hull, and the hull: what they look like and how they are built.
// Lengths in metres.
namespace handhold {

inline constexpr std::size_t k_robot_legs = 6;
inline constexpr double k_robot_height_m = 0.85;  // of the torso's frame over the hull
inline constexpr double k_robot_upper_radius_m = 0.085;
inline constexpr double k_robot_lower_radius_m = 0.065;

// About 3 m (along Z) x 1.1 m x 0.5 m, its head at -Z; rails and rungs on its back. In its body's
// frame; the spawn is over its back.
Structure make_robot_torso();
// Of its legs, left ones first, from head to tail: alternating, three stand while three swing.
std::array<CrawlerLeg, k_robot_legs> robot_legs();
CrawlerGait robot_gait();
// One bone about its middle, its length along Y; the foot's face is where the lower bone ends.
Structure make_robot_bone(const CrawlerLeg& leg, LegBone bone);

// Hull plates flush with y = 0, 26 m x 20 m, with things to look at where the robot does not go:
// inside and outside of its way.
Structure make_robot_hull();
// Its way: once around in the returned period, heading along it; begins in the middle of a straight
// piece that leads to -Z.
PosePath make_robot_path();

}  // namespace handhold
