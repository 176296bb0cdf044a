#include "engine/geometry/graph_links.hpp"

#include <gtest/gtest.h>

#include "broken_meshes.hpp"
#include "data_meshes.hpp"
#include "graph_claims.hpp"

namespace handhold::graph_links_test {
namespace {

using test::Random;

// Number of triangles of a ball about the origin that face outward.
std::size_t outward(const SurfaceGraph& graph) {
    std::size_t count = 0;
    for (std::size_t t = 0; t < graph.triangles.size(); ++t) {
        count += graph.normals[t].dot(graph.positions[graph.triangles[t][0]]) > 0.0 ? 1U : 0U;
    }
    return count;
}

TEST(OrientConsistently, FlipsSmallerShareOfEachSheet) {
    Random random(830);
    for (const double share : {0.05, 0.3, 0.45, 0.6, 1.0}) {
        const Mesh ball = test::with_holes(test::make_clean_ball(0.2, 20, 30), 0.05, random);
        SurfaceGraph graph = build_surface_graph(test::with_flips(ball, share, random));
        const std::size_t before = outward(graph);
        const std::uint32_t turned = orient_consistently(graph);
        test::expect_valid_graph(graph, ball);
        EXPECT_EQ(graph.report.flipped_links, 0U);
        const std::size_t all = graph.triangles.size();
        if (share < 0.5) {
            // Isolated triangles between holes may differ.
            EXPECT_GT(outward(graph), all * 99 / 100);
            EXPECT_NEAR(turned, static_cast<double>(all - before), 0.01 * static_cast<double>(all));
        } else {
            EXPECT_LT(outward(graph), all / 100);
        }
        EXPECT_EQ(orient_consistently(graph), 0U);
    }
}

TEST(OrientConsistently, MoebiusStripKeepsOneFlippedLink) {
    // A Moebius strip of 40 squares.
    Mesh strip;
    constexpr std::uint32_t k_squares = 40;
    for (std::uint32_t i = 0; i < k_squares; ++i) {
        const double turn = 2.0 * 3.14159265358979 * i / k_squares;
        const Quat around = rotation_about(Vec3::UnitY(), turn);
        const Quat twist = rotation_about(Vec3::UnitZ(), 0.5 * turn);
        for (const double side : {-0.1, 0.1}) {
            strip.positions.push_back(around * Vec3(Vec3::UnitX() + twist * Vec3(0, side, 0)));
        }
    }
    for (std::uint32_t i = 0; i < k_squares; ++i) {
        const bool last = i + 1 == k_squares;
        const std::uint32_t low = last ? 1 : 2 * i + 2;
        const std::uint32_t high = last ? 0 : 2 * i + 3;
        strip.triangles.push_back({2 * i, low, 2 * i + 1});
        strip.triangles.push_back({low, high, 2 * i + 1});
    }
    SurfaceGraph graph = build_surface_graph(strip);
    orient_consistently(graph);
    test::expect_valid_graph(graph, strip);
    EXPECT_EQ(graph.report.flipped_links, 1U);
    EXPECT_EQ(graph.report.border_edges, 2 * k_squares);
    EXPECT_EQ(graph.report.parts, 1U);
}

TEST(OrientOutward, FlipsInsideOutMeshButNotHollow) {
    const Mesh ball = test::make_clean_ball(0.2, 12, 20);
    SurfaceGraph right = build_surface_graph(ball);
    EXPECT_EQ(orient_outward(right), 0U);
    Mesh inside_out = ball;
    for (auto& triangle : inside_out.triangles) {
        std::swap(triangle[1], triangle[2]);
    }
    SurfaceGraph wrong = build_surface_graph(inside_out);
    EXPECT_EQ(orient_outward(wrong), ball.triangles.size());
    EXPECT_EQ(outward(wrong), ball.triangles.size());
    test::expect_valid_graph(wrong, inside_out);
    Mesh hollow = ball;
    const auto first = static_cast<std::uint32_t>(hollow.positions.size());
    for (const Vec3& position : ball.positions) {
        hollow.positions.push_back(0.9 * position);
    }
    for (const auto& [a, b, c] : inside_out.triangles) {
        hollow.triangles.push_back({first + a, first + b, first + c});
    }
    SurfaceGraph shell = build_surface_graph(hollow);
    EXPECT_EQ(orient_outward(shell), 0U);
    EXPECT_EQ(outward(shell), ball.triangles.size());
}

TEST(OrientConsistently, RealMeshesKeepValidGraphs) {
    int meshes = 0;
    for (const auto& path : test::data_files("nasty")) {
        SCOPED_TRACE(path);
        const Mesh mesh = test::load_whole(path);
        SurfaceGraph graph = build_surface_graph(mesh);
        const std::uint32_t flipped = graph.report.flipped_links;
        orient_consistently(graph);
        test::expect_valid_graph(graph, mesh);
        EXPECT_LE(graph.report.flipped_links, flipped);
        ++meshes;
    }
    if (meshes == 0) {
        GTEST_SKIP() << "no mesh data";
    }
}

}  // namespace
}  // namespace handhold::graph_links_test
