// The playground's session works every contraption.
#include <algorithm>
#include <map>
#include <string>

#include <gtest/gtest.h>

#include "game/levels/built_in_scenes.hpp"
#include "game/run/session_run.hpp"

namespace handhold::playground_test {
namespace {

struct Span {
    double low = 0.0;
    double high = 0.0;
};

class Playground : public ::testing::Test {
  public:
    Playground() {
        scene.emplace(*make_built_in_scene("playground"));
        const PlayerEntities player =
            add_scene_player(*scene, {"player", from_host(scene->spawns.front().pose_ws), 80.0});
        const Recording recording = *make_built_in_session("playground");
        log = run_session(*scene, player_ids({&player, 1}), &recording, {},
                          [this](const Scene&, const FrameLog& frame) { watch(frame); });
    }

    Entity find(const std::string& name) const {
        return find_by_id(scene->world(), persistent_id_from_name(name));
    }
    Span span_of(const std::string& joint) { return spans[find(joint)]; }

    std::optional<Scene> scene;
    RunLog log;
    double worst_joint_m = 0.0;
    double worst_joint_rad = 0.0;
    double pushed_off_mps = 0.0;
    // The right hand on the gun: frames by reported grip, and the view's travel in them.
    std::map<GripKind, int> on_gun;
    double gun_in_hand_m = 0.0;  // last distance of the gun from its place in the grip

  private:
    void watch(const FrameLog& frame) {
        const World& world = scene->world();
        for (std::size_t row = 0; row < world.joint.size(); ++row) {
            Span& span = spans[world.joint.owners()[row]];
            span.low = std::min(span.low, world.joint_state.elements()[index].coordinate);
            span.high = std::max(span.high, world.joint_state.elements()[index].coordinate);
        }
        watch_gun(world);
        worst_joint_m = std::max(worst_joint_m, frame.stats.joint_error_m);
        worst_joint_rad = std::max(worst_joint_rad, frame.stats.joint_error_rad);
        pushed_off_mps =
            std::max(pushed_off_mps, world.player_velocity.elements()[0].linear_mps.z());
    }

    void watch_gun(const World& world) {
        const Entity player = world.player.owners()[0];
        for (std::size_t row = 0; row < world.hand_owner.size(); ++row) {
            const Entity hand = world.hand_owner.owners()[row];
            const Grab& grab = world.grab.at(hand);
            if (world.hand_owner.elements()[index].side == HandSide::left ||
                grab.body != find("gun")) {
                continue;
            }
            const RenderPose::Hand& shown = world.render_pose.at(player).hands[1];
            ++on_gun[shown.grip];
            if (shown.grip == GripKind::authored) {
                const Vec3 wrist_ws =
                    transform_point(world.body_pose.at(grab.body).pose_ws,
                                    world.authored_hold.at(hand).hand.wrist_bs.position);
                gun_in_hand_m = (wrist_ws - shown.tracked_ws.position).norm();
            }
        }
    }

    struct BySlot {
        bool operator()(Entity x, Entity y) const { return x.slot < y.slot; }
    };
    std::map<Entity, Span, BySlot> spans;
};

TEST_F(Playground, SessionWorksEveryContraptionAndJointsHold) {
    EXPECT_GT(span_of("lever_hinge").high, 0.8);
    EXPECT_GT(span_of("drawer_slide_1").high, 0.15);
    EXPECT_GT(span_of("pivot").high, 0.5);
    EXPECT_LT(span_of("door_hinge").low, -0.8);
    EXPECT_GT(span_of("valve_hinge").high, 1.5);
    EXPECT_GT(span_of("cable/joint/20").high, 0.02);
    // The push, a smooth 0.24 m in 0.8 s, reaches 0.45 m/s.
    EXPECT_GT(pushed_off_mps, 0.4) << "the rock did not push";
    EXPECT_LE(worst_joint_m, 1e-6);
    EXPECT_LE(worst_joint_rad, 1e-5);
    EXPECT_EQ(scene->world().joint.size(), 48U);
}

// Talk row 10: 5 s by the handle, then 1.2 s by its back, where no authored grip is near.
TEST_F(Playground, GunIsTakenByItsHandleAndFartherOffByItsSurface) {
    EXPECT_NEAR(on_gun[GripKind::authored], 450, 3);
    EXPECT_NEAR(on_gun[GripKind::held], 108, 3);
    EXPECT_LT(gun_in_hand_m, 1e-4);
}

}  // namespace
}  // namespace handhold::playground_test
