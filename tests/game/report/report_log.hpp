#pragma once

#include <array>
#include <cstddef>

#include <handhold/math.hpp>

#include "game/run/run_log.hpp"

// A run made by hand: every figure of its report follows from the numbers here.
namespace handhold {

// Four frames at 2 Hz of two players and three bodies; the second player is idle. Lengths are sums
// of powers of two, hence exact.
inline RunLog make_small_run() {
    RunLog log;
    log.scene = "shaft <7>";
    log.input = "climb & drift.csv";
    log.spawn = "auto: 1 2 3, yaw 90";
    log.hz = 2.0;
    log.threads = 3;
    log.player_names = {"ann", "ben"};
    log.player_mass_kg = {80.0, 60.0};
    log.body_names = {"rail", "rock, \"small\"", "cart"};
    log.body_mass_kg = {0.0, 5.0, 0.0};
    log.wall_s = 0.5;
    log.state_hash = 0x00ab'cdef'0123'4567ULL;

    const std::array<double, 4> stage_us = {3.0, 1.0, 4.0, 2.0};  // of stage s: (s + 1) times this
    const std::array<hh::Vec3, 4> origins = {hh::Vec3{0.0, 0.0, 0.0}, hh::Vec3{3.0, 4.0, 0.0},
                                             hh::Vec3{3.0, 4.0, 0.0}, hh::Vec3{3.0, 4.0, 12.0}};
    for (std::size_t i = 0; i < origins.size(); ++i) {
        FrameLog frame;
        frame.frame = i + 1;
        frame.t_s = 0.5 * static_cast<double>(i + 1);
        for (std::size_t s = 0; s < frame.stats.stage_us.size(); ++s) {
            frame.stats.stage_us[s] = stage_us[i] * static_cast<double>(s + 1);
        }
        PlayerLog ann;
        ann.origin_ws = origins[i];
        ann.head_ws = origins[i] + hh::Vec3{0.0, 1.5, 0.0};
        PlayerLog ben;
        ben.player = 1;
        frame.players = {ann, ben};
        BodyLog rock;
        rock.body = 1;
        rock.pose_ws.position = hh::Vec3{0.5, 0.25, static_cast<double>(i)};
        BodyLog cart;
        cart.body = 2;
        frame.bodies = {rock, cart};
        log.frames.push_back(frame);
    }
    return log;
}

// A hand of the first player grips a body.
inline void grip(FrameLog& frame, hh::Side side, std::int32_t body, double error_m) {
    HandLog& hand = frame.players[0].hands[side];
    hand.grip = 1;
    hand.body = body;
    hand.error_m = error_m;
}

// make_small_run with each kind of grip: one hand free; one hand with contacts; two hands; one hand
// while pushed back.
inline RunLog make_gripping_run() {
    RunLog log = make_small_run();
    grip(log.frames[0], HH_LEFT, 0, 1.0 / 1024);
    grip(log.frames[1], HH_RIGHT, 1, 1.0 / 4);
    log.frames[1].stats.contacts = 2;
    grip(log.frames[2], HH_LEFT, 0, 1.0 / 64);
    grip(log.frames[2], HH_RIGHT, 2, 1.0 / 128);
    grip(log.frames[3], HH_LEFT, 0, 1.0 / 32);
    log.frames[3].players[0].push_back_m = 1.0 / 8;
    return log;
}

}  // namespace handhold
