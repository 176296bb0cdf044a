#pragma once

#include <algorithm>
#include <map>
#include <set>
#include <utility>

#include <gtest/gtest.h>

#include "engine/geometry/surface_graph.hpp"

// Invariants of every surface graph. Checked by brute force, without the code under test.
namespace handhold::test {

using Edge = std::pair<std::uint32_t, std::uint32_t>;

inline Edge edge_of(const SurfaceGraph& graph, std::uint32_t t, std::size_t side) {
    return {graph.triangles[t][side], graph.triangles[t][(side + 1) % 3]};
}

// Links are mutual and share the edge: t links to n over an edge as often as n links to t.
inline void expect_mutual_links(const SurfaceGraph& graph) {
    using Link = std::tuple<Edge, std::uint32_t, std::uint32_t>;  // edge, from, to
    std::multiset<Link> links;
    for (std::uint32_t t = 0; t < graph.triangles.size(); ++t) {
        for (std::size_t side = 0; side < 3; ++side) {
            const std::uint32_t n = graph.neighbours[t][side];
            if (n != k_no_triangle) {
                ASSERT_LT(n, graph.triangles.size());
                ASSERT_NE(n, t);
                const Edge edge = edge_of(graph, t, side);
                links.insert({std::minmax(edge.first, edge.second), t, n});
            }
        }
    }
    for (const auto& [edge, t, n] : links) {
        ASSERT_EQ(links.count({edge, t, n}), links.count({edge, n, t}))
            << "edge " << edge.first << "-" << edge.second << " of " << t << " and " << n;
    }
}

// No two half-edges of one edge are both left unpaired, and no more pairs run the same way than
// their directions force.
inline void expect_best_pairs(const SurfaceGraph& graph) {
    struct Sides {
        int forward = 0;
        int backward = 0;
        int borders = 0;
        int flipped = 0;  // links of half-edges in the same direction, counted from both
    };
    std::map<Edge, Sides> edges;
    for (std::uint32_t t = 0; t < graph.triangles.size(); ++t) {
        for (std::size_t side = 0; side < 3; ++side) {
            const Edge edge = edge_of(graph, t, side);
            Sides& sides = edges[std::minmax(edge.first, edge.second)];
            (edge.first < edge.second ? sides.forward : sides.backward) += 1;
            const std::uint32_t n = graph.neighbours[t][side];
            sides.borders += n == k_no_triangle ? 1 : 0;
            if (n != k_no_triangle) {
                bool opposed = false;
                for (std::size_t i = 0; i < 3; ++i) {
                    opposed = opposed || (graph.neighbours[n][i] == t &&
                                          edge_of(graph, n, i) == Edge(edge.second, edge.first));
                }
                sides.flipped += opposed ? 0 : 1;
            }
        }
    }
    std::uint32_t borders = 0;
    std::uint32_t non_manifold = 0;
    std::uint32_t flipped = 0;
    for (const auto& [edge, sides] : edges) {
        const int all = sides.forward + sides.backward;
        const int unmatched = std::abs(sides.forward - sides.backward);
        ASSERT_EQ(sides.borders, all % 2);
        ASSERT_EQ(sides.flipped, unmatched - all % 2);
        borders += static_cast<std::uint32_t>(sides.borders);
        non_manifold += all > 2 ? 1U : 0U;
        flipped += static_cast<std::uint32_t>(sides.flipped) / 2;
    }
    EXPECT_EQ(graph.report.border_edges, borders);
    EXPECT_EQ(graph.report.non_manifold_edges, non_manifold);
    EXPECT_EQ(graph.report.flipped_links, flipped);
}

inline void expect_valid_graph(const SurfaceGraph& graph, const Mesh& source) {
    const std::size_t count = graph.triangles.size();
    ASSERT_EQ(graph.neighbours.size(), count);
    ASSERT_EQ(graph.normals.size(), count);
    ASSERT_EQ(graph.source_triangle.size(), count);
    const SurfaceReport& report = graph.report;
    EXPECT_EQ(report.triangles, source.triangles.size());
    EXPECT_EQ(report.kept, count);
    EXPECT_EQ(report.not_finite + report.degenerate + report.duplicate + report.kept,
              report.triangles + report.cut_in);
    std::vector<bool> used(graph.positions.size(), false);
    std::set<std::array<std::uint32_t, 3>> seen;
    for (std::uint32_t t = 0; t < count; ++t) {
        auto triangle = graph.triangles[t];
        const auto& [a, b, c] = triangle;
        ASSERT_TRUE(a != b && b != c && c != a);
        for (const std::uint32_t corner : triangle) {
            ASSERT_LT(corner, graph.positions.size());
            used[corner] = true;
        }
        ASSERT_NEAR(graph.normals[t].norm(), 1.0, 1e-12);
        const Vec3 area = (graph.positions[b] - graph.positions[a])
                              .cross(graph.positions[c] - graph.positions[a]);
        ASSERT_GT(area.dot(graph.normals[t]), 0.0);
        ASSERT_LT(graph.source_triangle[t], source.triangles.size());
        ASSERT_TRUE(t == 0 || graph.source_triangle[t - 1] <= graph.source_triangle[t]);
        std::rotate(triangle.begin(), std::min_element(triangle.begin(), triangle.end()),
                    triangle.end());
        ASSERT_TRUE(seen.insert(triangle).second) << "twice";
    }
    ASSERT_EQ(std::count(used.begin(), used.end(), false), 0);
    for (const Vec3& position : graph.positions) {
        ASSERT_TRUE(is_finite(position));
    }
    expect_mutual_links(graph);
    expect_best_pairs(graph);
}

}  // namespace handhold::test
