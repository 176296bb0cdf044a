#include "engine/io/gltf_bind_pose.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <utility>

#include "engine/math/math.hpp"

namespace handhold::gltf {
namespace {

// Maps that differ by less than this count as equal: their linear parts relative to the scale, the
// points that they map relative to the skeleton's size.
constexpr double k_same = 1e-3;
constexpr double k_same_scale = 0.02;  // files store floats, and some exporters round matrices

std::optional<Affine> inverse_of(const Affine& map) {
    const double determinant = map.linear.determinant();
    if (!map.linear.allFinite() || !is_finite(map.translation) ||
        !(std::abs(determinant) > 1e-30)) {
        return std::nullopt;
    }
    const Mat3 inverse = map.linear.inverse();
    if (!inverse.allFinite()) {
        return std::nullopt;
    }
    return Affine{inverse, Vec3(-(inverse * map.translation))};
}

// The map's mean scale factor: cube root of its determinant, negative if it mirrors.
// The project's cube root, because std::cbrt is rounded differently by different libraries.
double scale_of(const Affine& map) {
    const double determinant = map.linear.determinant();
    return std::copysign(cube_root(std::abs(determinant)), determinant);
}

// Cosine of the rotation angle between two maps of the same scale: (trace - 1) / 2.
double cos_between(const Affine& a, const Affine& b) {
    const Mat3 turn = a.linear.inverse() * b.linear;
    return 0.5 * (turn.trace() - 1.0);
}

struct BoundJoint {
    int node = 0;
    Affine inverse_bind;
    Affine bind;  // inverse of inverse_bind
};

struct BoundSkin {
    int mesh_node = 0;  // the first node of the scene that uses the skin
    std::vector<BoundJoint> joints;
};

class BindPose {
  public:
    BindPose(const Model& model, AccessorReader& reader, Refusal& refusal,
             std::vector<PlacedNode>& placed)
        : model_(model), reader_(reader), refusal_(refusal), placed_(placed) {
        for (std::size_t i = 0; i < placed.size(); ++i) {
            order_[placed[i].node] = i;
        }
        for (const PlacedNode& above : placed) {
            for (const int child : element(model.nodes, above.node).children) {
                parent_[child] = above.node;
            }
        }
    }

    bool pose() {
        std::vector<BoundSkin> skins;
        if (!read_skins(skins)) {
            return false;
        }
        std::stable_sort(skins.begin(), skins.end(), [](const BoundSkin& a, const BoundSkin& b) {
            return a.joints.size() > b.joints.size();
        });
        for (const BoundSkin& skin : skins) {
            bind(skin);
        }
        return true;
    }

  private:
    const Affine& world_of(int node) const { return placed_[order_.at(node)].world; }

    bool read_skins(std::vector<BoundSkin>& skins) {
        std::map<int, int> mesh_node;  // mesh node by skin
        for (const PlacedNode& placed : placed_) {
            const Node& node = element(model_.nodes, placed.node);
            if (node.mesh != k_none && node.skin != k_none &&
                has_element(model_.skins, node.skin)) {
                mesh_node.try_emplace(node.skin, placed.node);
            }
        }
        for (const auto& [skin, node] : mesh_node) {
            const int accessor = element(model_.skins, skin).inverse_binds;
            if (accessor == k_none) {
                continue;
            }
            std::vector<float> matrices;
            if (!reader_.read_floats(accessor, Elements::matrices,
                                     pointer("skins", skin) + "/inverseBindMatrices", matrices)) {
                return false;
            }
            skins.push_back({node, read_joints(element(model_.skins, skin).joints, matrices)});
        }
        return true;
    }

    // Returns the joints that are nodes of the scene and whose matrices can be inverted.
    std::vector<BoundJoint> read_joints(std::span<const int> nodes,
                                        std::span<const float> matrices) const {
        std::vector<BoundJoint> joints;
        const std::size_t count = std::min(nodes.size(), matrices.size() / 16);
        for (std::size_t i = 0; i < count; ++i) {
            const Eigen::Map<const Eigen::Matrix4f> matrix(matrices.data() + 16 * i);
            const Affine inverse_bind{matrix.topLeftCorner<3, 3>().cast<double>(),
                                      matrix.topRightCorner<3, 1>().cast<double>()};
            const std::optional<Affine> bind = inverse_of(inverse_bind);
            if (bind && order_.contains(nodes[i])) {
                joints.push_back({nodes[i], inverse_bind, *bind});
            }
        }
        return joints;
    }

    // Moves the joints of a skin to where they were bound.
    void bind(const BoundSkin& skin) {
        if (skin.joints.empty()) {
            return;
        }
        const Vec3 first = skin.joints.front().bind.translation;
        double size = 0.0;
        for (const BoundJoint& joint : skin.joints) {
            size = std::max(size, (joint.bind.translation - first).norm());
        }
        if (!(size > 0.0)) {  // all joints at one point: the matrices do not give a pose
            return;
        }
        const BoundJoint& top = *std::min_element(skin.joints.begin(), skin.joints.end(),
                                                  [&](const BoundJoint& a, const BoundJoint& b) {
                                                      return order_.at(a.node) < order_.at(b.node);
                                                  });
        const auto shared = std::find_if(
            skin.joints.begin(), skin.joints.end(),
            [&](const BoundJoint& joint) { return is_in_earlier_skin_.contains(joint.node); });
        const BoundJoint& anchor = shared != skin.joints.end() ? *shared : top;
        const Affine of_anchor = world_of(anchor.node) * anchor.inverse_bind;
        if (!agree_on(skin, of_anchor, size)) {
            const Affine to_scene =
                shared != skin.joints.end() ? of_anchor : choose_map(skin, top, of_anchor, size);
            for (const BoundJoint& joint : skin.joints) {
                bound_.try_emplace(joint.node, to_scene * joint.bind);
            }
            move_nodes();
        }
        for (const BoundJoint& joint : skin.joints) {
            is_in_earlier_skin_.insert(joint.node);
        }
    }

    // True if all joints are where they were bound, given the map `to_scene` from the mesh to the
    // scene. `size`: size of the skeleton in the mesh's units.
    bool agree_on(const BoundSkin& skin, const Affine& to_scene, double size) const {
        const double scale = to_scene.linear.norm() / std::sqrt(3.0);
        return std::all_of(skin.joints.begin(), skin.joints.end(), [&](const BoundJoint& joint) {
            const Affine own = world_of(joint.node) * joint.inverse_bind;
            const Vec3 place = joint.bind.translation;
            return (own.linear - to_scene.linear).norm() <= k_same * scale &&
                   (transform_point(own, place) - transform_point(to_scene, place)).norm() <=
                       k_same * scale * size;
        });
    }

    Affine choose_map(const BoundSkin& skin, const BoundJoint& top, const Affine& of_top,
                      double size) const {
        std::vector<Affine> frames = {world_of(skin.mesh_node), Affine()};
        if (const auto above = parent_.find(top.node); above != parent_.end()) {
            frames.insert(frames.begin(), world_of(above->second));
        }
        const Vec3 place = top.bind.translation;
        const double scale = scale_of(of_top);
        Affine nearest = of_top;
        double best = -1.0;
        for (const Affine& frame : frames) {
            if (!inverse_of(frame) || !(std::abs(scale_of(frame) / scale - 1.0) <= k_same_scale)) {
                continue;
            }
            const double cosine = cos_between(frame, of_top);
            const double off =
                (transform_point(frame, place) - transform_point(of_top, place)).norm();
            const double nearness = cosine - off / (std::abs(scale) * size);
            if (cosine > k_cos_posed && nearness > best) {
                best = nearness;
                nearest = frame;
            }
        }
        return nearest;
    }

    // Moves the nodes in bound_ to their places there, and all other nodes along with their
    // parents.
    void move_nodes() {
        std::map<int, Affine> before;
        for (PlacedNode& placed : placed_) {
            before[placed.node] = placed.world;
            const auto bound = bound_.find(placed.node);
            if (bound != bound_.end()) {
                placed.world = bound->second;
                continue;
            }
            const auto above = parent_.find(placed.node);
            if (above == parent_.end()) {
                continue;
            }
            const std::optional<Affine> from_above = inverse_of(before.at(above->second));
            if (from_above) {
                placed.world = world_of(above->second) * (*from_above * placed.world);
            }
        }
    }

    const Model& model_;
    AccessorReader& reader_;
    Refusal& refusal_;
    std::vector<PlacedNode>& placed_;
    std::map<int, std::size_t> order_;  // index in placed_, by node
    std::map<int, int> parent_;         // parent by node
    std::map<int, Affine> bound_;       // new transform into the scene of each moved node
    std::set<int> is_in_earlier_skin_;  // nodes of the skins that were bound before
};

}  // namespace

bool pose_as_bound(const Model& model, AccessorReader& reader, Refusal& refusal,
                   std::vector<PlacedNode>& placed) {
    return BindPose(model, reader, refusal, placed).pose();
}

}  // namespace handhold::gltf
