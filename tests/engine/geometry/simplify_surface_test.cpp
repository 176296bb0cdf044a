#include "engine/geometry/simplify_surface.hpp"

#include <algorithm>
#include <cmath>
#include <set>

#include <gtest/gtest.h>

#include "broken_meshes.hpp"
#include "data_meshes.hpp"
#include "engine/geometry/simplify.hpp"
#include "engine/geometry/surface_distance.hpp"
#include "graph_claims.hpp"

// Oracle: distances of points sampled on one surface to the other. The code proves its limits by
// other means.
namespace handhold::simplify_surface_test {
namespace {

using test::Random;

double farthest_sample_m(const SurfaceGraph& from, const SurfaceGraph& to, Random& random) {
    const TriangleBvh bvh(to.positions, to.triangles);
    double worst = 0.0;
    for (const auto& [a, b, c] : from.triangles) {
        for (int i = 0; i < 3; ++i) {
            double u = random.between(0.0, 1.0);
            double v = random.between(0.0, 1.0);
            if (u + v > 1.0) {
                u = 1.0 - u;
                v = 1.0 - v;
            }
            const Vec3 point =
                (1.0 - u - v) * from.positions[a] + u * from.positions[b] + v * from.positions[c];
            worst = std::max(worst, bvh.closest_point(point, 1e9)->distance_m);
        }
    }
    return worst;
}

void expect_coarser_within(const SurfaceGraph& fine, const DetailLimits& limits, Random& random) {
    const SurfaceGraph coarse = simplify_surface(fine, limits);
    ASSERT_FALSE(coarse.triangles.empty());
    EXPECT_LE(coarse.triangles.size(), fine.triangles.size());
    EXPECT_LE(farthest_sample_m(fine, coarse, random), limits.deviation_m);
    EXPECT_LE(farthest_sample_m(coarse, fine, random), limits.deviation_m);
    test::expect_mutual_links(coarse);
    test::expect_best_pairs(coarse);
    const std::set<std::uint32_t> sources(fine.source_triangle.begin(), fine.source_triangle.end());
    for (const std::uint32_t source : coarse.source_triangle) {
        ASSERT_EQ(sources.count(source), 1U);
    }
}

TEST(SimplifySurface, KeepsDeviationBothWaysOnBrokenMeshes) {
    Random random(840);
    const Mesh ball = test::make_clean_ball(0.15, 60, 90);
    const std::vector<Mesh> meshes = {
        ball,
        test::as_soup(ball, 1e-5, random),
        test::with_holes(ball, 0.06, random),
        test::with_flips(ball, 0.15, random),
        test::with_t_junctions(ball, 0.3, random),
        test::with_slivers(ball, 0.2, random),
        test::doubled(ball),
        test::with_duplicates(ball, 0.3, random),
        test::with_wild_vertices(ball, 0.01, random),
    };
    for (std::size_t i = 0; i < meshes.size(); ++i) {
        SCOPED_TRACE(i);
        const SurfaceGraph fine = build_surface_graph(meshes[i]);
        expect_coarser_within(fine, {5e-4, 0.0}, random);
        expect_coarser_within(fine, {2.5e-3, 0.02}, random);
    }
}

TEST(SimplifySurface, KeepsDeviationOnRealMeshes) {
    Random random(841);
    int meshes = 0;
    for (const char* folder : {"objects", "nasty"}) {
        for (const auto& path : test::data_files(folder)) {
            const SurfaceGraph fine = build_surface_graph(test::load_whole(path));
            if (fine.triangles.empty() || fine.triangles.size() > 7000) {
                continue;
            }
            SCOPED_TRACE(path);
            expect_coarser_within(fine, {5e-4, 0.0}, random);
            expect_coarser_within(fine, {2.5e-3, 0.02}, random);
            ++meshes;
        }
    }
    if (meshes == 0) {
        GTEST_SKIP() << "no mesh data";
    }
}

TEST(SimplifySurface, MergesFlatTrianglesAndKeepsLargeOnes) {
    const SurfaceGraph fine = build_surface_graph(*test::make_floor(1.0, 100));
    EXPECT_LE(simplify_surface(fine, {5e-4, 0.0}).triangles.size(), 10U);
    // About as many as equilateral triangles with an edge of 20 mm.
    const double full = 1.0 / (std::sqrt(3.0) / 4.0 * 0.02 * 0.02);
    EXPECT_NEAR(static_cast<double>(simplify_surface(fine, {2.5e-3, 0.02}).triangles.size()), full,
                0.05 * full);
    const SurfaceGraph large = build_surface_graph(*test::make_floor(1.0, 10));
    EXPECT_EQ(simplify_surface(large, {2.5e-3, 0.02}).triangles, large.triangles);
}

TEST(SimplifySurface, ReachesTargetEdgeLengthOnBall) {
    // On a sphere of radius r, triangles of edge a deviate by a^2 / (6 r). At r = 150 mm, 2.5 mm of
    // deviation would allow a = 47 mm, so the target edge decides; the count follows from the area.
    const SurfaceGraph fine = build_surface_graph(test::make_clean_ball(0.15, 100, 200));
    const SurfaceGraph coarse = simplify_surface(fine, {2.5e-3, 0.02});
    const double full = 4.0 * 3.14159 * 0.15 * 0.15 / (std::sqrt(3.0) / 4.0 * 0.02 * 0.02);
    EXPECT_NEAR(static_cast<double>(coarse.triangles.size()), full, 0.1 * full);
}

TEST(Simplify, KeepsLockedPoints) {
    Random random(843);
    const Mesh ball = test::make_clean_ball(0.15, 40, 60);
    std::vector<std::uint32_t> locked;
    for (const auto& triangle : ball.triangles) {
        if (test::chance(random) < 0.05) {
            locked.push_back(triangle[0]);
        }
    }
    std::sort(locked.begin(), locked.end());
    locked.erase(std::unique(locked.begin(), locked.end()), locked.end());
    const auto corners_of = [&](std::span<const std::uint32_t> kept) {
        std::set<std::uint32_t> corners;
        for (const auto& triangle : simplify({ball.positions, ball.triangles, kept}, 0.01, 0)) {
            corners.insert(triangle.begin(), triangle.end());
        }
        return corners;
    };
    const std::set<std::uint32_t> free = corners_of({});
    const std::set<std::uint32_t> with_locks = corners_of(locked);
    EXPECT_LT(free.size(), ball.positions.size() / 20);
    EXPECT_LT(with_locks.size(), ball.positions.size() / 4);
    EXPECT_LT(*with_locks.rbegin(), ball.positions.size());
    for (const std::uint32_t point : locked) {
        ASSERT_EQ(with_locks.count(point), 1U);
    }
}

TEST(SurfaceDistance, MatchesDistanceOfShiftedSheet) {
    const Mesh sheet = *test::make_floor(0.3, 20);
    const Mesh coarse = *test::make_floor(0.3, 3);
    for (const double gap : {2e-4, 1e-3}) {
        std::vector<Vec3> lifted = coarse.positions;
        for (Vec3& position : lifted) {
            position.y() += gap;
        }
        const TriangleBvh sheet_bvh(sheet.positions, sheet.triangles);
        const TriangleBvh lifted_bvh(lifted, coarse.triangles);
        const TriangleSurface a = {sheet.positions, sheet.triangles, sheet_bvh};
        const TriangleSurface b = {lifted, coarse.triangles, lifted_bvh};
        EXPECT_TRUE(find_uncovered(a, b, gap + 1e-4).empty());
        EXPECT_TRUE(find_uncovered(b, a, gap + 1e-4).empty());
        EXPECT_FALSE(find_uncovered(a, b, gap - 1e-6).empty());
        EXPECT_FALSE(find_uncovered(b, a, gap - 1e-6).empty());
    }
}

TEST(SurfaceDistance, FindsHoleThatContainsNoCorner) {
    Random random(842);
    const Mesh whole = *test::make_floor(0.3, 1);
    Mesh holed = *test::make_floor(0.3, 30);
    holed.triangles.erase(holed.triangles.begin() + 900, holed.triangles.begin() + 902);
    const TriangleBvh whole_bvh(whole.positions, whole.triangles);
    const TriangleBvh holed_bvh(holed.positions, holed.triangles);
    const TriangleSurface a = {whole.positions, whole.triangles, whole_bvh};
    const TriangleSurface b = {holed.positions, holed.triangles, holed_bvh};
    EXPECT_TRUE(find_uncovered(b, a, 1e-4).empty());
    EXPECT_FALSE(find_uncovered(a, b, 4.9e-3).empty());  // the hole is a square of 10 mm
    EXPECT_TRUE(find_uncovered(a, b, 5.1e-3).empty());
}

}  // namespace
}  // namespace handhold::simplify_surface_test
