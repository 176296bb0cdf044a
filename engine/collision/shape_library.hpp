#pragma once

#include <cstdint>
#include <limits>
#include <memory>
#include <span>
#include <vector>

#include "engine/geometry/convex_hull.hpp"
#include "engine/geometry/mesh.hpp"

namespace handhold {

enum class ShapeKind : std::uint8_t { box, sphere, capsule, cylinder, hull, compound, mesh };

struct ShapeId {
    std::uint32_t index = 0;
    friend auto operator<=>(const ShapeId&, const ShapeId&) = default;
};
// Of what has no shape: nothing touches it.
inline constexpr ShapeId k_no_shape = {std::numeric_limits<std::uint32_t>::max()};

struct PlacedShape;

// A shape in its own frame. A free body's frame is at its centre of mass, along its principal
// axes: see ShapeLibrary::add_centred.
struct Shape {
    ShapeKind kind = ShapeKind::sphere;
    Vec3 half_m = Vec3::Zero();  // box: half extents
    double radius_m = 0.0;       // sphere, capsule, cylinder
    double half_height_m = 0.0;  // capsule, cylinder: half the length along local y, without caps
    std::shared_ptr<const ConvexHull> hull;                 // hull
    std::shared_ptr<const std::vector<PlacedShape>> parts;  // compound: at least one
    std::shared_ptr<const Mesh> mesh;  // mesh: only static and kinematic bodies may have one
    Vec3 scale = Vec3::Ones();         // mesh: along its own axes; applies to all of its positions
};

// A part of a compound.
struct PlacedShape {
    Shape shape;  // convex
    Pose pose;    // in the compound's frame
    double mass_kg = 0.0;
};

// A part of a compound that is to be.
struct CompoundChild {
    ShapeId shape;  // neither mesh nor compound
    Pose pose;      // in the compound's frame
    double mass_kg =
        0.0;  // how much of the whole is here: only the ratios count. 0, for all: by volume
};

// A shape about its centre of mass, and the frame it now has in the old one: a body that stood at
// `pose` stands at pose * frame.
struct CentredShape {
    ShapeId shape;
    Pose frame;
};

// The shapes of a scene: an asset, made once before the first frame and never changed while frames
// run. Ids are given in order from 0. What breaks a rule below throws PreconditionError.
class ShapeLibrary {
  public:
    // Sizes in metres, in [1e-3, 1e4].
    ShapeId add_box(const Vec3& half_m);
    ShapeId add_sphere(double radius_m);
    ShapeId add_capsule(double radius_m, double half_height_m);
    ShapeId add_cylinder(double radius_m, double half_height_m);
    // The convex hull of points that are finite and not in a plane; is_solid. At most
    // k_max_hull_corners corners: convex_hull.hpp says what more points lose.
    ShapeId add_hull(std::span<const Vec3> points);
    ShapeId add_hull(const ConvexHull& hull);
    // 1 to k_max_parts convex shapes that move as one; they may overlap. Masses: all 0 or all > 0.
    ShapeId add_compound(std::span<const CompoundChild> children);
    // A mesh of 1 to 2^21 triangles with indices in range and finite positions, stretched along its
    // axes by factors in [1e-3, 1e3]. Shapes of one mesh share it and its acceleration structure,
    // whatever their scales.
    ShapeId add_mesh(std::shared_ptr<const Mesh> mesh, const Vec3& scale = Vec3::Ones());
    // The same solid with its frame at the centre of mass, along principal axes. A shape that is
    // so already is given back as it is. Not for meshes.
    CentredShape add_centred(ShapeId id);

    const Shape& at(ShapeId id) const;
    std::size_t size() const { return shapes_.size(); }

  private:
    ShapeId add(Shape shape);
    ShapeId add_round(ShapeKind kind, double radius_m, double half_height_m);
    std::vector<Shape> shapes_;
};

constexpr std::size_t k_max_parts = 64;  // of a compound
constexpr std::size_t k_max_triangles = std::size_t{1}
                                        << 21U;  // of a mesh: what its tree can number

// True where add_hull takes it: 1e-3 to 1e4 m at its thinnest and widest.
bool is_solid(const ConvexHull& hull);

// Radius of a sphere about the shape's origin that holds it, metres: the smallest, but of a
// compound with cylinders.
double bounding_radius(const Shape& shape);
// Half the smallest extent, metres: what may pass through a thin wall unnoticed between two frames.
// Of a compound that of its thinnest part. A mesh has none: 0.
double thinnest_half_extent(const Shape& shape);
// Principal moments of inertia of the solid, kg m^2, about the local axes. Of a shape whose frame
// is at its centre of mass, along principal axes (PreconditionError otherwise, and for meshes:
// they have no inside).
Vec3 solid_inertia(const Shape& shape, double mass_kg);

}  // namespace handhold
