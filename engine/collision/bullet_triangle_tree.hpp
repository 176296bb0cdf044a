#pragma once

#include <algorithm>
#include <array>
#include <memory>
#include <optional>
#include <utility>

#include <BulletCollision/BroadphaseCollision/btQuantizedBvh.h>
#include <BulletCollision/CollisionShapes/btTriangleIndexVertexArray.h>

#include "engine/collision/bounds.hpp"
#include "engine/collision/shape_query.hpp"
#include "engine/geometry/closest_point.hpp"

class btBvhTriangleMeshShape;

// Finds the triangles of a mesh in a box or on a ray, through Bullet's quantised BVH. Bullet builds
// the tree. The traversal is this file's own and modifies nothing: Bullet's traversal counts its
// steps in a global, which is a data race.
namespace handhold {

// BVH of one unscaled mesh. Refers to the mesh, which must outlive it.
class TriangleTree {
  public:
    explicit TriangleTree(const Mesh& mesh);
    ~TriangleTree();
    TriangleTree(const TriangleTree&) = delete;
    TriangleTree& operator=(const TriangleTree&) = delete;

    // A box in the tree's quantised coordinates.
    struct NodeBox {
        std::array<unsigned short, 3> low;
        std::array<unsigned short, 3> high;
    };

    // Calls visit(triangle index) for the triangles whose bounds overlap `box`, and possibly for
    // some that nearly do. Skips the subtrees of nodes for which enters(node's box) is false. The
    // order is fixed; neighbouring triangles follow each other.
    template <typename Enters, typename Visit>
    void walk(const Bounds& box, const Enters& enters, const Visit& visit) const {
        const int count = nodes_->isLeafNode() ? 1 : nodes_->getEscapeIndex();
        const NodeBox wanted = node_box(box);
        for (int i = 0; i < count;) {
            const btQuantizedBvhNode& node = nodes_[i];
            const bool inside = meets(node, wanted) && enters(bounds_of_node(node));
            const bool leaf = node.isLeafNode();
            if (inside && leaf) {
                visit(static_cast<std::size_t>(node.getTriangleIndex()));
            }
            i += inside || leaf ? 1 : node.getEscapeIndex();
        }
    }
    const Mesh& mesh() const { return mesh_; }

  private:
    NodeBox node_box(const Bounds& box) const;
    Bounds bounds_of_node(const btQuantizedBvhNode& node) const {
        const auto at = [&](const unsigned short* grid) -> Vec3 {
            return low_ + Vec3(grid[0], grid[1], grid[2]).cwiseProduct(step_);
        };
        return {at(node.m_quantizedAabbMin), at(node.m_quantizedAabbMax)};
    }
    static bool meets(const btQuantizedBvhNode& node, const NodeBox& box) {
        bool overlap = true;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            overlap = overlap && node.m_quantizedAabbMin[axis] <= box.high[axis] &&
                      node.m_quantizedAabbMax[axis] >= box.low[axis];
        }
        return overlap;
    }

    const Mesh& mesh_;
    btTriangleIndexVertexArray parts_;
    std::unique_ptr<btBvhTriangleMeshShape> shape_;
    const btQuantizedBvh* tree_ = nullptr;       // owned by shape_
    const btQuantizedBvhNode* nodes_ = nullptr;  // owned by tree_
    Vec3 low_;                                   // origin and step of the quantisation grid
    Vec3 step_;
};

// Tests boxes against a segment. Boxes must already overlap the segment's bounds.
class SegmentTest {
  public:
    SegmentTest(const Vec3& from, const Vec3& displacement)
        : from_(from), inverse_(displacement.cwiseInverse()) {}

    // True if the first `fraction` of the segment enters the box. Rounding may make it true for a
    // near miss.
    bool may_meet(const Bounds& box, double fraction) const;

  private:
    Vec3 from_;
    Vec3 inverse_;  // infinite along axes that the segment is perpendicular to
};

// The triangles of a tree, scaled along the mesh's axes. Bodies with different scales share one
// tree; only triangles that a query finds are scaled.
class ScaledTriangles {
  public:
    // Scale factors are not 0; negative ones mirror.
    ScaledTriangles(std::shared_ptr<const TriangleTree> tree, const Vec3& scale);

    // Calls visit(corners) for the triangles whose bounds overlap the box, and possibly for others.
    template <typename Visit>
    void visit_box(const Bounds& box, const Visit& visit) const {
        tree_->walk(
            unscaled(box), [](const Bounds&) { return true; },
            [&](std::size_t triangle) { visit(corners(triangle)); });
    }
    // Calls visit(corners) for the triangles whose bounds a sphere may touch that moves from `from`
    // by `fraction` of `displacement`. visit may reduce `fraction` to that of the first impact so
    // far: triangles farther along are then left out.
    template <typename Visit>
    void visit_path(const Vec3& from, const Vec3& displacement, double radius_m,
                    const double& fraction, const Visit& visit) const {
        const SegmentTest path(from, displacement);
        tree_->walk(
            unscaled(bounds_of(from, from + fraction * displacement).grown(radius_m)),
            [&](const Bounds& box) { return path.may_meet(scaled(box).grown(radius_m), fraction); },
            [&](std::size_t triangle) { visit(corners(triangle)); });
    }
    // False only if no triangle's bounds overlap the box.
    bool may_meet(const Bounds& box) const;
    // First triangle that the segment hits, from either side.
    std::optional<LocalRayHit> cast_ray(const Vec3& from, const Vec3& to) const;
    // Nearest point within max_distance_m; nullopt if none.
    std::optional<LocalSurfacePoint> closest_point(const Vec3& point, double max_distance_m) const;

  private:
    Bounds scaled(const Bounds& box) const { return box.scaled(scale_); }
    Bounds unscaled(const Bounds& box) const { return box.scaled(inverse_scale_); }
    Corners corners(std::size_t triangle) const {
        const auto& [a, b, c] = tree_->mesh().triangles[triangle];
        const std::vector<Vec3>& positions = tree_->mesh().positions;
        const auto& [second, third] = is_mirrored_ ? std::pair(c, b) : std::pair(b, c);
        return {positions[a].cwiseProduct(scale_), positions[second].cwiseProduct(scale_),
                positions[third].cwiseProduct(scale_)};
    }

    std::shared_ptr<const TriangleTree> tree_;
    Vec3 scale_;
    Vec3 inverse_scale_;
    bool is_mirrored_;
};

}  // namespace handhold
