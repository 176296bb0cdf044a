#include "engine/collision/bounds.hpp"

namespace handhold {
namespace {

Bounds transformed(const Bounds& bounds, const Pose& pose) {
    const Vec3 middle = transform_point(pose, 0.5 * (bounds.low + bounds.high));
    const Vec3 half =
        pose.rotation.toRotationMatrix().cwiseAbs() * (0.5 * (bounds.high - bounds.low));
    return {middle - half, middle + half};
}

}  // namespace

ShapeExtent shape_extent(const Shape& shape) {
    const double radius_m = bounding_radius(shape);
    if (shape.kind == ShapeKind::mesh) {
        Bounds box = bounds_of(shape.mesh->positions.front(), shape.mesh->positions.front());
        for (const Vec3& position : shape.mesh->positions) {
            box = box.joined({position, position});
        }
        return {box, radius_m};
    }
    const Vec3 half =
        shape.kind == ShapeKind::box
            ? shape.half_m
            : Vec3(shape.radius_m, shape.radius_m + shape.half_height_m, shape.radius_m);
    return {{-half, half}, radius_m};
}

Bounds way_bounds(const ShapeExtent& extent, const Pose& from, const Pose& to) {
    // Between the ends a point strays from its chord by at most the sagitta of its arc, reach *
    // angle^2 / 8. Twice that, because a sweep's way is a chord in the other body's frame.
    const double angle_rad = rotation_to_vector(from.rotation.conjugate() * to.rotation).norm();
    const Bounds ends = transformed(extent.box, from).joined(transformed(extent.box, to));
    return ends.grown(extent.radius_m * angle_rad * angle_rad / 4.0 + k_rounding_m);
}

}  // namespace handhold
