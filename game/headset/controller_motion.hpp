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

// What moves on a controller when it is used: buttons, triggers, sticks. Pictures only. As WebXR's
// input profiles have it: a node of the model goes from one place to another.
namespace handhold {

enum class Control : std::uint8_t {
    trigger,
    squeeze,
    stick_x,       // 0 left, 1 right
    stick_y,       // 0 forward, 1 back
    lower_button,  // what brakes: X, A, a pressed trackpad
    upper_button,  // what calibrates: Y, B, the menu of a controller that has no other
    count
};
inline constexpr std::size_t k_control_count = static_cast<std::size_t>(Control::count);
// How far each control is, in [0, 1].
using ControlValues = std::array<double, k_control_count>;
inline constexpr ControlValues k_controls_at_rest = {0.0, 0.0, 0.5, 0.5, 0.0, 0.0};

ControlValues control_values(const HandReading& hand);
// Of whose input says no more than whether the hand closes.
ControlValues closing_values(bool closes);

// A node of a model that goes with a control, and those that say from where to where.
struct ControlledNode {
    Control control = Control::trigger;
    std::string node, from, to;
};

// The same, found in the model. Suffix _ms: in the model's frame, everything else at rest.
struct ControlMove {
    Control control = Control::trigger;
    Pose rest_ms, from_ms, to_ms;
};
// Of what hangs at the model's node with this pointer, the outermost first. What the model does not
// have, is squashed, or does not lie beside its ends moves nothing.
std::vector<ControlMove> moves_of(const std::string& pointer, std::span<const GltfNode> nodes,
                                  std::span<const ControlledNode> controlled);
// Moves what is at its rest in the model's frame: in it too.
Pose moved_by(std::span<const ControlMove> moves, const ControlValues& values);

}  // namespace handhold
