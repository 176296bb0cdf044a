#include "engine/collision/shape_library.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "engine/core/check.hpp"

namespace handhold {
namespace {

constexpr double k_min_size_m = 1e-3;
constexpr double k_max_size_m = 1e4;

// Written so that NaN is outside too.
bool is_size(double size_m) { return size_m >= k_min_size_m && size_m <= k_max_size_m; }

// A capsule is a cylinder and the two halves of a sphere. Each half's own moment about its centre
// of mass, 83/320 m r^2, and its offset h + 3/8 r add up to the closed form below.
Vec3 capsule_inertia(double radius_m, double half_height_m, double mass_kg) {
    const double r2 = radius_m * radius_m;
    const double h = half_height_m;
    // Volumes over 2 pi r^2: the common factor cancels in the shares.
    const double sphere_share = (2.0 / 3.0 * radius_m) / (2.0 / 3.0 * radius_m + h);
    const double sphere_kg = mass_kg * sphere_share;
    const double cylinder_kg = mass_kg - sphere_kg;
    const double along = cylinder_kg * r2 / 2.0 + sphere_kg * 0.4 * r2;
    const double across = cylinder_kg * (r2 / 4.0 + h * h / 3.0) +
                          sphere_kg * (0.4 * r2 + h * h + 0.75 * h * radius_m);
    return {across, along, across};
}

}  // namespace

ShapeId ShapeLibrary::add(Shape shape) {
    const ShapeId id{static_cast<std::uint32_t>(shapes_.size())};
    shapes_.push_back(std::move(shape));
    return id;
}

ShapeId ShapeLibrary::add_box(const Vec3& half_m) {
    for (const double half : half_m) {
        HH_CHECK(is_size(half), "half extent outside of [1e-3, 1e4] m", half);
    }
    Shape shape;
    shape.kind = ShapeKind::box;
    shape.half_m = half_m;
    return add(std::move(shape));
}

ShapeId ShapeLibrary::add_sphere(double radius_m) {
    HH_CHECK(is_size(radius_m), "radius outside of [1e-3, 1e4] m", radius_m);
    Shape shape;
    shape.kind = ShapeKind::sphere;
    shape.radius_m = radius_m;
    return add(std::move(shape));
}

ShapeId ShapeLibrary::add_capsule(double radius_m, double half_height_m) {
    HH_CHECK(is_size(radius_m), "radius outside of [1e-3, 1e4] m", radius_m);
    HH_CHECK(is_size(half_height_m), "half height outside of [1e-3, 1e4] m", half_height_m);
    Shape shape;
    shape.kind = ShapeKind::capsule;
    shape.radius_m = radius_m;
    shape.half_height_m = half_height_m;
    return add(std::move(shape));
}

ShapeId ShapeLibrary::add_mesh(std::shared_ptr<const Mesh> mesh) {
    HH_CHECK(mesh != nullptr && !mesh->triangles.empty(), "a mesh without triangles", 0);
    for (std::size_t i = 0; i < mesh->positions.size(); ++i) {
        HH_CHECK(is_finite(mesh->positions[i]), "a position is not finite", i);
    }
    for (std::size_t i = 0; i < mesh->triangles.size(); ++i) {
        for (const std::uint32_t index : mesh->triangles[i]) {
            HH_CHECK(index < mesh->positions.size(), "an index is out of range in triangle", i);
        }
    }
    Shape shape;
    shape.kind = ShapeKind::mesh;
    shape.mesh = std::move(mesh);
    return add(std::move(shape));
}

const Shape& ShapeLibrary::at(ShapeId id) const {
    HH_CHECK(id.index < shapes_.size(), "no shape with this id", id.index);
    return shapes_[id.index];
}

double bounding_radius(const Shape& shape) {
    switch (shape.kind) {
        case ShapeKind::box:
            return shape.half_m.norm();
        case ShapeKind::sphere:
            return shape.radius_m;
        case ShapeKind::capsule:
            return shape.radius_m + shape.half_height_m;
        case ShapeKind::mesh:
            break;
    }
    double squared = 0.0;
    for (const Vec3& position : shape.mesh->positions) {
        squared = std::max(squared, position.squaredNorm());
    }
    return std::sqrt(squared);
}

double thinnest_half_extent(const Shape& shape) {
    switch (shape.kind) {
        case ShapeKind::box:
            return shape.half_m.minCoeff();
        case ShapeKind::sphere:
        case ShapeKind::capsule:
            return shape.radius_m;
        case ShapeKind::mesh:
            break;
    }
    return 0.0;
}

Vec3 solid_inertia(const Shape& shape, double mass_kg) {
    switch (shape.kind) {
        case ShapeKind::box: {
            const Vec3 squared = shape.half_m.cwiseAbs2();
            return mass_kg / 3.0 * (Vec3::Constant(squared.sum()) - squared);
        }
        case ShapeKind::sphere:
            return Vec3::Constant(0.4 * mass_kg * shape.radius_m * shape.radius_m);
        case ShapeKind::capsule:
            return capsule_inertia(shape.radius_m, shape.half_height_m, mass_kg);
        case ShapeKind::mesh:
            break;
    }
    fail_precondition(__func__, "a mesh has no inside", "mesh");
}

}  // namespace handhold
