#pragma once

#include <array>

#include "game/devices/desktop_body.hpp"
#include "game/devices/play_settings.hpp"

// Reads a gamepad as input of the emulated head and hands.
namespace handhold {

// Raw device state; sticks are positive to the right and down.
struct GamepadState {
    std::array<double, 2> left_stick{};   // each [-1, 1]
    std::array<double, 2> right_stick{};  // each [-1, 1]
    std::array<double, 2> triggers{};     // indexed by HandSide, each [0, 1]
    std::array<bool, 2> shoulders{};      // indexed by HandSide
    std::array<bool, 4> pad{};            // order: up, down, left, right
    bool brake = false;                   // the lowest of the four face buttons
    bool hurry = false;                   // the left stick pressed
};

// What read_gamepad remembers between calls.
struct GamepadMemory {
    std::array<bool, 2> grips{};
    bool turned = false;  // limits snap turns to one per press
};

// Left stick: moves right and back; shoulder buttons: down (left) and up (right). Right stick:
// looks around. Triggers: a hand closes above 55 % and opens below 35 %. Pad: up and down move a
// held body away and nearer, left and right turn the player. The sticks have a dead zone of 18 %.
DesktopInput read_gamepad(const GamepadState& state, const PlaySettings& settings, double dt_s,
                          GamepadMemory& memory);

// Combines the input of two devices. A button is held if it is held on either device; motions add
// up to full speed at most.
DesktopInput combine(const DesktopInput& a, const DesktopInput& b);

}  // namespace handhold
