#include "game/scene/scene.hpp"
#include "systems/frame/frame.hpp"
#include "tests/fuzz/promise.hpp"

namespace handhold::fuzz {

void run_scene(Bytes bytes) {
    // The folder does not exist, so meshes are never found.
    const std::filesystem::path path = "/nonexistent/fuzz.json";
    const Result<SceneFile> file = parse_scene_file(text_of(bytes), path);
    if (!file) {
        promise(!file.error().expected.empty(), "a refusal says what was expected");
        return;
    }
    Result<Scene> built = build_scene(file.value(), path);
    if (!built) {
        promise(!built.error().expected.empty(), "a refusal says what was expected");
        return;
    }
    Scene& scene = built.value();
    for (const ScenePlayerStart& start : scene.players) {
        add_scene_player(scene, start);
    }
    FrameCaches caches(scene.shapes(), &scene.grip_meshes());
    StageStats stats;
    for (int frame = 0; frame < 3; ++frame) {
        step_frame(scene.world(), caches, scene.tuning(), {1.0 / 90.0, {}}, stats);
    }
    for (const BodyPose& pose : scene.world().body_pose.elements()) {
        promise(is_valid(pose.pose_ws), "bodies are somewhere");
    }
}

}  // namespace handhold::fuzz
