#pragma once

#include <vector>

#include "game/render/renderer.hpp"
#include "game/scene/scene.hpp"

namespace handhold {

// Adds the scene's meshes to a renderer. The result is indexed as Scene::visuals.
std::vector<MeshId> add_scene_meshes(const Scene& scene, Renderer& renderer);

// The current state of the scene: bodies, lamps and backdrop. The caller adds camera and players.
RenderFrame make_scene_frame(const Scene& scene, const std::vector<MeshId>& meshes);

}  // namespace handhold
