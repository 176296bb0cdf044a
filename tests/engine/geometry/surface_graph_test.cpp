#include "engine/geometry/surface_graph.hpp"

#include <limits>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "broken_meshes.hpp"
#include "data_meshes.hpp"
#include "engine/geometry/graph_links.hpp"
#include "graph_claims.hpp"

namespace handhold::surface_graph_test {
namespace {

using test::expect_valid_graph;
using test::Random;

void expect_closed(const SurfaceGraph& graph) {
    EXPECT_EQ(graph.report.border_edges, 0U);
    EXPECT_EQ(graph.report.non_manifold_edges, 0U);
    EXPECT_EQ(graph.report.flipped_links, 0U);
    EXPECT_EQ(graph.report.parts, 1U);
}

TEST(SurfaceGraph, SoupGivesGraphOfWholeMesh) {
    Random random(810);
    // The ball's seam and poles have duplicate points and degenerate triangles.
    const auto ball = test::make_wavy_ball(0.5, 20, 30);
    const Mesh soup = test::as_soup(*ball, 1e-6, random);
    const SurfaceGraph graph = build_surface_graph(soup);
    expect_valid_graph(graph, soup);
    expect_closed(graph);
    EXPECT_EQ(graph.positions.size(), 19U * 30U + 2U);
    EXPECT_EQ(graph.triangles.size(), 2U * 19U * 30U);
    EXPECT_EQ(graph.report.degenerate, 2U * 30U);
}

TEST(SurfaceGraph, MergesJitteredSoupButKeepsFineDetail) {
    Random random(811);
    const auto ball = test::make_wavy_ball(0.1, 20, 30);
    // The poles' degenerate triangles are jittered too.
    const SurfaceGraph graph = build_surface_graph(test::as_soup(*ball, 3e-5, random));
    expect_closed(graph);
    EXPECT_EQ(graph.positions.size(), 19U * 30U + 2U);
    // The same ball scaled to 2 mm: its edges are as short as the seam tolerance, but its points
    // must not merge.
    Mesh small = *ball;
    for (Vec3& position : small.positions) {
        position *= 0.02;
    }
    const SurfaceGraph fine = build_surface_graph(small);
    expect_closed(fine);
    EXPECT_EQ(fine.positions.size(), 19U * 30U + 2U);
}

TEST(SurfaceGraph, LinksOuterSidesOfSolidsThatTouchAtEdge) {
    // Two boxes share the edge x = y = 0, with four triangles on it. Triangles that bound the same
    // open wedge are linked, so links join faces of different boxes.
    const auto box = test::make_box_mesh({0.5, 0.5, 0.5});
    Mesh two;
    for (const double side : {0.5, -0.5}) {
        const auto first = static_cast<std::uint32_t>(two.positions.size());
        for (const Vec3& position : box->positions) {
            two.positions.push_back(position + Vec3(side, side, 0.0));
        }
        for (const auto& [a, b, c] : box->triangles) {
            two.triangles.push_back({first + a, first + b, first + c});
        }
    }
    const SurfaceGraph graph = build_surface_graph(two);
    expect_valid_graph(graph, two);
    EXPECT_EQ(graph.report.non_manifold_edges, 1U);
    EXPECT_EQ(graph.report.border_edges, 0U);
    EXPECT_EQ(graph.report.parts, 1U);
    int across = 0;
    for (std::uint32_t t = 0; t < 12; ++t) {
        for (std::size_t i = 0; i < 3; ++i) {
            const std::uint32_t n = graph.neighbours[t][i];
            if (n >= 12) {
                ++across;
                // Both face into the same quadrant.
                const Vec3 middle = graph.normals[t] + graph.normals[n];
                EXPECT_NEAR(middle.norm(), std::sqrt(2.0), 1e-12);
                EXPECT_LT(middle.x() * middle.y(), 0.0);  // neither box is in that quadrant
            }
        }
    }
    EXPECT_EQ(across, 2);
}

TEST(SurfaceGraph, LinksSidesOfDoubledSheetOnlyAtRim) {
    const auto floor = test::make_floor(1.0, 4);
    Mesh sheet = *floor;
    for (const auto& [a, b, c] : floor->triangles) {
        sheet.triangles.push_back({a, c, b});
    }
    const SurfaceGraph graph = build_surface_graph(sheet);
    expect_valid_graph(graph, sheet);
    EXPECT_EQ(graph.report.duplicate, 0U);
    EXPECT_EQ(graph.report.border_edges, 0U);
    EXPECT_EQ(graph.report.flipped_links, 0U);
    int around_rim = 0;
    for (std::uint32_t t = 0; t < graph.triangles.size(); ++t) {
        for (const std::uint32_t n : graph.neighbours[t]) {
            around_rim += graph.normals[t].dot(graph.normals[n]) < 0.0 ? 1 : 0;
        }
    }
    EXPECT_EQ(around_rim, 2 * 16);
}

TEST(SurfaceGraph, LinksNeighboursOfMixedWinding) {
    const auto floor = test::make_floor(1.0, 6, test::Winding::mixed);
    const SurfaceGraph graph = build_surface_graph(*floor);
    expect_valid_graph(graph, *floor);
    EXPECT_EQ(graph.report.border_edges, 24U);
    EXPECT_EQ(graph.report.parts, 1U);
}

TEST(SurfaceGraph, DropsInvalidAndDuplicateTriangles) {
    constexpr double k_nan = std::numeric_limits<double>::quiet_NaN();
    constexpr double k_infinity = std::numeric_limits<double>::infinity();
    Mesh mesh;
    mesh.positions = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0},         {0, 1, 0},
                      {1, 0, 0}, {2, 0, 0}, {k_nan, 0.0, 0.0}, {0.0, -k_infinity, 0.0}};
    mesh.triangles = {{0, 1, 2},
                      {0, 2, 3},
                      {2, 0, 1} /* again */,
                      {0, 2, 1} /* its other side */,
                      {1, 4, 2} /* one point twice */,
                      {0, 1, 5} /* on a line */,
                      {0, 1, 6},
                      {7, 1, 2},
                      {3, 0, 2} /* again */};
    const SurfaceGraph graph = build_surface_graph(mesh);
    expect_valid_graph(graph, mesh);
    EXPECT_EQ(graph.source_triangle, (std::vector<std::uint32_t>{0, 1, 3}));
    EXPECT_EQ(graph.report.not_finite, 2U);
    EXPECT_EQ(graph.report.degenerate, 2U);
    EXPECT_EQ(graph.report.duplicate, 2U);
    EXPECT_EQ(graph.positions.size(), 4U);
}

TEST(SurfaceGraph, SplitsTrianglesAtTJunctions) {
    Random random(812);
    const Mesh ball = test::make_clean_ball(0.3, 20, 30);
    const Mesh broken = test::with_t_junctions(ball, 0.3, random);
    const std::size_t split = broken.triangles.size() - ball.triangles.size();
    ASSERT_GT(split, 100U);
    const SurfaceGraph graph = build_surface_graph(broken);
    expect_valid_graph(graph, broken);
    expect_closed(graph);
    EXPECT_EQ(graph.report.cut_in, split);  // one split per T-junction, in the neighbour
    const auto area = [](const auto& positions, const auto& triangles) {
        double sum = 0.0;
        for (const auto& [a, b, c] : triangles) {
            sum += (positions[b] - positions[a]).cross(positions[c] - positions[a]).norm();
        }
        return sum;
    };
    EXPECT_NEAR(area(graph.positions, graph.triangles), area(ball.positions, ball.triangles), 1e-9);
}

TEST(SurfaceGraph, KeepsSeparateBordersApart) {
    // Two adjacent floors with different grids and a gap of 0.4 mm.
    Mesh two = *test::make_floor(0.5, 4);
    const auto other = test::make_floor(0.5, 7);
    const auto first = static_cast<std::uint32_t>(two.positions.size());
    for (const Vec3& position : other->positions) {
        two.positions.push_back(position + Vec3(0.5004, 0.0, 0.0));
    }
    for (const auto& [a, b, c] : other->triangles) {
        two.triangles.push_back({first + a, first + b, first + c});
    }
    EXPECT_EQ(build_surface_graph(two).report.parts, 2U);
    for (std::size_t v = first; v < two.positions.size(); ++v) {
        two.positions[v].x() -= 0.0003;
    }
    const SurfaceGraph sewn = build_surface_graph(two);
    expect_valid_graph(sewn, two);
    EXPECT_EQ(sewn.report.parts, 1U);
    // The borders of 4 and 7 edges became one linked border of 10 edges; the outer borders remain.
    EXPECT_EQ(sewn.report.border_edges, 3U * 4U + 3U * 7U);
}

TEST(SurfaceGraph, EmptyMeshGivesEmptyGraph) {
    const SurfaceGraph graph = build_surface_graph(Mesh{});
    EXPECT_TRUE(graph.triangles.empty());
    EXPECT_EQ(graph.report.parts, 0U);
}

TEST(SurfaceGraph, RejectsIndicesOutOfRange) {
    Mesh mesh;
    mesh.positions = {{0, 0, 0}};
    mesh.triangles = {{0, 0, 1}};
    EXPECT_THROW(build_surface_graph(mesh), PreconditionError);
}

TEST(SurfaceGraph, ValidForEveryRealMesh) {
    int meshes = 0;
    for (const char* folder : {"objects", "nasty", "level"}) {
        for (const auto& path : test::data_files(folder)) {
            SCOPED_TRACE(path);
            const Mesh mesh = test::load_whole(path);
            expect_valid_graph(build_surface_graph(mesh), mesh);
            meshes += mesh.triangles.empty() ? 0 : 1;
        }
    }
    if (meshes == 0) {
        GTEST_SKIP() << "no mesh data";
    }
}

// Few distinct points, so that corners, edges and whole triangles coincide by chance in any
// winding.
Mesh crowded_mesh(std::uint64_t seed, std::size_t triangles) {
    Random random(seed);
    Mesh mesh;
    const auto places = static_cast<std::size_t>(random.between(4.0, 12.0));
    for (std::size_t i = 0; i < places; ++i) {
        mesh.positions.push_back(random.vector(1.0));
        if (random.between(0.0, 1.0) < 0.3) {
            mesh.positions.push_back(mesh.positions.back() + random.vector(2e-6));
        }
    }
    const auto any = [&]() {
        return static_cast<std::uint32_t>(
            random.between(0.0, static_cast<double>(mesh.positions.size())));
    };
    for (std::size_t t = 0; t < triangles; ++t) {
        const std::uint32_t a = any();
        const std::uint32_t b = any();
        mesh.triangles.push_back({a, b, any()});
    }
    return mesh;
}

RC_GTEST_PROP(SurfaceGraph, ValidForAnyCrowdedMesh, (std::uint64_t seed)) {
    const Mesh mesh = crowded_mesh(seed, *rc::gen::inRange<std::size_t>(0, 60));
    expect_valid_graph(build_surface_graph(mesh), mesh);
    RC_ASSERT(!::testing::Test::HasFailure());
}

RC_GTEST_PROP(SurfaceGraph, ValidForAnyBrokenMesh, (std::uint64_t seed)) {
    Random random(seed);
    Mesh mesh = test::make_clean_ball(0.1, 8, 12);
    for (int i = 0; i < 4; ++i) {
        const auto kind = static_cast<int>(random.between(0.0, 8.0));
        const double share = random.between(0.0, 0.3);
        mesh = kind == 0   ? test::as_soup(mesh, random.between(0.0, 2e-4), random)
               : kind == 1 ? test::with_holes(mesh, share, random)
               : kind == 2 ? test::with_flips(mesh, share, random)
               : kind == 3 ? test::with_t_junctions(mesh, share, random)
               : kind == 4 ? test::with_slivers(mesh, share, random)
               : kind == 5 ? test::doubled(mesh)
               : kind == 6 ? test::with_duplicates(mesh, share, random)
                           : test::with_wild_vertices(mesh, 0.1 * share, random);
    }
    SurfaceGraph graph = build_surface_graph(mesh);
    expect_valid_graph(graph, mesh);
    orient_consistently(graph);
    orient_outward(graph);
    expect_valid_graph(graph, mesh);
    RC_ASSERT(!::testing::Test::HasFailure());
}

RC_GTEST_PROP(SurfaceGraph, LinksAreInvariantUnderRigidMotion, (std::uint64_t seed)) {
    const Mesh mesh = crowded_mesh(seed, *rc::gen::inRange<std::size_t>(0, 60));
    const SurfaceGraph graph = build_surface_graph(mesh);
    Random random(seed + 1);
    const Pose pose = random.pose(2.0);
    Mesh moved = mesh;
    for (Vec3& position : moved.positions) {
        position = transform_point(pose, position);
    }
    const SurfaceGraph again = build_surface_graph(moved);
    RC_ASSERT(graph.triangles == again.triangles);
    RC_ASSERT(graph.neighbours == again.neighbours);
}

}  // namespace
}  // namespace handhold::surface_graph_test
