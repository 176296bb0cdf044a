#include <algorithm>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "engine/geometry/shape_library.hpp"
#include "engine/io/gltf.hpp"
#include "engine/io/gltf_skin.hpp"
#include "game/commands/grip_file.hpp"
#include "systems/rigs/body_rig_fit.hpp"
#include "systems/rigs/builtin_hand_rig.hpp"
#include "systems/rigs/hand_kinematics.hpp"
#include "systems/rigs/hand_rig_fit.hpp"
#include "tests/fuzz/promise.hpp"

namespace handhold::fuzz {
namespace {

void check_notes(const std::vector<std::string>& notes) {
    for (const std::string& note : notes) {
        promise(note == printable(note, 1000), "notes are short and have no control characters");
    }
}

// The same bytes as a skinned hand.
void run_skin(Bytes bytes) {
    const Result<SkinnedMesh> skin = parse_gltf_skin(text_of(bytes), {});
    if (!skin) {
        promise(!skin.error().expected.empty(), "a refusal says what was expected");
        return;
    }
    const SkinnedMesh& mesh = skin.value();
    check_notes(mesh.notes);
    promise(mesh.weights.size() == mesh.positions.size() &&
                mesh.normals.size() == mesh.positions.size(),
            "every vertex has a normal and weights");
    for (const SkinWeights& weights : mesh.weights) {
        for (const std::uint16_t joint : weights.joint) {
            promise(joint < mesh.joints.size(), "weights name joints that are there");
        }
    }
    for (const HandSide side : {HandSide::left, HandSide::right}) {
        const Result<HandRigFit> fit = fit_hand_rig(mesh, side);
        for (std::size_t i = 0; fit && i < fit.value().rig.fingers.size(); ++i) {
            for (const Vec3& point :
                 finger_points(fit.value().rig.fingers[i], fit.value().bind[i])) {
                promise(is_finite(point), "a fitted rig is finite");
            }
        }
    }
}

// The same bytes as a body, in the default pose.
void run_figure(Bytes bytes) {
    const Result<SkinnedMesh> figure = parse_gltf_figure(text_of(bytes), {});
    if (!figure) {
        promise(!figure.error().expected.empty(), "a refusal says what was expected");
        return;
    }
    const Result<BodyRig> rig = fit_body_rig(figure.value());
    if (!rig) {
        promise(!rig.error().expected.empty(), "a refusal says what was expected");
        return;
    }
    promise(rig.value().joints.size() == figure.value().joints.size(), "every joint has a pose");
    SkeletonPose pose;
    pose_skeleton(rig.value(), {}, {}, pose);
    for (const Pose& joint : pose.joint_ws) {
        promise(is_valid(joint), "a posed body is finite");
    }
}

// The same bytes as an authored grip. A scene file must accept every grip that was read.
void run_grip(Bytes bytes) {
    const Result<SceneGrip> grip = parse_grip_glb(
        text_of(bytes), {}, {builtin_hand_rig(HandSide::left), builtin_hand_rig(HandSide::right)});
    if (!grip) {
        promise(!grip.error().expected.empty(), "a refusal says what was expected");
        return;
    }
    const Result<JsonDocument> json = JsonDocument::parse(write_scene_grip(grip.value()), "grip");
    promise(json.ok(), "a grip is written as JSON");
    std::set<std::string> names;
    read_scene_grip(json.value().root(), names);
    promise(!json.value().failed(), "a grip that was read can be written and read again");
}

}  // namespace

void run_gltf(Bytes bytes) {
    run_skin(bytes);
    run_figure(bytes);
    run_grip(bytes);
    // The folder does not exist, so no external buffer is found.
    Result<GltfLevel> level = parse_gltf_level(text_of(bytes), {});
    if (!level) {
        promise(!level.error().expected.empty(), "a refusal says what was expected");
        return;
    }
    check_notes(level.value().notes);
    ShapeLibrary shapes;
    for (LevelPart& part : level.value().parts) {
        for (const Vec3& position : part.mesh.positions) {
            promise(
                is_finite(position) && position.cwiseAbs().maxCoeff() <= k_max_level_coordinate_m,
                "positions lie within the limit");
        }
        promise(std::is_sorted(part.color_runs.begin(), part.color_runs.end(),
                               [](const ColorRun& a, const ColorRun& b) {
                                   return a.first_triangle < b.first_triangle;
                               }),
                "colour runs ascend");
        if (!part.mesh.triangles.empty()) {
            shapes.add_mesh(std::make_shared<const Mesh>(std::move(part.mesh)));
        }
    }
}

}  // namespace handhold::fuzz
