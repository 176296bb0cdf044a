#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "game/climber/climber.hpp"
#include "game/scene/scene.hpp"
#include "systems/frame/frame.hpp"

namespace handhold {

// Spreads players over a scene's free space, so that nobody starts inside a body, behind a wall, or
// in another player's head. Returns the origins of their play spaces; the first is `first_ws`. Each
// further head is visible from an earlier head or from a spawn. Returns fewer than `count` if there
// is no space for more. Equal seeds give equal places. Precondition: `caches` belong to the scene.
std::vector<Pose> spread_players(const Scene& scene, FrameCaches& caches, const Pose& first_ws,
                                 std::size_t count, std::uint64_t seed);

// The head of a player who stands upright at this origin.
Vec3 head_over(const Pose& origin_ws);

// Several climbers in one scene.
class Crowd {
  public:
    // One climber for each player. All wander; each has its own seed and speed.
    Crowd(const Scene& scene, std::span<const PlayerEntities> players, std::uint64_t seed);

    // Sets inputs[i] to the input of player i for the frame that ends at `frame_end_s`. The samples
    // stay valid until the next call. Moves all colliders to their current poses. Precondition:
    // `caches` belong to the scene.
    void drive(const Scene& scene, FrameCaches& caches, double frame_end_s,
               std::span<PlayerInput> inputs);

    // The climbers' complete state. Copies of this and of the world continue identically.
    std::vector<ClimberState>& states() { return states_; }
    const std::vector<ClimberState>& states() const { return states_; }

  private:
    std::vector<ClimberTask> tasks_;
    std::vector<ClimberState> states_;
    // Reused, so that warm frames allocate nothing.
    std::vector<std::vector<TrackingSample>> samples_;
};

}  // namespace handhold
