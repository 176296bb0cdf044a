// Bullet's GJK and EPA run on the cores, without margins: so they are exact to rounding on boxes
// and triangles, and a radius adds exactly. Its clipping then makes the points of two faces. Around
// them stands what Bullet lacks: a normal where cores meet without a volume, and two points where
// edges lie side by side (it gives one; perturbed poses give more, up to 0.7 mm off).
#include "engine/collision/bullet_convex.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include <BulletCollision/CollisionShapes/btBoxShape.h>
#include <BulletCollision/CollisionShapes/btCapsuleShape.h>
#include <BulletCollision/CollisionShapes/btSphereShape.h>
#include <BulletCollision/NarrowPhaseCollision/btGjkEpa2.h>
#include <BulletCollision/NarrowPhaseCollision/btPolyhedralContactClipping.h>

namespace handhold {
namespace {

// A face counts as facing along the normal up to 5 degrees: the points are then those of the faces,
// still on both surfaces.
constexpr double k_face_cosine = 0.996;
constexpr double k_edge_sine = 0.09;
constexpr double k_face_gain_m = 1e-9;
constexpr double k_same_place_m = 1e-6;
constexpr double k_no_limit_m = 1e30;
// Side planes stand this far out of their face: Bullet drops an edge that lies in one.
constexpr double k_inside_m = 1e-9;

btFace make_face(std::initializer_list<int> corners, const Vec3& normal, double offset_m) {
    btFace face;
    for (const int corner : corners) {
        face.m_indices.push_back(corner);
    }
    face.m_plane[0] = normal.x();
    face.m_plane[1] = normal.y();
    face.m_plane[2] = normal.z();
    face.m_plane[3] = -offset_m;
    return face;
}

// Corner i is on the positive side of axis k where bit k of i is set. Made here because Bullet's
// own hull builder puts corners on a grid.
void make_box_faces(const Vec3& half, double grown_m, btConvexPolyhedron& faces) {
    const Vec3 reach = half + Vec3::Constant(grown_m);
    for (unsigned i = 0; i < 8; ++i) {
        faces.m_vertices.push_back({(i & 1U) != 0 ? reach.x() : -reach.x(),
                                    (i & 2U) != 0 ? reach.y() : -reach.y(),
                                    (i & 4U) != 0 ? reach.z() : -reach.z()});
    }
    for (int axis = 0; axis < 3; ++axis) {
        const int bit = 1 << axis;
        const int u = 1 << ((axis + 1) % 3);
        const int v = 1 << ((axis + 2) % 3);
        const Vec3 normal = Vec3::Unit(axis);
        faces.m_faces.push_back(
            make_face({bit, bit | u, bit | u | v, bit | v}, normal, half[axis]));
        faces.m_faces.push_back(make_face({0, v, u | v, u}, -normal, half[axis]));
    }
}

Vec3 face_normal(const Convex& convex, int face) {
    const btScalar* plane = convex.faces->m_faces[face].m_plane;
    return from_bullet(convex.pose_ns.getBasis() * btVector3(plane[0], plane[1], plane[2]));
}

// The face that looks most along a direction.
int facing(const Convex& convex, const Vec3& direction) {
    int best = 0;
    for (int i = 1; i < convex.faces->m_faces.size(); ++i) {
        if (face_normal(convex, i).dot(direction) > face_normal(convex, best).dot(direction)) {
            best = i;
        }
    }
    return best;
}

// Both ends of a capsule's axis; of a sphere twice the centre.
std::array<Vec3, 2> axis_ends(const Convex& convex) {
    const Vec3 axis = from_bullet(convex.pose_ns.getBasis().getColumn(1));
    return {convex.support(-axis), convex.support(axis)};
}

// visit(from, to) for every edge of the core.
template <typename Visit>
void visit_edges(const Convex& convex, const Visit& visit) {
    if (convex.faces == nullptr) {
        const auto [from, to] = axis_ends(convex);
        visit(from, to);
        return;
    }
    const auto corner = [&](int index) {
        return from_bullet(convex.pose_ns * convex.faces->m_vertices[index]);
    };
    for (int i = 0; i < convex.faces->m_faces.size(); ++i) {
        const auto& loop = convex.faces->m_faces[i].m_indices;
        for (int k = 0; k < loop.size(); ++k) {
            visit(corner(loop[k]), corner(loop[(k + 1) % loop.size()]));
        }
    }
}

// Cores that meet in a plane or a line have no least way out: any across both is as good, and this
// one is always the same.
Vec3 any_way_out(const Convex& a, const Convex& b) {
    if (b.corners_ns != nullptr) {
        const Vec3 normal = face_normal(b, 0);
        return (a.centre_ns() - (*b.corners_ns)[0]).dot(normal) >= 0.0 ? normal : Vec3(-normal);
    }
    const auto axis = [](const Convex& convex) -> Vec3 {
        if (convex.faces != nullptr) {
            return Vec3::Zero();
        }
        const auto [from, to] = axis_ends(convex);
        return to - from;
    };
    const Vec3 axis_a = axis(a);
    const Vec3 axis_b = axis(b);
    const Vec3 across = axis_a.cross(axis_b);
    if (across.norm() > 1e-5 * axis_a.norm() * axis_b.norm()) {
        return across.normalized();
    }
    const Vec3 longer = axis_a.norm() > axis_b.norm() ? axis_a : axis_b;
    return longer.norm() > 0.0 ? Vec3(longer.unitOrthogonal()) : Vec3(Vec3::UnitY());
}

// A normal from two points that nearly meet is noise beside a face's own.
void snap_to_faces(const Convex& convex, double side, CoreSeparation& result) {
    if (convex.faces == nullptr) {
        return;
    }
    const Vec3 normal = side * face_normal(convex, facing(convex, side * result.normal));
    const double noise = 1e-6 + 1e-15 / std::max(std::abs(result.separation_m), 1e-13);
    if (normal.dot(result.normal) > 0.0 && normal.cross(result.normal).norm() < noise) {
        result.normal = normal;
    }
}

// EPA gives a wrong depth and way out where its first simplex is flat (two cubes in line: 0.7 mm
// across an edge instead of 1 mm out of a face). The ways through faces are tried beside it.
// `side`: the normal's direction against the faces', +1 for b's.
void try_faces(const Convex& a, const Convex& b, double side, CoreSeparation& best) {
    const Convex& owner = side > 0.0 ? b : a;
    const int count = owner.faces != nullptr ? owner.faces->m_faces.size() : 0;
    for (int i = 0; i < count; ++i) {
        const Vec3 normal = side * face_normal(owner, i);
        const Vec3 point_a = a.support(-normal);
        const Vec3 point_b = b.support(normal);
        const double separation = normal.dot(point_a - point_b);
        if (separation > best.separation_m + k_face_gain_m) {
            best = {normal, separation, point_a, point_b, true};
            (side > 0.0 ? best.point_b_ns : best.point_a_ns) =
                side > 0.0 ? Vec3(point_a - separation * normal)
                           : Vec3(point_b + separation * normal);
        }
    }
}

double depth_along(const Convex& a, const Convex& b, const Vec3& normal) {
    return normal.dot(a.support(-normal) - b.support(normal));
}

enum class Search { apart, way_out };

bool run(Search search, const Convex& a, const Convex& b, const btVector3& guess,
         CoreSeparation& result) {
    btGjkEpaSolver2::sResults found;
    const bool any =
        search == Search::apart
            ? btGjkEpaSolver2::Distance(a.shape, a.pose_ns, b.shape, b.pose_ns, guess, found)
            : btGjkEpaSolver2::Penetration(a.shape, a.pose_ns, b.shape, b.pose_ns, guess, found,
                                           false);
    if (any) {
        // Bullet leaves the normal in a's frame.
        result.normal = from_bullet(a.pose_ns.getBasis() * found.normal).normalized();
        result.separation_m = found.distance;
        result.point_a_ns = from_bullet(found.witnesses[0]);
        result.point_b_ns = from_bullet(found.witnesses[1]);
        snap_to_faces(a, -1.0, result);
        snap_to_faces(b, 1.0, result);
    }
    return any;
}

// A start for a search that stopped early: another octant each time.
btVector3 other_guess(int attempt) {
    return {(attempt & 1) != 0 ? 0.9 : -0.8, (attempt & 2) != 0 ? 0.7 : -1.0,
            (attempt & 4) != 0 ? 1.0 : -0.6};
}

// An answer is whole where no point of the cores lies between the planes across its normal. That
// Bullet stops early was measured in 1 of 5000 pairs, up to 30 cm off: it then starts again
// elsewhere, and the best of all answers counts. False where the cores meet, or have no volume.
bool find_whole(Search search, const Convex& a, const Convex& b, btVector3 guess,
                CoreSeparation& best) {
    constexpr int k_attempts = 8;
    bool any = false;
    for (int attempt = 0; attempt < k_attempts; ++attempt) {
        CoreSeparation result;
        if (run(search, a, b, guess, result)) {
            const double along_m = depth_along(a, b, result.normal);
            // Two points that nearly meet leave noise in the normal.
            const double noise_m = 1e-9 + 1e-14 / std::max(std::abs(result.separation_m), 1e-13);
            if (std::abs(along_m - result.separation_m) < noise_m) {
                best = result;
                return true;
            }
            result.separation_m = along_m;
            if (!any || along_m > best.separation_m) {
                best = result;
            }
            any = true;
        } else if (search == Search::apart && !any) {
            return false;
        }
        guess = other_guess(attempt);
    }
    return any;
}

// What a core turns towards `direction`: its face, else its segment where that lies across the
// direction, else a point. Points count twice: Bullet clips no polygon of one.
void supporting_feature(const Convex& convex, const Vec3& direction,
                        btAlignedObjectArray<btVector3>& polygon) {
    polygon.resizeNoInitialize(0);
    if (convex.faces == nullptr) {
        auto [from, to] = axis_ends(convex);
        if (std::abs((to - from).dot(direction)) > 0.5 * (to - from).norm()) {
            from = to = convex.support(direction);
        }
        polygon.push_back(to_bullet(from));
        polygon.push_back(to_bullet(to));
        return;
    }
    const auto& loop = convex.faces->m_faces[facing(convex, direction)].m_indices;
    for (int k = 0; k < loop.size(); ++k) {
        polygon.push_back(convex.pose_ns * convex.faces->m_vertices[loop[k]]);
    }
}

struct Pair {
    const Convex& a;
    const Convex& b;
    Vec3 normal;
    double margin_m;
    ClipScratch& scratch;
    std::vector<NearContact>& contacts;

    // Points of the cores: the radii are added here.
    void add(const Vec3& core_a, const Vec3& core_b) const {
        const double separation = normal.dot(core_a - core_b) - a.radius_m - b.radius_m;
        if (separation < margin_m) {
            contacts.push_back(
                {core_a - a.radius_m * normal, core_b + b.radius_m * normal, normal, separation});
        }
    }
};

// visit(point, foot): the corners of the part of `body`'s feature that is over `ground`'s face, and
// their feet on that face. `up` points from ground to body.
template <typename Visit>
void clip(const Convex& ground, const Convex& body, const Vec3& up, ClipScratch& scratch,
          const Visit& visit) {
    struct Collector final : btDiscreteCollisionDetectorInterface::Result {
        Collector(const Vec3& normal, const Visit& take) : face_normal(normal), visit(take) {}
        void setShapeIdentifiersA(int /*part*/, int /*index*/) override {}
        void setShapeIdentifiersB(int /*part*/, int /*index*/) override {}
        void addContactPoint(const btVector3& /*normal*/, const btVector3& point,
                             btScalar height) override {
            visit(from_bullet(point), Vec3(from_bullet(point) - height * face_normal));
        }
        Vec3 face_normal;
        const Visit& visit;
    };
    supporting_feature(body, -up, scratch.polygon);
    Collector collector(face_normal(ground, facing(ground, up)), visit);
    btPolyhedralContactClipping::clipFaceAgainstHull(
        to_bullet(Vec3(-up)), *ground.prisms, ground.pose_ns, scratch.polygon, scratch.clipped,
        -k_no_limit_m, k_no_limit_m, collector);
}

double facing_cosine(const Convex& convex, const Vec3& direction) {
    return convex.faces == nullptr ? 0.0
                                   : face_normal(convex, facing(convex, direction)).dot(direction);
}

bool add_faces(const Pair& pair) {
    const double cosine_a = facing_cosine(pair.a, -pair.normal);
    const double cosine_b = facing_cosine(pair.b, pair.normal);
    if (cosine_b > k_face_cosine && cosine_b + 1e-9 >= cosine_a) {
        clip(pair.b, pair.a, pair.normal, pair.scratch,
             [&](const Vec3& point, const Vec3& foot) { pair.add(point, foot); });
        return true;
    }
    if (cosine_a > k_face_cosine) {
        clip(pair.a, pair.b, -pair.normal, pair.scratch,
             [&](const Vec3& point, const Vec3& foot) { pair.add(foot, point); });
        return true;
    }
    return false;
}

// The edge at the outermost vertex that lies most across `direction`; nullopt where none lies
// across it.
std::optional<std::array<Vec3, 2>> supporting_edge(const Convex& convex, const Vec3& direction) {
    const Vec3 outermost = convex.support(direction);
    std::optional<std::array<Vec3, 2>> best;
    double least = k_edge_sine;
    visit_edges(convex, [&](const Vec3& from, const Vec3& to) {
        const double sine = std::abs((to - from).normalized().dot(direction));
        const bool is_outermost =
            std::min((from - outermost).norm(), (to - outermost).norm()) < k_same_place_m;
        if (is_outermost && from != to && sine < least) {
            least = sine;
            best = {from, to};
        }
    });
    return best;
}

// Two edges side by side hold each other at both ends of their common part.
void add_edges(const Pair& pair) {
    const auto edge_a = supporting_edge(pair.a, -pair.normal);
    const auto edge_b = supporting_edge(pair.b, pair.normal);
    if (!edge_a || !edge_b) {
        return;
    }
    const Vec3 along_b = (*edge_b)[1] - (*edge_b)[0];
    const Vec3 along_a = (*edge_a)[1] - (*edge_a)[0];
    if (std::abs(along_a.normalized().dot(along_b.normalized())) < k_face_cosine) {
        return;
    }
    for (const Vec3& end : *edge_b) {
        const Vec3 on_a = closest_on_segment(end, (*edge_a)[0], (*edge_a)[1]);
        pair.add(on_a, closest_on_segment(on_a, (*edge_b)[0], (*edge_b)[1]));
    }
}

}  // namespace

btTransform to_bullet(const Pose& pose) {
    const Quat& q = pose.rotation;
    return btTransform(btQuaternion(q.x(), q.y(), q.z(), q.w()), to_bullet(pose.position));
}

Vec3 Convex::support(const Vec3& direction) const {
    const btVector3 local = to_bullet(direction) * pose_ns.getBasis();
    return from_bullet(pose_ns * shape->localGetSupportVertexWithoutMarginNonVirtual(local));
}

ConvexShape::ConvexShape(const Shape& shape)
    : radius_m_(shape.kind == ShapeKind::box ? 0.0 : shape.radius_m),
      core_reach_m_(bounding_radius(shape) - radius_m_),
      thinnest_half_m_(thinnest_half_extent(shape)) {
    switch (shape.kind) {
        case ShapeKind::box:
            shape_ = std::make_unique<btBoxShape>(to_bullet(shape.half_m));
            shape_->setMargin(0.0);
            make_box_faces(shape.half_m, 0.0, faces_);
            make_box_faces(shape.half_m, k_inside_m, prisms_);
            break;
        case ShapeKind::sphere:
            shape_ = std::make_unique<btSphereShape>(shape.radius_m);
            break;
        case ShapeKind::capsule:
            shape_ = std::make_unique<btCapsuleShape>(shape.radius_m, 2.0 * shape.half_height_m);
            break;
        case ShapeKind::mesh:
            break;
    }
}

Convex ConvexShape::at(const Pose& pose_ns) const {
    const bool flat = faces_.m_faces.size() > 0;
    return {shape_.get(),
            flat ? &faces_ : nullptr,
            flat ? &prisms_ : nullptr,
            to_bullet(pose_ns),
            radius_m_,
            nullptr};
}

void ConvexShape::set_sphere_radius(double radius_m) {
    static_cast<btSphereShape&>(*shape_).setUnscaledRadius(radius_m);
    radius_m_ = radius_m;
}

TriangleShape::TriangleShape() : shape_({0, 0, 0}, {0, 0, 0}, {0, 0, 0}) {
    shape_.setMargin(0.0);
    faces_.m_vertices.resize(3);
    faces_.m_faces.push_back(make_face({0, 1, 2}, Vec3::UnitY(), 0.0));
    faces_.m_faces.push_back(make_face({0, 2, 1}, -Vec3::UnitY(), 0.0));
}

Convex TriangleShape::place(const Corners& corners_ns, const Vec3& unit_normal) {
    corners_ns_ = corners_ns;
    const Vec3 middle = (corners_ns[0] + corners_ns[1] + corners_ns[2]) / 3.0;
    const Vec3 normal =
        area_vector(corners_ns).dot(unit_normal) >= 0.0 ? unit_normal : Vec3(-unit_normal);
    for (int i = 0; i < 3; ++i) {
        const Vec3& corner = corners_ns_[static_cast<std::size_t>(i)];
        shape_.m_vertices1[i] = to_bullet(corner);
        faces_.m_vertices[i] = to_bullet(corner + k_inside_m * (corner - middle).normalized());
    }
    for (const int face : {0, 1}) {
        const Vec3 outward = face == 0 ? normal : Vec3(-normal);
        btScalar* plane = faces_.m_faces[face].m_plane;
        plane[0] = outward.x();
        plane[1] = outward.y();
        plane[2] = outward.z();
        plane[3] = -outward.dot(corners_ns[0]);
    }
    return {&shape_, &faces_, &faces_, btTransform::getIdentity(), 0.0, &corners_ns_};
}

CoreSeparation separate(const Convex& a, const Convex& b) {
    const Vec3 fallback = any_way_out(a, b);
    const btVector3 guess =
        -(to_bullet(fallback) * a.pose_ns.getBasis());  // where EPA has no volume: its answer
    CoreSeparation result;
    if (find_whole(Search::apart, a, b, guess, result) && result.separation_m > 0.0) {
        return result;
    }
    if (!find_whole(Search::way_out, a, b, guess, result)) {
        result.normal = fallback;
        result.separation_m = depth_along(a, b, fallback);
        result.point_a_ns = result.point_b_ns = a.support(-fallback);
    }
    result.overlap = true;
    try_faces(a, b, 1.0, result);
    try_faces(a, b, -1.0, result);
    return result;
}

void add_manifold(const Convex& a, const Convex& b, const CoreSeparation& separation,
                  double margin_m, ClipScratch& scratch, std::vector<NearContact>& contacts) {
    const std::size_t first = contacts.size();
    const Pair pair{a, b, separation.normal, margin_m, scratch, contacts};
    if (!add_faces(pair)) {
        add_edges(pair);
    }
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t i = first; i < contacts.size(); ++i) {
        least = std::min(least, contacts[i].separation_m);
    }
    if (separation.separation_m - a.radius_m - b.radius_m < least - k_same_place_m) {
        pair.add(separation.point_a_ns, separation.point_b_ns);
    }
}

void add_face_manifold(const Convex& a, const Convex& b, const Vec3& normal, double margin_m,
                       ClipScratch& scratch, std::vector<NearContact>& contacts) {
    const Pair pair{a, b, normal, margin_m, scratch, contacts};
    clip(b, a, normal, scratch,
         [&](const Vec3& point, const Vec3& foot) { pair.add(point, foot); });
}

}  // namespace handhold
