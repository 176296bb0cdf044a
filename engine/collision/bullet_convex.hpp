#pragma once

#include <array>
#include <memory>
#include <vector>

#include <BulletCollision/CollisionShapes/btConvexPolyhedron.h>
#include <BulletCollision/CollisionShapes/btConvexShape.h>
#include <BulletCollision/CollisionShapes/btTriangleShape.h>
#include <LinearMath/btTransform.h>

#include "engine/collision/closest_point.hpp"
#include "engine/collision/contact_outline.hpp"
#include "engine/collision/shape_library.hpp"

// Convex shapes as Bullet knows them, their distance (GJK, EPA) and the points where they hold each
// other (face clipping). All values of one call share one space ("near space", suffix _ns): b's
// axes about a's place, so that figures are as good far from the origin as at it. Nothing outlives
// a call but memory.
namespace handhold {

inline btVector3 to_bullet(const Vec3& v) { return {v.x(), v.y(), v.z()}; }
inline Vec3 from_bullet(const btVector3& v) { return {v.x(), v.y(), v.z()}; }
btTransform to_bullet(const Pose& pose);

// A shape at a place: a core (point, segment, triangle or box) grown by a radius.
struct Convex {
    const btConvexShape* shape = nullptr;        // its margin is radius_m
    const btConvexPolyhedron* faces = nullptr;   // null: sphere, capsule
    const btConvexPolyhedron* prisms = nullptr;  // faces with their side planes a nanometre out
    btTransform pose_ns = btTransform::getIdentity();
    double radius_m = 0.0;
    const Corners* corners_ns = nullptr;  // of a triangle; null otherwise

    Vec3 centre_ns() const { return from_bullet(pose_ns.getOrigin()); }
    // The core's point farthest along a direction.
    Vec3 support(const Vec3& direction) const;
};

// A box, sphere or capsule, made once a shape.
class ConvexShape {
  public:
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
    double radius_m_ = 0.0;
    double core_reach_m_ = 0.0;
    double thinnest_half_m_ = 0.0;
};

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

// How far two cores are apart, radii left out.
struct CoreSeparation {
    Vec3 normal = Vec3::UnitY();  // unit, from b towards a: along the shortest way between the
                                  // cores, or out of b where they overlap
    double separation_m =
        0.0;  // negative: the least way along which a core must move to be free of the other
    Vec3 point_a_ns = Vec3::Zero();  // a pair of points of the cores that are this far apart
    Vec3 point_b_ns = Vec3::Zero();
    bool overlap = false;
};
CoreSeparation separate(const Convex& a, const Convex& b);

// Memory that is reused; its content means nothing between calls.
struct ClipScratch {
    btAlignedObjectArray<btVector3> polygon;
    btAlignedObjectArray<btVector3> clipped;
};

// Appends the contacts of a pair along its separation's normal that are nearer than `margin_m`. At
// least the nearest point, if that is near enough.
void add_manifold(const Convex& a, const Convex& b, const CoreSeparation& separation,
                  double margin_m, ClipScratch& scratch, std::vector<NearContact>& contacts);

// Appends the contacts of a with the plane of triangle b, where a's points lie over (or, sunk,
// under) the triangle. The normal is given: the triangle's own on the side that counts as outside.
// Depth is measured to that side, however deep a is sunk.
void add_face_manifold(const Convex& a, const Convex& b, const Vec3& normal, double margin_m,
                       ClipScratch& scratch, std::vector<NearContact>& contacts);

}  // namespace handhold
