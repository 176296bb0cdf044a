#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "game/climber/climber.hpp"
#include "game/scene/scene.hpp"
#include "systems/frame.hpp"

namespace handhold {

// Origins of play spaces spread over a scene's free space, so that no player begins inside
// something, behind a wall, or in another's head. They are found by straight walks through enclosed
// space from `first_ws` and the scene's spawns. The first is `first_ws` itself. Fewer than `count`
// if there is no space for more. Equal seeds give equal places. `caches` belong to the scene.
std::vector<Pose> spread_players(const Scene& scene, FrameCaches& caches, const Pose& first_ws,
                                 std::size_t count, std::uint64_t seed);

// The head's centre of a player in the rest pose at this origin.
Vec3 head_over(const Pose& origin_ws);

// Several climbers in one scene.
class Crowd {
  public:
    // All wander, each with a seed and a pace of its own.
    Crowd(const Scene& scene, std::span<const PlayerEntities> players, std::uint64_t seed);

    // What they do in the frame that ends at frame_end_s: inputs[i] for the i-th player. The
    // samples stay valid until the next call. `caches` belong to the scene; all colliders are at
    // their present poses afterwards.
    void drive(const Scene& scene, FrameCaches& caches, double frame_end_s,
               std::span<PlayerInput> inputs);

    // With the world, all that the next frame depends on.
    std::vector<ClimberState>& states() { return states_; }
    const std::vector<ClimberState>& states() const { return states_; }

  private:
    std::vector<ClimberTask> tasks_;
    std::vector<ClimberState> states_;
    std::vector<std::vector<TrackingSample>> samples_;  // reused: warm frames allocate nothing
};

}  // namespace handhold
