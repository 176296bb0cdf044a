#include "game/view/controller_figures.hpp"

#include <algorithm>

#include "engine/io/gltf_nodes.hpp"
#include "game/render/figures.hpp"
#include "game/view/grip_fit.hpp"
#include "systems/host/host_columns.hpp"

namespace handhold {
namespace {

// The wand's handle lies in the fist along the same line as a real controller's. The hand is lower
// on the handle, because the wand's head is longer.
constexpr HandleGrip k_wand_grip = {HandleGrip{}.radius_m, HandleGrip{}.slant_rad, -0.015};

// Replaces white. The renderer has no textures, so a material whose colour is in a texture would be
// white.
constexpr Color k_textured_color = {0.045F, 0.048F, 0.055F};
// Least sum of the bends of the index finger while the trigger is pressed. A finger that does not
// rest on the trigger waits so far above its closed pose, outer hinges first, as far as they open.
constexpr double k_press_rad = 0.28;
constexpr Color k_white = {1.0F, 1.0F, 1.0F};

Result<ControllerModel> load_controller(const ControllerSide& side,
                                        std::vector<std::string>& notes) {
    const Result<GltfLevel> level = load_gltf_level(side.model);
    if (!level) {
        return level.error();
    }
    const Result<std::vector<GltfNode>> nodes = load_gltf_nodes(side.model);
    if (!nodes) {
        return nodes.error();
    }
    std::vector<ModelNode> model_nodes;
    for (const GltfNode& node : nodes.value()) {
        model_nodes.push_back(
            {node.name, node.pointer, node.parent,
             node.pose_ms ? std::optional(to_host(*node.pose_ms)) : std::nullopt});
    }
    notes.insert(notes.end(), level.value().notes.begin(), level.value().notes.end());
    ControllerModel model;
    model.fit = side.fit;
    for (const LevelPart& part : level.value().parts) {
        const std::vector<ControlMove> moves = moves_of(part.pointer, model_nodes, side.controls);
        for (LevelMesh& mesh : make_level_meshes(GltfLevel{{part}})) {
            model.meshes.push_back(std::move(mesh));
            model.moves.push_back(moves);
        }
    }
    if (model.meshes.empty()) {
        return FileError{side.model.string(), "/meshes", "expected triangles, found none"};
    }
    for (LevelMesh& part : model.meshes) {
        if (part.mesh.color == k_white) {
            part.mesh.color = k_textured_color;
        }
    }
    return model;
}

// A control that rotates about a point of the wand, from its rest pose.
ControlMove turn_of_wand(Control control, const Vec3& about_ms, const Vec3& from_rad,
                         const Vec3& to_rad) {
    const hh::Pose rest = hh::pose_at(to_host(about_ms));
    return {control,
            rest,
            {rest.position, to_host(rotation_from_vector(from_rad))},
            {rest.position, to_host(rotation_from_vector(to_rad))}};
}

// The trigger rotates on a pin, the squeeze button moves in, the pad tilts.
void add_wand(ControllerModel& model) {
    constexpr double k_trigger_rad = 0.35;
    constexpr double k_tilt_rad = 0.2;
    constexpr double k_squeeze_m = 0.0025;
    const auto add = [&model](std::vector<Mesh> meshes, const std::vector<ControlMove>& moves) {
        for (Mesh& mesh : meshes) {
            model.meshes.push_back({std::move(mesh), {}});
            model.moves.push_back(moves);
        }
    };
    WandMeshes wand = make_wand();
    add(std::move(wand.body), {});
    add(std::move(wand.trigger), {turn_of_wand(Control::trigger, k_wand_pin_m, Vec3::Zero(),
                                               -k_trigger_rad * Vec3::UnitX())});
    add(std::move(wand.squeeze),
        {{Control::squeeze, hh::k_origin, hh::k_origin, hh::pose_at({0.0, k_squeeze_m, 0.0})}});
    const Vec3 right = k_tilt_rad * Vec3::UnitZ();
    const Vec3 back = k_tilt_rad * Vec3::UnitX();
    add(std::move(wand.pad), {turn_of_wand(Control::stick_x, k_wand_pad_m, right, -right),
                              turn_of_wand(Control::stick_y, k_wand_pad_m, -back, back)});
}

Mesh whole_mesh(const ControllerModel& model, const ControlValues& values) {
    Mesh whole;
    for (std::size_t i = 0; i < model.meshes.size(); ++i) {
        const Mesh& part = model.meshes[i].mesh;
        const Pose moved = from_host(moved_by(model.moves[i], values));
        const auto first = static_cast<std::uint32_t>(whole.positions.size());
        for (const Vec3& position : part.positions) {
            whole.positions.push_back(transform_point(moved, position));
        }
        for (const auto& [a, b, c] : part.triangles) {
            whole.triangles.push_back({first + a, first + b, first + c});
        }
    }
    return whole;
}

}  // namespace

std::array<hh::Pose, 2> ControllerModels::joints() const {
    return {sides[0].fit.hand_in_grip, sides[1].fit.hand_in_grip};
}

ControllerModels builtin_controllers(const HandShape& shape) {
    ControllerModels models;
    models.name = "builtin";
    for (const hh::Side side : {HH_LEFT, HH_RIGHT}) {
        ControllerModel& model = models.sides[side];
        add_wand(model);
        // Chooses the tracked pose's place in the model so that the handle lies in the fist when
        // the hand has its tuned pose in the controller.
        const hh::Pose& joint = shape.in_controller[side];
        model.fit.hand_in_grip = joint;
        model.fit.grip_ms =
            hh::inverse(joint * handle_in_hand(side, k_wand_grip, shape.palm_center_m));
        model.fit.aim_ms = model.fit.grip_ms;
    }
    return models;
}

Result<ControllerModels> choose_controllers(const std::string& name_or_file) {
    if (name_or_file == "builtin") {
        return builtin_controllers(hand_shape(hh::World()));
    }
    const Result<std::string> text = read_file(name_or_file);
    if (!text) {
        return text.error();
    }
    const Result<ControllerProfile> profile = parse_controller_profile(text.value(), name_or_file);
    if (!profile) {
        return profile.error();
    }
    ControllerModels models;
    models.name = profile.value().name;
    models.has_own_joint = true;
    for (std::size_t side = 0; side < k_hand_count; ++side) {
        Result<ControllerModel> model = load_controller(profile.value().sides[side], models.notes);
        if (!model) {
            return model.error();
        }
        models.sides[side] = std::move(model.value());
    }
    return models;
}

std::array<FingerAngles, k_finger_count> fingers_around(const ControllerModel& model,
                                                        const HandRig& rig,
                                                        const ControlValues& values) {
    AuthoredHand held;
    held.is_there = true;
    held.wrist_bs = from_host(hh::inverse(controller_in_hand(model.fit)));
    return fit_grip(build_grip_mesh(whole_mesh(model, values)), rig, held.wrist_bs, {}, &held)
        .fingers;
}

FollowingFingers::FollowingFingers(const ControllerModel& model, const HandRig& rig)
    : rest_(fingers_around(model, rig)) {
    const auto pressed = [&](Control control) {
        ControlValues values = k_controls_at_rest;
        values[static_cast<std::size_t>(control)] = 1.0;
        return fingers_around(model, rig, values);
    };
    trigger_ = pressed(Control::trigger);
    squeeze_ = pressed(Control::squeeze);
    for (std::size_t f = 0; f < rig.fingers.size(); ++f) {
        const FingerRig& finger = rig.fingers[f];
        if (finger.name != FingerName::index) {
            continue;
        }
        double missing_rad = k_press_rad;
        for (std::size_t link = 0; link < finger.link_count; ++link) {
            missing_rad -= trigger_[f].curl_rad[link] - rest_[f].curl_rad[link];
        }
        for (std::size_t link = finger.link_count; link-- > 0;) {
            double& curl_rad = rest_[f].curl_rad[link];
            const double room_rad = std::max(curl_rad - finger.lower_rad[link], 0.0);
            const double lift_rad =
                std::clamp(missing_rad, 0.0, std::min(room_rad, 0.5 * k_press_rad));
            curl_rad -= lift_rad;
            missing_rad -= lift_rad;
        }
    }
}

std::array<FingerAngles, k_finger_count> FollowingFingers::at(const ControlValues& values) const {
    std::array<FingerAngles, k_finger_count> angles = rest_;
    const auto add = [&](Control control, const std::array<FingerAngles, k_finger_count>& pressed) {
        const double share = values[static_cast<std::size_t>(control)];
        for (std::size_t f = 0; f < k_finger_count; ++f) {
            for (std::size_t link = 0; link < k_max_links; ++link) {
                angles[f].curl_rad[link] +=
                    share * (pressed[f].curl_rad[link] - rest_[f].curl_rad[link]);
            }
            angles[f].opposition_rad +=
                share * (pressed[f].opposition_rad - rest_[f].opposition_rad);
        }
    };
    add(Control::trigger, trigger_);
    add(Control::squeeze, squeeze_);
    return angles;
}

ControllerFigures::ControllerFigures(const ControllerModels& models, const HandFigures& hands,
                                     Renderer& renderer) {
    for (const HandSide side : {HandSide::left, HandSide::right}) {
        const ControllerModel& model = models.sides[index_of(side)];
        Side& made = sides_[index_of(side)];
        for (std::size_t i = 0; i < model.meshes.size(); ++i) {
            made.parts.push_back(
                {renderer.add_mesh(model.meshes[i].mesh), model.meshes[i].look, model.moves[i]});
        }
        made.in_hand = from_host(controller_in_hand(model.fit));
        made.fingers = FollowingFingers(model, hands.rig(side));
    }
}

void ControllerFigures::add(HandSide side, const Pose& wrist_ws, const ControlValues& values,
                            RenderFrame& frame) const {
    const Side& model = sides_[index_of(side)];
    for (const Part& part : model.parts) {
        frame.instances.push_back(
            {part.mesh, wrist_ws * model.in_hand * from_host(moved_by(part.moves, values)),
             std::nullopt, part.look});
    }
}

}  // namespace handhold
