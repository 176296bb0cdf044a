#include "game/commands/grip_command.hpp"

#include <algorithm>
#include <cstdio>
#include <optional>

#include "engine/core/text_file.hpp"
#include "game/commands/exported_objects.hpp"
#include "game/commands/grip_file.hpp"
#include "game/levels/load_scene.hpp"
#include "game/play/exit_status.hpp"
#include "game/scene/scene.hpp"
#include "game/view/grip_fit.hpp"
#include "systems/input/read_tracking.hpp"
#include "systems/rigs/builtin_hand_rig.hpp"

namespace handhold {
namespace {

// Adds the body's visuals in the frame of its grips.
void add_object(const Scene& scene, Entity body, const Pose& body_in_file, GripScene& out) {
    for (const SceneVisual& visual : scene.visuals) {
        if (visual.body != body) {
            continue;
        }
        const Mesh& mesh = *visual.mesh;
        GltfSurface surface = exported_surface(mesh.name.empty() ? "part" : mesh.name, mesh,
                                               body_in_file, out.materials.size());
        if (!surface.indices.empty()) {
            out.materials.push_back({surface.name, visual.color.value_or(mesh.color),
                                     visual.look.emissive, visual.look.opacity, visual.look.gloss});
            out.object.push_back(std::move(surface));
        }
    }
}

std::optional<Pose> pose_of(const std::vector<double>& numbers) {
    if (numbers.size() != 7) {
        return std::nullopt;
    }
    Pose pose{Vec3(numbers[0], numbers[1], numbers[2]),
              Quat(numbers[6], numbers[3], numbers[4], numbers[5])};
    const double length = pose.rotation.norm();
    if (!is_finite(pose.position) || !(std::abs(length - 1.0) < 1e-2)) {
        return std::nullopt;
    }
    pose.rotation.normalize();
    return pose;
}

// Fills `out` with a new grip, fitted as the game fits a hand that closes at options.wrist. All
// fingers count as posed, with the fitted angles.
std::optional<FileError> pose_new(const Scene& scene, const GripMesh& mesh,
                                  const ExportGripOptions& options, const Pose& body_in_file,
                                  const HandRig& rig, GripScene& out) {
    const std::optional<Pose> wrist = pose_of(options.wrist);
    if (!wrist) {
        return FileError{options.scene, "",
                         "expected --wrist with a position and a unit quaternion for a new grip"};
    }
    const FittedGrip fitted =
        fit_grip(mesh, rig, inverse(body_in_file) * *wrist, scene.tuning(), nullptr);
    if (!fitted.is_gripping) {
        return FileError{options.scene, "", "expected a surface in reach of the wrist, found none"};
    }
    AuthoredHand& hand = out.grip.grip.hands[index_of(out.side)];
    hand.is_there = true;
    hand.wrist_bs = body_in_file * fitted.wrist_bs;
    hand.is_posed.fill(true);
    for (std::size_t f = 0; f < rig.fingers.size(); ++f) {
        hand.fingers[static_cast<std::size_t>(rig.fingers[f].name)] = fitted.fingers[f];
    }
    out.fingers = fitted.fingers;
    return std::nullopt;
}

std::optional<FileError> pose_known(const Scene& scene, const GripMesh& mesh,
                                    const Pose& body_in_file, const HandRig& rig, GripScene& out) {
    const AuthoredGrip placed = in_body_frame(out.grip.grip, body_in_file);
    const AuthoredHand& hand = placed.hands[index_of(out.side)];
    if (!hand.is_there) {
        return FileError{scene.name, "", "expected a grip for this hand"};
    }
    const FittedGrip fitted = fit_grip(mesh, rig, hand.wrist_bs, scene.tuning(), &hand);
    out.fingers = fitted.fingers;
    if (fitted.penetrating_fingers > 0) {
        std::fprintf(stderr, "%d posed fingers would penetrate and were fitted instead\n",
                     static_cast<int>(fitted.penetrating_fingers));
    }
    return std::nullopt;
}

}  // namespace

int export_grip_command(const ExportGripOptions& options) {
    Result<Scene> loaded = load_scene(options.scene);
    if (!loaded) {
        return refuse(loaded.error());
    }
    const Scene& scene = loaded.value();
    const Entity body = find_by_id(scene.world(), persistent_id_from_name(options.body));
    const Collider* const collider = scene.world().collider.find(body);
    if (collider == nullptr || !scene.world().body.contains(body)) {
        return refuse(
            {options.scene, "/bodies",
             "expected a body that can be touched, found none named \"" + options.body + "\""});
    }
    const auto frame = scene.body_in_file.find(options.body);
    const Pose body_in_file = frame != scene.body_in_file.end() ? frame->second : Pose();
    const GripMesh& mesh = scene.grip_meshes().at(collider->shape);
    GripScene out;
    out.side = options.hand == "left" ? HandSide::left : HandSide::right;
    out.grip.name = options.grip;
    out.controller = {
        {"controller", inverse(default_controller_to_hand(out.side, scene.tuning().hand))}};
    if (!options.controllers.empty()) {
        const Result<ControllerModels> models = choose_controllers(options.controllers);
        if (!models) {
            return refuse(models.error());
        }
        out.controller =
            controller_objects(models.value().sides[index_of(out.side)], out.materials);
    }
    const HandRig rig = builtin_hand_rig(out.side);
    std::optional<FileError> error;
    bool is_known = false;
    if (const auto grips = scene.grips.find(options.body); grips != scene.grips.end()) {
        for (const SceneGrip& grip : grips->second) {
            if (grip.name == options.grip && options.wrist.empty()) {
                out.grip = grip;
                is_known = true;
            }
        }
    }
    error = is_known ? pose_known(scene, mesh, body_in_file, rig, out)
                     : pose_new(scene, mesh, options, body_in_file, rig, out);
    if (!error) {
        add_object(scene, body, body_in_file, out);
        error = write_file_atomically(options.out, write_grip_glb(out, rig));
    }
    return error ? refuse(*error) : 0;
}

int import_grip_command(const std::string& file, const std::string& out) {
    const Result<std::string> bytes = read_file(file);
    if (!bytes) {
        return refuse(bytes.error());
    }
    const Result<SceneGrip> grip = parse_grip_glb(
        bytes.value(), file, {builtin_hand_rig(HandSide::left), builtin_hand_rig(HandSide::right)});
    if (!grip) {
        return refuse(grip.error());
    }
    const std::string json = write_scene_grip(grip.value());
    if (out.empty()) {
        std::fputs(json.c_str(), stdout);
        return 0;
    }
    const auto error = write_file_atomically(out, json);
    return error ? refuse(*error) : 0;
}

}  // namespace handhold
