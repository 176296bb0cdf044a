#include "engine/collision/shape_query.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <tuple>
#include <utility>

namespace handhold {
namespace {

// Faces are extended past their edges by this relative tolerance, so that no ray slips between
// them.
constexpr double k_edge_tolerance = 1e-12;

struct Ray {
    Vec3 from;
    Vec3 along;

    Vec3 at(double fraction) const { return from + fraction * along; }
};

// The interval in which a ray's line is inside a convex shape. Built by offering it all
// intersections with the surface.
struct Passage {
    double enter = std::numeric_limits<double>::infinity();  // fraction of the ray
    double leave = -std::numeric_limits<double>::infinity();
    Vec3 enter_normal = Vec3::UnitY();
    Vec3 leave_normal = Vec3::UnitY();

    bool any() const { return enter <= leave; }
    void offer(double fraction, const Vec3& unit_normal) {
        if (fraction < enter) {
            enter = fraction;
            enter_normal = unit_normal;
        }
        if (fraction > leave) {
            leave = fraction;
            leave_normal = unit_normal;
        }
    }
    std::optional<LocalRayHit> first() const {
        if (enter >= 0.0 && enter <= 1.0) {
            return LocalRayHit{enter, enter_normal};
        }
        return enter < 0.0 && leave >= 0.0 && leave <= 1.0
                   ? std::optional(LocalRayHit{leave, leave_normal})
                   : std::nullopt;
    }
};

void offer_box(const Ray& ray, const Vec3& half, Passage& passage) {
    for (Eigen::Index axis = 0; axis < 3; ++axis) {
        if (ray.along[axis] == 0.0) {
            continue;
        }
        for (const double side : {-1.0, 1.0}) {
            const double fraction = (side * half[axis] - ray.from[axis]) / ray.along[axis];
            Vec3 beyond = ray.at(fraction).cwiseAbs() - half;
            beyond[axis] = 0.0;
            if (beyond.maxCoeff() <= k_edge_tolerance * half.maxCoeff()) {
                passage.offer(fraction, side * Vec3::Unit(axis));
            }
        }
    }
}

// Roots of a f^2 + 2 b f + c = 0 in ascending order, without cancellation.
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

// `cap`: 0 for the whole sphere; +1 or -1 for the half beyond that end of a capsule's axis.
void offer_sphere(const Ray& ray, const Vec3& centre, double radius, double cap, Passage& passage) {
    const Vec3 offset = ray.from - centre;
    const auto hits = roots(ray.along.squaredNorm(), offset.dot(ray.along),
                            offset.squaredNorm() - radius * radius);
    if (!hits) {
        return;
    }
    for (const double fraction : {hits->first, hits->second}) {
        const Vec3 outward = ray.at(fraction) - centre;
        if (outward.y() * cap >= 0.0) {
            passage.offer(fraction, outward.normalized());
        }
    }
}

void offer_barrel(const Ray& ray, double radius, double half_height, Passage& passage) {
    const Vec3 flat(1.0, 0.0, 1.0);
    const Vec3 along = ray.along.cwiseProduct(flat);
    const Vec3 from = ray.from.cwiseProduct(flat);
    const auto hits =
        roots(along.squaredNorm(), from.dot(along), from.squaredNorm() - radius * radius);
    if (!hits) {
        return;
    }
    for (const double fraction : {hits->first, hits->second}) {
        const Vec3 point = ray.at(fraction);
        if (std::abs(point.y()) <= half_height) {
            passage.offer(fraction, point.cwiseProduct(flat).normalized());
        }
    }
}

void offer_caps(const Ray& ray, double radius, double half_height, Passage& passage) {
    if (ray.along.y() == 0.0) {
        return;
    }
    for (const double side : {-1.0, 1.0}) {
        const double fraction = (side * half_height - ray.from.y()) / ray.along.y();
        const Vec3 point = ray.at(fraction);
        const double reach = radius * (1.0 + k_edge_tolerance);
        if (point.x() * point.x() + point.z() * point.z() <= reach * reach) {
            passage.offer(fraction, side * Vec3::UnitY());
        }
    }
}

// Clips the line against all face planes.
Passage clip_to_hull(const Ray& ray, const ConvexHull& hull) {
    Passage inside;
    std::swap(inside.enter, inside.leave);
    for (const HullFace& face : hull.faces) {
        const double height = face.normal.dot(ray.from) - face.offset_m;
        const double rise = face.normal.dot(ray.along);
        if (rise == 0.0) {
            if (height > k_edge_tolerance) {
                return {};
            }
        } else if (const double fraction = -height / rise; rise < 0.0 && fraction > inside.enter) {
            inside.enter = fraction;
            inside.enter_normal = face.normal;
        } else if (rise > 0.0 && fraction < inside.leave) {
            inside.leave = fraction;
            inside.leave_normal = face.normal;
        }
    }
    return inside.any() ? inside : Passage{};
}

// The passage through a convex shape.
Passage find_passage(const Shape& shape, const Ray& ray) {
    Passage passage;
    switch (shape.kind) {
        case ShapeKind::box:
            offer_box(ray, shape.half_m, passage);
            break;
        case ShapeKind::sphere:
            offer_sphere(ray, Vec3::Zero(), shape.radius_m, 0.0, passage);
            break;
        case ShapeKind::capsule: {
            const Vec3 end = shape.half_height_m * Vec3::UnitY();
            offer_barrel(ray, shape.radius_m, shape.half_height_m, passage);
            offer_sphere(ray, end, shape.radius_m, 1.0, passage);
            offer_sphere(ray, -end, shape.radius_m, -1.0, passage);
            break;
        }
        case ShapeKind::cylinder:
            offer_barrel(ray, shape.radius_m, shape.half_height_m, passage);
            offer_caps(ray, shape.radius_m, shape.half_height_m, passage);
            break;
        case ShapeKind::hull:
            return clip_to_hull(ray, *shape.hull);
        case ShapeKind::compound:
        case ShapeKind::mesh:
            break;
    }
    return passage;
}

Passage find_passage(const PlacedShape& part, const Ray& ray) {
    const Quat back = part.pose.rotation.conjugate();
    Passage passage =
        find_passage(part.shape, {inverse_transform_point(part.pose, ray.from), back * ray.along});
    passage.enter_normal = part.pose.rotation * passage.enter_normal;
    passage.leave_normal = part.pose.rotation * passage.leave_normal;
    return passage;
}

// First surface of the union of the parts. For a ray that starts inside: the point at which it
// leaves the union. The exit moves on while another part contains it.
std::optional<LocalRayHit> cast_on_parts(std::span<const PlacedShape> parts, const Ray& ray) {
    constexpr double k_seam = 1e-12;  // relative gap between parts that count as touching
    std::optional<LocalRayHit> first;
    std::optional<LocalRayHit> exit;
    double inside_until = 0.0;
    for (bool extended = true; extended;) {
        extended = false;
        for (const PlacedShape& part : parts) {
            const Passage passage = find_passage(part, ray);
            const double begins = passage.enter;
            if (begins >= 0.0 && begins <= 1.0 && (!first || begins < first->fraction)) {
                first = LocalRayHit{begins, passage.enter_normal};
            }
            const bool continues = exit ? begins <= inside_until + k_seam : begins < 0.0;
            if (continues && passage.leave > inside_until) {
                inside_until = passage.leave;
                exit = LocalRayHit{passage.leave, passage.leave_normal};
                extended = true;
            }
        }
    }
    if (exit) {
        return inside_until <= 1.0 ? exit : std::nullopt;
    }
    return first;
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

LocalSurfacePoint closest_on_round(const Shape& shape, const Vec3& point) {
    const Vec3 axis_point(0.0, std::clamp(point.y(), -shape.half_height_m, shape.half_height_m),
                          0.0);
    const Vec3 offset = point - axis_point;
    const double distance = offset.norm();
    // On the axis every direction is equally near.
    const Vec3 outward = distance > 0.0 ? Vec3(offset / distance) : Vec3(Vec3::UnitX());
    return {axis_point + shape.radius_m * outward, outward,
            std::max(0.0, distance - shape.radius_m)};
}

LocalSurfacePoint closest_on_cylinder(double radius, double half_height, const Vec3& point) {
    const Vec3 flat(point.x(), 0.0, point.z());
    const double from_axis = flat.norm();
    const Vec3 outward = from_axis > 0.0 ? Vec3(flat / from_axis) : Vec3(Vec3::UnitX());
    const double side = point.y() < 0.0 ? -1.0 : 1.0;
    const double beyond_barrel = from_axis - radius;
    const double beyond_cap = std::abs(point.y()) - half_height;
    if (beyond_barrel <= 0.0 && beyond_cap <= 0.0) {
        if (beyond_barrel > beyond_cap) {
            return {radius * outward + point.y() * Vec3::UnitY(), outward, 0.0};
        }
        return {flat + side * half_height * Vec3::UnitY(), side * Vec3::UnitY(), 0.0};
    }
    const Vec3 surface = std::min(from_axis, radius) * outward +
                         std::clamp(point.y(), -half_height, half_height) * Vec3::UnitY();
    const Vec3 along = point - surface;
    return {surface, along.normalized(), along.norm()};
}

LocalSurfacePoint closest_on_hull(const ConvexHull& hull, const Vec3& point) {
    const HullFace* nearest = &hull.faces.front();
    double highest = -std::numeric_limits<double>::infinity();
    for (const HullFace& face : hull.faces) {
        if (const double height = face.normal.dot(point) - face.offset_m; height > highest) {
            highest = height;
            nearest = &face;
        }
    }
    if (highest <= 0.0) {
        return {point - highest * nearest->normal, nearest->normal, 0.0};
    }
    Vec3 best = hull.corners.front();
    for (const HullFace& face : hull.faces) {
        if (face.normal.dot(point) < face.offset_m) {
            continue;  // back faces are skipped: the nearest point is on a front face
        }
        for (std::size_t i = 1; i + 1 < face.loop.size(); ++i) {
            const Vec3 candidate =
                closest_on_triangle(point, {hull.corners[face.loop[0]], hull.corners[face.loop[i]],
                                            hull.corners[face.loop[i + 1]]});
            if ((candidate - point).squaredNorm() < (best - point).squaredNorm()) {
                best = candidate;
            }
        }
    }
    const Vec3 along = point - best;
    const double distance = along.norm();
    return {best, distance > 0.0 ? Vec3(along / distance) : nearest->normal, distance};
}

LocalSurfacePoint closest_on_part(const PlacedShape& part, const Vec3& point) {
    LocalSurfacePoint near =
        closest_on_shape(part.shape, inverse_transform_point(part.pose, point));
    near.point = transform_point(part.pose, near.point);
    near.normal = part.pose.rotation * near.normal;
    return near;
}

// True if the point is strictly inside the part.
bool is_inside(const PlacedShape& part, const Vec3& point) {
    constexpr double k_on_surface_m = 1e-9;
    const LocalSurfacePoint near = closest_on_part(part, point);
    return near.distance_m == 0.0 && (near.point - point).norm() > k_on_surface_m;
}

// If no part contains the point: the nearest surface point. Else: the nearest exit from one of
// these parts that is not inside another part.
LocalSurfacePoint closest_on_parts(std::span<const PlacedShape> parts, const Vec3& point) {
    using Rank = std::tuple<bool, bool, double>;  // compared lexicographically, the lowest wins
    constexpr double k_far = std::numeric_limits<double>::infinity();
    Rank lowest(true, true, k_far);
    LocalSurfacePoint best;
    for (const PlacedShape& part : parts) {
        const LocalSurfacePoint near = closest_on_part(part, point);
        const bool outside = near.distance_m > 0.0;
        const bool hidden =
            !outside && std::any_of(parts.begin(), parts.end(), [&](const PlacedShape& other) {
                return &other != &part && is_inside(other, near.point);
            });
        if (const Rank rank(outside, hidden, (near.point - point).norm()); rank < lowest) {
            lowest = rank;
            best = near;
        }
    }
    return best;
}

}  // namespace

std::optional<LocalRayHit> cast_ray_on_shape(const Shape& shape, const Vec3& from, const Vec3& to) {
    const Ray ray{from, to - from};
    return shape.kind == ShapeKind::compound ? cast_on_parts(*shape.parts, ray)
                                             : find_passage(shape, ray).first();
}

LocalSurfacePoint closest_on_shape(const Shape& shape, const Vec3& point) {
    switch (shape.kind) {
        case ShapeKind::box:
            return closest_on_box(shape.half_m, point);
        case ShapeKind::cylinder:
            return closest_on_cylinder(shape.radius_m, shape.half_height_m, point);
        case ShapeKind::hull:
            return closest_on_hull(*shape.hull, point);
        case ShapeKind::compound:
            return closest_on_parts(*shape.parts, point);
        default:
            return closest_on_round(shape, point);
    }
}

LocalSurfacePoint closest_on_triangle_surface(const Corners& corners, const Vec3& point) {
    // Smaller distances count as 0, because the direction to the point is then rounding noise.
    constexpr double k_on_surface_m = 1e-9;
    const Vec3 surface = closest_on_triangle(point, corners);
    const Vec3 along = point - surface;
    const double distance = along.norm();
    if (distance > k_on_surface_m) {
        return {surface, along / distance, distance};
    }
    const Vec3 area = area_vector(corners);
    return {surface, area.isZero(0.0) ? Vec3(Vec3::UnitY()) : area.normalized(), distance};
}

}  // namespace handhold
