#include "engine/geometry/shape_library.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "engine/core/check.hpp"
#include "engine/geometry/mass_properties.hpp"

namespace handhold {
namespace {

constexpr double k_min_size_m = 1e-3;
constexpr double k_max_size_m = 1e4;

// False for NaN too.
bool is_size(double size_m) { return size_m >= k_min_size_m && size_m <= k_max_size_m; }

constexpr double k_min_scale = 1e-3;
constexpr double k_max_scale = 1e3;

bool is_scale(double factor) {
    return std::abs(factor) >= k_min_scale && std::abs(factor) <= k_max_scale;
}

// The dimensions of capsules and cylinders.
void check_round(const char* caller, double radius_m, double half_height_m) {
    const auto check = [caller](const char* what, double size_m) {
        if (!is_size(size_m)) {
            fail_precondition(caller, what, number_text(size_m));
        }
    };
    check("radius outside of [1e-3, 1e4] m", radius_m);
    check("half_height_m outside of [1e-3, 1e4] m", half_height_m);
}

// Radius about the compound's origin that contains the part.
double farthest_m(const PlacedShape& part) {
    const Vec3& centre = part.pose.position;
    const Shape& shape = part.shape;
    switch (shape.kind) {
        case ShapeKind::box: {
            const Vec3 local = part.pose.rotation.conjugate() * centre;
            return (local.cwiseAbs() + shape.half_m).norm();
        }
        case ShapeKind::hull: {
            double farthest = 0.0;
            for (const Vec3& corner : shape.hull->corners) {
                farthest = std::max(farthest, transform_point(part.pose, corner).norm());
            }
            return farthest;
        }
        case ShapeKind::capsule: {
            const Vec3 half = part.pose.rotation * (shape.half_height_m * Vec3::UnitY());
            return std::max((centre + half).norm(), (centre - half).norm()) + shape.radius_m;
        }
        default:
            return centre.norm() + bounding_radius(shape);
    }
}

// True if the shape's frame is at its centre of mass along principal axes. The tolerance allows for
// rounding and for the digits of numbers in files.
bool is_centred(const MassProperties& properties, double reach_m) {
    constexpr double k_rounding = 1e-6;
    const Mat3& inertia = properties.inertia_per_kg_m2;
    const Mat3 diagonal = inertia.diagonal().asDiagonal();
    return properties.centre_m.norm() <= k_rounding * reach_m &&
           (inertia - diagonal).cwiseAbs().maxCoeff() <= k_rounding * inertia.trace();
}

}  // namespace

ShapeId ShapeLibrary::add(Shape shape) {
    ++revision_;
    if (!free_.empty()) {
        const ShapeId id{free_.back()};
        free_.pop_back();
        shapes_[id.index] = std::move(shape);
        slots_[id.index] = {revision_, false};
        return id;
    }
    const ShapeId id{static_cast<std::uint32_t>(shapes_.size())};
    shapes_.push_back(std::move(shape));
    slots_.push_back({revision_, false});
    return id;
}

void ShapeLibrary::remove(ShapeId id) {
    HH_CHECK(has(id), "no shape with this id", id.index);
    shapes_[id.index] = {};
    slots_[id.index] = {++revision_, true};
    removed_.push_back(id.index);
}

void ShapeLibrary::recycle_removed() {
    free_.insert(free_.end(), removed_.begin(), removed_.end());
    removed_.clear();
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

ShapeId ShapeLibrary::add_round(ShapeKind kind, double radius_m, double half_height_m) {
    Shape shape;
    shape.kind = kind;
    shape.radius_m = radius_m;
    shape.half_height_m = half_height_m;
    return add(std::move(shape));
}

ShapeId ShapeLibrary::add_capsule(double radius_m, double half_height_m) {
    check_round(__func__, radius_m, half_height_m);
    return add_round(ShapeKind::capsule, radius_m, half_height_m);
}

ShapeId ShapeLibrary::add_cylinder(double radius_m, double half_height_m) {
    check_round(__func__, radius_m, half_height_m);
    return add_round(ShapeKind::cylinder, radius_m, half_height_m);
}

ShapeId ShapeLibrary::add_hull(std::span<const Vec3> points) {
    const std::optional<ConvexHull> hull = make_convex_hull(points);
    HH_CHECK(hull.has_value(), "the points have no volume; their number", points.size());
    return add_hull(*hull);
}

ShapeId ShapeLibrary::add_hull(const ConvexHull& hull) {
    HH_CHECK(is_solid(hull), "hull's width outside of [1e-3, 1e4] m", hull.width_m);
    Shape shape;
    shape.kind = ShapeKind::hull;
    shape.hull = std::make_shared<const ConvexHull>(hull);
    return add(std::move(shape));
}

ShapeId ShapeLibrary::add_compound(std::span<const CompoundChild> children) {
    HH_CHECK(!children.empty() && children.size() <= k_max_parts, "a compound has 1 to 64 parts",
             children.size());
    std::vector<PlacedShape> parts;
    for (const CompoundChild& child : children) {
        const ShapeKind kind = at(child.shape).kind;
        HH_CHECK(kind != ShapeKind::mesh && kind != ShapeKind::compound,
                 "a part of a compound must be convex, shape", child.shape.index);
        HH_CHECK(is_valid(child.pose), "a part's pose is not valid, part", parts.size());
        HH_CHECK(child.mass_kg >= 0.0 && (child.mass_kg > 0.0) == (children[0].mass_kg > 0.0),
                 "masses of parts must be all 0 or all above", child.mass_kg);
        parts.push_back({at(child.shape), child.pose, child.mass_kg});
    }
    Shape shape;
    shape.kind = ShapeKind::compound;
    shape.parts = std::make_shared<const std::vector<PlacedShape>>(std::move(parts));
    return add(std::move(shape));
}

ShapeId ShapeLibrary::add_mesh(std::shared_ptr<const Mesh> mesh, const Vec3& scale) {
    HH_CHECK(mesh != nullptr && !mesh->triangles.empty(), "a mesh without triangles", 0);
    HH_CHECK(mesh->triangles.size() <= k_max_triangles, "more than 2^21 triangles",
             mesh->triangles.size());
    for (const double factor : scale) {
        HH_CHECK(is_scale(factor), "a scale whose size is outside of [1e-3, 1e3]", factor);
    }
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
    shape.scale = scale;
    return add(std::move(shape));
}

CentredShape ShapeLibrary::add_centred(ShapeId id) {
    const MassProperties properties = mass_properties(at(id));
    if (is_centred(properties, bounding_radius(at(id)))) {
        return {id, {}};
    }
    const Pose frame = principal_frame(properties);
    const Pose to_frame = inverse(frame);
    Shape shape = at(id);
    if (shape.kind == ShapeKind::hull) {
        shape.hull = std::make_shared<const ConvexHull>(moved_hull(*shape.hull, to_frame));
    } else {
        std::vector<PlacedShape> parts = *shape.parts;
        for (PlacedShape& part : parts) {
            part.pose = to_frame * part.pose;
        }
        shape.parts = std::make_shared<const std::vector<PlacedShape>>(std::move(parts));
    }
    return {add(std::move(shape)), frame};
}

const Shape& ShapeLibrary::at(ShapeId id) const {
    HH_CHECK(has(id), "no shape with this id", id.index);
    return shapes_[id.index];
}

bool is_solid(const ConvexHull& hull) {
    Vec3 low = hull.corners.front();
    Vec3 high = low;
    for (const Vec3& corner : hull.corners) {
        low = low.cwiseMin(corner);
        high = high.cwiseMax(corner);
    }
    return is_size(hull.width_m) && is_size((high - low).maxCoeff());
}

double bounding_radius(const Shape& shape) {
    double radius_m = 0.0;
    switch (shape.kind) {
        case ShapeKind::box:
            return shape.half_m.norm();
        case ShapeKind::sphere:
            return shape.radius_m;
        case ShapeKind::capsule:
            return shape.radius_m + shape.half_height_m;
        case ShapeKind::cylinder:
            return Vec3(shape.radius_m, shape.half_height_m, 0.0).norm();
        case ShapeKind::hull:
            for (const Vec3& corner : shape.hull->corners) {
                radius_m = std::max(radius_m, corner.norm());
            }
            return radius_m;
        case ShapeKind::compound:
            for (const PlacedShape& part : *shape.parts) {
                radius_m = std::max(radius_m, farthest_m(part));
            }
            return radius_m;
        case ShapeKind::mesh:
            break;
    }
    for (const Vec3& position : shape.mesh->positions) {
        radius_m = std::max(radius_m, position.cwiseProduct(shape.scale).norm());
    }
    return radius_m;
}

double thinnest_half_extent(const Shape& shape) {
    double thinnest_m = std::numeric_limits<double>::infinity();
    switch (shape.kind) {
        case ShapeKind::box:
            return shape.half_m.minCoeff();
        case ShapeKind::sphere:
        case ShapeKind::capsule:
            return shape.radius_m;
        case ShapeKind::cylinder:
            return std::min(shape.radius_m, shape.half_height_m);
        case ShapeKind::hull:
            return 0.5 * shape.hull->width_m;
        case ShapeKind::compound:
            for (const PlacedShape& part : *shape.parts) {
                thinnest_m = std::min(thinnest_m, thinnest_half_extent(part.shape));
            }
            return thinnest_m;
        case ShapeKind::mesh:
            break;
    }
    return 0.0;
}

Vec3 solid_inertia(const Shape& shape, double mass_kg) {
    const MassProperties properties = mass_properties(shape);
    HH_CHECK(is_centred(properties, bounding_radius(shape)),
             "the shape's frame must be at its centre of mass, along principal axes: add_centred",
             properties.centre_m.norm());
    return mass_kg * properties.inertia_per_kg_m2.diagonal();
}

}  // namespace handhold
