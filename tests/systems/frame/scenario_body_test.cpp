// Talk row 23 through the whole frame.
#include <algorithm>

#include <gtest/gtest.h>

#include "tests/systems/frame/scenario.hpp"

namespace handhold::scenario_body_test {
namespace {

constexpr double k_pushes_s = 1.2;
constexpr double k_lets_go_s = 1.5;
constexpr double k_brakes_s = 3.0;
constexpr double k_push_mps = 2.0;

// How far the hand is drawn back towards the player: a stroke, back, a push that ends at
// k_push_mps, and back.
double drawn_m(double t_s) {
    constexpr double k_stroke_m = 0.25;
    constexpr double k_follows_s = 0.05;
    const double push_s = std::clamp(t_s - k_pushes_s, 0.0, k_lets_go_s - k_pushes_s);
    const double push_m = 0.5 * k_push_mps * push_s * push_s / (k_lets_go_s - k_pushes_s);
    const double after_m = k_push_mps * std::clamp(t_s - k_lets_go_s, 0.0, k_follows_s);
    return k_stroke_m * (ease(t_s, 0.1, 0.6) - ease(t_s, 0.66, 1.0)) +
           (push_m + after_m) * (1.0 - ease(t_s, k_lets_go_s + k_follows_s, 2.2));
}

bool holds(double t_s) {
    return (t_s > 0.05 && t_s < 0.63) || (t_s > 1.1 && t_s < k_lets_go_s) || t_s > k_brakes_s;
}

// Crawls along a rail with one hand, pushes off, drifts, grips the rail again.
TEST(ShownBody, LegsTrailSwingPastTheBodyAndSettle) {
    Scenario s;
    s.tuning.locomotion.drift_drag_per_s = 0.0;
    s.add_wall("rail", Vec3(0.05, 0.05, 20.0), Vec3(0.5, 1.0, 0.0));
    s.add_player_here();
    const Vec3 hand = hand_for_palm(s, Vec3(0.5, 1.06, 0.1));
    s.script.hands[1] = [=](double t) {
        return Pose{hand + Vec3(0.0, 0.0, drawn_m(t)), Quat::Identity()};
    };
    s.script.grabs[1] = holds;
    s.run(0.04);
    const auto foot = [&] {
        const SpinePose& pose = s.world.spine_pose.at(s.player.player);
        return Vec3(pose.legs[0].foot_ws.position - pose.chest_ws.position);
    };
    const Vec3 rest = foot();
    double max_behind_m = 0.0;
    double max_ahead_m = 0.0;
    s.run(9.0, [&] {
        const double z = foot().z() - rest.z();  // the player moves along -Z
        if (s.t_s() < k_brakes_s) {
            max_behind_m = std::max(max_behind_m, z);
        } else {
            max_ahead_m = std::max(max_ahead_m, -z);
        }
        const ArmPose& arms = s.world.arm_pose.at(s.player.player);
        for (std::size_t side = 0; side < k_hand_count; ++side) {
            const Pose& palm_ws = s.world.palm_pose.at(s.player.hands[side]).pose_ws;
            ASSERT_TRUE(same_pose(arms.arms[side].hand_ws, palm_ws));
        }
        if (s.t_s() > 2.0 && s.t_s() < k_brakes_s) {
            ASSERT_NEAR(s.velocity().z(), -k_push_mps, 0.2);
        }
    });
    EXPECT_LT(s.velocity().norm(), 1e-6);
    EXPECT_GT(max_behind_m, 0.2);
    EXPECT_GT(max_ahead_m, 0.1);
    EXPECT_LT((foot() - rest).norm(), 0.06);  // the idle clip moves it a little
}

}  // namespace
}  // namespace handhold::scenario_body_test
