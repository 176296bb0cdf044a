#include "engine/collision/bullet_convex.hpp"

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <limits>
#include <utility>

#include <BulletCollision/CollisionShapes/btBoxShape.h>
#include <BulletCollision/CollisionShapes/btCapsuleShape.h>
#include <BulletCollision/CollisionShapes/btConvexHullShape.h>
#include <BulletCollision/CollisionShapes/btCylinderShape.h>
#include <BulletCollision/CollisionShapes/btSphereShape.h>

#include "engine/geometry/mass_properties.hpp"

namespace handhold {
namespace {

// Clipping planes are moved outwards by this distance, because Bullet drops an edge that lies in a
// clipping plane.
constexpr double k_inside_m = 1e-9;

template <typename Loop>
btFace make_face(const Loop& corners, const Vec3& normal, double offset_m) {
    btFace face;
    for (const auto corner : corners) {
        face.m_indices.push_back(static_cast<int>(corner));
    }
    face.m_plane[0] = normal.x();
    face.m_plane[1] = normal.y();
    face.m_plane[2] = normal.z();
    face.m_plane[3] = -offset_m;
    return face;
}

// Bit k of a corner's index is set if the corner is on the positive side of axis k. Bullet's hull
// builder is not used, because it snaps corners to a grid.
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
            make_face(std::array{bit, bit | u, bit | u | v, bit | v}, normal, half[axis]));
        faces.m_faces.push_back(make_face(std::array{0, v, u | v, u}, -normal, half[axis]));
    }
}

// Number of corners of the polygons that stand for a cylinder's ends. Between two corners the
// polygon lies up to 2 % of the radius inside the rim. This affects only the spread of the
// contacts, because the deepest point is added separately.
constexpr int k_rim_corners = 16;

void make_end_faces(const Barrel& barrel, double grown_m, btConvexPolyhedron& faces) {
    constexpr double k_turn_rad = 6.28318530717958647693;
    std::array<int, k_rim_corners> top{};
    std::array<int, k_rim_corners> bottom{};
    for (int i = 0; i < k_rim_corners; ++i) {
        double sine = 0.0;
        double cosine = 0.0;
        sin_cos(k_turn_rad * i / k_rim_corners, sine, cosine);
        const double reach = barrel.radius_m + grown_m;
        const auto at = static_cast<std::size_t>(i);
        for (const double side : {1.0, -1.0}) {
            (side > 0.0 ? top[at] : bottom[k_rim_corners - 1 - at]) = faces.m_vertices.size();
            faces.m_vertices.push_back({reach * sine, side * barrel.half_height_m, reach * cosine});
        }
    }
    faces.m_faces.push_back(make_face(top, Vec3::UnitY(), barrel.half_height_m));
    faces.m_faces.push_back(make_face(bottom, -Vec3::UnitY(), barrel.half_height_m));
}

// Moves every face outwards by at least grown_m, by scaling about the origin, which is inside.
void make_hull_faces(const ConvexHull& hull, double grown_m, btConvexPolyhedron& faces) {
    // Distance from the origin to the nearest face.
    double inradius_m = std::numeric_limits<double>::infinity();
    for (const HullFace& face : hull.faces) {
        inradius_m = std::min(inradius_m, face.offset_m);
        faces.m_faces.push_back(make_face(face.loop, face.normal, face.offset_m));
    }
    for (const Vec3& corner : hull.corners) {
        faces.m_vertices.push_back(to_bullet((1.0 + grown_m / inradius_m) * corner));
    }
}

std::unique_ptr<btConvexShape> make_core(const Shape& shape) {
    switch (shape.kind) {
        case ShapeKind::box: {
            auto box = std::make_unique<btBoxShape>(to_bullet(shape.half_m));
            box->setMargin(0.0);
            return box;
        }
        case ShapeKind::sphere:
            return std::make_unique<btSphereShape>(shape.radius_m);
        case ShapeKind::capsule:
            return std::make_unique<btCapsuleShape>(shape.radius_m, 2.0 * shape.half_height_m);
        case ShapeKind::cylinder: {
            auto cylinder = std::make_unique<btCylinderShape>(
                btVector3(shape.radius_m, shape.half_height_m, shape.radius_m));
            cylinder->setMargin(0.0);
            return cylinder;
        }
        case ShapeKind::hull: {
            auto hull = std::make_unique<btConvexHullShape>();
            for (const Vec3& corner : shape.hull->corners) {
                hull->addPoint(to_bullet(corner), false);
            }
            hull->recalcLocalAabb();
            hull->setMargin(0.0);
            return hull;
        }
        case ShapeKind::compound:
        case ShapeKind::mesh:
            break;
    }
    return nullptr;
}

bool is_grown(const Shape& shape) {
    return shape.kind == ShapeKind::sphere || shape.kind == ShapeKind::capsule;
}

void make_faces(const Shape& shape, double grown_m, btConvexPolyhedron& faces) {
    if (shape.kind == ShapeKind::box) {
        make_box_faces(shape.half_m, grown_m, faces);
    } else if (shape.kind == ShapeKind::cylinder) {
        make_end_faces({shape.radius_m, shape.half_height_m}, grown_m, faces);
    } else if (shape.kind == ShapeKind::hull) {
        make_hull_faces(*shape.hull, grown_m, faces);
    }
}

// The core (the shape without its radius) must contain its frame's origin. A hull need not contain
// its own origin, so a hull's core frame is at the centroid.
Pose core_frame(const Shape& shape) {
    if (shape.kind != ShapeKind::hull) {
        return {};
    }
    const Vec3 centre = mass_properties(shape).centre_m;
    const bool centred = centre.norm() <= 1e-9 * bounding_radius(shape);
    return centred ? Pose{} : Pose{centre, Quat::Identity()};
}

Shape core_of(const Shape& shape) {
    Shape core = shape;
    if (shape.kind == ShapeKind::hull) {
        core.hull =
            std::make_shared<const ConvexHull>(moved_hull(*shape.hull, inverse(core_frame(shape))));
    }
    return core;
}

}  // namespace

Vec3 Convex::support(const Vec3& direction) const {
    const btVector3 local = to_bullet(direction) * pose_ns.getBasis();
    if (box_half_m != nullptr) {
        const btVector3 corner(local.x() >= 0.0 ? box_half_m->x() : -box_half_m->x(),
                               local.y() >= 0.0 ? box_half_m->y() : -box_half_m->y(),
                               local.z() >= 0.0 ? box_half_m->z() : -box_half_m->z());
        return from_bullet(pose_ns * corner);
    }
    return from_bullet(pose_ns * shape->localGetSupportVertexWithoutMarginNonVirtual(local));
}

Vec3 Convex::face_normal(int face) const {
    const btScalar* plane = faces->m_faces[face].m_plane;
    return from_bullet(pose_ns.getBasis() * btVector3(plane[0], plane[1], plane[2]));
}

int Convex::facing(const Vec3& direction) const {
    const Vec3 local = from_bullet(to_bullet(direction) * pose_ns.getBasis());
    int best = 0;
    double best_cosine = -std::numeric_limits<double>::infinity();
    for (int i = 0; i < faces->m_faces.size(); ++i) {
        const btScalar* plane = faces->m_faces[i].m_plane;
        if (const double cosine = local.dot(Vec3(plane[0], plane[1], plane[2]));
            cosine > best_cosine) {
            best_cosine = cosine;
            best = i;
        }
    }
    return best;
}

std::array<Vec3, 2> Convex::side_line(const Vec3& direction) const {
    const Vec3 up = axis();
    if (barrel == nullptr) {
        return {support(-up), support(up)};
    }
    const Vec3 half = barrel->half_height_m * up;
    Vec3 out = direction - direction.dot(up) * up;
    const double length = out.norm();
    // If `direction` is parallel to the axis, all lines on the curved side are equally far: takes
    // any.
    out = length > 0.0 ? Vec3(out / length) : from_bullet(pose_ns.getBasis().getColumn(2));
    const Vec3 middle = centre_ns() + barrel->radius_m * out;
    return {middle - half, middle + half};
}

ConvexShape::ConvexShape(const Shape& shape)
    : shape_(make_core(shape)),
      radius_m_(is_grown(shape) ? shape.radius_m : 0.0),
      core_reach_m_(bounding_radius(shape) - radius_m_),
      thinnest_half_m_(thinnest_half_extent(shape)) {
    make_faces(shape, 0.0, faces_);
    make_faces(shape, k_inside_m, prisms_);
    if (shape.kind == ShapeKind::cylinder) {
        barrel_ = {shape.radius_m, shape.half_height_m};
    }
    if (shape.kind == ShapeKind::box) {
        box_half_m_ = shape.half_m;
    }
}

Convex ConvexShape::at(const Pose& pose_ns) const {
    const bool flat = faces_.m_faces.size() > 0;
    return {shape_.get(),
            flat ? &faces_ : nullptr,
            flat ? &prisms_ : nullptr,
            to_bullet(pose_ns),
            radius_m_,
            nullptr,
            barrel_.radius_m > 0.0 ? &barrel_ : nullptr,
            box_half_m_.x() > 0.0 ? &box_half_m_ : nullptr};
}

void ConvexShape::set_sphere_radius(double radius_m) {
    static_cast<btSphereShape&>(*shape_).setUnscaledRadius(radius_m);
    radius_m_ = radius_m;
}

ConvexPart::ConvexPart(const Shape& shape, const Pose& pose_bs)
    : shape_(core_of(shape)),
      pose_bs_(pose_bs * core_frame(shape)),
      centred_(pose_bs_.position.isZero(0.0) &&
               pose_bs_.rotation.coeffs() == Quat::Identity().coeffs()),
      extent_(part_extent({shape, pose_bs})) {}

void ConvexPart::set_sphere_radius(double radius_m) {
    shape_.set_sphere_radius(radius_m);
    extent_ = {{Vec3::Constant(-radius_m), Vec3::Constant(radius_m)},
               pose_bs_.position.norm() + radius_m};
}

std::vector<ConvexPart> make_parts(const Shape& shape) {
    std::vector<ConvexPart> parts;
    if (shape.kind != ShapeKind::compound) {
        parts.emplace_back(shape, Pose{});
        return parts;
    }
    for (const PlacedShape& part : *shape.parts) {
        parts.emplace_back(part.shape, part.pose);
    }
    return parts;
}

TriangleShape::TriangleShape() : shape_({0, 0, 0}, {0, 0, 0}, {0, 0, 0}) {
    shape_.setMargin(0.0);
    faces_.m_vertices.resize(3);
    faces_.m_faces.push_back(make_face(std::array{0, 1, 2}, Vec3::UnitY(), 0.0));
    faces_.m_faces.push_back(make_face(std::array{0, 2, 1}, -Vec3::UnitY(), 0.0));
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

}  // namespace handhold
