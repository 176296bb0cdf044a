// Talk row 23 through the whole frame.
#include <algorithm>

#include <gtest/gtest.h>

#include "systems/body/shared/hang_body.hpp"
#include "systems/body/shared/spine_chain.hpp"
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

// Where the left foot of a player at rest is, relative to the chest. `pull`: what the gripping
// hands pull in the end. Both in world axes; the player's origin is not turned.
Vec3 foot_at_rest(const Quat& chest, const Vec3& pull, double scale) {
    const Quat to_chest = chest.conjugate();
    const TrunkLean lean = lean_of(to_chest * pull, upright_turn(to_chest * Vec3::UnitY(), 0.0));
    SpineChain chain{frame_at(leaning_chest(chest, lean)), {}};
    BodyLinkVectors end_m = zero_vectors();
    constexpr std::size_t k_left_shin = k_spine_links + 1;
    for (std::size_t i = 0; i <= k_left_shin; ++i) {
        const SpineLink& link = spine_links()[i];
        const SpineFrame& above = frame_above_link(chain, link);
        const Vec3& rest = i < k_spine_links ? lean.rest_above[i] : link.rest;
        end_m[i] =
            link_base(above, end_m, link, scale) + above.axes * ((scale * link.length_m) * rest);
        chain.links[i] = frame_at(link_frame(above.rotation, rest, 0.0));
    }
    return end_m[k_left_shin];
}

// What one gripping hand pulls in the end.
Vec3 pull_of_right_hand(const Scenario& s) {
    const ArmEstimate& arms = s.world.arm_estimate.at(s.player.player);
    const BodyMeasures& measures = s.world.body_measures.at(s.player.player);
    const Vec3 p = s.tuning.spine.hang / (measures.upper_arm_m + measures.forearm_m) *
                   (arms.arms[1].hand_ps.position - arms.chest_ps.position);
    return p / std::sqrt(1.0 + p.squaredNorm());
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
    const Entity player = s.player.player;
    const double scale = s.world.body_measures.at(player).eye_height_m / k_scale_eye_m;
    const auto chest = [&] { return s.world.arm_estimate.at(player).chest_ps.rotation; };
    const Vec3 rest = foot();
    EXPECT_LT((rest - foot_at_rest(chest(), Vec3::Zero(), scale)).norm(), 0.01);
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
    // It hangs from the hand on the rail. The idle clip moves it a little.
    const Vec3 hanging = foot_at_rest(chest(), pull_of_right_hand(s), scale);
    EXPECT_GT((hanging - rest).norm(), 0.15);
    EXPECT_LT((foot() - hanging).norm(), 0.06);
}

}  // namespace
}  // namespace handhold::scenario_body_test
