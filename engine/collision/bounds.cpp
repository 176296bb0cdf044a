#include "engine/collision/bounds.hpp"

#include <span>

namespace handhold {

Bounds transformed(const Bounds& bounds, const Pose& pose) {
    const Vec3 centre = transform_point(pose, 0.5 * (bounds.low + bounds.high));
    const Vec3 half =
        pose.rotation.toRotationMatrix().cwiseAbs() * (0.5 * (bounds.high - bounds.low));
    return {centre - half, centre + half};
}

namespace {

Bounds bounds_of_points(std::span<const Vec3> points) {
    Bounds box{points.front(), points.front()};
    for (const Vec3& point : points) {
        box = box.joined({point, point});
    }
    return box;
}

Bounds part_box(const PlacedShape& part);

Bounds shape_box(const Shape& shape) {
    switch (shape.kind) {
        case ShapeKind::box:
            return {-shape.half_m, shape.half_m};
        case ShapeKind::cylinder: {
            const Vec3 half(shape.radius_m, shape.half_height_m, shape.radius_m);
            return {-half, half};
        }
        case ShapeKind::hull:
            return bounds_of_points(std::span<const Vec3>(shape.hull->corners));
        case ShapeKind::compound: {
            Bounds box = part_box(shape.parts->front());
            for (const PlacedShape& part : *shape.parts) {
                box = box.joined(part_box(part));
            }
            return box;
        }
        case ShapeKind::mesh: {
            const Bounds box = bounds_of_points(std::span<const Vec3>(shape.mesh->positions));
            return box.scaled(shape.scale);
        }
        default: {
            const Vec3 half(shape.radius_m, shape.radius_m + shape.half_height_m, shape.radius_m);
            return {-half, half};
        }
    }
}

Bounds part_box(const PlacedShape& part) { return transformed(shape_box(part.shape), part.pose); }

}  // namespace

ShapeExtent shape_extent(const Shape& shape) { return {shape_box(shape), bounding_radius(shape)}; }

ShapeExtent part_extent(const PlacedShape& part) {
    return {part_box(part), part.pose.position.norm() + bounding_radius(part.shape)};
}

Bounds swept_bounds(const ShapeExtent& extent, const Pose& from, const Pose& to) {
    const Bounds end = transformed(extent.box, to);
    if (from.position == to.position && from.rotation.coeffs() == to.rotation.coeffs()) {
        return end.grown(k_rounding_m);
    }
    // A point that moves along an arc of radius R and angle phi stays within R phi^2 / 8 (the
    // sagitta) of the chord. The box grows by twice the sagitta, because a sweep interpolates in
    // the other body's frame, where the point moves along another arc. phi <= pi sin(phi / 2).
    const double square = (from.rotation.conjugate() * to.rotation).vec().squaredNorm();
    const double sagitta_m = extent.radius_m * k_pi * k_pi * square / 8.0;
    return transformed(extent.box, from).joined(end).grown(2.0 * sagitta_m + k_rounding_m);
}

}  // namespace handhold
