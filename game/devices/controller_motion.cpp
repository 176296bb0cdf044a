#include "game/devices/controller_motion.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <optional>

namespace handhold {
namespace {

double& value_of(ControlValues& values, Control control) {
    return values[static_cast<std::size_t>(control)];
}

// The sibling of `node` with that name.
const ModelNode* find_beside(std::span<const ModelNode> nodes, const ModelNode& node,
                             const std::string& name) {
    const auto found = std::ranges::find_if(nodes, [&](const ModelNode& other) {
        return other.name == name && other.parent == node.parent;
    });
    return found != nodes.end() ? &*found : nullptr;
}

std::optional<ControlMove> find_move(const ModelNode& node, std::span<const ModelNode> nodes,
                                     std::span<const ControlledNode> controlled) {
    const auto it = std::ranges::find(controlled, node.name, &ControlledNode::node);
    if (it == controlled.end()) {
        return std::nullopt;
    }
    const ModelNode* const from = find_beside(nodes, node, it->from);
    const ModelNode* const to = find_beside(nodes, node, it->to);
    if (from == nullptr || to == nullptr || !node.pose_ms || !from->pose_ms || !to->pose_ms) {
        return std::nullopt;
    }
    return ControlMove{it->control, *node.pose_ms, *from->pose_ms, *to->pose_ms};
}

}  // namespace

ControlValues control_values(const HandReading& hand) {
    ControlValues values = k_controls_at_rest;
    value_of(values, Control::trigger) = hand.trigger;
    value_of(values, Control::squeeze) = hand.squeeze;
    // WebXR maps the corners of a stick's range onto its circle.
    const double length = std::max(std::hypot(hand.stick[0], hand.stick[1]), 1.0);
    value_of(values, Control::stick_x) = 0.5 + 0.5 * hand.stick[0] / length;
    value_of(values, Control::stick_y) = 0.5 - 0.5 * hand.stick[1] / length;
    value_of(values, Control::lower_button) = hand.brake ? 1.0 : 0.0;
    value_of(values, Control::upper_button) = hand.calibrate ? 1.0 : 0.0;
    return values;
}

ControlValues closing_values(bool closes) {
    ControlValues values = k_controls_at_rest;
    value_of(values, Control::trigger) = closes ? 1.0 : 0.0;
    value_of(values, Control::squeeze) = closes ? 1.0 : 0.0;
    return values;
}

std::vector<ControlMove> moves_of(const std::string& pointer, std::span<const ModelNode> nodes,
                                  std::span<const ControlledNode> controlled) {
    std::vector<ControlMove> moves;
    const auto leaf = std::ranges::find(nodes, pointer, &ModelNode::pointer);
    std::optional<std::size_t> at;
    if (leaf != nodes.end()) {
        at = static_cast<std::size_t>(std::distance(nodes.begin(), leaf));
    }
    for (; at; at = nodes[*at].parent) {
        if (const auto move = find_move(nodes[*at], nodes, controlled)) {
            moves.push_back(*move);
        }
    }
    std::ranges::reverse(moves);
    return moves;
}

// The poses of a move assume that the node's ancestors are at rest. The ancestors' moves are
// applied last and move the node along.
hh::Pose moved_by(std::span<const ControlMove> moves, const ControlValues& values) {
    hh::Pose moved = hh::k_origin;
    for (const ControlMove& move : moves) {
        const double share = std::clamp(values[static_cast<std::size_t>(move.control)], 0.0, 1.0);
        moved =
            moved * hh::interpolate(move.from_ms, move.to_ms, share) * hh::inverse(move.rest_ms);
    }
    return moved;
}

}  // namespace handhold
