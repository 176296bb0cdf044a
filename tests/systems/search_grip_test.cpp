#include "systems/hand/search_grip.hpp"

#include <gtest/gtest.h>

#include "components/palm_fit.hpp"
#include "engine/collision/closest_point.hpp"
#include "fitted_hand.hpp"

namespace handhold::search_grip_test {
namespace {

using test::FittedHand;
using test::k_right;
using test::Random;
using test::wrist_with_palm_at;

// Dunes: a floor with hills of up to a centimetre over 12 cm.
Mesh make_dunes(Random& random) {
    Mesh mesh = test::make_floor_mesh();
    const double phase = random.between(0.0, 6.0);
    for (Vec3& position : mesh.positions) {
        position.y() = 0.01 * std::sin(position.x() / 0.03 + phase) * std::cos(position.z() / 0.04);
    }
    return mesh;
}

// What talk row 17 counts, written anew: the move to the nearest place over the triangle within the
// range of heights, the turn into the range of angles, and what a turned-away face costs.
double sync_cost_m(const SurfaceGraph& graph, std::uint32_t triangle, const Vec3& center,
                   const Vec3& up, const PalmTuning& tuning) {
    const auto& [a, b, c] = graph.triangles[triangle];
    const Corners corners = {graph.positions[a], graph.positions[b], graph.positions[c]};
    const Vec3 wound = area_vector(corners).normalized();
    const bool is_back = wound.dot(up) < 0.0;
    const Vec3 normal = is_back ? Vec3(-wound) : wound;
    // Of all places of the prism over the triangle the nearest: in the plane and along the normal
    // apart, since they are at right angles.
    const double height_m = (center - corners[0]).dot(normal);
    const Vec3 flat = center - height_m * normal;
    const double beside_m = (closest_on_triangle(flat, corners) - flat).norm();
    const double lift_m =
        std::max({tuning.min_height_m - height_m, height_m - tuning.max_height_m, 0.0});
    const double angle_rad = std::acos(std::clamp(up.dot(normal), -1.0, 1.0));
    return std::hypot(beside_m, lift_m) +
           tuning.tilt_cost_m_per_rad * std::max(0.0, angle_rad - tuning.max_angle_rad) +
           (is_back ? tuning.back_cost_m : 0.0);
}

TEST(SearchGrip, FindsTheTriangleThatNeedsTheLeastMovement) {
    int compared = 0;
    int missed = 0;  // behind a hill that the search's patience does not reach over
    for (std::uint64_t seed = 2201; seed < 2211; ++seed) {
        Random random(seed);
        const GripMesh mesh = build_grip_mesh(make_dunes(random));
        const HandRig rig = builtin_hand_rig(HandSide::right);
        for (int i = 0; i < 30; ++i) {
            const Vec3 up = (Vec3::UnitY() + random.vector(0.5)).normalized();
            const Vec3 center = Vec3(0.0, random.between(0.0, 0.06), 0.0) + random.vector(0.05);
            FittedHand hand(mesh, wrist_with_palm_at(rig, center, up));
            hand.search();
            const GripSurface& surface = hand.surface.at(k_right);
            double least_m = 1.0;
            std::uint32_t best = 0;
            for (std::uint32_t t = 0; t < mesh.search.triangles.size(); ++t) {
                const double cost_m = sync_cost_m(mesh.search, t, center, up, hand.tuning.palm);
                if (cost_m < least_m) {
                    least_m = cost_m;
                    best = t;
                }
            }
            ASSERT_NE(surface.triangle, GripSurface::k_none);
            // Another is taken only where the palm would stay sunk at the cheapest.
            GripSurface cheapest = surface;
            cheapest.triangle = best;
            if (fit_palm(hand.hands.front(), cheapest, 0.0, hand.tuning.palm).sunk_m < 5e-4) {
                ++compared;
                const double excess_m =
                    sync_cost_m(mesh.search, surface.triangle, center, up, hand.tuning.palm) -
                    least_m;
                missed += excess_m > 1e-9 ? 1 : 0;
                EXPECT_LT(excess_m, 2e-3) << "seed " << seed << " case " << i;
            }
        }
    }
    EXPECT_GT(compared, 200);
    EXPECT_LE(missed, compared / 100);
}

TEST(SearchGrip, PrefersTheOuterSideOfAPlate) {
    // Two sheets 6 mm apart: an upper side that looks up and an under side that looks down. A palm
    // over the plate is as near to either, but for the plate's thickness.
    Mesh plate = test::make_floor_mesh();
    const auto count = static_cast<std::uint32_t>(plate.positions.size());
    const std::size_t triangles = plate.triangles.size();
    for (std::uint32_t v = 0; v < count; ++v) {
        plate.positions.push_back(plate.positions[v] - Vec3(0.0, 0.006, 0.0));
    }
    for (std::size_t t = 0; t < triangles; ++t) {
        const auto [a, b, c] = plate.triangles[t];
        plate.triangles.push_back({count + a, count + c, count + b});
    }
    const GripMesh mesh = build_grip_mesh(plate);
    const HandRig rig = builtin_hand_rig(HandSide::right);
    for (const double height_m : {-0.004, 0.001, 0.01, 0.05}) {
        FittedHand hand(mesh, wrist_with_palm_at(rig, {0.011, height_m, 0.004}, Vec3::UnitY()));
        hand.search();
        const GripSurface& surface = hand.surface.at(k_right);
        EXPECT_NEAR(surface.point_bs.y(), 0.0, 1e-9) << height_m;
        EXPECT_GT(surface.normal_bs.y(), 0.99);
    }
}

TEST(SearchGrip, LeavesHandsOutOfReachWithoutASurfaceAndCountsThem) {
    const GripMesh mesh = build_grip_mesh(test::make_floor_mesh());
    const HandRig rig = builtin_hand_rig(HandSide::right);
    FittedHand hand(mesh, wrist_with_palm_at(rig, {0.0, 0.4, 0.0}, Vec3::UnitY()));
    hand.search();
    EXPECT_EQ(hand.surface.at(k_right).triangle, GripSurface::k_none);
    EXPECT_EQ(test::count_of(hand.stats, Fallback::palm_no_surface), 1U);
    hand.hands.front().body = k_no_entity;
    hand.hands.front().meshes.clear();
    hand.search();
    EXPECT_EQ(test::count_of(hand.stats, Fallback::palm_no_surface), 1U);  // empty: not a failure
}

}  // namespace
}  // namespace handhold::search_grip_test
