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
// A collider with this id touches nothing.
inline constexpr ShapeId k_no_shape = {std::numeric_limits<std::uint32_t>::max()};

struct PlacedShape;

// A shape in its own frame. A free body's frame must be at its centre of mass, along principal
// axes: see ShapeLibrary::add_centred.
struct Shape {
    ShapeKind kind = ShapeKind::sphere;
    Vec3 half_m = Vec3::Zero();  // box: half extents
    double radius_m = 0.0;       // sphere, capsule, cylinder
    double half_height_m = 0.0;  // capsule, cylinder: half the length along local y, without caps
    std::shared_ptr<const ConvexHull> hull;                 // hull
    std::shared_ptr<const std::vector<PlacedShape>> parts;  // compound: at least one
    std::shared_ptr<const Mesh> mesh;  // mesh: only static and kinematic bodies may have one
    Vec3 scale = Vec3::Ones();         // mesh: scale along its own axes; negative: mirrored
};

// True if a mesh's scale turns its triangles inside out: their corners are then taken in the
// opposite order.
inline bool is_mirrored(const Vec3& scale) { return scale.prod() < 0.0; }

// A part of a compound.
struct PlacedShape {
    Shape shape;  // convex
    Pose pose;    // pose in the compound's frame
    double mass_kg = 0.0;
};

// Input of add_compound.
struct CompoundChild {
    ShapeId shape;  // neither mesh nor compound
    Pose pose;      // pose in the compound's frame
    // Mass of this part. Only ratios count. If all parts have 0, masses are proportional to
    // volumes.
    double mass_kg = 0.0;
};

// A shape whose frame is at its centre of mass. `frame` is this frame in the shape's old frame: a
// body whose old frame was at `pose` is now at pose * frame.
struct CentredShape {
    ShapeId shape;
    Pose frame;
};

// The shapes of a scene: an asset, immutable while a frame runs. Shapes may come and go between
// frames. Ids count up from 0. Invalid arguments throw PreconditionError.
class ShapeLibrary {
  public:
    // All sizes are in metres, in [1e-3, 1e4].
    ShapeId add_box(const Vec3& half_m);
    ShapeId add_sphere(double radius_m);
    ShapeId add_capsule(double radius_m, double half_height_m);
    ShapeId add_cylinder(double radius_m, double half_height_m);
    // Convex hull of finite points that are not coplanar. Must satisfy is_solid. Reduced to
    // k_max_hull_corners corners; convex_hull.hpp describes the loss.
    ShapeId add_hull(std::span<const Vec3> points);
    ShapeId add_hull(const ConvexHull& hull);
    // 1 to k_max_parts convex shapes that move as one body; they may overlap. Either all masses are
    // 0 or all are > 0.
    ShapeId add_compound(std::span<const CompoundChild> children);
    // A mesh of 1 to 2^21 triangles, with indices in range and finite positions. The size of each
    // scale factor is in [1e-3, 1e3]; negative ones mirror the mesh. All shapes of a mesh share the
    // mesh and its BVH, even at different scales.
    ShapeId add_mesh(std::shared_ptr<const Mesh> mesh, const Vec3& scale = Vec3::Ones());
    // Adds the same solid with its frame at the centre of mass, along principal axes. Returns `id`
    // if the shape is already centred. Not for meshes.
    CentredShape add_centred(ShapeId id);

    // Frees the shape's memory. Precondition: no collider has the shape. Compounds keep their own
    // copies of their parts.
    void remove(ShapeId id);
    // Lets the add functions reuse the ids of removed shapes, last removed first. Call it after a
    // frame has run without them: caches compare colliders by id.
    void recycle_removed();

    // Throws for a removed shape.
    const Shape& at(ShapeId id) const;
    bool has(ShapeId id) const { return id.index < shapes_.size() && !slots_[id.index].removed; }
    // Ids are below this number; some may be removed.
    std::size_t size() const { return shapes_.size(); }

    // Number of changes so far, and the change at which the shape was added or removed: caches
    // rebuild what is newer than they are.
    std::uint64_t revision() const { return revision_; }
    std::uint64_t revision_of(ShapeId id) const { return slots_[id.index].revision; }

  private:
    struct Slot {
        std::uint64_t revision = 0;
        bool removed = false;
    };
    ShapeId add(Shape shape);
    ShapeId add_round(ShapeKind kind, double radius_m, double half_height_m);
    std::vector<Shape> shapes_;
    std::vector<Slot> slots_;             // parallel to shapes_
    std::vector<std::uint32_t> removed_;  // indices of removed shapes that are not reusable yet
    std::vector<std::uint32_t> free_;     // indices of removed shapes that are reusable
    std::uint64_t revision_ = 0;
};

constexpr std::size_t k_max_parts = 64;  // parts of a compound
// Largest number of triangles of a mesh: the limit of the BVH's index.
constexpr std::size_t k_max_triangles = std::size_t{1} << 21U;

// True if add_hull accepts `hull`: its smallest width and its largest extent are in [1e-3, 1e4] m.
bool is_solid(const ConvexHull& hull);

// Radius of a sphere about the shape's origin that contains the shape, metres. It is the smallest
// such sphere, except for compounds with cylinders, where it may be larger.
double bounding_radius(const Shape& shape);
// Half the smallest extent, metres; a compound's is that of its thinnest part. Bodies this thin may
// tunnel. Meshes: 0.
double thinnest_half_extent(const Shape& shape);
// Principal moments of inertia of the solid, kg m^2, about the local axes. Throws PreconditionError
// if the shape is not centred (add_centred) or is a mesh.
Vec3 solid_inertia(const Shape& shape, double mass_kg);

}  // namespace handhold
