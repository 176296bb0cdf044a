#include "engine/collision/shape_query.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace handhold {
namespace {

constexpr double k_edge = 1e-12;  // share of a triangle or extent by which its edges are widened

struct Ray {
    Vec3 from;
    Vec3 way;

    Vec3 at(double fraction) const { return from + fraction * way; }
};

struct FirstHit {
    double fraction = std::numeric_limits<double>::infinity();
    Vec3 normal = Vec3::UnitY();

    void offer(double candidate, const Vec3& unit_normal) {
        if (candidate >= 0.0 && candidate <= 1.0 && candidate < fraction) {
            fraction = candidate;
            normal = unit_normal;
        }
    }
    std::optional<LocalRayHit> result() const {
        return fraction <= 1.0 ? std::optional(LocalRayHit{fraction, normal}) : std::nullopt;
    }
};

void offer_box(const Ray& ray, const Vec3& half, FirstHit& hit) {
    for (Eigen::Index axis = 0; axis < 3; ++axis) {
        if (ray.way[axis] == 0.0) {
            continue;
        }
        for (const double side : {-1.0, 1.0}) {
            const double fraction = (side * half[axis] - ray.from[axis]) / ray.way[axis];
            Vec3 beyond = ray.at(fraction).cwiseAbs() - half;
            beyond[axis] = 0.0;
            if (beyond.maxCoeff() <= k_edge * half.maxCoeff()) {
                hit.offer(fraction, side * Vec3::Unit(axis));
            }
        }
    }
}

// Roots of a f^2 + 2 b f + c = 0 in rising order, without cancellation.
std::optional<std::pair<double, double>> roots(double a, double b, double c) {
    const double discriminant = b * b - a * c;
    if (!(a > 0.0) || discriminant < 0.0) {
        return std::nullopt;
    }
    const double q = -(b + std::copysign(std::sqrt(discriminant), b));
    const double first = q / a;
    const double second = q != 0.0 ? c / q : first;
    return std::pair(std::min(first, second), std::max(first, second));
}

// `cap`: 0 for a whole sphere, +1 or -1 for the half of it beyond the end of a capsule's axis.
void offer_sphere(const Ray& ray, const Vec3& centre, double radius, double cap, FirstHit& hit) {
    const Vec3 offset = ray.from - centre;
    const auto both =
        roots(ray.way.squaredNorm(), offset.dot(ray.way), offset.squaredNorm() - radius * radius);
    if (!both) {
        return;
    }
    for (const double fraction : {both->first, both->second}) {
        const Vec3 outward = ray.at(fraction) - centre;
        if (outward.y() * cap >= 0.0) {
            hit.offer(fraction, outward.normalized());
        }
    }
}

void offer_cylinder(const Ray& ray, double radius, double half_height, FirstHit& hit) {
    const Vec3 flat(1.0, 0.0, 1.0);
    const Vec3 way = ray.way.cwiseProduct(flat);
    const Vec3 from = ray.from.cwiseProduct(flat);
    const auto both = roots(way.squaredNorm(), from.dot(way), from.squaredNorm() - radius * radius);
    if (!both) {
        return;
    }
    for (const double fraction : {both->first, both->second}) {
        const Vec3 point = ray.at(fraction);
        if (std::abs(point.y()) <= half_height) {
            hit.offer(fraction, point.cwiseProduct(flat).normalized());
        }
    }
}

LocalSurfacePoint closest_on_box(const Vec3& half, const Vec3& point) {
    const Vec3 clamped = point.cwiseMax(-half).cwiseMin(half);
    const Vec3 offset = point - clamped;
    const double distance = offset.norm();
    if (distance > 0.0) {
        return {clamped, offset / distance, distance};
    }
    Eigen::Index axis = 0;
    (half - point.cwiseAbs()).minCoeff(&axis);
    const double side = point[axis] < 0.0 ? -1.0 : 1.0;
    Vec3 surface = point;
    surface[axis] = side * half[axis];
    return {surface, side * Vec3::Unit(axis), 0.0};
}

}  // namespace

std::optional<LocalRayHit> cast_ray_on_shape(const Shape& shape, const Vec3& from, const Vec3& to) {
    const Ray ray{from, to - from};
    FirstHit hit;
    switch (shape.kind) {
        case ShapeKind::box:
            offer_box(ray, shape.half_m, hit);
            break;
        case ShapeKind::sphere:
            offer_sphere(ray, Vec3::Zero(), shape.radius_m, 0.0, hit);
            break;
        case ShapeKind::capsule: {
            const Vec3 end = shape.half_height_m * Vec3::UnitY();
            offer_cylinder(ray, shape.radius_m, shape.half_height_m, hit);
            offer_sphere(ray, end, shape.radius_m, 1.0, hit);
            offer_sphere(ray, -end, shape.radius_m, -1.0, hit);
            break;
        }
        case ShapeKind::mesh:
            break;
    }
    return hit.result();
}

LocalSurfacePoint closest_on_shape(const Shape& shape, const Vec3& point) {
    if (shape.kind == ShapeKind::box) {
        return closest_on_box(shape.half_m, point);
    }
    const Vec3 axis_point(0.0, std::clamp(point.y(), -shape.half_height_m, shape.half_height_m),
                          0.0);
    const Vec3 offset = point - axis_point;
    const double distance = offset.norm();
    // On the axis every way out is as short.
    const Vec3 outward = distance > 0.0 ? Vec3(offset / distance) : Vec3(Vec3::UnitX());
    return {axis_point + shape.radius_m * outward, outward,
            std::max(0.0, distance - shape.radius_m)};
}

LocalSurfacePoint closest_on_triangle_surface(const Corners& corners, const Vec3& point) {
    constexpr double k_on_surface_m = 1e-9;  // nearer than this the way to the point is rounding
    const Vec3 surface = closest_on_triangle(point, corners);
    const Vec3 way = point - surface;
    const double distance = way.norm();
    if (distance > k_on_surface_m) {
        return {surface, way / distance, distance};
    }
    const Vec3 area = area_vector(corners);
    return {surface, area.isZero(0.0) ? Vec3(Vec3::UnitY()) : area.normalized(), distance};
}

}  // namespace handhold
