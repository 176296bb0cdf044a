#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <handhold/handhold.hpp>
#include <handhold/math.hpp>

#include "game/devices/headset_reading.hpp"

// Moving parts of a drawn controller: buttons, triggers, sticks. As in WebXR's input profiles, a
// node of the model moves between two poses.
namespace handhold {

enum class Control : std::uint8_t {
    trigger,
    squeeze,
    stick_x,       // 0 left, 1 right
    stick_y,       // 0 forward, 1 back
    lower_button,  // brake: X, A, a pressed trackpad
    upper_button,  // calibrate: Y, B, menu on controllers without them
    count
};
inline constexpr std::size_t k_control_count = static_cast<std::size_t>(Control::count);
// Position of each control, in [0, 1].
using ControlValues = std::array<double, k_control_count>;
inline constexpr ControlValues k_controls_at_rest = {0.0, 0.0, 0.5, 0.5, 0.0, 0.0};

ControlValues control_values(const HandReading& hand);
// Values for input that only says whether the hand closes.
ControlValues closing_values(bool closes);

// A node of a model that moves with a control, and the nodes that mark its two end poses.
struct ControlledNode {
    Control control = Control::trigger;
    std::string node, from, to;
};

// A node of a controller's model.
struct ModelNode {
    std::string name;
    std::string pointer;                // JSON pointer in the file
    std::optional<std::size_t> parent;  // index; nullopt: a root
    std::optional<hh::Pose> pose_ms;    // nullopt: it is scaled
};

// A ControlledNode with the poses that its model's nodes have. Suffix _ms: in the model's frame,
// all other parts at rest.
struct ControlMove {
    Control control = Control::trigger;
    hh::Pose rest_ms = hh::k_origin;
    hh::Pose from_ms = hh::k_origin;
    hh::Pose to_ms = hh::k_origin;
};
// Moves of the node with this pointer and of its ancestors, the outermost first. Left out: nodes
// that the model lacks, that are scaled, or that are no siblings of their end poses.
std::vector<ControlMove> moves_of(const std::string& pointer, std::span<const ModelNode> nodes,
                                  std::span<const ControlledNode> controlled);
// Transform of a part from its rest pose to the given values, in the model's frame.
hh::Pose moved_by(std::span<const ControlMove> moves, const ControlValues& values);

}  // namespace handhold
