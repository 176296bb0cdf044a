#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "engine/geometry/mesh.hpp"

namespace handhold {

enum class ShapeKind : std::uint8_t { box, sphere, capsule, mesh };

struct ShapeId {
    std::uint32_t index = 0;
    friend auto operator<=>(const ShapeId&, const ShapeId&) = default;
};

// A shape in its own frame, centred where its body's centre of mass is.
struct Shape {
    ShapeKind kind = ShapeKind::sphere;
    Vec3 half_m = Vec3::Zero();  // box: half extents
    double radius_m = 0.0;       // sphere, capsule
    double half_height_m = 0.0;  // capsule: half the length of its axis (local y), without the caps
    std::shared_ptr<const Mesh> mesh;  // mesh: only static and kinematic bodies may have one
};

// The shapes of a scene: an asset, made once before the first frame and never changed while frames
// run. Ids are given in order from 0.
class ShapeLibrary {
  public:
    // Sizes in metres, in [1e-3, 1e4]; throws PreconditionError outside of it.
    ShapeId add_box(const Vec3& half_m);
    ShapeId add_sphere(double radius_m);
    ShapeId add_capsule(double radius_m, double half_height_m);
    // Throws PreconditionError for no triangles, an index out of range or a position that is not
    // finite.
    ShapeId add_mesh(std::shared_ptr<const Mesh> mesh);

    const Shape& at(ShapeId id) const;
    std::size_t size() const { return shapes_.size(); }

  private:
    ShapeId add(Shape shape);
    std::vector<Shape> shapes_;
};

// Radius of the smallest sphere about the shape's origin that holds it, metres.
double bounding_radius(const Shape& shape);
// Half the smallest extent, metres: what may pass through a thin wall unnoticed between two frames.
// A mesh has none: 0.
double thinnest_half_extent(const Shape& shape);
// Principal moments of inertia of the solid of uniform density, kg m^2, about the local axes. Not
// for meshes (PreconditionError): they have no inside.
Vec3 solid_inertia(const Shape& shape, double mass_kg);

}  // namespace handhold
