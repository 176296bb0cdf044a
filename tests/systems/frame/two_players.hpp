#pragma once

#include <array>
#include <cmath>
#include <functional>
#include <memory>
#include <vector>

#include "tests/systems/frame/scenario.hpp"

namespace handhold::test {

// A world of two players whose devices follow functions of time. Drifting players are not braked.
struct TwoPlayers {
    static constexpr double k_step_s = 1.0 / 90.0;

    ShapeLibrary shapes;
    World world;
    Tuning tuning;
    StageStats stats;
    std::array<DeviceScript, 2> scripts;
    std::array<PlayerEntities, 2> players;
    std::array<PlayerCommands, 2> commands;
    std::unique_ptr<FrameCaches> caches;
    // The kind of frame that runs.
    decltype(&step_frame) kind_of_step = &step_frame;
    bool are_silent = false;  // true: no device sends anything

    TwoPlayers() { tuning.locomotion.drift_drag_per_s = 0.0; }
    void add_players(const std::array<const char*, 2>& names,
                     const std::array<double, 2>& masses_kg) {
        for (std::size_t i = 0; i < players.size(); ++i) {
            PlayerDescription description;
            description.name = names[i];
            description.body.mass_kg = masses_kg[i];
            description.head_shape = shapes.add_sphere(tuning.head.radius_m);
            players[i] = add_player(world, description);
            for (const Entity hand : players[i].hands) {
                world.controller_to_hand.add(hand, {});
            }
        }
    }
    // Call before the first frame, after all bodies were added.
    void drop_caches() { caches = std::make_unique<FrameCaches>(shapes); }

    // One frame. Devices are sampled at its start and its end.
    void step() {
        const double end_s = world.clock.t_s + k_step_s;
        std::array<std::array<TrackingSample, 2>, 2> samples;
        std::vector<PlayerInput> inputs;
        for (std::size_t p = 0; p < players.size(); ++p) {
            samples[p] = {sample_of(scripts[p], world.clock.t_s), sample_of(scripts[p], end_s)};
            inputs.push_back({players[p].player, samples[p], commands[p]});
        }
        if (are_silent) {
            inputs.clear();
        }
        kind_of_step(world, *caches, tuning, {k_step_s, inputs}, stats);
    }
    void run(
        double seconds, const std::function<void()>& after_frame = [] {}) {
        for (int i = 0; i < static_cast<int>(std::lround(seconds / k_step_s)); ++i) {
            step();
            after_frame();
        }
    }

    double t_s() const { return world.clock.t_s; }
    Vec3 origin(std::size_t i) const {
        return world.player_origin.at(players[i].player).pose_ws.position;
    }
    Vec3& velocity(std::size_t i) { return world.player_velocity.at(players[i].player).linear_mps; }
    double mass_kg(std::size_t i) const { return world.player.at(players[i].player).mass_kg; }
    Vec3 momentum() { return mass_kg(0) * velocity(0) + mass_kg(1) * velocity(1); }
};

}  // namespace handhold::test
