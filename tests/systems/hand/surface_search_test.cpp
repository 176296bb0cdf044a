#include "systems/hand/shared/surface_search.hpp"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "engine/geometry/closest_point.hpp"
#include "fitted_hand.hpp"

namespace handhold::surface_search_test {
namespace {

using test::Random;

// A floor with hills of up to 1 cm.
Mesh make_dunes(Random& random) {
    Mesh mesh = test::make_floor_mesh();
    const double phase = random.between(0.0, 6.0);
    for (Vec3& position : mesh.positions) {
        position.y() = 0.01 * std::sin(position.x() / 0.03 + phase) * std::cos(position.z() / 0.04);
    }
    return mesh;
}

// Oracle: the cost of talk row 17, implemented independently. Movement to the nearest place over
// the triangle within the height limits, rotation into the tilt limit, and the cost of a backface.
double sync_cost_m(const SurfaceGraph& graph, std::uint32_t triangle, const Vec3& center,
                   const Vec3& up, const PalmTuning& tuning) {
    const auto& [a, b, c] = graph.triangles[triangle];
    const Corners corners = {graph.positions[a], graph.positions[b], graph.positions[c]};
    const Vec3 winding_normal = area_vector(corners).normalized();
    const bool is_backface = winding_normal.dot(up) < 0.0;
    const Vec3 normal = is_backface ? Vec3(-winding_normal) : winding_normal;
    // Nearest point of the prism over the triangle: the in-plane and normal parts are independent
    // because they are perpendicular.
    const double height_m = (center - corners[0]).dot(normal);
    const Vec3 in_plane = center - height_m * normal;
    const double in_plane_m = (closest_on_triangle(in_plane, corners) - in_plane).norm();
    const double along_normal_m =
        std::max({tuning.min_height_m - height_m, height_m - tuning.max_height_m, 0.0});
    const double angle_rad = std::acos(std::clamp(up.dot(normal), -1.0, 1.0));
    return std::hypot(in_plane_m, along_normal_m) +
           tuning.tilt_cost_m_per_rad * std::max(0.0, angle_rad - tuning.max_angle_rad) +
           (is_backface ? tuning.backface_cost_m : 0.0);
}

// Cheapest triangle of a search seeded at the nearest one.
PalmCost searched(const GripMesh& mesh, const PalmFrame& palm, const PalmTuning& tuning) {
    GripSearchScratch scratch;
    SurfaceSearch search(mesh.search, palm, tuning, scratch);
    constexpr std::uint32_t k_max_idle_pops = 24;
    if (const auto near = mesh.search_bvh.closest_point(palm.center, tuning.reach_m)) {
        search.add_seed(near->triangle);
    }
    search.run(k_max_idle_pops);
    const auto found = search.cheapest_excluding({});
    return found ? PalmCost{found->cost_m, found->point} : PalmCost{};
}

TEST(SurfaceSearch, FindsTriangleOfLeastCost) {
    const PalmTuning tuning;
    int compared = 0;
    int missed = 0;  // the search ended before it crossed a hill
    for (std::uint64_t seed = 2201; seed < 2211; ++seed) {
        Random random(seed);
        const GripMesh mesh = build_grip_mesh(make_dunes(random));
        for (int i = 0; i < 30; ++i) {
            const Vec3 up = (Vec3::UnitY() + random.vector(0.5)).normalized();
            const double height_m = random.between(0.0, 0.06);
            const Vec3 center = Vec3(0.0, height_m, 0.0) + random.vector(0.05);
            double min_cost_m = 1.0;
            for (std::uint32_t t = 0; t < mesh.search.triangles.size(); ++t) {
                min_cost_m = std::min(min_cost_m, sync_cost_m(mesh.search, t, center, up, tuning));
            }
            const double excess_m = searched(mesh, {center, up}, tuning).cost_m - min_cost_m;
            ++compared;
            missed += excess_m > 1e-9 ? 1 : 0;
            EXPECT_GT(excess_m, -1e-9) << "seed " << seed << " case " << i;
            EXPECT_LT(excess_m, 2e-3) << "seed " << seed << " case " << i;
        }
    }
    EXPECT_LE(missed, compared / 100);
}

TEST(SurfaceSearch, AppendsSameCandidatesAsRepeatedQueries) {
    const PalmTuning tuning;
    Random random(2211);
    std::size_t listed = 0;
    for (int i = 0; i < 60; ++i) {
        const GripMesh mesh = build_grip_mesh(make_dunes(random));
        const Vec3 up = (Vec3::UnitY() + random.vector(0.5)).normalized();
        const Vec3 beside = random.vector(0.05);
        const PalmFrame palm = {beside + random.between(0.0, 0.06) * Vec3::UnitY(), up};
        GripSearchScratch scratch;
        SurfaceSearch search(mesh.search, palm, tuning, scratch);
        search.add_seed(mesh.search_bvh.closest_point(palm.center, tuning.reach_m)->triangle);
        search.run(SurfaceSearch::k_max_pops);
        std::array<SurfaceSearch::Candidate, 5> excluded = {*search.cheapest_excluding({})};
        const double max_cost_m = 1e-6 + random.between(1.0, 4.0) * excluded[0].cost_m;
        std::vector<SurfaceSearch::Candidate> expected = {excluded[0]};
        while (expected.size() < excluded.size()) {
            const auto next = search.cheapest_excluding(expected);
            if (!next || next->cost_m >= max_cost_m) {
                break;
            }
            expected.push_back(*next);
        }
        std::array<SurfaceSearch::Candidate, 5> from_none = {};
        EXPECT_EQ(search.append_cheapest_excluding(from_none, 0, max_cost_m), expected.size()) << i;
        const std::size_t count = search.append_cheapest_excluding(excluded, 1, max_cost_m);
        ASSERT_EQ(count, expected.size()) << i;
        for (std::size_t k = 0; k < count; ++k) {
            EXPECT_EQ(excluded[k].triangle, expected[k].triangle) << i;
        }
        listed += count - 1;
    }
    EXPECT_GT(listed, 60U);
}

}  // namespace
}  // namespace handhold::surface_search_test
