#include "game/view/scene_picture.hpp"

namespace handhold {

std::vector<MeshId> add_scene_meshes(const Scene& scene, Renderer& renderer) {
    std::vector<MeshId> meshes;
    meshes.reserve(scene.visuals.size());
    for (const SceneVisual& visual : scene.visuals) {
        meshes.push_back(renderer.add_mesh(*visual.mesh));
    }
    return meshes;
}

RenderFrame make_scene_frame(const Scene& scene, const std::vector<MeshId>& meshes) {
    const World& world = scene.world();
    RenderFrame frame;
    frame.backdrop = Backdrop::space;
    frame.up_ws = scene.up_ws;
    frame.lamps = scene.lamps;
    frame.key = scene.key;
    if (scene.lamps.empty()) {
        frame.head_light = 0.55F;  // light for a level without its own lamps
    }
    if (!is_null(scene.lamps_body)) {  // a ship's lamps move with the ship
        const Pose& ship = world.body_pose.at(scene.lamps_body).pose_ws;
        for (Lamp& lamp : frame.lamps) {
            lamp.position_ws = transform_point(ship, lamp.position_ws);
        }
    }
    for (std::size_t i = 0; i < scene.visuals.size(); ++i) {
        const SceneVisual& visual = scene.visuals[i];
        frame.instances.push_back(
            {meshes[i], world.body_pose.at(visual.body).pose_ws, visual.color, visual.look});
    }
    return frame;
}

}  // namespace handhold
