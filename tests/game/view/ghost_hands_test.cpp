// Ghosts of hands in pictures, checked by where they must appear. A pinhole camera puts a point at
// x = w/2 (1 + X / (-Z tan(fov/2) w/h)), y = h/2 (1 - Y / (-Z tan(fov/2))) (X, Y, Z in its axes).
#include <algorithm>
#include <cmath>
#include <cstdlib>

#include <gtest/gtest.h>

#include "game/levels/built_in_scenes.hpp"
#include "game/mesh/primitives.hpp"
#include "game/view/player_view.hpp"
#include "game/view/snap_hint.hpp"
#include "systems/frame/frame.hpp"
#include "systems/input/read_tracking.hpp"

namespace handhold::ghost_hands_test {
namespace {

constexpr int k_width_px = 320;
constexpr int k_height_px = 240;
constexpr double k_fov_rad = 1.0;

RenderPose::Hand hand_apart(const Vec3& by_m, double turned_rad = 0.0) {
    RenderPose::Hand hand;
    hand.shown_ws.position = Vec3(0.1, 0.2, 0.3);
    hand.tracked_ws = {hand.shown_ws.position + by_m,
                       rotation_about(Vec3(0.6, 0.0, 0.8), turned_rad)};
    return hand;
}

TEST(GhostShare, GrowsWithDistanceBetweenItsLimits) {
    const GhostSettings limits;
    const double middle_m = 0.5 * (limits.apart_from_m + limits.apart_full_m);
    const double middle_rad = 0.5 * (limits.turned_from_rad + limits.turned_full_rad);
    EXPECT_EQ(ghost_share(hand_apart(Vec3::Zero()), limits), 0.0);
    EXPECT_EQ(ghost_share(hand_apart(0.99 * limits.apart_from_m * Vec3::UnitX()), limits), 0.0);
    EXPECT_NEAR(ghost_share(hand_apart(-middle_m * Vec3::UnitZ()), limits), 0.5, 1e-9);
    EXPECT_EQ(ghost_share(hand_apart(1.01 * limits.apart_full_m * Vec3::UnitY()), limits), 1.0);
    EXPECT_NEAR(ghost_share(hand_apart(Vec3::Zero(), middle_rad), limits), 0.5, 1e-9);
}

TEST(SnapHint, HintsAtTheGripThatAClosingHandSnapsTo) {
    Scene scene = *make_built_in_scene("playground");
    const PlayerEntities player = add_scene_player(scene, {"player", {}, 80.0});
    World& world = scene.world();
    const Entity gun = find_by_id(world, persistent_id_from_name("gun"));
    const AuthoredGrip& grip = world.authored_grips.at(gun).grips[0];
    const Pose wrist_ws =
        world.body_pose.at(gun).pose_ws * grip.hands[index_of(HandSide::right)].wrist_bs;
    RenderPose::Hand& hand = world.render_pose.at(player.player).hands[index_of(HandSide::right)];
    const auto hint_at = [&](double share_of_radius) {
        hand.tracked_ws = wrist_ws;
        hand.tracked_ws.position += share_of_radius * grip.snap_radius_m * Vec3::UnitY();
        return find_snap_hint(world, player.hands[1], scene.tuning().hand);
    };
    ASSERT_TRUE(hint_at(0.0));
    EXPECT_NEAR(hint_at(0.0)->nearness, 1.0, 1e-9);
    EXPECT_LT((hint_at(0.9)->wrist_ws.position - wrist_ws.position).norm(), 1e-12);
    EXPECT_TRUE(hint_at(0.99)->is_within);
    EXPECT_FALSE(hint_at(1.01)->is_within);
    EXPECT_FALSE(hint_at(2.01));
    hand.tracked_ws = wrist_ws;
    world.grab.at(player.hands[1]).kind = GripKind::held;
    EXPECT_FALSE(find_snap_hint(world, player.hands[1], scene.tuning().hand));
}

// One player who looks along -Z, with the right hand in front of the eyes.
class GhostPicture : public testing::Test {
  protected:
    void SetUp() override {
        player_ = add_scene_player(scene_, {"player", {}, 80.0});
        RenderPose& render = scene_.world().render_pose.at(player_.player);
        lay_body_behind(render);
        for (RenderPose::Hand& hand : render.hands) {
            put(hand, Vec3(0.0, 0.0, 5.0));  // behind the player
        }
        put(right(), Vec3(0.0, -0.05, -0.6));
    }
    RenderPose::Hand& right() {
        return scene_.world().render_pose.at(player_.player).hands[index_of(HandSide::right)];
    }
    static void put(RenderPose::Hand& hand, const Vec3& place) {
        hand.tracked_ws = hand.shown_ws = {place, Quat::Identity()};
        hand.ray_from_ws = hand.ray_to_ws = place;
    }
    // No frame was played, so the body would be at the eyes.
    static void lay_body_behind(RenderPose& render) {
        const Pose behind{Vec3(0.0, 0.0, 5.0), Quat::Identity()};
        render.arms.chest_ws = render.spine.chest_ws = render.spine.pelvis_ws = behind;
        for (ArmPose::Arm& arm : render.arms.arms) {
            arm.clavicle_ws = arm.upper_ws = arm.forearm_ws = arm.hand_ws = behind;
        }
        render.spine.spine_ws.fill(behind);
        for (SpinePose::Leg& leg : render.spine.legs) {
            leg.thigh_ws = leg.shin_ws = leg.foot_ws = behind;
        }
    }
    // A wall between the eyes and everything beyond `ahead_m`.
    void add_wall(double ahead_m) {
        add_static_mesh(scene_, "wall",
                        std::make_shared<const Mesh>(make_box(Vec3(2.0, 2.0, 0.02))),
                        {Vec3(0.0, 0.0, -ahead_m - 0.02), Quat::Identity()});
    }
    // False on machines that cannot draw.
    bool open() {
        std::string why_not;
        view_ =
            PlayerView::open(scene_, {}, k_width_px, k_height_px, why_not, PictureQuality::plain);
        if (view_) {
            view_->show_hand_lines(false);
        }
        return view_.has_value();
    }
    Image draw(std::optional<std::size_t> whose_eyes = 0) {
        Image image;
        view_->draw(Pose{}, k_fov_rad, whose_eyes, image);
        return image;
    }
    Scene scene_;
    PlayerEntities player_;
    std::optional<PlayerView> view_;
};

// Number of differing pixels, and how many of them are farther than `radius_m` from the projection
// of `place`.
struct Differing {
    int all = 0;
    int outside = 0;
};
Differing compare(const Image& a, const Image& b, const Vec3& place, double radius_m) {
    const double scale = 0.5 * k_height_px / std::tan(0.5 * k_fov_rad) / -place.z();
    const double at_x = 0.5 * k_width_px + scale * place.x();
    const double at_y = 0.5 * k_height_px - scale * place.y();
    Differing found;
    for (int y = 0; y < k_height_px; ++y) {
        for (int x = 0; x < k_width_px; ++x) {
            const std::uint8_t* p = a.pixel(x, y);
            const std::uint8_t* q = b.pixel(x, y);
            const int difference =
                std::max({std::abs(p[0] - q[0]), std::abs(p[1] - q[1]), std::abs(p[2] - q[2])});
            if (difference > 6) {
                ++found.all;
                found.outside +=
                    std::hypot(x + 0.5 - at_x, y + 0.5 - at_y) > scale * radius_m ? 1 : 0;
            }
        }
    }
    return found;
}

constexpr double k_hand_m = 0.24;  // largest distance of any part of a hand from its wrist

TEST_F(GhostPicture, AppearsOnlyAtTheTrackedPose) {
    if (!open()) {
        GTEST_SKIP() << "no picture can be drawn here";
    }
    const Image agree = draw();
    right().tracked_ws.position = Vec3(0.25, 0.1, -0.7);
    const Differing apart = compare(draw(), agree, right().tracked_ws.position, k_hand_m);
    EXPECT_GT(apart.all, 400);
    EXPECT_EQ(apart.outside, 0);
}

TEST_F(GhostPicture, IsVisibleThroughAWall) {
    add_wall(0.5);
    if (!open()) {
        GTEST_SKIP() << "no picture can be drawn here";
    }
    put(right(), Vec3(-0.2, -0.05, -0.4));
    right().grip = GripKind::surface;
    const Image agree = draw();
    right().tracked_ws.position = Vec3(0.1, 0.0, -0.7);
    const Differing apart = compare(draw(), agree, right().tracked_ws.position, k_hand_m + 0.02);
    EXPECT_GT(apart.all, 400);
    EXPECT_EQ(apart.outside, 0);
}

TEST_F(GhostPicture, IsAbsentIfTrackedAndShownPoseNearlyAgree) {
    if (!open()) {
        GTEST_SKIP() << "no picture can be drawn here";
    }
    const Image agree = draw();
    right().tracked_ws.position += 0.9 * GhostSettings{}.apart_from_m * Vec3::UnitX();
    EXPECT_EQ(compare(draw(), agree, Vec3(0.0, 0.0, -1.0), 0.0).all, 0);
}

TEST_F(GhostPicture, EmptyHandDeepInAWallShinesThroughInItsPlayersViewOnly) {
    add_wall(0.5);
    if (!open()) {
        GTEST_SKIP() << "no picture can be drawn here";
    }
    put(right(), Vec3(0.0, -0.05, 5.0));
    const Image no_hand = draw();
    const Image no_hand_for_others = draw(std::nullopt);
    put(right(), Vec3(0.0, -0.05, -0.75));
    const Differing inside = compare(draw(), no_hand, Vec3(0.0, -0.05, -0.75), k_hand_m);
    EXPECT_GT(inside.all, 300);  // visible from its wrist
    EXPECT_EQ(inside.outside, 0);
    EXPECT_EQ(compare(draw(std::nullopt), no_hand_for_others, Vec3(0.0, 0.0, -1.0), 0.0).all, 0);
    // A gripping hand behind its body is hidden like any object.
    right().grip = GripKind::held;
    EXPECT_EQ(compare(draw(), no_hand, Vec3(0.0, -0.05, -0.75), k_hand_m).all, 0);
}

// Only the player is in the scene: drawing hands' ghosts must not change the picture.
TEST(GhostOfOwnHand, DoesNotShineThroughOwnArmOrOtherHand) {
    Scene scene;
    const PlayerEntities player = add_scene_player(scene, {"player", {}, 80.0});
    PlayerModels without;
    without.ghosts.penetrating = 0.0F;
    std::string why_not;
    auto view = PlayerView::open(scene, {}, k_width_px, k_height_px, why_not);
    auto bare = PlayerView::open(scene, without, k_width_px, k_height_px, why_not);
    if (!view || !bare) {
        GTEST_SKIP() << "no picture can be drawn here";
    }
    FrameCaches caches(scene.shapes(), &scene.grip_meshes());
    StageStats stats;
    Image image;
    Image expected;
    for (int pose = 0; pose < 6; ++pose) {
        // From a fist at the shoulder to an arm stretched up in front of the eyes; the left hand
        // half as far.
        const double reach = 0.2 * pose;
        const Quat points_up = rotation_about(Vec3::UnitX(), 0.6 * reach);
        TrackingSample sample;
        sample.head_ps.position = Vec3(0.0, 1.6, 0.0);
        const auto put = [&](HandSide side, const Pose& hand_ps) {
            sample.controllers[index_of(side)].controller_ps =
                hand_ps * inverse(default_controller_to_hand(side, scene.tuning().hand));
        };
        put(HandSide::right, {Vec3(0.06, 1.40 + 0.2 * reach, -0.3 - 0.35 * reach), points_up});
        put(HandSide::left, {Vec3(0.02, 1.42 + 0.1 * reach, -0.25 - 0.1 * reach), points_up});
        for (int frame = 0; frame < 10; ++frame) {
            sample.t_s = scene.world().clock.t_s + 0.02;
            const PlayerInput input{player.player, {&sample, 1}, {}};
            step_frame(scene.world(), caches, scene.tuning(), {0.02, {&input, 1}}, stats);
        }
        const Pose eyes_ws = scene.world().render_pose.at(player.player).head_ws;
        view->draw(eyes_ws, 1.3, 0, image);
        bare->draw(eyes_ws, 1.3, 0, expected);
        EXPECT_EQ(compare(image, expected, Vec3(0.0, 0.0, -1.0), 0.0).all, 0) << pose;
    }
}

}  // namespace
}  // namespace handhold::ghost_hands_test
