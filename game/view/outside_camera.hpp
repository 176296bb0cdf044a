#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "components/render.hpp"
#include "engine/collision/collision_world.hpp"
#include "game/scene/scene.hpp"

namespace handhold {

// Where the camera of a play is.
enum class PlayerViewpoint : std::uint8_t { eyes, mirror, behind, free };
inline constexpr int k_player_viewpoints = 4;

// Cameras that look at a player, in the room with him. Only reads the world.
class OutsideCamera {
  public:
    // `scene` must outlive it.
    explicit OutsideCamera(const Scene& scene) : scene_(&scene), walls_(*scene.shapes) {}

    // Behind and above his head, as the scene's up is.
    Pose behind(const RenderPose& render);
    // Before him, looking back: his left hand is on the right, as in a photograph.
    // Behind where a wall leaves no room.
    Pose before(const RenderPose& render);

  private:
    // Ahead, up and to the right of what is looked at, metres.
    using Offset = std::array<double, 3>;
    // Looks at the target from the first of these places that walls between it and the head do not
    // bring much nearer to the target than another.
    Pose look_from(std::span<const Offset> offsets, const Vec3& head_ws, const Vec3& target_ws,
                   const Vec3& ahead_ws);
    Vec3 level_ahead(const RenderPose& render) const;
    void place_walls();

    const Scene* scene_;
    CollisionWorld walls_;  // of what is not free to move
};

}  // namespace handhold
