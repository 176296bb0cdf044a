#include "engine/geometry/disc_trace.hpp"

#include <map>
#include <set>

#include <gtest/gtest.h>

#include "broken_meshes.hpp"
#include "engine/geometry/triangle_bvh.hpp"
#include "surface_cuts.hpp"

namespace handhold::disc_trace_test {
namespace {

using test::cut_by_hand;
using test::Random;

double nearest_m(const Vec2& point, const std::vector<DiscSegment>& segments) {
    double nearest = std::numeric_limits<double>::infinity();
    for (const DiscSegment& segment : segments) {
        nearest = std::min(nearest, test::point_to_segment(point, segment.a_ds, segment.b_ds));
    }
    return nearest;
}

// Number of segments that end at each point; points within a micrometre count as one.
std::map<std::pair<long, long>, int> count_ends(const std::vector<DiscSegment>& segments) {
    std::map<std::pair<long, long>, int> ends;
    for (const DiscSegment& segment : segments) {
        for (const Vec2& end : {segment.a_ds, segment.b_ds}) {
            ++ends[{std::lround(1e6 * end.x()), std::lround(1e6 * end.y())}];
        }
    }
    return ends;
}

int loose_ends(const std::vector<DiscSegment>& segments) {
    int loose = 0;
    for (const auto& [place, count] : count_ends(segments)) {
        loose += count == 1 ? 1 : 0;
    }
    return loose;
}

std::vector<DiscSegment> walk(const SurfaceGraph& graph, const Disc& disc, std::uint32_t from,
                              std::uint32_t* walked = nullptr) {
    TraceScratch scratch;
    std::vector<DiscSegment> segments;
    const std::uint32_t count = walk_crossing(graph, disc, from, scratch, segments);
    if (walked != nullptr) {
        *walked = count;
    }
    return segments;
}

// All of `cut` is in `walked` up to the simplification tolerance, and nothing else is.
void expect_same_line(const std::vector<DiscSegment>& walked, const std::vector<DiscSegment>& cut) {
    for (const DiscSegment& segment : cut) {
        ASSERT_LT(nearest_m(segment.a_ds, walked), k_straight_m + 1e-9);
        ASSERT_LT(nearest_m(segment.b_ds, walked), k_straight_m + 1e-9);
        ASSERT_LT(nearest_m(0.5 * (segment.a_ds + segment.b_ds), walked), k_straight_m + 1e-9);
    }
    for (const DiscSegment& segment : walked) {
        ASSERT_LT(nearest_m(segment.a_ds, cut), 1e-9);
        ASSERT_LT(nearest_m(segment.b_ds, cut), 1e-9);
    }
}

TEST(WalkCrossing, WalksAroundConvexSolidOnceAndCloses) {
    Random random(1501);
    for (const Mesh& mesh :
         {*test::make_box_mesh({0.03, 0.05, 0.08}), test::make_clean_ball(0.06, 12, 20)}) {
        const SurfaceGraph graph = build_surface_graph(mesh);
        for (int i = 0; i < 200; ++i) {
            const Disc disc = test::random_disc(random.vector(0.015), 0.5, random);
            const auto cut = cut_by_hand(graph, disc);
            ASSERT_FALSE(cut.empty());
            std::uint32_t count = 0;
            const auto walked = walk(graph, disc, cut.front().triangle, &count);
            expect_same_line(walked, cut);
            EXPECT_EQ(count, cut.size());
            EXPECT_EQ(loose_ends(walked), 0);
        }
    }
}

TEST(WalkCrossing, StaysOnOneRingOfTorus) {
    // The plane x = 0 cuts the torus in two circles; the walk covers only the one it starts on.
    const SurfaceGraph graph = build_surface_graph(test::make_torus(0.06, 0.02, 37, 24));
    Disc disc;
    disc.x_axis = Vec3::UnitY();
    disc.y_axis = Vec3::UnitZ();
    disc.normal = Vec3::UnitX();
    disc.radius_m = 0.5;
    std::vector<DiscSegment> near;
    for (const DiscSegment& segment : cut_by_hand(graph, disc)) {
        if (segment.a_ds.y() > 0.0) {
            near.push_back(segment);
        }
    }
    const auto walked = walk(graph, disc, near.front().triangle);
    expect_same_line(walked, near);
    EXPECT_EQ(loose_ends(walked), 0);
}

TEST(WalkCrossing, EndsAtBorders) {
    const SurfaceGraph graph = build_surface_graph(*test::make_floor(0.2, 9));
    Random random(1502);
    for (int i = 0; i < 100; ++i) {
        const double turn = random.between(-M_PI, M_PI);
        Disc disc;
        disc.center = Vec3{random.between(-0.05, 0.05), 0.01, random.between(-0.05, 0.05)};
        disc.x_axis = Vec3(std::cos(turn), 0.0, std::sin(turn));
        disc.y_axis = Vec3::UnitY();
        disc.normal = disc.x_axis.cross(disc.y_axis);
        disc.radius_m = 0.5;
        const auto cut = cut_by_hand(graph, disc);
        const auto walked = walk(graph, disc, cut[cut.size() / 2].triangle);
        expect_same_line(walked, cut);
        EXPECT_EQ(loose_ends(walked), 2);
    }
}

TEST(WalkCrossing, KeepsWithinDiscRadius) {
    const SurfaceGraph graph = build_surface_graph(*test::make_floor(1.0, 50));
    Random random(1503);
    for (int i = 0; i < 100; ++i) {
        Disc disc = test::random_disc(Vec3(0.0, 0.02, 0.0) + random.vector(0.01), 0.1, random);
        const auto cut = cut_by_hand(graph, disc);
        if (cut.empty()) {
            continue;
        }
        const auto walked = walk(graph, disc, cut[cut.size() / 2].triangle);
        for (const DiscSegment& segment : walked) {
            EXPECT_LE(test::point_to_segment(Vec2::Zero(), segment.a_ds, segment.b_ds),
                      disc.radius_m);
        }
        expect_same_line(walked, cut);
    }
}

TEST(WalkCrossing, EmptyForTriangleThatIsNotCut) {
    const SurfaceGraph graph = build_surface_graph(*test::make_floor(0.2, 4));
    Disc disc;  // the plane z = 0, moved beyond the floor
    disc.center = Vec3(0.0, 0.0, 0.3);
    std::uint32_t walked = 1;
    EXPECT_TRUE(walk(graph, disc, 0, &walked).empty());
    EXPECT_EQ(walked, 0U);
}

TEST(WalkCrossing, CornerOnPlaneIsCrossedOnce) {
    // A disc through a row of vertices, and through a ball's pole.
    const SurfaceGraph floor = build_surface_graph(*test::make_floor(0.2, 4));
    Disc disc;
    disc.radius_m = 0.5;
    const auto cut = cut_by_hand(floor, disc);
    ASSERT_EQ(cut.size(), 8U);
    EXPECT_EQ(loose_ends(walk(floor, disc, cut.front().triangle)), 2);
    const SurfaceGraph ball = build_surface_graph(test::make_clean_ball(0.06, 12, 20));
    const auto round = cut_by_hand(ball, disc);
    EXPECT_EQ(loose_ends(walk(ball, disc, round.front().triangle)), 0);
}

GraphPoint nearest_on(const TriangleBvh& bvh, const Vec3& point) {
    const auto near = bvh.closest_point(point, 10.0);
    return {near->triangle, near->point};
}

// Two floors, one above the other, and a disc that cuts only the upper one. The lower floor has no
// neighbour there, although much of it is in reach. The order of starts therefore does not change
// the result. A start without a triangle is ignored, and a start given twice is visited once.
TEST(FindCrossing, FindsComponentOnlyFromStartOnIt) {
    constexpr double k_up_m = 0.14;
    Mesh floors = *test::make_floor(1.0, 50);
    const auto lower_count = static_cast<std::uint32_t>(floors.positions.size());
    const std::size_t triangle_count = floors.triangles.size();
    for (std::uint32_t i = 0; i < lower_count; ++i) {
        floors.positions.push_back(floors.positions[i] + Vec3(0.0, k_up_m, 0.0));
    }
    for (std::size_t i = 0; i < triangle_count; ++i) {
        const auto [a, b, c] = floors.triangles[i];
        floors.triangles.push_back({a + lower_count, b + lower_count, c + lower_count});
    }
    const SurfaceGraph graph = build_surface_graph(floors);
    ASSERT_EQ(graph.report.parts, 2U);
    const TriangleBvh bvh(graph.positions, graph.triangles);
    Random random(1507);
    TraceScratch scratch;
    std::uint32_t max_failed_pops = 0;
    int compared = 0;
    for (int i = 0; i < 100; ++i) {
        Disc disc = test::random_disc(Vec3(0.0, k_up_m, 0.0) + random.vector(0.02), 0.1, random);
        if (std::abs(disc.normal.y()) > 0.9) {
            continue;  // it may pass beside both
        }
        const GraphPoint lower = nearest_on(bvh, random.vector(0.05));
        const GraphPoint upper = nearest_on(bvh, Vec3(0.0, k_up_m, 0.0) + random.vector(0.05));
        const auto search = [&](const GraphPoint& first, const GraphPoint& second = {}) {
            return find_crossing(graph, disc, std::array{first, second}, scratch);
        };
        const CrossingSearch alone = search(lower);
        const CrossingSearch there = search(upper);
        EXPECT_EQ(alone.triangle, k_no_triangle);
        max_failed_pops = std::max(max_failed_pops, alone.pops);
        ASSERT_NE(there.triangle, k_no_triangle);
        EXPECT_EQ(search(upper, upper).pops, there.pops);
        EXPECT_EQ(search({}, upper).point, there.point);
        EXPECT_EQ(search({}).pops, 0U);
        if (alone.pops + there.pops <= k_max_pops) {  // the starts share k_max_pops
            ++compared;
            EXPECT_EQ(search(lower, upper).point, there.point);
            EXPECT_EQ(search(upper, lower).point, there.point);
        }
    }
    EXPECT_GT(max_failed_pops, 10U);
    EXPECT_GT(compared, 30);
}

TEST(FindCrossing, GivesUpIfNothingIsInReach) {
    const SurfaceGraph graph = build_surface_graph(*test::make_floor(1.0, 50));
    Disc disc;
    disc.center = Vec3(0.0, 0.5, 0.0);
    const GraphPoint start = {1275, Vec3::Zero()};
    TraceScratch scratch;
    const CrossingSearch found = find_crossing(graph, disc, {&start, 1}, scratch);
    EXPECT_EQ(found.triangle, k_no_triangle);
    EXPECT_LE(found.pops, 1U);  // no edge is within 30 mm of the disc
}

}  // namespace
}  // namespace handhold::disc_trace_test
