#pragma once

#include <array>

#include "game/desktop/desktop_body.hpp"
#include "game/desktop/play_settings.hpp"

// A gamepad as what keys and mouse are: input of the emulated head and hands.
namespace handhold {

// As the device says; sticks are positive to the right and down.
struct GamepadState {
    std::array<double, 2> left_stick{};   // each [-1, 1]
    std::array<double, 2> right_stick{};  // each [-1, 1]
    std::array<double, 2> triggers{};     // by HandSide, each [0, 1]
    std::array<bool, 2> shoulders{};      // by HandSide
    std::array<bool, 4> pad{};            // up, down, left, right
    bool brake = false;                   // the lowest of the four buttons
    bool hurry = false;                   // the left stick pressed
};

// What is remembered from one reading to the next.
struct GamepadMemory {
    std::array<bool, 2> grips{};
    bool turned = false;  // one snap turn a press
};

// Left stick: pulls right and back; shoulders: down, up. Right stick: looks about. Triggers: each
// hand grips from 55 % on until it is below 35 %. Pad: up and down push what is held away and pull
// it near, left and right turn. Sticks count from 18 % of their way on.
DesktopInput read_gamepad(const GamepadState& state, const PlaySettings& settings, double dt_s,
                          GamepadMemory& memory);

// Two devices at once: what either holds is held, and motions add up to full speed at most.
DesktopInput combine(const DesktopInput& a, const DesktopInput& b);

}  // namespace handhold
