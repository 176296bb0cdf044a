#pragma once

#include <array>
#include <memory>
#include <span>
#include <vector>

#include <BulletCollision/CollisionShapes/btConvexPolyhedron.h>
#include <BulletCollision/CollisionShapes/btConvexShape.h>
#include <BulletCollision/CollisionShapes/btTriangleShape.h>

#include "engine/collision/bounds.hpp"
#include "engine/collision/bullet_vector.hpp"
#include "engine/geometry/closest_point.hpp"
#include "engine/geometry/shape_library.hpp"

// Convex shapes in Bullet's representation. All values of one call are in "near space" (suffix
// _ns): b's axes with the origin at a's position. Precision therefore does not depend on the
// distance from the world's origin. Between calls only allocated memory is kept.
namespace handhold {

// The curved side of a cylinder.
struct Barrel {
    double radius_m = 0.0;
    double half_height_m = 0.0;  // half length along local y
};

// A placed convex shape: a core (point, segment, triangle, polyhedron or cylinder) inflated by
// radius_m.
struct Convex {
    const btConvexShape* shape = nullptr;  // shape whose Bullet margin equals radius_m
    // Null for spheres and capsules. The faces of a cylinder are its two ends only.
    const btConvexPolyhedron* faces = nullptr;
    // `faces` with the side planes moved outwards by a nanometre, for clipping.
    const btConvexPolyhedron* prisms = nullptr;
    btTransform pose_ns = btTransform::getIdentity();
    double radius_m = 0.0;
    const Corners* corners_ns = nullptr;  // triangle: its corners; null otherwise
    const Barrel* barrel = nullptr;       // cylinder: its curved side; null otherwise
    const Vec3* box_half_m = nullptr;     // box: its half extents; null otherwise

    Vec3 centre_ns() const { return from_bullet(pose_ns.getOrigin()); }  // a point inside the core
    // Support point of the core: its farthest point along `direction`.
    Vec3 support(const Vec3& direction) const;
    Vec3 face_normal(int face) const;
    // Index of the face whose normal is nearest to `direction`. Requires `faces`.
    int facing(const Vec3& direction) const;
    // The local y axis, a unit vector.
    Vec3 axis() const { return from_bullet(pose_ns.getBasis().getColumn(1)); }
    // Round cores only: the core's farthest points along `direction`, as a segment. Sphere: the
    // centre twice. Capsule: the whole core. Cylinder: the line on its curved side that is farthest
    // along `direction`. Undefined for other shapes.
    std::array<Vec3, 2> side_line(const Vec3& direction) const;
};

// A convex shape, prepared once for many poses. The origin of its frame lies inside it.
class ConvexShape {
  public:
    // `shape` is neither a mesh nor a compound; a hull must contain its origin.
    explicit ConvexShape(const Shape& shape);
    Convex at(const Pose& pose_ns) const;
    // Spheres only. Does not allocate.
    void set_sphere_radius(double radius_m);
    // Distance from the centre to the core's farthest point.
    double core_reach_m() const { return core_reach_m_; }
    double thinnest_half_m() const { return thinnest_half_m_; }
    double bounding_radius_m() const { return core_reach_m_ + radius_m_; }

  private:
    std::unique_ptr<btConvexShape> shape_;
    btConvexPolyhedron faces_;
    btConvexPolyhedron prisms_;
    Barrel barrel_;
    Vec3 box_half_m_ = Vec3::Zero();
    double radius_m_ = 0.0;
    double core_reach_m_ = 0.0;
    double thinnest_half_m_ = 0.0;
};

// A convex shape placed in a body: a part of a compound, or the whole body.
class ConvexPart {
  public:
    ConvexPart(const Shape& shape, const Pose& pose_bs);
    Convex at(const Pose& body_ns) const { return shape_.at(placed(body_ns)); }
    Pose placed(const Pose& body) const { return centred_ ? body : body * pose_bs_; }
    const ConvexShape& shape() const { return shape_; }
    // Spheres only. Does not allocate.
    void set_sphere_radius(double radius_m);
    // Upper bound of the distance between the body's origin and any point of the core: the lever
    // arm of the body's rotation.
    double arm_m() const { return pose_bs_.position.norm() + shape_.core_reach_m(); }
    // Extent in the body's frame; the radius is about the body's origin.
    const ShapeExtent& extent() const { return extent_; }

  private:
    ConvexShape shape_;
    Pose pose_bs_;
    bool centred_ = true;  // pose_bs_ is the identity
    ShapeExtent extent_;
};

// The parts of a compound, or one part for another convex shape. Not for meshes.
std::vector<ConvexPart> make_parts(const Shape& shape);

// Reuses one Bullet shape for many triangles. The returned Convex is valid until the next place().
class TriangleShape {
  public:
    TriangleShape();
    Convex place(const Corners& corners_ns, const Vec3& unit_normal);

  private:
    btTriangleShape shape_;
    btConvexPolyhedron faces_;
    Corners corners_ns_;
};

}  // namespace handhold
