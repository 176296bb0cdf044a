#include "game/commands/grip_file.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

#include "engine/io/gltf_nodes.hpp"
#include "engine/io/gltf_skin_writer.hpp"
#include "game/commands/hand_export.hpp"
#include "systems/rigs/authored_hand.hpp"
#include "systems/rigs/hand_joint_names.hpp"
#include "systems/rigs/hand_kinematics.hpp"

namespace handhold {
namespace {

constexpr const char* k_object_name = "object";
constexpr std::string_view k_grip_prefix = "grip/";
constexpr double k_max_coordinate_m = 1e3;
// A smaller spread is rounding of the file's single precision.
constexpr double k_no_spread_rad = 1e-5;
// Names of the extras (glTF's custom properties) of the wrist's node.
constexpr const char* k_priority_key = "grip_priority";
constexpr const char* k_radius_key = "grip_snap_radius_m";
constexpr const char* k_angle_key = "grip_snap_angle_deg";
constexpr const char* k_mirror_key = "grip_mirror_axis";
constexpr const char* k_posed_key = "grip_posed_fingers";
// Prefix of a key that ends with a finger's name. The value of such a key is four angles in
// degrees: three curls and the opposition.
constexpr const char* k_pressed_key = "grip_pressed_deg_";

const char* text_of(HandSide side) { return side == HandSide::left ? "left" : "right"; }

struct GripName {
    std::string name;
    HandSide side = HandSide::right;
};

// Splits "grip/<name>/right" or "grip/<name>/left". Some packages append a suffix to the names of
// copies (".001"), which is ignored.
std::optional<GripName> parse_grip_name(const std::string& node) {
    const std::size_t end = node.rfind('/');
    if (!node.starts_with(k_grip_prefix) || end <= k_grip_prefix.size()) {
        return std::nullopt;
    }
    const std::string side = node.substr(end + 1, node.find('.', end) - end - 1);
    if (side != "left" && side != "right") {
        return std::nullopt;
    }
    return GripName{node.substr(k_grip_prefix.size(), end - k_grip_prefix.size()),
                    side == "left" ? HandSide::left : HandSide::right};
}

// Looks up nodes by name and keeps the first error.
class GripNodes {
  public:
    GripNodes(const std::vector<GltfNode>& nodes, std::string file)
        : nodes_(nodes), file_(std::move(file)) {
        for (const GltfNode& node : nodes) {
            if (const auto bone = parse_hand_joint_name(node.name)) {
                bones_.try_emplace({bone->finger, bone->bone}, &node);
            }
        }
    }

    const GltfNode* find(std::string_view what, const auto& is_it) {
        const GltfNode* found = nullptr;
        for (const GltfNode& node : nodes_) {
            if (is_it(node)) {
                if (found != nullptr) {
                    return refuse(node.pointer, "expected one " + std::string(what) + " node");
                }
                found = &node;
            }
        }
        return found != nullptr
                   ? found
                   : refuse("/nodes", "expected a " + std::string(what) + " node, found none");
    }
    const GltfNode* find_bone(const std::string& name) {
        const auto wanted = parse_hand_joint_name(name);
        const auto found = wanted ? bones_.find({wanted->finger, wanted->bone}) : bones_.end();
        return found != bones_.end() ? found->second
                                     : refuse("/nodes", "expected a node \"" + name + "\"");
    }
    Pose pose_of(const GltfNode* node) {
        if (node != nullptr && !node->pose_ms) {
            refuse(node->pointer, "expected a node that is turned, moved and evenly scaled");
        }
        return node != nullptr && node->pose_ms ? *node->pose_ms : Pose();
    }
    double number(const GltfNode* node, const char* key, double fallback, double low, double high) {
        if (node == nullptr || !node->numbers.contains(key)) {
            return fallback;
        }
        const std::vector<double>& numbers = node->numbers.at(key);
        if (numbers.size() != 1 || !(numbers[0] >= low && numbers[0] <= high)) {
            refuse(
                node->pointer + "/extras/" + key,
                "expected a number in [" + std::to_string(low) + ", " + std::to_string(high) + "]");
            return fallback;
        }
        return numbers[0];
    }
    const GltfNode* refuse(std::string place, std::string expected) {
        if (!error_) {
            error_ = FileError{file_, std::move(place), std::move(expected)};
        }
        return nullptr;
    }
    const std::optional<FileError>& error() const { return error_; }

  private:
    const std::vector<GltfNode>& nodes_;
    std::string file_;
    std::map<std::pair<FingerName, HandBone>, const GltfNode*> bones_;
    std::optional<FileError> error_;
};

void read_pressed(GripNodes& nodes, const GltfNode* wrist, AuthoredHand& hand) {
    for (std::size_t f = 0; f < k_finger_count; ++f) {
        const std::string key =
            k_pressed_key + std::string(finger_text(static_cast<FingerName>(f)));
        if (wrist == nullptr || !wrist->numbers.contains(key)) {
            continue;
        }
        const std::vector<double>& angles = wrist->numbers.at(key);
        // Tests the ranges that scene files allow.
        const auto is_curl = [](double angle_deg) {
            return angle_deg >= -30.0 && angle_deg <= 130.0;
        };
        if (angles.size() != k_max_links + 1 ||
            !std::all_of(angles.begin(), angles.end() - 1, is_curl) ||
            !(std::abs(angles.back()) <= 180.0)) {
            nodes.refuse(wrist->pointer + "/extras/" + key,
                         "expected three curls of -30 to 130 degrees and an opposition within 180");
            return;
        }
        hand.follows_trigger[f] = true;
        for (std::size_t link = 0; link < k_max_links; ++link) {
            hand.pressed[f].curl_rad[link] = k_degree * angles[link];
        }
        hand.pressed[f].opposition_rad = k_degree * angles[k_max_links];
    }
}

void read_numbers(GripNodes& nodes, const GltfNode* wrist, SceneGrip& grip, AuthoredHand& hand) {
    grip.grip.priority =
        static_cast<std::int32_t>(nodes.number(wrist, k_priority_key, 0.0, -100.0, 100.0));
    grip.grip.snap_radius_m = nodes.number(wrist, k_radius_key, grip.grip.snap_radius_m, 1e-6, 1.0);
    grip.grip.snap_angle_rad =
        k_degree *
        nodes.number(wrist, k_angle_key, grip.grip.snap_angle_rad / k_degree, 1e-6, 180.0);
    grip.mirror_axis = static_cast<int>(nodes.number(wrist, k_mirror_key, -1.0, -1.0, 2.0));
    hand.is_posed.fill(true);
    read_pressed(nodes, wrist, hand);
    if (wrist == nullptr || !wrist->numbers.contains(k_posed_key)) {
        return;
    }
    const std::vector<double>& posed = wrist->numbers.at(k_posed_key);
    if (posed.size() != k_finger_count) {
        nodes.refuse(wrist->pointer + "/extras/" + k_posed_key,
                     "expected five numbers, thumb to little finger");
        return;
    }
    for (std::size_t f = 0; f < k_finger_count; ++f) {
        hand.is_posed[f] = posed[f] != 0.0;
    }
}

void read_fingers(GripNodes& nodes, const HandRig& rig, const Pose& wrist_ms, AuthoredHand& hand) {
    for (std::size_t f = 0; f < rig.fingers.size(); ++f) {
        const FingerRig& finger = rig.fingers[f];
        const auto name = static_cast<std::size_t>(finger.name);
        std::vector<Quat> links;
        for (std::uint32_t link = 0; link < finger.link_count; ++link) {
            const auto joint =
                std::find_if(rig.joints.begin(), rig.joints.end(), [&](const RigJoint& candidate) {
                    return candidate.finger == static_cast<std::int32_t>(f) &&
                           candidate.link == link;
                });
            if (joint == rig.joints.end()) {
                break;
            }
            const Pose joint_ms = nodes.pose_of(nodes.find_bone(joint->name));
            links.push_back(
                (inverse(wrist_ms) * joint_ms * inverse(joint->joint_in_link)).rotation);
        }
        if (!hand.is_posed[name]) {
            continue;
        }
        FingerAngles& angles = hand.fingers[name];
        angles = angles_of_links(finger, links);
        if (finger.name != FingerName::thumb && std::abs(angles.opposition_rad) < k_no_spread_rad) {
            angles.opposition_rad = 0.0;
        }
        for (std::size_t link = 0; link < finger.link_count; ++link) {
            angles.curl_rad[link] =
                std::clamp(angles.curl_rad[link], finger.lower_rad[link], finger.upper_rad[link]);
        }
    }
}

}  // namespace

std::string write_grip_glb(const GripScene& scene, const HandRig& rig) {
    const AuthoredHand& hand = scene.grip.grip.hands[index_of(scene.side)];
    RobotHandSkin made = make_robot_hand_skin(rig, scene.fingers, hand.wrist_bs);
    made.skin.name = std::string(k_grip_prefix) + scene.grip.name + "/" + text_of(scene.side);
    for (SkinJoint& joint : made.skin.joints) {
        if (!is_wrist_name(joint.name)) {
            continue;
        }
        joint.numbers[k_priority_key] = {static_cast<double>(scene.grip.grip.priority)};
        joint.numbers[k_radius_key] = {scene.grip.grip.snap_radius_m};
        joint.numbers[k_angle_key] = {scene.grip.grip.snap_angle_rad / k_degree};
        joint.numbers[k_mirror_key] = {static_cast<double>(scene.grip.mirror_axis)};
        for (const bool is_posed : hand.is_posed) {
            joint.numbers[k_posed_key].push_back(is_posed ? 1.0 : 0.0);
        }
        for (std::size_t f = 0; f < k_finger_count; ++f) {
            if (!hand.follows_trigger[f]) {
                continue;
            }
            std::vector<double>& angles =
                joint.numbers[k_pressed_key + std::string(finger_text(static_cast<FingerName>(f)))];
            for (const double curl_rad : hand.pressed[f].curl_rad) {
                angles.push_back(curl_rad / k_degree);
            }
            angles.push_back(hand.pressed[f].opposition_rad / k_degree);
        }
    }
    const std::size_t of_hand = made.materials.size();
    made.materials.insert(made.materials.end(), scene.materials.begin(), scene.materials.end());
    std::vector<GltfObject> objects = {{k_object_name, {}, scene.object}};
    for (GltfObject controller : scene.controller) {
        controller.pose_ms = hand.wrist_bs * controller.pose_ms;
        objects.push_back(std::move(controller));
    }
    for (GltfObject& object : objects) {
        for (GltfSurface& surface : object.surfaces) {
            surface.material += of_hand;
        }
    }
    return write_skinned_glb(made.materials, made.skin, objects);
}

Result<SceneGrip> parse_grip_glb(std::string_view bytes, const std::filesystem::path& path,
                                 const std::array<HandRig, k_hand_count>& rigs) {
    const Result<std::vector<GltfNode>> read = parse_gltf_nodes(bytes, path);
    if (!read) {
        return read.error();
    }
    GripNodes nodes(read.value(), path.string());
    const GltfNode* const root =
        nodes.find("\"grip/<name>/<right or left>\"",
                   [](const auto& node) { return parse_grip_name(node.name).has_value(); });
    const GltfNode* const object =
        nodes.find("\"object\"", [](const auto& node) { return node.name == k_object_name; });
    const GltfNode* const wrist =
        nodes.find("wrist", [](const auto& node) { return is_wrist_name(node.name); });
    if (nodes.error()) {
        return *nodes.error();
    }
    const GripName name = *parse_grip_name(root->name);
    SceneGrip grip;
    grip.name = name.name;
    AuthoredHand& hand = grip.grip.hands[index_of(name.side)];
    hand.is_there = true;
    const Pose wrist_ms = nodes.pose_of(wrist);
    hand.wrist_bs = inverse(nodes.pose_of(object)) * wrist_ms;
    if (!(hand.wrist_bs.position.cwiseAbs().maxCoeff() <= k_max_coordinate_m)) {
        nodes.refuse(wrist->pointer, "expected a wrist within 1000 m of the object");
    }
    read_numbers(nodes, wrist, grip, hand);
    read_fingers(nodes, rigs[index_of(name.side)], wrist_ms, hand);
    if (nodes.error()) {
        return *nodes.error();
    }
    if (grip.mirror_axis != SceneGrip::k_no_mirror) {
        grip.grip.hands[1 - index_of(name.side)] = mirror_authored_hand(hand, grip.mirror_axis);
    }
    return grip;
}

}  // namespace handhold
