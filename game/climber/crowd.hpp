#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "game/climber/climber.hpp"
#include "game/scene/scene.hpp"

namespace handhold {

// Spreads players over a scene's free space, so that nobody starts inside a body, behind a wall, or
// in another player's head. Returns the origins of their play spaces; the first is `first_ws`. Each
// further head is visible from an earlier head or from a spawn. Returns fewer than `count` if there
// is no space for more. Equal seeds give equal places.
std::vector<hh::Pose> spread_players(Scene& scene, const hh::Pose& first_ws, std::size_t count,
                                     std::uint64_t seed);

// The head of a player who stands upright at this origin.
hh::Vec3 head_over(const hh::Pose& origin_ws);

// Several climbers in one scene.
class Crowd {
  public:
    // One climber for each player. All wander; each has its own seed and speed.
    Crowd(const hh::World& world, std::span<const hh::Player> players, std::uint64_t seed);

    // Sets inputs[i] to the input of player i for the frame that ends at `frame_end_s`. The samples
    // stay valid until the next call. `sight`: of the world with the players.
    void drive(const ClimberSight& sight, double frame_end_s, std::span<hh_player_input> inputs);

    // The climbers' complete state. Copies of this and of the world continue identically.
    std::vector<ClimberState>& states() { return states_; }
    const std::vector<ClimberState>& states() const { return states_; }

  private:
    std::vector<ClimberTask> tasks_;
    std::vector<ClimberState> states_;
    // Reused, so that warm frames allocate nothing.
    std::vector<std::vector<hh::Sample>> samples_;
};

}  // namespace handhold
