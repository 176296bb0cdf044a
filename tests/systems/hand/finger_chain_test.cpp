#include "systems/hand/shared/finger_chain.hpp"

#include <gtest/gtest.h>

#include "fitted_hand.hpp"

namespace handhold::finger_chain_test {
namespace {

using test::FittedHand;
using test::k_right;
using test::k_unlimited_s;
using test::wrist_with_palm_at;

constexpr std::size_t k_index = 1;
constexpr std::size_t k_middle = 2;

// Two floors in the plane y = 0 with a slot of 1 mm between them, too wide to be welded.
Mesh make_slotted_floor(double slot_x_m) {
    Mesh mesh;
    for (const double side : {-1.0, 1.0}) {
        const Mesh half = test::make_floor_mesh();
        const auto first = static_cast<std::uint32_t>(mesh.positions.size());
        for (const Vec3& position : half.positions) {
            mesh.positions.emplace_back(position + Vec3(slot_x_m + 0.5005 * side, 0.0, 0.0));
        }
        for (const auto& [a, b, c] : half.triangles) {
            mesh.triangles.push_back({a + first, b + first, c + first});
        }
    }
    return mesh;
}

// A flat hand over the slot: its palm is above one floor, its index finger above the other.
struct FingerChain : testing::Test {
    const HandRig rig = builtin_hand_rig(HandSide::right);
    const double slot_x_m =
        0.5 * (rig.fingers[k_index].base_hs.position + rig.fingers[k_middle].base_hs.position).x() -
        rig.palm_center_hs.x();
    const GripMesh floors = build_grip_mesh(make_slotted_floor(slot_x_m));
    FittedHand hand{floors, wrist_with_palm_at(rig, {0.0, 0.012, 0.0}, Vec3::UnitY())};

    bool is_under_palm(const GraphPoint& point) const {
        return (corners_of(floors.search, point.triangle)[0].x() > slot_x_m) == (slot_x_m < 0.0);
    }
    ChainSeed seed_of_index() {
        return chain_seed(hand.hands.front(), hand.surface.at(k_right),
                          finger_chain(rig.fingers[k_index], 0.0, hand.wrist_bs()));
    }
};

TEST_F(FingerChain, SearchIsSeededUnderPalmAndAtFinger) {
    ASSERT_EQ(floors.search.report.parts, 2U);
    hand.search();
    const auto [palm, finger] = seed_of_index();
    ASSERT_NE(palm.triangle, k_no_triangle);
    ASSERT_NE(finger.triangle, k_no_triangle);
    EXPECT_TRUE(is_under_palm(palm));
    EXPECT_FALSE(is_under_palm(finger));
    hand.surface.at(k_right).triangle = GripSurface::k_none;
    EXPECT_EQ(seed_of_index()[0].triangle, k_no_triangle);
}

TEST_F(FingerChain, FingerOverAnotherPartThanPalmTouchesIt) {
    hand.frame(k_unlimited_s);
    for (std::size_t f = k_index; f < rig.fingers.size(); ++f) {
        EXPECT_GE(hand.traces[0][f].contact_link, 0) << f;
    }
    EXPECT_EQ(hand.stats.fallbacks[static_cast<std::size_t>(Fallback::finger_full_search)], 0U);
}

}  // namespace
}  // namespace handhold::finger_chain_test
