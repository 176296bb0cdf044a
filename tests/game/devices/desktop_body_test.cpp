// A player at a keyboard reaches for surfaces in view and pulls along them.
#include "game/devices/desktop_body.hpp"

#include <gtest/gtest.h>

#include "tests/game/climber/climber_scene.hpp"

namespace handhold::desktop_body_test {
namespace {

constexpr double k_dt_s = 1.0 / 90.0;

struct Desk {
    Scene scene;
    hh::Player player;
    DesktopBody body;
    DesktopInput input;

    Desk(Scene in, const Vec3& head_ws)
        : scene(std::move(in)),
          player(add_scene_player(scene, "player0",
                                  hh::pose_at(to_host(Vec3(head_ws - Vec3(0.0, 1.6, 0.0)))))) {}

    void step() {
        const double end_s = scene.host.time_s() + k_dt_s;
        const hh::Sample sample = body.advance(scene.host, player, input, end_s, k_dt_s);
        input.turn_left_rad = input.look_up_rad = input.farther_m = 0.0;
        EXPECT_TRUE(scene.host.step(k_dt_s, hh::input(player, {&sample, 1}, body.commands(input))));
    }
    void run(double seconds) {
        for (double t_s = 0.0; t_s < seconds; t_s += k_dt_s) {
            step();
        }
    }
    GripKind grip(HandSide side) const {
        return scene.world()
            .grab.at(player_entities(scene.world(), player).hands[index_of(side)])
            .kind;
    }
    const Vec3& head_ws() const {
        return scene.world().render_pose.at(entity_of(player)).head_ws.position;
    }
};

// Half a metre beside the rail on the tunnel's left wall, looking at the rail ahead.
struct DeskAtRail : Desk {
    DeskAtRail() : Desk(make_tunnel(8.0), Vec3(-0.45, 0.35, 6.0)) {
        run(0.1);
        input.turn_left_rad = 0.9;
        input.look_up_rad = -0.2;
        run(0.3);
    }
};

TEST(DesktopBody, HandReachesForTheSurfaceInView) {
    DeskAtRail desk;
    EXPECT_EQ(desk.grip(HandSide::left), GripKind::none);
    EXPECT_TRUE(desk.body.can_reach());
    desk.input.grip[0] = true;
    desk.run(0.7);
    EXPECT_EQ(desk.grip(HandSide::left), GripKind::surface);
    EXPECT_EQ(desk.grip(HandSide::right), GripKind::none);
    const Vec3 before = desk.head_ws();
    desk.input.turn_left_rad = 3.0;  // looking around moves nobody
    desk.run(0.5);
    EXPECT_FALSE(desk.body.can_reach());
    EXPECT_LT((desk.head_ws() - before).norm(), 1e-6);
}

TEST(DesktopBody, PullsHandOverHandAlongARail) {
    DeskAtRail desk;
    const double from_m = desk.head_ws().z();
    for (int stroke = 0; stroke < 16; ++stroke) {
        const auto side = static_cast<std::size_t>(stroke % 2);
        desk.input.grip[side] = true;
        desk.input.move = {};
        desk.run(0.7);
        desk.input.grip[1 - side] = false;
        // Along the tunnel: ahead and to the right of the view.
        desk.input.move = {0.78, 0.0, -0.62};
        desk.run(0.6);
    }
    EXPECT_GT(from_m - desk.head_ws().z(), 3.0);
    EXPECT_LT(std::abs(desk.head_ws().x() + 0.45), 0.4);
}

TEST(DesktopBody, LettingGoWhilePullingDrifts) {
    DeskAtRail desk;
    desk.input.grip[0] = true;
    desk.run(0.7);
    desk.input.move = {0.78, 0.0, -0.62};
    desk.run(0.3);
    desk.input.grip[0] = false;
    desk.run(0.2);
    const Vec3 velocity = desk.scene.world().player_velocity.at(entity_of(desk.player)).linear_mps;
    EXPECT_NEAR(velocity.norm(), 0.9, 0.15);
    EXPECT_LT(velocity.z(), -0.7);
}

TEST(DesktopBody, EmptyFistDoesNotStopTheOtherHand) {
    DeskAtRail desk;
    desk.input.grip[0] = true;
    desk.run(0.7);
    ASSERT_EQ(desk.grip(HandSide::left), GripKind::surface);
    desk.input.turn_left_rad = -1.2;  // nothing there
    desk.step();
    desk.input.grip[1] = true;
    desk.run(0.8);
    ASSERT_EQ(desk.grip(HandSide::right), GripKind::none);
    const Vec3 before = desk.head_ws();
    desk.input.move = {0.0, 0.0, -1.0};
    desk.run(0.4);
    EXPECT_GT((desk.head_ws() - before).norm(), 0.25);
}

TEST(DesktopBody, JetsThrustInTheViewDirection) {
    Desk desk(make_void(), Vec3::Zero());
    desk.scene.tuning().locomotion.thruster_mps2 = 1.0;
    desk.input.turn_left_rad = 1.5707963267948966;  // along -x
    desk.step();
    desk.input.move = -hh::k_z;
    desk.run(0.5);
    const Vec3 velocity = desk.scene.world().player_velocity.at(entity_of(desk.player)).linear_mps;
    EXPECT_NEAR(velocity.x(), -0.5, 0.05);
    EXPECT_NEAR(velocity.z(), 0.0, 1e-9);
}

TEST(DesktopBody, CarriesALooseBodyWhileLookingAround) {
    Scene scene = make_void();
    BodyDescription box;
    box.name = "box";
    box.shape = scene.shapes().add_box(Vec3::Constant(0.05));
    box.body = {BodyKind::free, 2.0, Vec3::Constant(0.01), 0.0};
    box.pose_ws.position = Vec3(0.0, 0.0, -0.6);
    scene.body_names.emplace_back("box");
    const Entity body = add_body(scene.world(), box);
    Desk desk(std::move(scene), Vec3::Zero());
    desk.run(0.1);
    desk.input.grip[1] = true;
    desk.run(0.8);
    ASSERT_EQ(desk.grip(HandSide::right), GripKind::held);
    for (int i = 0; i < 45; ++i) {
        desk.input.turn_left_rad = 1.5707963267948966 / 45.0;
        desk.step();
    }
    desk.run(0.1);
    const Vec3 place = desk.scene.world().body_pose.at(body).pose_ws.position;
    EXPECT_LT(place.x(), -0.4);  // the view is along -x now
    EXPECT_LT(desk.head_ws().norm(), 0.05);
}

}  // namespace
}  // namespace handhold::desktop_body_test
