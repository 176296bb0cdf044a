#pragma once

#include <string>

#include "game/levels/station_description.hpp"
#include "game/levels/station_kit.hpp"

namespace handhold {

inline constexpr double k_hatch_half_m = 0.64;  // half the clear width of every hatchway
inline constexpr double k_vestibule_length_m = 0.30;

// Of a section of type module.
double module_length_m(const StationSection& section);

// A cylinder with four walls of racks, stand-offs with lamps and cables between the walls, and a
// vestibule at its near end. `pose` is the section's.
void build_module(Structure& out, const StationSection& section, const Pose& pose);

// The passage between two sections, from z = -k_vestibule_length_m to 0 of `pose`. It overlaps both
// sections by 20 mm.
void add_vestibule(StationKit& kit, const Pose& pose);
// A closed door in a hatchway. `frame` as in dress_hatch_plate.
void add_door(StationKit& kit, const Pose& frame);

// The frame of a wall at `distance_m` from the Z axis, turned about it by `angle_rad` from the
// floor.
Pose wall_frame(double angle_rad, double distance_m);

// A plate across Z with a hatchway `half_m` wide, from z = 0 to thickness_m. `corner_m` rounds its
// outside.
Mesh make_hatch_plate(double half_m, double corner_m, double thickness_m);
// The inside of such a plate: collar, panels, and handrails around the hatchway or only beside it.
// The frame has +Y away from the plate, and its origin is the hatchway's middle on the plate's
// face.
enum class HatchRails { around, beside };
void dress_hatch_plate(StationKit& kit, const Pose& frame, const std::string& name,
                       HatchRails rails);

// The rails and hoses of a section's description. `pose` is the section's.
void add_described_parts(StationKit& kit, const StationSection& section, const Pose& pose);

}  // namespace handhold
