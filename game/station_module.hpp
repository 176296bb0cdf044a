#pragma once

#include <string>

#include "game/station_kit.hpp"

namespace handhold {

// What a solid wall across a section opens with, and what closes it.
enum class EndKind { hatchway, door, window };

inline constexpr double k_hatch_half_m = 0.64;  // half the clear width of every hatchway
inline constexpr double k_vestibule_length_m = 0.30;

struct ModuleSpec {
    std::string name;
    Pose pose;  // +Z along the module, away from the node; the origin in the middle of its near end
    std::size_t racks = 5;
    EndKind far_end = EndKind::door;
    Color accent = {0.5F, 0.5F, 0.5F};
    std::size_t seed = 1;
};
double module_length_m(const ModuleSpec& spec);

// A cylinder with four walls of racks, stand-offs with lamps and cables between them, a vestibule
// at its near end.
void build_module(Structure& out, const ModuleSpec& spec);

// A frame on the wall at `distance_m` from the Z axis, turned by `angle_rad` about it from the
// floor.
Pose wall_frame(double angle_rad, double distance_m);

// A plate across Z with a hatchway, `half_m` wide, from z = 0 to thickness_m; `corner_m` rounds its
// outside.
Mesh make_hatch_plate(double half_m, double corner_m, double thickness_m);
// What is seen of such a plate from inside a section: collar, panels, and handrails: around
// it, or at its left and right only. The frame has +Y
// away from the plate, its origin in the hatchway's middle on the plate's face.
enum class HatchRails { around, beside };
void dress_hatch_plate(StationKit& kit, const Pose& frame, const std::string& name,
                       HatchRails rails);

}  // namespace handhold
