#include "game/commands/hand_export.hpp"

#include <algorithm>
#include <filesystem>
#include <optional>

#include "engine/core/check.hpp"
#include "engine/core/text_file.hpp"
#include "game/commands/exported_objects.hpp"
#include "game/commands/output_folder.hpp"
#include "game/play/exit_status.hpp"
#include "game/render/figure_skin.hpp"
#include "game/render/robot_hand.hpp"
#include "systems/rigs/builtin_hand_rig.hpp"
#include "systems/rigs/hand_joint_names.hpp"
#include "systems/rigs/hand_kinematics.hpp"
#include "systems/rigs/hand_rig_fit.hpp"

namespace handhold {
namespace {

std::size_t joint_of(const HandRig& rig, std::int32_t finger, std::uint32_t link) {
    const auto found = std::find_if(
        rig.joints.begin(), rig.joints.end(),
        [&](const RigJoint& joint) { return joint.finger == finger && joint.link == link; });
    HH_CHECK(found != rig.joints.end(), "a joint for every link", link);
    return static_cast<std::size_t>(found - rig.joints.begin());
}

// Index of the parent joint: the previous link, the finger's metacarpal, or the wrist; -1 for the
// wrist itself.
std::int32_t parent_of(const HandRig& rig, std::size_t index) {
    const RigJoint& joint = rig.joints[index];
    const std::size_t wrist = joint_of(rig, RigJoint::k_palm, 0);
    if (index == wrist) {
        return -1;
    }
    if (joint.finger == RigJoint::k_palm) {
        return static_cast<std::int32_t>(wrist);
    }
    const std::size_t own = joint_of(rig, joint.finger, joint.link);
    if (own != index) {  // tip
        return static_cast<std::int32_t>(own);
    }
    if (joint.link > 0) {
        return static_cast<std::int32_t>(joint_of(rig, joint.finger, joint.link - 1));
    }
    const FingerName name = rig.fingers[static_cast<std::size_t>(joint.finger)].name;
    for (std::size_t i = 0; i < index; ++i) {
        const auto parsed = parse_hand_joint_name(rig.joints[i].name);
        if (rig.joints[i].finger == RigJoint::k_palm && parsed && parsed->finger == name) {
            return static_cast<std::int32_t>(i);
        }
    }
    return static_cast<std::int32_t>(wrist);
}

std::vector<double> as_numbers(const Vec3& v) { return {v.x(), v.y(), v.z()}; }

// Adds the numbers that hand_rig_from_skin reads (systems/rigs/hand_rig_fit.hpp).
void add_numbers(const HandRig& rig, std::vector<SkinJoint>& joints) {
    for (std::size_t i = 0; i < rig.fingers.size(); ++i) {
        for (std::uint32_t link = 0; link < rig.fingers[i].link_count; ++link) {
            auto& numbers = joints[joint_of(rig, static_cast<std::int32_t>(i), link)].numbers;
            numbers[k_link_radius_key] = {rig.fingers[i].radius_m[link]};
            numbers[k_link_length_key] = {rig.fingers[i].length_m[link]};
        }
    }
    auto& numbers = joints[joint_of(rig, RigJoint::k_palm, 0)].numbers;
    numbers[k_palm_center_key] = as_numbers(rig.palm_center_hs);
    std::vector<double>& capsules = numbers[k_palm_capsules_key];
    for (const PalmCapsule& capsule : rig.palm) {
        for (const Vec3& end : {capsule.a_hs, capsule.b_hs}) {
            for (const double number : as_numbers(end)) {
                capsules.push_back(number);
            }
        }
        capsules.push_back(capsule.radius_m);
    }
}

}  // namespace

RobotHandSkin make_robot_hand_skin(const HandRig& rig,
                                   const std::array<FingerAngles, k_finger_count>& fingers,
                                   const Pose& wrist_ms) {
    std::vector<std::array<Pose, k_max_links>> frames;
    for (std::size_t i = 0; i < rig.fingers.size(); ++i) {
        frames.push_back(finger_link_frames(rig.fingers[i], fingers[i]));
    }
    const auto carrier = [&](std::int32_t finger, std::uint32_t link) {
        return finger == RigJoint::k_palm
                   ? wrist_ms
                   : wrist_ms * frames[static_cast<std::size_t>(finger)][link];
    };
    std::vector<SkinJoint> joints;
    for (std::size_t i = 0; i < rig.joints.size(); ++i) {
        const RigJoint& joint = rig.joints[i];
        joints.push_back({joint.name,
                          parent_of(rig, i),
                          carrier(joint.finger, joint.link) * joint.joint_in_link,
                          {}});
    }
    add_numbers(rig, joints);
    FigureSkin skin(rig.side == HandSide::left ? "robot_hand_left" : "robot_hand_right");
    for (const HandPart& part : make_robot_hand(rig)) {
        skin.add(part.material, part.mesh, carrier(part.finger, part.link),
                 static_cast<std::uint16_t>(joint_of(rig, part.finger, part.link)));
    }
    return {FigureSkin::materials(), skin.finish(std::move(joints))};
}

std::string export_robot_hand(const HandRig& rig, const ControllerModel* controller) {
    std::array<FingerAngles, k_finger_count> at_ease;
    for (std::size_t i = 0; i < rig.fingers.size(); ++i) {
        at_ease[i] = relaxed_angles(rig.fingers[i]);
    }
    RobotHandSkin hand = make_robot_hand_skin(rig, at_ease, {});
    std::vector<GltfObject> objects;
    if (controller != nullptr) {
        objects = controller_objects(*controller, hand.materials);
    }
    return write_skinned_glb(hand.materials, hand.skin, objects);
}

int export_hands_command(const std::string& folder, const std::string& controllers) {
    std::optional<ControllerModels> models;
    if (!controllers.empty()) {
        Result<ControllerModels> chosen = choose_controllers(controllers);
        if (!chosen) {
            return refuse(chosen.error());
        }
        models = std::move(chosen.value());
    }
    const Result<OutputFolder> out = OutputFolder::open(folder);
    if (!out) {
        return refuse(out.error());
    }
    for (const HandSide side : {HandSide::left, HandSide::right}) {
        const std::filesystem::path file =
            std::filesystem::path(folder) /
            (side == HandSide::left ? "robot_hand_left.glb" : "robot_hand_right.glb");
        if (const auto error = write_file_atomically(
                file, export_robot_hand(builtin_hand_rig(side),
                                        models ? &models->sides[index_of(side)] : nullptr))) {
            return refuse(*error);
        }
    }
    return 0;
}

}  // namespace handhold
