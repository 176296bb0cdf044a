#include "engine/io/gltf_skin_joints.hpp"

#include <cmath>
#include <optional>
#include <utility>

namespace handhold::gltf {
namespace {

// A pose whose Y axis has the direction of the frame's Y axis. Its Z axis is as close as possible
// to the frame's.
Pose straightened(const Affine& frame) {
    Vec3 y = frame.linear.col(1);
    Vec3 z = frame.linear.col(2);
    const double length_y = y.norm();
    const double length_z = z.norm();
    y = length_y > 1e-9 ? Vec3(y / length_y) : Vec3(Vec3::UnitY());
    z = length_z > 1e-9 ? Vec3(z / length_z) : Vec3(Vec3::UnitZ());
    const Vec3 x = y.cross(z);
    const double across = x.norm();
    if (!(across > 1e-6) || !std::isfinite(across)) {
        return {frame.translation, Quat::Identity()};
    }
    Mat3 axes;
    axes.col(0) = x / across;
    axes.col(1) = y;
    axes.col(2) = Vec3(axes.col(0)).cross(y);
    return {frame.translation, Quat(axes).normalized()};
}

// Fills a SkinJoints. Stops at the first error.
class SkinJointReader {
  public:
    SkinJointReader(const Model& model, std::span<const PlacedNode> placed, JointSource source,
                    Refusal& refusal, SkinJoints& joints)
        : model_(model), placed_(placed), source_(source), refusal_(refusal), joints_(joints) {}

    bool read() { return choose_skin() && read_joints(); }

  private:
    bool refuse(std::string place, std::string expected) {
        return refusal_.refuse(std::move(place), std::move(expected));
    }
    bool choose_skin();
    bool list_joints(std::vector<int>& nodes);
    bool read_joints();
    bool append_joint(const PlacedNode& placed);
    void find_parents();

    const Model& model_;
    std::span<const PlacedNode> placed_;
    JointSource source_;
    Refusal& refusal_;
    SkinJoints& joints_;
    int skin_index_ = k_none;  // used only with JointSource::skin
};

bool SkinJointReader::choose_skin() {
    if (source_ == JointSource::scene) {
        return true;
    }
    for (const PlacedNode& placed : placed_) {
        const Node& node = element(model_.nodes, placed.node);
        if (node.mesh == k_none || node.skin == k_none) {
            continue;
        }
        const std::string place = pointer("nodes", placed.node) + "/skin";
        if (!has_element(model_.skins, node.skin)) {
            return refusal_.refuse_index(place, "skin", model_.skins.size(), node.skin);
        }
        if (skin_index_ != k_none && skin_index_ != node.skin) {
            return refuse(place, "expected one skin, found a second one");
        }
        skin_index_ = node.skin;
    }
    return skin_index_ != k_none || refuse("/nodes", "expected a mesh with a skin");
}

// Lists the nodes that become joints, in order.
bool SkinJointReader::list_joints(std::vector<int>& nodes) {
    if (source_ == JointSource::skin) {
        nodes = element(model_.skins, skin_index_).joints;
    } else {
        for (const PlacedNode& placed : placed_) {
            nodes.push_back(placed.node);
        }
    }
    const std::string place =
        source_ == JointSource::skin ? pointer("skins", skin_index_) + "/joints" : "/nodes";
    return check_joint_count(nodes.size(), place, refusal_);
}

bool SkinJointReader::read_joints() {
    std::vector<int> nodes;
    if (!list_joints(nodes)) {
        return false;
    }
    for (const PlacedNode& placed : placed_) {
        joints_.placed_by_node[placed.node] = &placed;
    }
    for (std::size_t i = 0; i < nodes.size(); ++i) {
        const auto node = joints_.placed_by_node.find(nodes[i]);
        const auto place = [&] {
            return pointer("skins", skin_index_) + "/joints/" + std::to_string(i);
        };
        if (node == joints_.placed_by_node.end()) {
            return refuse(place(),
                          "expected a node of the scene, found " + std::to_string(nodes[i]));
        }
        if (!joints_.of_node.emplace(nodes[i], static_cast<std::uint16_t>(i)).second) {
            return refuse(place(), "expected every joint once");
        }
        if (!append_joint(*node->second)) {
            return false;
        }
    }
    find_parents();
    return true;
}

bool SkinJointReader::append_joint(const PlacedNode& placed) {
    std::optional<Pose> pose = rigid_part(placed.world);
    const bool is_mirrored =
        rigid_part({Mat3(-placed.world.linear), placed.world.translation}).has_value();
    if (!pose && (source_ == JointSource::scene || is_mirrored) &&
        is_finite(placed.world.translation)) {
        pose = straightened(placed.world);
    }
    if (!pose || pose->position.cwiseAbs().maxCoeff() > k_max_level_coordinate_m) {
        return refuse(pointer("nodes", placed.node),
                      "expected a joint without uneven scale or shear");
    }
    const Node& node = element(model_.nodes, placed.node);
    joints_.list.push_back({node.name, -1, *pose, node.numbers});
    return true;
}

void SkinJointReader::find_parents() {
    std::map<int, std::int32_t> joint_above;    // nearest joint above a node, indexed by node
    for (const PlacedNode& placed : placed_) {  // parents first
        const auto self = joints_.of_node.find(placed.node);
        const auto above = joint_above.find(placed.node);
        std::int32_t joint = above == joint_above.end() ? -1 : above->second;
        if (self != joints_.of_node.end()) {
            joints_.list[static_cast<std::size_t>(self->second)].parent = joint;
            joint = self->second;
        }
        for (const int child : element(model_.nodes, placed.node).children) {
            joint_above[child] = joint;
        }
    }
}

}  // namespace

bool read_skin_joints(const Model& model, std::span<const PlacedNode> placed, JointSource source,
                      Refusal& refusal, SkinJoints& joints) {
    return SkinJointReader(model, placed, source, refusal, joints).read();
}

bool check_joint_count(std::size_t count, const std::string& place, Refusal& refusal) {
    return (count > 0 && count <= k_max_skin_joints) ||
           refusal.refuse(place, "expected 1 to " + std::to_string(k_max_skin_joints) +
                                     " joints, found " + std::to_string(count));
}

}  // namespace handhold::gltf
