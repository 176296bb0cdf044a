#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "components/world.hpp"

namespace handhold::lab {

// Counts what hands do in a world, tick by tick.
struct HoldsCount {
    // A body that was let go slower than this was not thrown.
    static constexpr double k_throw_mps = 1.0;

    std::uint64_t grips = 0;         // hands that closed on something
    std::uint64_t shared_holds = 0;  // ticks in which hands of two players hold one body
    std::uint64_t player_holds = 0;  // ticks in which a hand holds another player
    std::uint64_t throws = 0;  // free bodies that the last hand let go faster than k_throw_mps

    void add(const World& world) {
        std::size_t holding = 0;
        bool is_shared = false;
        bool is_player_held = false;
        for (std::size_t a = 0; a < world.grab.size(); ++a) {
            const Grab& grab = world.grab.elements()[a];
            holding += grab.kind != GripKind::none ? 1U : 0U;
            is_player_held = is_player_held || grab.kind == GripKind::player;
            for (std::size_t b = 0; b < a && grab.kind == GripKind::held; ++b) {
                const Grab& other = world.grab.elements()[b];
                is_shared = is_shared || (other.kind == GripKind::held && other.body == grab.body &&
                                          world.hand_owner.at(world.grab.owners()[a]).player !=
                                              world.hand_owner.at(world.grab.owners()[b]).player);
            }
        }
        grips += holding > holding_ ? holding - holding_ : 0;
        shared_holds += is_shared ? 1U : 0U;
        player_holds += is_player_held ? 1U : 0U;
        holding_ = holding;
        count_throws(world);
    }

  private:
    static bool is_held(const World& world, Entity body) {
        return std::ranges::any_of(world.grab.elements(), [body](const Grab& grab) {
            return grab.kind != GripKind::none && grab.body == body;
        });
    }
    void count_throws(const World& world) {
        for (const Entity body : held_) {
            const BodyVelocity* const velocity = world.body_velocity.find(body);
            throws += velocity != nullptr && !is_held(world, body) &&
                              velocity->linear_mps.norm() > k_throw_mps
                          ? 1U
                          : 0U;
        }
        held_.clear();
        for (std::size_t i = 0; i < world.grab.size(); ++i) {
            const Grab& grab = world.grab.elements()[i];
            bool is_known = grab.kind != GripKind::held || grab.jointed;
            for (const Entity body : held_) {
                is_known = is_known || body == grab.body;
            }
            if (!is_known) {
                held_.push_back(grab.body);
            }
        }
    }

    std::size_t holding_ = 0;   // hands that held something in the last tick
    std::vector<Entity> held_;  // loose bodies that they held
};

}  // namespace handhold::lab
