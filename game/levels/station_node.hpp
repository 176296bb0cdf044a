#pragma once

#include <array>

#include "game/levels/station_description.hpp"
#include "game/levels/station_kit.hpp"

namespace handhold {

inline constexpr std::size_t k_port_count = 4;  // numbered to the left, from +Z

// Distance from a node's middle to the outside of its walls.
double node_half_m();
// The frame on the outside of a node's wall: +Z away from the node's middle.
Pose node_port(const Pose& node, int port);

// What a node's hatchway leads to: another section, or a closed door.
enum class PortUse : std::uint8_t { closed, open };

// Builds a cube with four hatchways and with racks in floor and ceiling. `pose`: the frame at the
// cube's middle.
void build_node(Structure& out, const StationSection& section, const Pose& pose,
                const std::array<PortUse, k_port_count>& ports);

// Builds a window of eight slanted panes and a front pane. `pose`: frame of the node's port
// (node_port).
void build_cupola(Structure& out, const StationSection& section, const Pose& pose);

}  // namespace handhold
