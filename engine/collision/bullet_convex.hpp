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
#include "engine/collision/closest_point.hpp"
#include "engine/collision/shape_library.hpp"

// Convex shapes as Bullet knows them. All values of one call share one space ("near space", suffix
// _ns): b's axes about a's place, so that figures are as good far from the origin as at it. Nothing
// outlives a call but memory.
namespace handhold {

// The curved side of a cylinder.
struct Barrel {
    double radius_m = 0.0;
    double half_height_m = 0.0;  // along local y
};

// A shape at a place: a core (point, segment, triangle, polyhedron or cylinder) grown by a radius.
struct Convex {
    const btConvexShape* shape = nullptr;        // its margin is radius_m
    const btConvexPolyhedron* faces = nullptr;   // null: sphere, capsule; of a cylinder its ends
    const btConvexPolyhedron* prisms = nullptr;  // faces with their side planes a nanometre out
    btTransform pose_ns = btTransform::getIdentity();
    double radius_m = 0.0;
    const Corners* corners_ns = nullptr;  // of a triangle; null otherwise
    const Barrel* barrel = nullptr;       // of a cylinder; null otherwise

    Vec3 centre_ns() const { return from_bullet(pose_ns.getOrigin()); }  // inside
    // The core's point farthest along a direction.
    Vec3 support(const Vec3& direction) const;
    Vec3 face_normal(int face) const;
    // The face that looks most along a direction. Not of spheres and capsules.
    int facing(const Vec3& direction) const;
    // Along local y, unit.
    Vec3 axis() const { return from_bullet(pose_ns.getBasis().getColumn(1)); }
    // Of a sphere twice its centre, of a capsule the ends of its core, of a cylinder those of the
    // line on its side that lies farthest along a direction. Of nothing else.
    std::array<Vec3, 2> side_line(const Vec3& direction) const;
};

// A shape with one convex core, made once. Its own frame is inside of it.
class ConvexShape {
  public:
    // Neither a mesh nor a compound; a hull's corners must lie about the origin.
    explicit ConvexShape(const Shape& shape);
    Convex at(const Pose& pose_ns) const;
    // Of a sphere only: the same shape at another size, without an allocation.
    void set_sphere_radius(double radius_m);
    double core_reach_m() const { return core_reach_m_; }  // from the centre to the core's corners
    double thinnest_half_m() const { return thinnest_half_m_; }
    double bounding_radius_m() const { return core_reach_m_ + radius_m_; }

  private:
    std::unique_ptr<btConvexShape> shape_;
    btConvexPolyhedron faces_;
    btConvexPolyhedron prisms_;
    Barrel barrel_;
    double radius_m_ = 0.0;
    double core_reach_m_ = 0.0;
    double thinnest_half_m_ = 0.0;
};

// A convex shape where it sits in a body: a compound's part, or the whole.
class ConvexPart {
  public:
    ConvexPart(const Shape& shape, const Pose& pose_bs);
    Convex at(const Pose& body_ns) const { return shape_.at(placed(body_ns)); }
    Pose placed(const Pose& body) const { return centred_ ? body : body * pose_bs_; }
    const ConvexShape& shape() const { return shape_; }
    // Of a sphere only: the same shape at another size, without an allocation.
    void set_sphere_radius(double radius_m);
    // From the body's place to the core's corners: the arm that the body's turning has.
    double arm_m() const { return pose_bs_.position.norm() + shape_.core_reach_m(); }
    // In the body's frame, about the body's place.
    const ShapeExtent& extent() const { return extent_; }

  private:
    ConvexShape shape_;
    Pose pose_bs_;
    bool centred_ = true;  // pose_bs_ is the identity
    ShapeExtent extent_;
};

// All parts of a shape: one, or those of a compound. Not for meshes.
std::vector<ConvexPart> make_parts(const Shape& shape);

// One triangle after another in the same memory; a Convex of it is good until the next is placed.
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
