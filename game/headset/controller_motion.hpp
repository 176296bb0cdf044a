#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "engine/io/gltf_nodes.hpp"
#include "engine/math/math.hpp"
#include "game/headset/headset_reading.hpp"

// Moving parts of a drawn controller: buttons, triggers, sticks. They have no effect on the
// simulation. As in WebXR's input profiles, a node of the model moves between the poses of two
// other nodes.
namespace handhold {

enum class Control : std::uint8_t {
    trigger,
    squeeze,
    stick_x,       // 0 left, 1 right
    stick_y,       // 0 forward, 1 back
    lower_button,  // brake: X, A or a pressed trackpad
    upper_button,  // calibrate: Y, B, or the menu button if there is neither
    count
};
inline constexpr std::size_t k_control_count = static_cast<std::size_t>(Control::count);
// Position of each Control, in [0, 1].
using ControlValues = std::array<double, k_control_count>;
inline constexpr ControlValues k_controls_at_rest = {0.0, 0.0, 0.5, 0.5, 0.0, 0.0};

ControlValues control_values(const HandReading& hand);
// Control values if only `closes` is known of the input.
ControlValues closing_values(bool closes);

// Names of three nodes of a model. `node` follows the control: from the pose of `from` (value 0) to
// that of `to` (value 1).
struct ControlledNode {
    Control control = Control::trigger;
    std::string node, from, to;
};

// Poses of the three nodes of a ControlledNode. _ms: in the model's frame, with all other nodes at
// rest.
struct ControlMove {
    Control control = Control::trigger;
    Pose rest_ms, from_ms, to_ms;
};
// Moves of the node with this pointer and of its ancestors, outermost first. A node is skipped if
// it or its end nodes (`from`, `to`) are missing, have a scale that a Pose cannot hold, or are not
// siblings.
std::vector<ControlMove> moves_of(const std::string& pointer, std::span<const GltfNode> nodes,
                                  std::span<const ControlledNode> controlled);
// Transform in the model's frame that moves a part from its rest pose to its pose at `values`.
Pose moved_by(std::span<const ControlMove> moves, const ControlValues& values);

}  // namespace handhold
