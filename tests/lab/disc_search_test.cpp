#include "tools/lab/disc_search.hpp"

#include <set>

#include <gtest/gtest.h>

#include "engine/geometry/closest_point.hpp"
#include "engine/geometry/triangle_bvh.hpp"
#include "tests/engine/geometry/broken_meshes.hpp"
#include "tests/engine/geometry/surface_cuts.hpp"

namespace handhold::lab::disc_search_test {
namespace {

using test::cut_by_hand;
using test::Random;

GraphPoint nearest_on(const TriangleBvh& bvh, const Vec3& point) {
    const auto near = bvh.closest_point(point, 10.0);
    return {near->triangle, near->point};
}

struct Pops {
    std::uint32_t best = 0;
    std::uint32_t breadth = 0;
    std::uint32_t searches = 0;
    std::uint32_t max_best = 0;
};

// Searches from a random start in both orders; any triangle found has to be cut by the disc.
Pops search_at_random(const SurfaceGraph& graph, const Disc& disc, const Vec3& near, double size_m,
                      Random& random) {
    const TriangleBvh bvh(graph.positions, graph.triangles);
    std::set<std::uint32_t> cut;
    for (const DiscSegment& segment : cut_by_hand(graph, disc)) {
        cut.insert(segment.triangle);
    }
    const GraphPoint start = nearest_on(bvh, near + random.vector(size_m));
    TraceScratch scratch;
    const auto search = [&](SearchOrder order) {
        return find_crossing_in(order, graph, disc, {&start, 1}, scratch);
    };
    const CrossingSearch best = search(SearchOrder::best_first);
    const CrossingSearch breadth = search(SearchOrder::breadth_first);
    for (const CrossingSearch& found : {best, breadth}) {
        EXPECT_EQ(found.triangle == k_no_triangle || cut.contains(found.triangle), true);
        EXPECT_LE(found.pops, k_max_pops);
        if (found.triangle != k_no_triangle) {
            EXPECT_NEAR(disc.normal.dot(found.point - disc.center), 0.0, 1e-12);
        }
    }
    EXPECT_TRUE(best.triangle != k_no_triangle || breadth.triangle == k_no_triangle);
    return {best.pops, breadth.pops, 1, best.pops};
}

TEST(DiscSearch, PopsFewOnPlaneAndFewerThanBreadthFirst) {
    // Cells of 20 mm and a disc perpendicular to the floor: a straight path of 6 cm crosses 3
    // cells.
    const SurfaceGraph graph = build_surface_graph(*test::make_floor(1.0, 50));
    Random random(1504);
    Pops sum;
    for (int i = 0; i < 500; ++i) {
        const double turn = random.between(-M_PI, M_PI);
        Disc disc;
        disc.center = Vec3{random.between(-0.1, 0.1), 0.03, random.between(-0.1, 0.1)};
        disc.x_axis = Vec3(std::cos(turn), 0.0, std::sin(turn));
        disc.y_axis = Vec3::UnitY();
        disc.normal = disc.x_axis.cross(disc.y_axis);
        const Pops one = search_at_random(graph, disc, disc.center, 0.04, random);
        sum.best += one.best;
        sum.breadth += one.breadth;
        sum.max_best = std::max(sum.max_best, one.best);
    }
    // A path of at most 4 * sqrt(2) cm enters at most 4 rows and 4 columns of cells.
    EXPECT_LE(sum.max_best, 16U);
    EXPECT_LE(sum.best, 5U * 500U);
    EXPECT_LT(sum.best, sum.breadth);
}

TEST(DiscSearch, PopsFewerThanBreadthFirstOnRoundMeshes) {
    Random random(1505);
    Pops sum;
    for (const Mesh& mesh :
         {test::make_torus(0.08, 0.03, 30, 16), test::make_clean_ball(0.08, 24, 40)}) {
        const SurfaceGraph graph = build_surface_graph(mesh);
        for (int i = 0; i < 300; ++i) {
            const Vec3 center = 0.09 * random.direction();
            const Disc disc = test::random_disc(center, 0.1, random);
            const Pops one = search_at_random(graph, disc, center, 0.03, random);
            sum.best += one.best;
            sum.breadth += one.breadth;
        }
    }
    EXPECT_LT(sum.best, sum.breadth);
}

// A floor is one component and its part within a sphere is connected: the flood visits each
// triangle with a shared edge in reach once.
TEST(DiscSearch, FloodVisitsAllInReachAndFindsSameAsBreadthFirst) {
    const SurfaceGraph graph = build_surface_graph(*test::make_floor(1.0, 50));
    const TriangleBvh bvh(graph.positions, graph.triangles);
    Random random(1506);
    TraceScratch scratch;
    for (int i = 0; i < 100; ++i) {
        const Disc disc = test::random_disc(random.vector(0.05), 0.1, random);
        const GraphPoint start = nearest_on(bvh, disc.center);
        std::uint32_t in_reach = 0;
        for (std::uint32_t t = 0; t < graph.triangles.size(); ++t) {
            bool is_near = false;
            for (std::size_t edge = 0; edge < 3; ++edge) {
                const Vec3 near =
                    closest_on_segment(disc.center, graph.positions[graph.triangles[t][edge]],
                                       graph.positions[graph.triangles[t][(edge + 1) % 3]]);
                is_near = is_near || (graph.neighbours[t][edge] != k_no_triangle &&
                                      (near - disc.center).norm() <= disc.radius_m + 0.03);
            }
            in_reach += is_near ? 1U : 0U;
        }
        const auto search = [&](SearchOrder order) {
            return find_crossing_in(order, graph, disc, {&start, 1}, scratch);
        };
        const CrossingSearch flooded = search(SearchOrder::flood);
        const CrossingSearch stopped = search(SearchOrder::breadth_first);
        EXPECT_EQ(flooded.pops, in_reach);
        EXPECT_EQ(flooded.triangle, stopped.triangle);
        EXPECT_EQ(flooded.point, stopped.point);
    }
}

}  // namespace
}  // namespace handhold::lab::disc_search_test
