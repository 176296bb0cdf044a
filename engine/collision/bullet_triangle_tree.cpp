#include "engine/collision/bullet_triangle_tree.hpp"

#include <cmath>
#include <utility>

#include <BulletCollision/CollisionShapes/btBvhTriangleMeshShape.h>
#include <BulletCollision/NarrowPhaseCollision/btRaycastCallback.h>

#include "engine/collision/bullet_vector.hpp"

namespace handhold {
bool SegmentTest::may_meet(const Bounds& box, double fraction) const {
    constexpr double k_rounding = 1e-12;
    double enter = 0.0;
    double leave = fraction;
    for (Eigen::Index axis = 0; axis < 3; ++axis) {
        if (!std::isfinite(inverse_[axis])) {
            continue;  // the box overlaps the segment along this axis
        }
        const double near = (box.low[axis] - from_[axis]) * inverse_[axis];
        const double far = (box.high[axis] - from_[axis]) * inverse_[axis];
        enter = std::max(enter, std::min(near, far));
        leave = std::min(leave, std::max(near, far));
    }
    return enter <= leave + k_rounding;
}

TriangleTree::TriangleTree(const Mesh& mesh) : mesh_(mesh) {
    btIndexedMesh part;
    part.m_numTriangles = static_cast<int>(mesh.triangles.size());
    part.m_triangleIndexBase = reinterpret_cast<const unsigned char*>(mesh.triangles.data());
    part.m_triangleIndexStride = sizeof(mesh.triangles[0]);
    part.m_numVertices = static_cast<int>(mesh.positions.size());
    part.m_vertexBase = reinterpret_cast<const unsigned char*>(mesh.positions.data());
    part.m_vertexStride = sizeof(Vec3);
    part.m_vertexType = PHY_DOUBLE;
    parts_.addIndexedMesh(part);
    shape_ = std::make_unique<btBvhTriangleMeshShape>(&parts_, true);
    btOptimizedBvh* const tree = shape_->getOptimizedBvh();
    tree_ = tree;
    nodes_ = &tree->getQuantizedNodeArray()[0];
    const std::array<unsigned short, 3> origin = {0, 0, 0};
    const std::array<unsigned short, 3> one = {1, 1, 1};
    low_ = from_bullet(tree->unQuantize(origin.data()));
    step_ = from_bullet(tree->unQuantize(one.data())) - low_;
}

TriangleTree::~TriangleTree() = default;

TriangleTree::NodeBox TriangleTree::node_box(const Bounds& box) const {
    NodeBox result{};
    tree_->quantizeWithClamp(result.low.data(), to_bullet(box.low), 0);
    tree_->quantizeWithClamp(result.high.data(), to_bullet(box.high), 1);
    return result;
}

ScaledTriangles::ScaledTriangles(std::shared_ptr<const TriangleTree> tree, const Vec3& scale)
    : tree_(std::move(tree)),
      scale_(scale),
      inverse_scale_(scale.cwiseInverse()),
      is_mirrored_(is_mirrored(scale)) {}

bool ScaledTriangles::may_meet(const Bounds& box) const {
    bool found = false;
    tree_->walk(
        unscaled(box), [&found](const Bounds&) { return !found; },
        [&found](std::size_t) { found = true; });
    return found;
}

std::optional<LocalRayHit> ScaledTriangles::cast_ray(const Vec3& from, const Vec3& to) const {
    struct Nearest final : btTriangleRaycastCallback {
        using btTriangleRaycastCallback::btTriangleRaycastCallback;
        btScalar reportHit(const btVector3& unit_normal, btScalar fraction, int /*part*/,
                           int /*index*/) override {
            hit = LocalRayHit{fraction, from_bullet(unit_normal)};
            return fraction;
        }
        std::optional<LocalRayHit> hit;
    };
    Nearest nearest(to_bullet(from), to_bullet(to));
    // The tree stores the unscaled mesh. Scaling does not change a ray's fractions.
    const SegmentTest segment(from.cwiseProduct(inverse_scale_),
                              (to - from).cwiseProduct(inverse_scale_));
    tree_->walk(
        unscaled(bounds_of(from, to)),
        [&](const Bounds& box) { return segment.may_meet(box, nearest.m_hitFraction); },
        [&](std::size_t triangle) {
            const Corners c = corners(triangle);
            std::array<btVector3, 3> points = {to_bullet(c[0]), to_bullet(c[1]), to_bullet(c[2])};
            nearest.processTriangle(points.data(), 0, static_cast<int>(triangle));
        });
    return nearest.hit;
}

// Searches boxes of doubling size until one contains a triangle nearer than the box's half size.
std::optional<LocalSurfacePoint> ScaledTriangles::closest_point(const Vec3& point,
                                                                double max_distance_m) const {
    std::optional<LocalSurfacePoint> best;
    double reach_m = max_distance_m / 32.0;
    do {
        reach_m = std::min(2.0 * reach_m, max_distance_m);
        double nearest_m = reach_m;
        visit_box(bounds_of(point, point).grown(reach_m), [&](const Corners& corners) {
            const Vec3 low = corners[0].cwiseMin(corners[1]).cwiseMin(corners[2]);
            const Vec3 high = corners[0].cwiseMax(corners[1]).cwiseMax(corners[2]);
            if ((point.cwiseMax(low).cwiseMin(high) - point).squaredNorm() >
                nearest_m * nearest_m) {
                return;
            }
            const LocalSurfacePoint near = closest_on_triangle_surface(corners, point);
            if (best ? near.distance_m < nearest_m : near.distance_m <= nearest_m) {
                nearest_m = near.distance_m;
                best = near;
            }
        });
    } while (!best && reach_m < max_distance_m);
    return best;
}

}  // namespace handhold
