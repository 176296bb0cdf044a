#pragma once

#include <string>

#include "game/levels/station_description.hpp"
#include "game/levels/station_kit.hpp"

namespace handhold {

inline constexpr double k_hatch_half_m = 0.64;  // half the clear width of every hatchway
inline constexpr double k_vestibule_length_m = 0.30;

// Precondition: a section of type module.
double module_length_m(const StationSection& section);

// Builds a cylinder with four walls of racks, stand-offs with lamps and cables between the walls,
// and a vestibule at the near end. `pose`: the section's frame in the station.
void build_module(Structure& out, const StationSection& section, const Pose& pose);

// Adds the passage between two sections, from z = -k_vestibule_length_m to z = 0 in the frame
// `pose`. The passage overlaps both sections by 20 mm.
void add_vestibule(StationKit& kit, const Pose& pose);
// Adds a closed door in a hatchway. `frame`: as in dress_hatch_plate.
void add_door(StationKit& kit, const Pose& frame);

// The frame of a wall at `distance_m` from the Z axis. `angle_rad`: rotation about Z; 0 is the
// floor.
Pose wall_frame(double angle_rad, double distance_m);

// A square plate across Z with a hatchway, from z = 0 to `thickness_m`. `half_m`: half the plate's
// width; `corner_m`: radius of its corners.
Mesh make_hatch_plate(double half_m, double corner_m, double thickness_m);
// Adds the parts on the inside of a hatch plate: collar, panels, and handrails around the hatchway
// or only beside it. The frame has +Y away from the plate; its origin is the middle of the
// hatchway, on the plate's face.
enum class HatchRails { around, beside };
void dress_hatch_plate(StationKit& kit, const Pose& frame, const std::string& name,
                       HatchRails rails);

// Adds the rails and hoses of a section's description. `pose` is the section's.
void add_described_parts(StationKit& kit, const StationSection& section, const Pose& pose);

}  // namespace handhold
