#include "game/desktop/gamepad.hpp"

#include <algorithm>
#include <cmath>

namespace handhold {
namespace {

constexpr double k_dead_zone = 0.18;
constexpr double k_closes_at = 0.55;
constexpr double k_opens_at = 0.35;
constexpr double k_farther_mps = 0.4;

// Removes the dead zone: in every direction, the result grows without a step from 0 at the dead
// zone's edge to 1 at full deflection.
std::array<double, 2> beyond_dead_zone(const std::array<double, 2>& stick) {
    const double length = std::hypot(stick[0], stick[1]);
    if (!(length > k_dead_zone)) {
        return {};
    }
    const double scale = std::min(1.0, (length - k_dead_zone) / (1.0 - k_dead_zone)) / length;
    return {scale * stick[0], scale * stick[1]};
}

double difference(bool more, bool less) { return (more ? 1.0 : 0.0) - (less ? 1.0 : 0.0); }

}  // namespace

DesktopInput read_gamepad(const GamepadState& state, const PlaySettings& settings, double dt_s,
                          GamepadMemory& memory) {
    enum Pad : std::uint8_t { up, down, left, right };
    DesktopInput input;
    const std::array<double, 2> move = beyond_dead_zone(state.left_stick);
    const std::array<double, 2> look = beyond_dead_zone(state.right_stick);
    input.move = {move[0], difference(state.shoulders[1], state.shoulders[0]), move[1]};
    // The speed is quadratic in the deflection: small deflections aim, large ones turn around.
    const double look_radps = settings.stick_look_radps * std::hypot(look[0], look[1]);
    input.turn_left_rad = -look_radps * dt_s * look[0];
    input.look_up_rad = -look_radps * dt_s * look[1];
    for (std::size_t side = 0; side < 2; ++side) {
        const double threshold = memory.grips[side] ? k_opens_at : k_closes_at;
        memory.grips[side] = state.triggers[side] >= threshold;
        input.grip[side] = memory.grips[side];
    }
    input.farther_m = k_farther_mps * dt_s * difference(state.pad[up], state.pad[down]);
    const double turn = difference(state.pad[left], state.pad[right]);
    if (settings.turn == TurnKind::smooth) {
        input.smooth_turn = turn;
    } else if (!memory.turned) {
        input.snap_turns = static_cast<int>(turn);
    }
    memory.turned = turn != 0.0;
    input.brake = state.brake;
    input.hurry = state.hurry;
    return input;
}

DesktopInput combine(const DesktopInput& a, const DesktopInput& b) {
    DesktopInput both = a;
    both.turn_left_rad += b.turn_left_rad;
    both.look_up_rad += b.look_up_rad;
    both.farther_m += b.farther_m;
    both.move = {std::clamp(a.move.x + b.move.x, -1.0, 1.0),
                 std::clamp(a.move.y + b.move.y, -1.0, 1.0),
                 std::clamp(a.move.z + b.move.z, -1.0, 1.0)};
    both.smooth_turn = std::clamp(a.smooth_turn + b.smooth_turn, -1.0, 1.0);
    both.snap_turns += b.snap_turns;
    for (std::size_t side = 0; side < 2; ++side) {
        both.grip[side] = a.grip[side] || b.grip[side];
        both.opened[side] = (a.opened[side] || b.opened[side]) && !(a.grip[side] && b.grip[side]);
    }
    both.hurry = a.hurry || b.hurry;
    both.brake = a.brake || b.brake;
    return both;
}

}  // namespace handhold
