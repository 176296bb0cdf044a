#pragma once

#include <algorithm>
#include <optional>
#include <span>

#include "engine/geometry/chain_fit.hpp"
#include "engine/geometry/closest_point.hpp"
#include "tests/engine/collision/scene.hpp"

// Penetration depth of capsules by brute force over all triangles. A point's distance from a
// triangle is convex along a line, so ternary search finds the minimum.
namespace handhold::test {

inline double segment_to_triangle_m(const std::array<Vec3, 2>& segment, const Corners& corners) {
    const auto distance_at = [&](double t) {
        const Vec3 point = segment[0] + t * (segment[1] - segment[0]);
        return (point - closest_on_triangle(point, corners)).norm();
    };
    double low = 0.0;
    double high = 1.0;
    for (int i = 0; i < 100; ++i) {
        const double third = (high - low) / 3.0;
        const bool nearer_low = distance_at(low + third) < distance_at(high - third);
        low += nearer_low ? 0.0 : third;
        high -= nearer_low ? third : 0.0;
    }
    return distance_at(0.5 * (low + high));
}

inline Corners corners_of(const PlacedMesh& placed, std::uint32_t triangle) {
    const SurfaceGraph& graph = placed.mesh->contact;
    const auto& [a, b, c] = graph.triangles[triangle];
    return {transform_point(placed.pose, graph.positions[a]),
            transform_point(placed.pose, graph.positions[b]),
            transform_point(placed.pose, graph.positions[c])};
}

// Negative: penetration depth. Larger gaps than 2 cm are reported as 2 cm.
inline double gap_m(const Capsule& capsule, std::span<const PlacedMesh> meshes) {
    double min_m = capsule.radius_m + 0.02;
    const Vec3 low = capsule.ends[0].cwiseMin(capsule.ends[1]);
    const Vec3 high = capsule.ends[0].cwiseMax(capsule.ends[1]);
    for (const PlacedMesh& placed : meshes) {
        for (std::uint32_t t = 0; t < placed.mesh->contact.triangles.size(); ++t) {
            const Corners corners = corners_of(placed, t);
            const Vec3 box_low = corners[0].cwiseMin(corners[1]).cwiseMin(corners[2]);
            const Vec3 box_high = corners[0].cwiseMax(corners[1]).cwiseMax(corners[2]);
            if ((box_low - high).cwiseMax(low - box_high).maxCoeff() < min_m) {
                min_m = std::min(min_m, segment_to_triangle_m(capsule.ends, corners));
            }
        }
    }
    return min_m - capsule.radius_m;
}

}  // namespace handhold::test
