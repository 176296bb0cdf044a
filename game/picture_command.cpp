#include "game/picture_command.hpp"

#include <chrono>
#include <cstdio>
#include <filesystem>
#include <system_error>

#include "engine/io/text_file.hpp"
#include "game/exit_status.hpp"
#include "game/player_defaults.hpp"
#include "game/render/hand_figures.hpp"
#include "game/scene_picture.hpp"
#include "systems/frame.hpp"

namespace handhold {
namespace {

void step_to(Scene& scene, double seconds) {
    constexpr double k_dt_s = 1.0 / 90.0;
    FrameCaches caches(*scene.shapes, scene.grip_meshes.get());
    StageStats stats;
    while (scene.world.clock.t_s + 0.5 * k_dt_s < seconds) {
        step_frame(scene.world, caches, scene.tuning, {k_dt_s, {}}, stats);
    }
}

Pose eyes_at(const SceneSpawnPoint& spawn, const PictureOptions& options) {
    const Quat look = rotation_about(Vec3::UnitY(), options.yaw_deg * k_degree) *
                      rotation_about(Vec3::UnitX(), options.pitch_deg * k_degree);
    return spawn.pose_ws * Pose{Vec3(0.0, k_eye_height_m, 0.0), look};
}

// Both hands before the eyes, as a player looks at them: fingers up, palms half turned to him.
void add_hands(const std::string& shape, const Pose& eyes_ws, HandFigures& figures,
               Renderer& renderer, RenderFrame& frame) {
    figures.begin();
    for (const HandSide side : {HandSide::left, HandSide::right}) {
        const HandRig& rig = figures.rig(side);
        const double out = side == HandSide::left ? -1.0 : 1.0;
        const Pose wrist{Vec3(out * 0.10, -0.13, -0.36), rotation_about(Vec3::UnitY(), -out * 0.5) *
                                                             rotation_about(Vec3::UnitX(), 1.0)};
        std::array<FingerAngles, k_finger_count> fingers;
        for (std::size_t i = 0; i < rig.fingers.size(); ++i) {
            const bool is_thumb = rig.fingers[i].name == FingerName::thumb;
            fingers[i] = shape == "fist" ? coupled_angles(rig.fingers[i], is_thumb ? 0.5 : 0.85)
                                         : relaxed_angles(rig.fingers[i]);
            fingers[i].opposition_rad = shape == "fist" && is_thumb ? 0.9 : 0.0;
        }
        figures.add(side, eyes_ws * wrist, fingers, renderer, frame);
    }
}

}  // namespace

int picture_command(const PictureOptions& options) {
    Result<Scene> loaded = load_scene(options.scene);
    if (!loaded) {
        return refuse(loaded.error());
    }
    Scene& scene = loaded.value();
    Result<PlayerModels> models = choose_player_models(options.models);
    if (!models) {
        return refuse(models.error());
    }
    std::error_code failure;
    std::filesystem::create_directories(options.out, failure);
    if (failure) {
        return refuse({options.out, "", "expected a folder that can be made"});
    }
    step_to(scene, options.seconds);
    std::string why_not;
    std::optional<Renderer> renderer =
        Renderer::create(options.width_px, options.height_px, why_not, PictureQuality::fine);
    if (!renderer) {
        std::fprintf(stderr, "no pictures: %s\n", why_not.c_str());
        return k_exit_bad_file;
    }
    const std::vector<MeshId> meshes = add_scene_meshes(scene, *renderer);
    HandFigures figures(std::move(models.value().hands), *renderer);
    Image image;
    for (const SceneSpawnPoint& spawn : scene.spawns) {
        if (!options.spawn.empty() && options.spawn != spawn.name) {
            continue;
        }
        RenderFrame frame = make_scene_frame(scene, meshes);
        frame.camera.pose_ws = eyes_at(spawn, options);
        if (!options.hands.empty()) {
            add_hands(options.hands, frame.camera.pose_ws, figures, *renderer, frame);
        }
        const auto begin = std::chrono::steady_clock::now();
        renderer->draw(frame, image);
        const std::chrono::duration<double> cost = std::chrono::steady_clock::now() - begin;
        const std::vector<std::uint8_t> png = encode_png(image);
        const std::filesystem::path file =
            std::filesystem::path(options.out) / (spawn.name + ".png");
        if (const auto error = write_file_atomically(file, std::string(png.begin(), png.end()))) {
            return refuse(*error);
        }
        std::printf("%s: %.2f s, %d triangles in all passes\n", file.string().c_str(), cost.count(),
                    renderer->counters().triangles);
    }
    return 0;
}

}  // namespace handhold
