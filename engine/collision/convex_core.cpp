// Sources: separating axes after Gottschalk, Lin and Manocha 1996; distance of disjoint polytopes
// as the least over all pairs of features (vertex and face, edge and edge). The cores have at most
// 8 vertices and 12 edges: comparing all pairs costs a few microseconds, ends always and is exact,
// where iterating on a simplex (GJK, EPA) stops at a tolerance.
#include "engine/collision/convex_core.hpp"

#include <algorithm>
#include <cmath>

namespace handhold {
namespace {

// Nearer than this the way between two points is rounding: the normal comes from the features
// instead.
constexpr double k_touch_m = 1e-7;
// An axis across two edges must beat a face's by this, so that rounding never turns a resting
// face's normal.
constexpr double k_edge_bias_m = 1e-7;

constexpr std::array<std::array<std::uint8_t, 2>, 12> k_box_edges = {{{0, 1},
                                                                      {2, 3},
                                                                      {4, 5},
                                                                      {6, 7},
                                                                      {0, 2},
                                                                      {1, 3},
                                                                      {4, 6},
                                                                      {5, 7},
                                                                      {0, 4},
                                                                      {1, 5},
                                                                      {2, 6},
                                                                      {3, 7}}};
constexpr std::array<std::array<std::uint8_t, 2>, 3> k_triangle_edges = {{{0, 1}, {1, 2}, {2, 0}}};
constexpr std::array<std::array<std::uint8_t, 2>, 1> k_segment_edges = {{{0, 1}}};

struct Interval {
    double low = 0.0;
    double high = 0.0;
};

Interval project(const ConvexCore& core, const Vec3& axis) {
    if (core.kind == CoreKind::box) {
        const double middle = core.centre_ns.dot(axis);
        const double reach = (core.axes.transpose() * axis).cwiseAbs().dot(core.half_m);
        return {middle - reach, middle + reach};
    }
    Interval interval{core.vertices_ns[0].dot(axis), core.vertices_ns[0].dot(axis)};
    for (const Vec3& vertex : core.vertices()) {
        const double s = vertex.dot(axis);
        interval = {std::min(interval.low, s), std::max(interval.high, s)};
    }
    return interval;
}

// Directions, up to three, of a core's faces and edges.
struct Directions {
    std::array<Vec3, 3> values;
    std::size_t count = 0;
};

Directions face_directions(const ConvexCore& core) {
    switch (core.kind) {
        case CoreKind::box:
            return {{core.axes.col(0), core.axes.col(1), core.axes.col(2)}, 3};
        case CoreKind::triangle:
            return {{core.axes.col(0), Vec3::Zero(), Vec3::Zero()}, 1};
        default:
            return {};
    }
}

Directions edge_directions(const ConvexCore& core) {
    const auto& v = core.vertices_ns;
    switch (core.kind) {
        case CoreKind::box:
            return face_directions(core);
        case CoreKind::triangle:
            return {{(v[1] - v[0]).normalized(), (v[2] - v[1]).normalized(),
                     (v[0] - v[2]).normalized()},
                    3};
        case CoreKind::segment:
            return {{core.axes.col(0), Vec3::Zero(), Vec3::Zero()}, 1};
        default:
            return {};
    }
}

enum class AxisSource : std::uint8_t { none, face_of_a, face_of_b, edges };

struct Axis {
    Vec3 normal = Vec3::UnitY();  // from b towards a
    double separation_m = -std::numeric_limits<double>::infinity();
    AxisSource source = AxisSource::none;
};

void try_axis(const ConvexCore& a, const ConvexCore& b, const Vec3& axis, AxisSource source,
              Axis& best) {
    const Interval on_a = project(a, axis);
    const Interval on_b = project(b, axis);
    const double bias = source == AxisSource::edges ? k_edge_bias_m : 0.0;
    const double forward = on_a.low - on_b.high;
    const double backward = on_b.low - on_a.high;
    if (std::max(forward, backward) > best.separation_m + bias) {
        best = forward >= backward ? Axis{axis, forward, source} : Axis{-axis, backward, source};
    }
}

Axis find_axis(const ConvexCore& a, const ConvexCore& b) {
    Axis best;
    const Directions faces_b = face_directions(b);
    for (std::size_t i = 0; i < faces_b.count; ++i) {
        try_axis(a, b, faces_b.values[i], AxisSource::face_of_b, best);
    }
    const Directions faces_a = face_directions(a);
    for (std::size_t i = 0; i < faces_a.count; ++i) {
        try_axis(a, b, faces_a.values[i], AxisSource::face_of_a, best);
    }
    const Directions edges_a = edge_directions(a);
    const Directions edges_b = edge_directions(b);
    for (std::size_t i = 0; i < edges_a.count; ++i) {
        for (std::size_t j = 0; j < edges_b.count; ++j) {
            const Vec3 across = edges_a.values[i].cross(edges_b.values[j]);
            const double sine = across.norm();
            if (sine > 1e-5) {  // parallel edges span no axis that the faces lack
                try_axis(a, b, across / sine, AxisSource::edges, best);
            }
        }
    }
    return best;
}

struct ClosestPair {
    Vec3 a = Vec3::Zero();
    Vec3 b = Vec3::Zero();
    double squared = std::numeric_limits<double>::infinity();

    void offer(const Vec3& on_a, const Vec3& on_b) {
        const double distance = (on_a - on_b).squaredNorm();
        if (distance < squared) {
            *this = {on_a, on_b, distance};
        }
    }
};

void offer_edges(const ConvexCore& a, const ConvexCore& b, ClosestPair& best) {
    for (const auto& edge_a : core_edges(a.kind)) {
        const std::array<Vec3, 2> segment_a{a.vertices_ns[edge_a[0]], a.vertices_ns[edge_a[1]]};
        for (const auto& edge_b : core_edges(b.kind)) {
            const auto [on_a, on_b] = closest_between_segments(
                segment_a, {b.vertices_ns[edge_b[0]], b.vertices_ns[edge_b[1]]});
            best.offer(on_a, on_b);
        }
    }
}

ClosestPair closest_features(const ConvexCore& a, const ConvexCore& b) {
    ClosestPair best;
    for (const Vec3& vertex : a.vertices()) {
        best.offer(vertex, closest_on_core(vertex, b));
    }
    for (const Vec3& vertex : b.vertices()) {
        best.offer(closest_on_core(vertex, a), vertex);
    }
    offer_edges(a, b, best);
    return best;
}

bool pierces(const ConvexCore& segment, const ConvexCore& triangle) {
    const Vec3 normal = triangle.axes.col(0);
    const Vec3& from = segment.vertices_ns[0];
    const Vec3& to = segment.vertices_ns[1];
    const double before = (from - triangle.vertices_ns[0]).dot(normal);
    const double after = (to - triangle.vertices_ns[0]).dot(normal);
    if (before * after >= 0.0) {
        return false;
    }
    const Vec3 through = from + before / (before - after) * (to - from);
    return (closest_on_core(through, triangle) - through).norm() < k_touch_m;
}

bool cores_overlap(const ConvexCore& a, const ConvexCore& b, const Axis& axis) {
    if (a.kind == CoreKind::box || b.kind == CoreKind::box) {
        return axis.separation_m <= 0.0;  // the axes are complete where one core has a volume
    }
    if (a.kind == CoreKind::segment && b.kind == CoreKind::triangle) {
        return pierces(a, b);
    }
    return a.kind == CoreKind::triangle && b.kind == CoreKind::segment && pierces(b, a);
}

// Cores that meet and span no axis: collinear capsules, concentric spheres. Any way out is as good;
// this one is always the same.
Vec3 any_way_out(const ConvexCore& a, const ConvexCore& b) {
    const ConvexCore& core = a.kind == CoreKind::segment ? a : b;
    if (core.kind != CoreKind::segment) {
        return Vec3::UnitY();
    }
    return core.axes.col(0).unitOrthogonal();
}

// Where the outermost edges of two overlapping cores pass each other: the pair of points of an axis
// across two edges.
ClosestPair outermost_edges(const ConvexCore& a, const ConvexCore& b, const Vec3& normal) {
    constexpr double k_flat_m = 1e-6;
    const double lowest = project(a, normal).low + k_flat_m;
    const double highest = project(b, normal).high - k_flat_m;
    ClosestPair best;
    for (const auto& edge_a : core_edges(a.kind)) {
        const std::array<Vec3, 2> segment_a{a.vertices_ns[edge_a[0]], a.vertices_ns[edge_a[1]]};
        if (segment_a[0].dot(normal) > lowest || segment_a[1].dot(normal) > lowest) {
            continue;
        }
        for (const auto& edge_b : core_edges(b.kind)) {
            const std::array<Vec3, 2> segment_b{b.vertices_ns[edge_b[0]], b.vertices_ns[edge_b[1]]};
            if (segment_b[0].dot(normal) >= highest && segment_b[1].dot(normal) >= highest) {
                const auto [on_a, on_b] = closest_between_segments(segment_a, segment_b);
                best.offer(on_a, on_b);
            }
        }
    }
    return best;
}

CoreSeparation from_axis(const ConvexCore& a, const ConvexCore& b, const Axis& axis) {
    CoreSeparation result;
    result.overlap = true;
    if (axis.source == AxisSource::none) {
        result.normal = any_way_out(a, b);
        result.point_a_ns = result.point_b_ns = closest_features(a, b).a;
        return result;
    }
    result.normal = axis.normal;
    result.separation_m = axis.separation_m;
    if (axis.source == AxisSource::face_of_a) {
        result.point_b_ns = support_vertex(b, axis.normal);
        result.point_a_ns = result.point_b_ns + axis.separation_m * axis.normal;
    } else {
        result.point_a_ns = axis.source == AxisSource::edges ? outermost_edges(a, b, axis.normal).a
                                                             : support_vertex(a, -axis.normal);
        result.point_b_ns = result.point_a_ns - axis.separation_m * axis.normal;
    }
    return result;
}

}  // namespace

std::span<const std::array<std::uint8_t, 2>> core_edges(CoreKind kind) {
    switch (kind) {
        case CoreKind::box:
            return k_box_edges;
        case CoreKind::triangle:
            return k_triangle_edges;
        case CoreKind::segment:
            return k_segment_edges;
        case CoreKind::point:
            break;
    }
    return {};
}

ConvexCore make_core(const Shape& shape, const Pose& pose_ns) {
    ConvexCore core;
    core.centre_ns = pose_ns.position;
    core.vertices_ns[0] = pose_ns.position;
    if (shape.kind == ShapeKind::box) {
        core.kind = CoreKind::box;
        core.axes = pose_ns.rotation.toRotationMatrix();
        core.half_m = shape.half_m;
        core.vertex_count = 8;
        for (std::size_t i = 0; i < 8; ++i) {
            const Vec3 side((i & 1U) != 0 ? 1.0 : -1.0, (i & 2U) != 0 ? 1.0 : -1.0,
                            (i & 4U) != 0 ? 1.0 : -1.0);
            core.vertices_ns[i] = core.centre_ns + core.axes * side.cwiseProduct(shape.half_m);
        }
        return core;
    }
    core.radius_m = shape.radius_m;
    if (shape.kind == ShapeKind::capsule) {
        core.kind = CoreKind::segment;
        core.axes.col(0) = pose_ns.rotation * Vec3::UnitY();
        core.vertex_count = 2;
        core.vertices_ns[0] = core.centre_ns - shape.half_height_m * core.axes.col(0);
        core.vertices_ns[1] = core.centre_ns + shape.half_height_m * core.axes.col(0);
    }
    return core;
}

ConvexCore make_triangle_core(const Corners& corners_ns, const Vec3& unit_normal) {
    ConvexCore core;
    core.kind = CoreKind::triangle;
    core.vertex_count = 3;
    core.vertices_ns[0] = corners_ns[0];
    core.vertices_ns[1] = corners_ns[1];
    core.vertices_ns[2] = corners_ns[2];
    core.centre_ns = (corners_ns[0] + corners_ns[1] + corners_ns[2]) / 3.0;
    core.axes.col(0) = unit_normal;
    return core;
}

Vec3 support_vertex(const ConvexCore& core, const Vec3& direction) {
    Vec3 best = core.vertices_ns[0];
    for (const Vec3& vertex : core.vertices()) {
        if (vertex.dot(direction) > best.dot(direction)) {
            best = vertex;
        }
    }
    return best;
}

Vec3 closest_on_core(const Vec3& point, const ConvexCore& core) {
    const auto& v = core.vertices_ns;
    switch (core.kind) {
        case CoreKind::point:
            break;
        case CoreKind::segment:
            return closest_on_segment(point, v[0], v[1]);
        case CoreKind::triangle:
            return closest_on_triangle(point, {v[0], v[1], v[2]});
        case CoreKind::box: {
            const Vec3 local = core.axes.transpose() * (point - core.centre_ns);
            return core.centre_ns + core.axes * local.cwiseMax(-core.half_m).cwiseMin(core.half_m);
        }
    }
    return v[0];
}

std::optional<CoreSeparation> separate_cores(const ConvexCore& a, const ConvexCore& b,
                                             double limit_m) {
    const Axis axis = find_axis(a, b);
    if (axis.separation_m > limit_m) {
        return std::nullopt;
    }
    if (cores_overlap(a, b, axis)) {
        return from_axis(a, b, axis);
    }
    const ClosestPair closest = closest_features(a, b);
    const double distance = std::sqrt(closest.squared);
    if (distance < k_touch_m) {
        return from_axis(a, b, axis);
    }
    return CoreSeparation{(closest.a - closest.b) / distance, distance, closest.a, closest.b,
                          false};
}

}  // namespace handhold
