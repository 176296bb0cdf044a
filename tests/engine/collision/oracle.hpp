#pragma once

#include "engine/geometry/closest_point.hpp"
#include "tests/engine/collision/scene.hpp"

// Distances of convex shapes by brute force over their features, independent of the library under
// test.
namespace handhold::test {

// A placed convex core: corners, edges as pairs of corner indices, and the radius it is inflated
// by.
struct Core {
    std::vector<Vec3> corners;
    std::vector<std::pair<std::size_t, std::size_t>> edges;
    double radius_m = 0.0;
    Pose pose;
    Vec3 half_m = Vec3::Zero();  // box
    double barrel_m = 0.0;       // cylinder: radius about the line between its two corners; else 0

    Vec3 support(const Vec3& direction) const {
        if (barrel_m > 0.0) {
            const Vec3 along = (corners[1] - corners[0]).normalized();
            const Vec3 out = direction - direction.dot(along) * along;
            const Vec3 end = direction.dot(along) < 0.0 ? corners[0] : corners[1];
            return out.norm() > 1e-9 ? Vec3(end + barrel_m * out.normalized()) : end;
        }
        return *std::max_element(corners.begin(), corners.end(), [&](const Vec3& a, const Vec3& b) {
            return a.dot(direction) < b.dot(direction);
        });
    }
};

inline Core make_core(const Shape& shape, const Pose& pose) {
    const bool grown = shape.kind == ShapeKind::sphere || shape.kind == ShapeKind::capsule;
    Core core{{}, {}, grown ? shape.radius_m : 0.0, pose, shape.half_m, 0.0};
    if (shape.kind == ShapeKind::box) {
        for (unsigned i = 0; i < 8; ++i) {
            const Vec3 side((i & 1U) != 0 ? 1.0 : -1.0, (i & 2U) != 0 ? 1.0 : -1.0,
                            (i & 4U) != 0 ? 1.0 : -1.0);
            core.corners.push_back(transform_point(pose, side.cwiseProduct(shape.half_m)));
            for (const unsigned bit : {1U, 2U, 4U}) {
                if ((i & bit) == 0) {
                    core.edges.emplace_back(i, i | bit);
                }
            }
        }
    } else if (shape.kind == ShapeKind::hull) {
        for (const Vec3& corner : shape.hull->corners) {
            core.corners.push_back(transform_point(pose, corner));
        }
        for (const HullFace& face : shape.hull->faces) {
            for (std::size_t i = 0; i < face.loop.size(); ++i) {
                core.edges.emplace_back(face.loop[i], face.loop[(i + 1) % face.loop.size()]);
            }
        }
    } else {
        core.barrel_m = shape.kind == ShapeKind::cylinder ? shape.radius_m : 0.0;
        const Vec3 end = shape.half_height_m * Vec3::UnitY();
        core.corners = {transform_point(pose, -end), transform_point(pose, end)};
        core.edges = {{0, 1}};
    }
    return core;
}

inline Core make_triangle_core(const Corners& c) {
    return {{c[0], c[1], c[2]}, {{0, 1}, {1, 2}, {2, 0}}, 0.0, {}, Vec3::Zero(), 0.0};
}

// Signed gap between the supporting planes of a and b perpendicular to `direction` (from b towards
// a), radii included.
inline double gap_along(const Core& a, const Core& b, const Vec3& direction) {
    return direction.dot(a.support(-direction) - b.support(direction)) - a.radius_m - b.radius_m;
}

inline bool pierces(const Vec3& from, const Vec3& to, const Corners& corners) {
    const Vec3 area = area_vector(corners);
    const double before = (from - corners[0]).dot(area);
    const double after = (to - corners[0]).dot(area);
    if (before * after >= 0.0) {
        return false;
    }
    const Vec3 through = from + before / (before - after) * (to - from);
    return (closest_on_triangle(through, corners) - through).norm() < 1e-9;
}

struct Gap {
    double distance_m = 1e9;      // between the surfaces; at most -radius if the cores intersect
    Vec3 normal = Vec3::UnitY();  // unit, away from the triangle; undefined if the cores intersect
};

// Gap between a convex shape and a triangle.
inline Gap gap_to_triangle(const Core& core, const Corners& corners) {
    Gap gap;
    const auto offer = [&](const Vec3& on_core, const Vec3& on_triangle) {
        const double distance = (on_core - on_triangle).norm();
        if (distance < gap.distance_m) {
            gap = {distance, (on_core - on_triangle) / std::max(distance, 1e-300)};
        }
    };
    for (const Vec3& corner : core.corners) {
        offer(corner, closest_on_triangle(corner, corners));
    }
    for (const auto& [i, j] : core.edges) {
        for (std::size_t k = 0; k < 3; ++k) {
            const auto [on_core, on_triangle] = closest_between_segments(
                {core.corners[i], core.corners[j]}, {corners[k], corners[(k + 1) % 3]});
            offer(on_core, on_triangle);
        }
        if (pierces(core.corners[i], core.corners[j], corners)) {
            gap.distance_m = 0.0;
        }
    }
    if (core.half_m != Vec3::Zero()) {  // the triangle's corners outside or inside the box
        for (const Vec3& corner : corners) {
            const Vec3 local = inverse_transform_point(core.pose, corner);
            offer(transform_point(core.pose, local.cwiseMax(-core.half_m).cwiseMin(core.half_m)),
                  corner);
        }
        for (std::size_t k = 0; k < 3; ++k) {  // edges through the box: look for a sample inside
            for (int i = 1; i < 64; ++i) {
                const Vec3 point = corners[k] + i / 64.0 * (corners[(k + 1) % 3] - corners[k]);
                if ((inverse_transform_point(core.pose, point).cwiseAbs() - core.half_m)
                        .maxCoeff() < 0.0) {
                    gap.distance_m = 0.0;
                }
            }
        }
    }
    gap.distance_m -= core.radius_m;
    return gap;
}

}  // namespace handhold::test
