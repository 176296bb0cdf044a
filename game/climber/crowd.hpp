#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "game/climber/climber.hpp"
#include "game/scene/scene.hpp"
#include "systems/frame.hpp"

namespace handhold {

// Places for play spaces spread over a scene's free space: found by wandering in straight lines
// from `first_ws` and the scene's spawns through space that is enclosed, so that nobody begins
// inside of something, on the far side of a wall, or in another's head. The first is `first_ws`
// itself. Fewer than `count` where there is no room for more. Equal seeds give equal places.
// `caches` belong to the scene.
std::vector<Pose> spread_players(const Scene& scene, FrameCaches& caches, const Pose& first_ws,
                                 std::size_t count, std::uint64_t seed);

// Where the head of someone is who stands there at ease.
Vec3 head_over(const Pose& origin_ws);

// Many climbers in one scene.
class Crowd {
  public:
    // Every player wanders, each with a seed and a pace of his own.
    Crowd(const Scene& scene, std::span<const PlayerEntities> players, std::uint64_t seed);

    // What all of them do in the frame that ends at frame_end_s: inputs[i] of the i-th player. The
    // samples stay good until the next call. `caches` belong to the scene and are left with every
    // collider where it is.
    void drive(const Scene& scene, FrameCaches& caches, double frame_end_s,
               std::span<PlayerInput> inputs);

    // All that the next frame depends on beside the world.
    std::vector<ClimberState>& states() { return states_; }
    const std::vector<ClimberState>& states() const { return states_; }

  private:
    std::vector<ClimberTask> tasks_;
    std::vector<ClimberState> states_;
    std::vector<std::vector<TrackingSample>>
        samples_;  // kept, so that warm frames allocate nothing
};

}  // namespace handhold
