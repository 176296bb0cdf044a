#include "systems/hand/shared/finger_chain.hpp"

#include <gtest/gtest.h>

#include "fitted_hand.hpp"

namespace handhold::finger_chain_test {
namespace {

using test::FittedHand;
using test::k_right;
using test::k_unbudgeted_s;
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
    ChainSeed seed_of_index(std::uint32_t last_triangle) {
        return chain_seed(hand.hands.front(), hand.surface.at(k_right), last_triangle,
                          finger_chain(rig.fingers[k_index], 0.0, hand.wrist_bs()));
    }
};

TEST_F(FingerChain, ColdSearchIsSeededUnderPalmAndAtFinger) {
    ASSERT_EQ(floors.search.report.parts, 2U);
    hand.search();
    for (const std::uint32_t none : {k_no_triangle, 1'000'000U}) {  // the latter from an older mesh
        const auto [palm, finger] = seed_of_index(none);
        ASSERT_NE(palm.triangle, k_no_triangle);
        ASSERT_NE(finger.triangle, k_no_triangle);
        EXPECT_TRUE(is_under_palm(palm));
        EXPECT_FALSE(is_under_palm(finger));
    }
    hand.surface.at(k_right).triangle = GripSurface::k_none;
    EXPECT_EQ(seed_of_index(k_no_triangle)[0].triangle, k_no_triangle);
}

TEST_F(FingerChain, WarmSearchIsSeededWhereLastOneEnded) {
    hand.search();
    const auto [last, none] = seed_of_index(3);
    EXPECT_EQ(last.triangle, 3U);
    EXPECT_EQ(none.triangle, k_no_triangle);
}

TEST_F(FingerChain, FingerOverAnotherPartThanPalmTouchesIt) {
    hand.frame(k_unbudgeted_s);
    for (std::size_t f = k_index; f < rig.fingers.size(); ++f) {
        EXPECT_GE(hand.traces[0][f].contact_link, 0) << f;
    }
    EXPECT_EQ(hand.stats.fallbacks[static_cast<std::size_t>(Fallback::finger_full_search)], 0U);
}

TEST(IsClearlyBetter, IfClearOrLessThanHalfAsDeep) {
    const ChainFitSettings settings;
    const auto penetrating = [](double depth_m) {
        ChainFit fit;
        fit.depth_m = depth_m;
        return fit;
    };
    EXPECT_TRUE(is_clearly_better(penetrating(settings.open_depth_m), penetrating(1e-3), settings));
    EXPECT_TRUE(is_clearly_better(penetrating(4e-3), penetrating(9e-3), settings));
    EXPECT_FALSE(is_clearly_better(penetrating(5e-3), penetrating(9e-3), settings));
    EXPECT_FALSE(is_clearly_better(penetrating(1.5e-3), penetrating(2e-3), settings));
}

// During a transition the shown angles open at its rate; any further opening of the target is shown
// at once.
TEST(FollowTarget, OpensAtLimitedRateOnlyDuringTransition) {
    constexpr double k_dt_s = 1.0 / 90.0;
    FingerTuning tuning;
    tuning.transition_radps = 9.0;  // 0.1 rad per frame
    tuning.close_radps = 4.5;       // 0.05 rad per frame
    FingerPose pose;
    pose.shown[k_index].curl_rad = {1.0, 0.5, 0.0};
    begin_transition({0.65, 0.3, 0.2}, k_index, pose);
    pose.target[k_index].curl_rad = {0.65, 0.3, 0.2};
    const std::array<std::array<double, k_max_links>, 4> expected = {
        {{0.9, 0.4, 0.05}, {0.8, 0.3, 0.1}, {0.6, 0.2, 0.15}, {0.55, 0.2, 0.2}}};
    for (std::size_t frame = 0; frame < expected.size(); ++frame) {
        if (frame == 2) {  // the surface comes closer
            pose.target[k_index].curl_rad = {0.55, 0.2, 0.2};
        }
        follow_target(k_index, k_dt_s, tuning, pose);
        for (std::size_t i = 0; i < k_max_links; ++i) {
            EXPECT_NEAR(pose.shown[k_index].curl_rad[i], expected[frame][i], 1e-12)
                << "frame " << frame << ", link " << i;
        }
    }
    EXPECT_EQ(pose.shown[k_middle].curl_rad, pose.target[k_middle].curl_rad);

    // The hand lets go and makes a fist: the remaining lag must not close it beyond the fist.
    pose.shown[k_index].curl_rad = {1.6, 1.6, 1.6};
    begin_transition({0.2, 0.2, 0.2}, k_index, pose);
    pose.target[k_index].curl_rad = {1.36, 1.36, 1.36};
    double last_rad = 1.6;
    for (int frame = 0; frame < 20; ++frame) {
        follow_target(k_index, k_dt_s, tuning, pose);
        EXPECT_LE(pose.shown[k_index].curl_rad[1], last_rad) << "frame " << frame;
        last_rad = pose.shown[k_index].curl_rad[1];
    }
    EXPECT_EQ(last_rad, 1.36);

    begin_transition({0.0, 0.0, 0.0}, k_index, pose);
    pose.target[k_index].curl_rad = {0.0, 0.0, 0.0};
    follow_target(k_index, k_unbudgeted_s, tuning, pose);
    EXPECT_EQ(pose.shown[k_index].curl_rad, pose.target[k_index].curl_rad);
}

}  // namespace
}  // namespace handhold::finger_chain_test
