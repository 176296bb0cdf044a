#include "game/render/hand_figures.hpp"

#include "engine/core/check.hpp"
#include "game/render/robot_hand.hpp"
#include "systems/rigs/builtin_hand_rig.hpp"
#include "systems/rigs/hand_kinematics.hpp"

namespace handhold {
namespace {

// Adds the triangles of one colour as a moving mesh with all vertices of the skin.
MeshId add_run(const SkinnedMesh& skin, std::size_t run, Renderer& renderer) {
    const std::size_t from = skin.color_runs[run].first_triangle;
    const std::size_t to = run + 1 < skin.color_runs.size()
                               ? skin.color_runs[run + 1].first_triangle
                               : skin.triangles.size();
    return renderer.add_moving_mesh(std::span(skin.triangles).subspan(from, to - from),
                                    skin.color_runs[run].color);
}

Result<HandModel> load_hand_model(const std::filesystem::path& path, HandSide side) {
    Result<SkinnedMesh> skin = load_gltf_skin(path);
    if (!skin) {
        return skin.error();
    }
    Result<HandRigFit> fit = fit_hand_rig(skin.value(), side);
    if (!fit) {
        return fit.error();
    }
    HandModel model;
    model.rig = fit.value().rig;
    model.fit = std::move(fit.value());
    model.skin = std::move(skin.value());
    return model;
}

}  // namespace

HandModels builtin_hand_models() {
    HandModels models;
    for (const HandSide side : {HandSide::left, HandSide::right}) {
        models[index_of(side)].rig = builtin_hand_rig(side);
    }
    return models;
}

Result<HandModels> load_hand_models(const std::filesystem::path& left,
                                    const std::filesystem::path& right) {
    HandModels models;
    for (const HandSide side : {HandSide::left, HandSide::right}) {
        Result<HandModel> model = load_hand_model(side == HandSide::left ? left : right, side);
        if (!model) {
            return model.error();
        }
        models[index_of(side)] = std::move(model.value());
    }
    return models;
}

Result<HandModels> choose_hand_models(std::span<const std::string> files) {
    HH_CHECK(files.empty() || files.size() == k_hand_count, "no files or two", files.size());
    return files.empty() ? Result<HandModels>(builtin_hand_models())
                         : load_hand_models(files[0], files[1]);
}

std::vector<Pose> skeleton_pose(const HandRig& rig,
                                const std::array<FingerAngles, k_finger_count>& fingers) {
    std::vector<std::array<Pose, k_max_links>> frames;
    for (std::size_t i = 0; i < rig.fingers.size(); ++i) {
        frames.push_back(finger_link_frames(rig.fingers[i], fingers[i]));
    }
    std::vector<Pose> poses;
    poses.reserve(rig.joints.size());
    for (const RigJoint& joint : rig.joints) {
        poses.push_back(joint.finger == RigJoint::k_palm
                            ? joint.joint_in_link
                            : frames[static_cast<std::size_t>(joint.finger)][joint.link] *
                                  joint.joint_in_link);
    }
    return poses;
}

HandFigures::HandFigures(HandModels models, Renderer& renderer) : models_(std::move(models)) {
    for (std::size_t side = 0; side < k_hand_count; ++side) {
        if (models_[side].skin) {
            continue;
        }
        for (const HandPart& part : make_robot_hand(models_[side].rig)) {
            Look look;
            look.gloss = figure_gloss(part.material);
            parts_[side].push_back({part.finger, part.link, renderer.add_mesh(part.mesh), look,
                                    part.is_cuff, part.material == FigureMaterial::shell});
        }
    }
}

void HandFigures::begin() { used_.fill(0); }

void HandFigures::add(HandSide side, const Pose& wrist_ws, const Quat& forearm_ws,
                      const std::array<FingerAngles, k_finger_count>& fingers, Renderer& renderer,
                      RenderFrame& frame) {
    if (models_[index_of(side)].skin) {
        add_skin(side, wrist_ws, fingers, renderer, frame);
    } else {
        add_parts(side, wrist_ws, forearm_ws, fingers, frame);
    }
}

void HandFigures::add_parts(HandSide side, const Pose& wrist_ws, const Quat& forearm_ws,
                            const std::array<FingerAngles, k_finger_count>& fingers,
                            RenderFrame& frame) const {
    const HandRig& rig = models_[index_of(side)].rig;
    std::array<std::array<Pose, k_max_links>, k_finger_count> links_ws;
    for (std::size_t i = 0; i < rig.fingers.size(); ++i) {
        links_ws[i] = finger_link_frames(rig.fingers[i], fingers[i]);
        for (Pose& link : links_ws[i]) {
            link = wrist_ws * link;
        }
    }
    const Pose cuff_ws{wrist_ws.position, forearm_ws};
    for (const Part& part : parts_[index_of(side)]) {
        const Pose& at = part.is_cuff ? cuff_ws
                         : part.finger == RigJoint::k_palm
                             ? wrist_ws
                             : links_ws[static_cast<std::size_t>(part.finger)][part.link];
        frame.instances.push_back(
            {part.mesh, at, part.is_shell ? shell_ : std::nullopt, part.look});
    }
}

void HandFigures::add_skin(HandSide side, const Pose& wrist_ws,
                           const std::array<FingerAngles, k_finger_count>& fingers,
                           Renderer& renderer, RenderFrame& frame) {
    const HandModel& model = models_[index_of(side)];
    const SkinnedMesh& skin = *model.skin;
    std::vector<SkinCopy>& copies = copies_[index_of(side)];
    std::size_t& used = used_[index_of(side)];
    if (used == copies.size()) {
        SkinCopy copy;
        for (std::size_t run = 0; run < skin.color_runs.size(); ++run) {
            copy.push_back(add_run(skin, run, renderer));
        }
        copies.push_back(std::move(copy));
    }
    // Transforms from the file's frame directly to hand space.
    const std::vector<Pose> posed_hs = skeleton_pose(model.rig, fingers);
    std::vector<Affine> carry;
    carry.reserve(posed_hs.size());
    for (std::size_t i = 0; i < posed_hs.size(); ++i) {
        carry.push_back(to_affine(posed_hs[i] * inverse(skin.joints[i].bind_ms)));
    }
    skin_vertices({skin.positions, skin.normals, skin.weights, carry}, positions_, normals_);
    for (std::size_t run = 0; run < skin.color_runs.size(); ++run) {
        const MeshId mesh = copies[used][run];
        renderer.move_mesh(mesh, positions_, normals_);
        Look look;
        look.gloss = skin.color_runs[run].gloss;
        look.emissive = skin.color_runs[run].emissive;
        frame.instances.push_back({mesh, wrist_ws, std::nullopt, look});
    }
    ++used;
}

}  // namespace handhold
