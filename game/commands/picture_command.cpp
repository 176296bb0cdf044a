#include "game/commands/picture_command.hpp"

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <filesystem>

#include "engine/core/printable.hpp"
#include "engine/core/text_file.hpp"
#include "engine/io/file_name.hpp"
#include "game/commands/output_folder.hpp"
#include "game/mesh/primitives.hpp"
#include "game/play/exit_status.hpp"
#include "game/play/loading.hpp"
#include "game/render/hand_figures.hpp"
#include "game/scene/player_defaults.hpp"
#include "game/session/interrupt.hpp"
#include "game/view/grip_fit.hpp"
#include "game/view/scene_picture.hpp"
#include "systems/frame/frame.hpp"
#include "systems/rigs/hand_kinematics.hpp"

namespace handhold {
namespace {

void step_to(Scene& scene, double seconds) {
    constexpr double k_dt_s = 1.0 / 90.0;
    while (scene.host.time_s() + 0.5 * k_dt_s < seconds && scene.host.step(k_dt_s)) {
    }
}

Pose eyes_at(const SceneSpawnPoint& spawn, const PictureOptions& options) {
    const Quat look = rotation_about(Vec3::UnitY(), options.yaw_deg * k_degree) *
                      rotation_about(Vec3::UnitX(), options.pitch_deg * k_degree);
    return from_host(spawn.pose_ws) * Pose{Vec3(0.0, k_eye_height_m, 0.0), look};
}

// Pose of a wrist in front of the eyes. An open hand has its fingers up and its back to the player.
// A fist around a controller has its thumb up.
Pose wrist_before_eyes(HandSide side, bool holds_controller) {
    const double out = side == HandSide::left ? -1.0 : 1.0;
    if (holds_controller) {
        return {Vec3(out * 0.18, -0.17, -0.30), rotation_about(Vec3::UnitY(), out * 0.45) *
                                                    rotation_about(Vec3::UnitX(), 0.45) *
                                                    rotation_about(Vec3::UnitZ(), -out * 1.25)};
    }
    return {Vec3(out * 0.10, -0.13, -0.36),
            rotation_about(Vec3::UnitY(), -out * 0.5) * rotation_about(Vec3::UnitX(), 1.0)};
}

void add_hands(const std::string& shape, const Pose& eyes_ws, HandFigures& figures,
               const std::optional<ControllerFigures>& controllers, Renderer& renderer,
               RenderFrame& frame) {
    figures.begin();
    for (const HandSide side : {HandSide::left, HandSide::right}) {
        const HandRig& rig = figures.rig(side);
        const Pose wrist = wrist_before_eyes(side, controllers.has_value());
        std::array<FingerAngles, k_finger_count> fingers;
        for (std::size_t i = 0; i < rig.fingers.size(); ++i) {
            fingers[i] = shape == "fist" ? rig.fingers[i].fist : relaxed_angles(rig.fingers[i]);
        }
        if (controllers) {
            const ControlValues controls = closing_values(shape == "fist");
            fingers = controllers->fingers(side, controls);
            controllers->add(side, eyes_ws * wrist, controls, frame);
        }
        figures.add(side, eyes_ws * wrist, fingers, renderer, frame);
    }
}

// Draws pictures, saves them, and prints each one's drawing time and number of triangles.
class PictureSaver {
  public:
    PictureSaver(Renderer& renderer, std::filesystem::path folder)
        : renderer_(renderer), folder_(std::move(folder)) {}

    std::optional<FileError> save(const RenderFrame& frame, const std::string& name) {
        const auto begin = std::chrono::steady_clock::now();
        renderer_.draw(frame, image_);
        const std::chrono::duration<double> cost = std::chrono::steady_clock::now() - begin;
        const std::vector<std::uint8_t> png = encode_png(image_);
        const std::filesystem::path file = folder_ / (file_name(name) + ".png");
        if (auto error = write_file_atomically(file, std::string(png.begin(), png.end()))) {
            return error;
        }
        std::printf("%s: %.2f s, %d triangles in all passes\n", printable(file.string()).c_str(),
                    cost.count(), renderer_.counters().triangles);
        return std::nullopt;
    }

  private:
    Renderer& renderer_;
    std::filesystem::path folder_;
    Image image_;
};

// Draws the body from several sides with a right hand in its first grip and a left hand in its
// second.
std::optional<FileError> draw_grips(const Scene& scene, const std::string& name,
                                    const RenderFrame& bare, HandFigures& figures,
                                    Renderer& renderer, PictureSaver& saver) {
    const Entity body = find_by_id(scene.world(), persistent_id_from_name(name));
    const AuthoredGrips* const grips = scene.world().authored_grips.find(body);
    const Collider* const collider = scene.world().collider.find(body);
    if (grips == nullptr || collider == nullptr) {
        return FileError{scene.name, "/bodies",
                         "expected a body with grips, found none named \"" + name + "\""};
    }
    const Pose& body_ws = scene.world().body_pose.at(body).pose_ws;
    RenderFrame frame = bare;
    figures.begin();
    for (std::size_t i = 0; i < std::min<std::size_t>(grips->count, k_hand_count); ++i) {
        const HandSide side = i == 0 ? HandSide::right : HandSide::left;
        const AuthoredHand& hand = grips->grips[i].hands[index_of(side)];
        if (hand.is_there) {
            const FittedGrip fit =
                fit_grip(scene.grip_meshes().at(collider->shape), figures.rig(side), hand.wrist_bs,
                         scene.tuning(), &hand);
            figures.add(side, body_ws * fit.wrist_bs, fit.fingers, renderer, frame);
        }
    }
    const struct {
        const char* name;
        Vec3 from;
    } views[] = {{"right", Vec3(0.40, 0.12, -0.02)},
                 {"left", Vec3(-0.40, 0.10, -0.10)},
                 {"behind", Vec3(0.10, 0.20, 0.38)},
                 {"front", Vec3(-0.16, -0.04, -0.52)}};
    frame.head_light = 0.8F;
    const Vec3 middle_ws = transform_point(body_ws, Vec3(0.0, -0.02, 0.0));
    for (const auto& view : views) {
        const Vec3 eye_ws = transform_point(body_ws, view.from);
        frame.camera.pose_ws =
            look_along(eye_ws, middle_ws - eye_ws, body_ws.rotation * Vec3::UnitY());
        if (auto error = saver.save(frame, name + "_" + view.name)) {
            return error;
        }
    }
    return std::nullopt;
}

}  // namespace

int picture_command(const PictureOptions& options) {
    const InterruptGuard interrupts;
    Result<Scene> loaded = load_scene_with_progress(options.scene);
    if (!loaded) {
        return refuse(loaded.error());
    }
    Scene& scene = loaded.value();
    print_notes(scene.notes);
    Result<PlayerModels> models = choose_player_models(options.models);
    if (!models) {
        return refuse(models.error());
    }
    print_notes(models.value().notes);
    const Result<OutputFolder> folder = OutputFolder::open(options.out);
    if (!folder) {
        return refuse(folder.error());
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
    std::optional<ControllerFigures> controllers;
    if (models.value().controllers) {
        controllers.emplace(*models.value().controllers, figures, *renderer);
    }
    PictureSaver saver(*renderer, options.out);
    if (!options.grips_of.empty()) {
        const auto error = draw_grips(scene, options.grips_of, make_scene_frame(scene, meshes),
                                      figures, *renderer, saver);
        return error ? refuse(*error) : 0;
    }
    for (const SceneSpawnPoint& spawn : scene.spawns) {
        if (!options.spawn.empty() && options.spawn != spawn.name) {
            continue;
        }
        RenderFrame frame = make_scene_frame(scene, meshes);
        frame.camera.pose_ws = eyes_at(spawn, options);
        if (!options.hands.empty()) {
            add_hands(options.hands, frame.camera.pose_ws, figures, controllers, *renderer, frame);
        }
        if (const auto error = saver.save(frame, spawn.name)) {
            return refuse(*error);
        }
        if (is_interrupted()) {
            return k_exit_interrupted;
        }
    }
    return 0;
}

}  // namespace handhold
