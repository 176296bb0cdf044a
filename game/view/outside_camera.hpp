#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "components/render.hpp"
#include "engine/collision/collision_world.hpp"
#include "game/scene/scene.hpp"

namespace handhold {

// Where the camera is while somebody plays.
enum class PlayerViewpoint : std::uint8_t { eyes, mirror, behind, free };
inline constexpr int k_player_viewpoints = 4;

// Cameras that look at a player and avoid walls. Only reads the world.
class OutsideCamera {
  public:
    // `scene` must outlive the camera.
    explicit OutsideCamera(const Scene& scene) : scene_(&scene), walls_(scene.shapes()) {}

    // Behind and above the player's head.
    Pose behind(const RenderPose& render);
    // In front of the player, looking back. The left hand is on the right, as in a photograph. The
    // same as `behind` if walls leave less than 0.6 m.
    Pose before(const RenderPose& render);
    // From the side of two players, so that both are seen, and the first from behind.
    Pose beside(const RenderPose& first, const RenderPose& second);

  private:
    // Offset ahead, up and to the right of the target, metres.
    using Offset = std::array<double, 3>;
    // Looks at the target from one of the offsets. If a wall is in the way, the position is moved
    // in front of the wall. A later offset is chosen only if its position is farther from the
    // target by more than k_min_gain_m.
    Pose look_from(std::span<const Offset> offsets, const Vec3& head_ws, const Vec3& target_ws,
                   const Vec3& ahead_ws);
    Vec3 level_ahead(const RenderPose& render) const;
    void place_walls();

    const Scene* scene_;
    CollisionWorld walls_;  // colliders of the bodies that are not free
};

}  // namespace handhold
