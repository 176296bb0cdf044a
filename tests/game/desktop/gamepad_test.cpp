// Input of the emulated head and hands from sticks and triggers, without a device.
#include "game/desktop/gamepad.hpp"

#include <cmath>

#include <gtest/gtest.h>

namespace handhold::gamepad_test {
namespace {

constexpr double k_dt_s = 0.01;

DesktopInput read(const GamepadState& state, const PlaySettings& settings = {}) {
    GamepadMemory memory;
    return read_gamepad(state, settings, k_dt_s, memory);
}

TEST(Gamepad, SticksAtRestGiveNoInput) {
    GamepadState state;
    state.left_stick = {0.12, -0.12};  // offset of worn sticks at rest
    state.right_stick = {-0.1, 0.14};
    const DesktopInput input = read(state);
    EXPECT_TRUE(input.move == hh::Vec3{});
    EXPECT_EQ(input.turn_left_rad, 0.0);
    EXPECT_EQ(input.look_up_rad, 0.0);
}

TEST(Gamepad, LeftStickPullsInItsDirectionUpToKeySpeed) {
    GamepadState state;
    state.left_stick = {0.0, -1.0};
    EXPECT_NEAR(read(state).move.z, -1.0, 1e-12);  // forward, like W
    for (int i = 0; i < 24; ++i) {
        const double angle = i * 3.14159265358979323846 / 12.0;
        for (const double length : {0.3, 0.7, 1.0}) {
            state.left_stick = {length * std::cos(angle), length * std::sin(angle)};
            const hh::Vec3 move = read(state).move;
            // Closed form: from 0 at 0.18 to 1 at 1, along the stick.
            EXPECT_NEAR(hh::length(move), (length - 0.18) / 0.82, 1e-12);
            EXPECT_NEAR(move.x * std::sin(angle) - move.z * std::cos(angle), 0.0, 1e-12);
        }
    }
}

TEST(Gamepad, RightStickTurnRateIsIndependentOfFrameRate) {
    PlaySettings settings;
    settings.stick_look_radps = 2.0;
    GamepadState state;
    state.right_stick = {1.0, 0.0};
    for (const double dt_s : {1.0 / 30.0, 1.0 / 90.0, 1.0 / 240.0}) {
        GamepadMemory memory;
        double turned_rad = 0.0;
        for (int i = 0; i < static_cast<int>(std::lround(1.0 / dt_s)); ++i) {
            turned_rad += read_gamepad(state, settings, dt_s, memory).turn_left_rad;
        }
        EXPECT_NEAR(turned_rad, -2.0, 1e-9);  // right
    }
}

TEST(Gamepad, TriggerHysteresisGivesOneGrip) {
    GamepadMemory memory;
    GamepadState state;
    int changes = 0;
    bool before = false;
    for (int i = 0; i < 400; ++i) {
        const double pressed = i < 200 ? i / 200.0 : (400 - i) / 200.0;  // pressed, then released
        state.triggers[1] = pressed + 0.08 * (i % 2 == 0 ? 1.0 : -1.0);
        const bool grips = read_gamepad(state, {}, k_dt_s, memory).grip[1];
        changes += grips != before ? 1 : 0;
        before = grips;
    }
    EXPECT_EQ(changes, 2);
    EXPECT_FALSE(memory.grips[0]);
}

TEST(Gamepad, HeldPadTurnsOneStepOrContinuously) {
    GamepadState state;
    state.pad[2] = true;  // left
    GamepadMemory memory;
    int steps = 0;
    for (int i = 0; i < 50; ++i) {
        steps += read_gamepad(state, {}, k_dt_s, memory).snap_turns;
    }
    EXPECT_EQ(steps, 1);
    PlaySettings smooth;
    smooth.turn = TurnKind::smooth;
    EXPECT_EQ(read_gamepad(state, smooth, k_dt_s, memory).smooth_turn, 1.0);
    EXPECT_EQ(read_gamepad(state, smooth, k_dt_s, memory).snap_turns, 0);
}

TEST(Gamepad, CombinesWithKeysByHoldingEither) {
    DesktopInput keys;
    keys.grip[0] = true;
    keys.move = {0.0, 0.0, -1.0};
    keys.turn_left_rad = 0.1;
    GamepadState state;
    state.triggers[1] = 1.0;
    state.left_stick = {0.0, -1.0};
    const DesktopInput both = combine(keys, read(state));
    EXPECT_TRUE(both.grip[0] && both.grip[1]);
    EXPECT_TRUE(both.move == -hh::k_z);
    EXPECT_EQ(both.turn_left_rad, 0.1);
}

}  // namespace
}  // namespace handhold::gamepad_test
