#pragma once

#include <vector>

#include "game/render/renderer.hpp"
#include "game/scene/scene.hpp"

namespace handhold {

// The scene's meshes in a renderer, by Scene::visuals.
std::vector<MeshId> add_scene_meshes(const Scene& scene, Renderer& renderer);

// The scene as it stands now: bodies, lamps and backdrop; camera and players are the caller's.
RenderFrame make_scene_frame(const Scene& scene, const std::vector<MeshId>& meshes);

}  // namespace handhold
