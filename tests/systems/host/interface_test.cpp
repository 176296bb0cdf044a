// Names, events, pausing, saving, rigs and frames of the C interface.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include <gtest/gtest.h>
#include <handhold/ecs.hpp>
#include <handhold/handhold.hpp>
#include <rapidcheck/gtest.h>

#include "tests/systems/host/host_scene.hpp"

namespace handhold::host_interface_test {
namespace {

using namespace test;

double distance_m(const hh::Vec3& a, const hh::Vec3& b) {
    return std::hypot(a.x - b.x, a.y - b.y, a.z - b.z);
}

TEST(HostNames, AreKeptAndFound) {
    HostScene scene;
    const hh::Body wall = scene.add_wall();
    const char* name = nullptr;
    ASSERT_EQ(hh_body_name(scene.world.get(), wall, &name), HH_OK);
    EXPECT_STREQ(name, "wall");
    EXPECT_TRUE(*scene.world.find_body("wall") == wall);
    EXPECT_EQ(scene.world.find_body("window").status().result(), HH_ERROR_NAME);
    hh_body_def twin = hh::body_def();
    twin.name = "wall";
    EXPECT_EQ(scene.world.add(twin).status().result(), HH_ERROR_NAME);
    std::vector<std::byte> saved;
    ASSERT_TRUE(scene.world.save(saved));
    ASSERT_TRUE(scene.world.remove(wall));
    EXPECT_FALSE(scene.world.find_body("wall"));
    ASSERT_TRUE(scene.world.restore(saved));
    ASSERT_EQ(hh_body_name(scene.world.get(), wall, &name), HH_OK);
    EXPECT_STREQ(name, "wall");
}

TEST(HostWrapper, IteratesOverATemporary) {
    HostScene scene;
    scene.step();
    std::size_t valid = 0;
    for (const hh_hand_joint& joint :
         *scene.world.hand_joints(scene.player, HH_RIGHT, HH_SPACE_WORLD)) {
        valid += joint.is_valid ? 1 : 0;
    }
    EXPECT_GT(valid, 20U);
    const auto& hand = *scene.world.hand(scene.player, HH_RIGHT);
    EXPECT_TRUE(hand.is_tracked);
}

TEST(HostSamples, StampsMayDifferFromTheClockByRounding) {
    HostScene scene;
    scene.add_wall();
    for (int frame = 1; frame <= 60; ++frame) {
        hh::Sample sample = scene.sample();
        sample.time_s = frame / 90.0;
        sample.grab[HH_RIGHT] = frame >= 54;
        ASSERT_TRUE(scene.world.step(k_step_s, hh::input(scene.player, {&sample, 1})));
        EXPECT_EQ(scene.world.hand(scene.player, HH_RIGHT)->is_closed, frame >= 54) << frame;
    }
}

// A query that calls back into its world.
struct CallingBack {
    hh_world* world = nullptr;
    hh_result step = HH_OK;
    hh_result add = HH_OK;
    hh_result read = HH_ERROR_INTERNAL;
    int calls = 0;
};
std::uint8_t call_back(void* context, hh_vec3, hh_vec3, const hh_body*, size_t, hh_surface_hit*) {
    auto& self = *static_cast<CallingBack*>(context);
    const hh_body_def def = hh_default_body_def();
    hh_body body{};
    hh_world_stats stats = hh_default_world_stats();
    self.step = hh_world_step(self.world, k_step_s, nullptr, 0);
    self.add = hh_body_add(self.world, &def, &body);
    self.read = hh_world_get_stats(self.world, &stats);
    ++self.calls;
    return false;
}

TEST(HostSurfaces, AQueryMayReadItsWorldButNotChangeIt) {
    HostScene scene;
    CallingBack called{scene.world.get()};
    hh_surface_query query = hh_default_surface_query();
    query.context = &called;
    query.cast_ray = call_back;
    ASSERT_EQ(hh_world_set_surface_query(scene.world.get(), &query), HH_OK);
    scene.closed[HH_RIGHT] = true;
    scene.step(2);
    ASSERT_GT(called.calls, 0);
    EXPECT_EQ(called.step, HH_ERROR_STATE);
    EXPECT_EQ(called.add, HH_ERROR_STATE);
    EXPECT_EQ(called.read, HH_OK);
    EXPECT_NEAR(scene.world.time_s(), 2 * k_step_s, 1e-12);
}

std::uint8_t throw_once(void* context, hh_vec3, hh_vec3, const hh_body*, size_t, hh_surface_hit*) {
    int& calls = *static_cast<int*>(context);
    if (calls++ == 0) {
        throw std::runtime_error("the host's ray failed");
    }
    return false;
}

TEST(HostSurfaces, AQueryThatThrowsFailsOneStep) {
    HostScene scene;
    scene.step();
    int calls = 0;
    hh_surface_query query = hh_default_surface_query();
    query.context = &calls;
    query.cast_ray = throw_once;
    ASSERT_EQ(hh_world_set_surface_query(scene.world.get(), &query), HH_OK);
    hh::Sample sample = scene.sample();
    sample.grab[HH_RIGHT] = true;
    const auto step = [&] {
        sample.time_s = scene.world.time_s() + k_step_s;
        return scene.world.step(k_step_s, hh::input(scene.player, {&sample, 1})).result();
    };
    EXPECT_EQ(step(), HH_ERROR_INTERNAL);
    EXPECT_EQ(step(), HH_OK);
    EXPECT_GT(calls, 0);
}

TEST(HostEvents, SayWhyAGripEnded) {
    HostScene scene;
    const hh::Body wall = scene.add_wall();
    scene.step();
    scene.closed[HH_RIGHT] = true;
    scene.step();
    scene.closed[HH_RIGHT] = false;
    scene.step();
    EXPECT_EQ(scene.log, "grab right;release right;");
    scene.closed[HH_RIGHT] = true;
    scene.step();
    ASSERT_TRUE(scene.world.remove(wall));
    scene.step();
    EXPECT_EQ(scene.log, "grab right;release right;grab right;slip right body_gone;");
}

TEST(HostEvents, LatchesAndLimitsAreReportedOnce) {
    hh::World world;
    hh_body_def panel = crate(world, {0.4, 0.0, 0.0});
    panel.angular_velocity_radps = {0.0, 0.0, 1.0};
    panel.velocity_mps = {0.0, 0.4, 0.0};
    hh_joint_def hinge = hh::joint_def();
    hinge.kind = HH_HINGE;
    hinge.body_b = *world.add(panel);
    hinge.frame.rotation = {0.0, -std::sqrt(0.5), 0.0, std::sqrt(0.5)};  // x becomes z
    hinge.limited = true;
    hinge.lower = -1.0;
    hinge.upper = 0.5;
    const hh::Joint joint = *world.add(hinge);
    int reached = 0;
    for (int i = 0; i < 120; ++i) {
        ASSERT_TRUE(world.step(k_step_s));
        for (const hh::Event& event : world.events()) {
            reached += event.kind == HH_EVENT_LIMIT_REACHED && event.joint == joint ? 1 : 0;
        }
    }
    double angle_rad = 0.0;
    ASSERT_EQ(hh_joint_state(world.get(), joint, &angle_rad, nullptr, nullptr), HH_OK);
    EXPECT_GE(reached, 1);
    EXPECT_LE(reached, 2) << "not in every step that it rests there";
    EXPECT_LT(std::fabs(angle_rad), 1.0 + 1e-6);
}

TEST(HostPause, ShowsHandsWhileTheWorldStandsStill) {
    HostScene scene;
    scene.add_wall();
    const hh::Body thrown = *scene.world.add(crate(scene.world, {3.0, 1.0, 0.0}));
    ASSERT_TRUE(scene.world.set_velocity(thrown, {0.5, 0.0, 0.0}));
    scene.step();
    scene.closed[HH_RIGHT] = true;
    scene.step(3);
    const double x_m = scene.world.pose(thrown)->position.x;
    const double time_s = scene.world.time_s();
    const hh_player_pose before = *scene.world.pose(scene.player);
    scene.hand_at[HH_LEFT].y += 0.3;
    scene.hand_at[HH_RIGHT].z += 0.1;  // less than hand.max_stretch_m
    const hh::Sample now = scene.sample();
    const std::array inputs = {hh::input(scene.player, {&now, 1})};
    for (int i = 0; i < 5; ++i) {
        ASSERT_TRUE(scene.world.step_pose_only(k_step_s, inputs));
    }
    const hh_player_pose paused = *scene.world.pose(scene.player);
    EXPECT_EQ(scene.world.pose(thrown)->position.x, x_m);
    EXPECT_EQ(scene.world.time_s(), time_s);
    EXPECT_EQ(paused.origin.position.z, before.origin.position.z);
    EXPECT_NEAR(paused.hands[HH_LEFT].tracked.position.y,
                before.hands[HH_LEFT].tracked.position.y + 0.3, 1e-12);
    // The hand that stayed closed grips where it is now: the player is not pulled.
    scene.step(3);
    const hh_player_pose after = *scene.world.pose(scene.player);
    EXPECT_EQ(after.hands[HH_RIGHT].grip, HH_GRIP_SURFACE);
    EXPECT_NEAR(after.origin.position.z, before.origin.position.z, 1e-6);
    EXPECT_GT(scene.world.pose(thrown)->position.x, x_m);
}

RC_GTEST_PROP(HostSnapshots, ReplayAfterRestoreIsBitForBitEqual, ()) {
    const int saved_at = *rc::gen::inRange(1, 30);
    const double late_s = *rc::gen::element(0.0, 0.004, 0.02);  // samples of after the step's end
    HostScene scene;
    scene.add_wall();
    const auto run = [&](int from, int to) {
        for (int i = from; i < to; ++i) {
            hh::Sample now = scene.sample();
            now.time_s += late_s;
            now.grab[HH_RIGHT] = i > 10;
            now.hands[HH_RIGHT].position.z += 0.004 * i;
            RC_ASSERT(
                static_cast<bool>(scene.world.step(k_step_s, hh::input(scene.player, {&now, 1}))));
        }
    };
    run(0, saved_at);
    std::vector<std::byte> saved;
    RC_ASSERT(static_cast<bool>(scene.world.save(saved)));
    run(saved_at, 40);
    const std::uint64_t hash = scene.world.hash();
    RC_ASSERT(static_cast<bool>(scene.world.add(crate(scene.world, {0.0, 9.0, 0.0}))));
    RC_ASSERT(hash != scene.world.hash());
    // Shapes are named by content, so the crate's may stay. The crate goes.
    RC_ASSERT(static_cast<bool>(scene.world.restore(saved)));
    std::size_t count = 0;
    RC_ASSERT(hh_world_bodies(scene.world.get(), nullptr, 0, &count) == HH_OK && count == 1);
    run(saved_at, 40);
    RC_ASSERT(hash == scene.world.hash());
}

RC_GTEST_PROP(HostSnapshots, RollbackGivesTheSameHash, ()) {
    const int saved_at = *rc::gen::inRange(1, 30);
    const double late_s = *rc::gen::element(0.0, 0.004, 0.02);
    HostScene scene;
    scene.add_wall();
    const auto run = [&](int from, int to) {
        for (int i = from; i < to; ++i) {
            hh::Sample now = scene.sample();
            now.time_s += late_s;
            now.grab[HH_RIGHT] = i > 10;
            now.hands[HH_RIGHT].position.z += 0.004 * i;
            RC_ASSERT(
                static_cast<bool>(scene.world.step(k_step_s, hh::input(scene.player, {&now, 1}))));
        }
    };
    run(0, saved_at);
    std::vector<std::byte> saved;
    RC_ASSERT(static_cast<bool>(scene.world.save(saved)));
    run(saved_at, 40);
    const std::uint64_t hash = scene.world.hash();
    RC_ASSERT(static_cast<bool>(scene.world.restore(saved)));
    run(saved_at, 40);
    RC_ASSERT(scene.world.hash() == hash);
}

// A host gives each sample once, always a little after the step's end, as headsets predict.
TEST(HostInput, SamplesOfAfterTheStepAreNotLost) {
    HostScene scene;
    for (int i = 0; i < 60; ++i) {
        hh::Sample now = scene.sample();
        now.time_s += 0.003;
        ASSERT_TRUE(scene.world.step(k_step_s, hh::input(scene.player, {&now, 1})));
    }
    EXPECT_TRUE(scene.hand(HH_RIGHT).is_tracked);
}

// The samples are of after the step's end: the world keeps them for the next step.
// Bytes in memory have no file name, and no file is read beside them.
TEST(HostRigs, RefusalsNameTheRigAndWhatIsWrong) {
    HostScene scene;
    const std::string outside =
        R"({"asset":{"version":"2.0"},"buffers":[{"byteLength":4,"uri":"rig.bin"}],)"
        R"("bufferViews":[{"buffer":0,"byteLength":4}],"nodes":[{}]})";
    EXPECT_EQ(
        hh_player_set_body_rig(scene.world.get(), scene.player, outside.data(), outside.size()),
        HH_ERROR_DATA);
    EXPECT_EQ(std::string_view(hh_last_error()).substr(0, 10), "body rig: ") << hh_last_error();
    EXPECT_EQ(hh_player_set_hand_rig(scene.world.get(), scene.player, HH_LEFT, "{}", 2),
              HH_ERROR_DATA);
    EXPECT_EQ(std::string_view(hh_last_error()).substr(0, 10), "hand rig: ") << hh_last_error();
}

TEST(HostGrips, IndexFingerOfAnAuthoredGripFollowsTheTrigger) {
    HostScene scene;
    hh_body_def def = crate(scene.world, {0.2, 1.4, -0.53});
    const hh::Body held = *scene.world.add(def);
    hh_grip_def grip = hh::grip_def();
    hh_grip_hand& hand = grip.hands[HH_RIGHT];
    hand.is_used = true;
    hand.wrist = hh::pose_at({0.0, 0.0, 0.14}, {0.7071067811865476, 0.0, 0.0, 0.7071067811865476});
    for (hh_finger& finger : hand.fingers) {
        finger.is_posed = true;
    }
    hand.fingers[1].follows_trigger = true;
    hand.fingers[1].pressed_curl_rad[0] = 0.8;
    ASSERT_TRUE(scene.world.add_grip(held, grip));
    const auto tip_after = [&](double trigger) {
        for (int i = 0; i < 60; ++i) {
            hh::Sample now = scene.sample();
            now.time_s += 0.003;
            now.trigger[HH_RIGHT] = trigger;
            EXPECT_TRUE(scene.world.step(k_step_s, hh::input(scene.player, {&now, 1})));
        }
        EXPECT_EQ(scene.hand(HH_RIGHT).grip, HH_GRIP_AUTHORED);
        const auto joints = *scene.world.hand_joints(scene.player, HH_RIGHT, HH_SPACE_WORLD);
        return joints[HH_INDEX_TIP].pose.position;
    };
    scene.step();
    scene.closed[HH_RIGHT] = true;
    const hh::Vec3 released = tip_after(0.0);
    const hh::Vec3 half = tip_after(0.5);
    const hh::Vec3 pressed = tip_after(1.0);
    EXPECT_GT(distance_m(released, half), 0.02);
    EXPECT_GT(distance_m(half, pressed), 0.02);
    EXPECT_LT(distance_m(tip_after(0.0), released), 1e-6);
}

TEST(HostShapes, BadMeshesNameTheVertexOrTriangle) {
    const auto error_of = [](const std::vector<float>& xyz, const std::vector<std::uint32_t>& of) {
        const hh::Mesh mesh(xyz, of);
        EXPECT_FALSE(mesh.is_valid());
        return std::string(hh_last_error());
    };
    std::vector<float> xyz = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1};
    EXPECT_NE(error_of(xyz, {0, 1, 2, 0, 4, 1}).find("triangle 1 "), std::string::npos);
    xyz[7] = std::nanf("");
    EXPECT_NE(error_of(xyz, {0, 1, 2}).find("vertex 2 "), std::string::npos);
}

TEST(HostShapes, HullsKeepTheFrameInWhichTheHostMadeThem) {
    hh::World world;
    // A box of 0.2 x 0.4 x 0.6 m whose corner is the host's origin.
    std::vector<hh::Vec3> corners;
    for (const double x : {0.0, 0.2}) {
        for (const double y : {0.0, 0.4}) {
            for (const double z : {0.0, 0.6}) {
                corners.push_back({x, y, z});
            }
        }
    }
    hh_body_def def = hh::body_def();
    def.kind = HH_DYNAMIC;
    def.shape = *world.add_hull(corners);
    def.pose = hh::pose_at({1.0, 2.0, 3.0});
    const hh::Body body = *world.add(def);
    EXPECT_LT(distance_m(world.pose(body)->position, {1.0, 2.0, 3.0}), 1e-9);
    EXPECT_NEAR(std::fabs(world.pose(body)->rotation.w), 1.0, 1e-9);
    ASSERT_TRUE(world.set_velocity(body, {0.0, 0.0, 0.0}, {0.0, 1.0, 0.0}));
    for (int i = 0; i < 90; ++i) {
        ASSERT_TRUE(world.step(k_step_s));
    }
    // It turns about its centre of mass, (1.1, 2.2, 3.3): the corner's distance from it stays.
    const double arm_m = distance_m(world.pose(body)->position, {1.1, 2.2, 3.3});
    EXPECT_NEAR(arm_m, std::hypot(0.1, 0.2, 0.3), 1e-6);
    EXPECT_GT(distance_m(world.pose(body)->position, {1.0, 2.0, 3.0}), 0.1);
    ASSERT_TRUE(world.teleport(body, hh::pose_at({-1.0, 0.0, 0.0})));
    EXPECT_LT(distance_m(world.pose(body)->position, {-1.0, 0.0, 0.0}), 1e-9);
}

TEST(HostBodyClips, MoveLegsAndNeverHandsAndBadOnesChangeNothing) {
    HostScene plain;
    HostScene clipped;
    HostScene refused;
    constexpr std::string_view k_idle =
        R"({"idle": {"keys": [{"at": 0}, {"at": 1, "left_thigh": [30, 0, 0]}, {"at": 2}]}})";
    ASSERT_TRUE(clipped.world.load_body_clips(k_idle));
    EXPECT_EQ(refused.world.load_body_clips(R"({"idle": {"keys": 3}})").result(), HH_ERROR_DATA);
    EXPECT_NE(std::string(hh_last_error()).find("/idle/keys"), std::string::npos);
    const auto joints = [](const HostScene& scene) {
        return *scene.world.body_joints(scene.player, HH_SPACE_WORLD);
    };
    const auto apart_m = [&](const HostScene& a, const HostScene& b, hh_body_joint joint) {
        return distance_m(joints(a)[joint].position, joints(b)[joint].position);
    };
    for (HostScene* const scene : {&plain, &clipped, &refused}) {
        scene->add_wall();
        scene->step(90);
    }
    EXPECT_GT(apart_m(plain, clipped, HH_LEFT_FOOT), 0.1);
    EXPECT_EQ(apart_m(plain, clipped, HH_RIGHT_HAND), 0.0);
    EXPECT_EQ(refused.world.hash(), plain.world.hash());
    ASSERT_TRUE(clipped.world.load_body_clips({}));
    for (HostScene* const scene : {&plain, &clipped}) {
        scene->step();
    }
    EXPECT_LT(apart_m(plain, clipped, HH_LEFT_FOOT), 1e-9);
}

// Two players of one world with hands of different sizes.
TEST(PlayerRigs, TwoPlayersHaveDifferentHands) {
    ShapeLibrary shapes;
    World world;
    std::array<PlayerEntities, 2> players;
    players[0] =
        add_player(world, {.name = "small", .body = {}, .origin_ws = {}, .head_shape = k_no_shape});
    players[1] =
        add_player(world, {.name = "tall", .body = {}, .origin_ws = {}, .head_shape = k_no_shape});
    BodyDescription wall;
    wall.name = "wall";
    wall.pose_ws.position = Vec3(0.0, 1.5, -0.6);
    wall.shape = shapes.add_box(Vec3(2.0, 2.0, 0.1));
    add_body(world, wall);
    const GripMeshLibrary meshes(shapes);
    FrameCaches caches(shapes, &meshes);
    HandRig large = builtin_hand_rig(HandSide::right);
    for (FingerRig& finger : large.fingers) {
        finger.base_hs.position *= 1.5;
        for (std::size_t link = 0; link < k_max_links; ++link) {
            finger.length_m[link] *= 1.5;
        }
    }
    caches.more_hand_rigs.push_back(large);
    world.hand_rig.add(players[1].hands[1], {0});
    StageStats stats;
    for (int frame = 1; frame <= 60; ++frame) {
        TrackingSample sample;
        sample.t_s = world.clock.t_s + k_step_s;
        sample.head_ps.position = Vec3(0.0, 1.6, 0.0);
        for (std::size_t side = 0; side < k_hand_count; ++side) {
            const auto which = static_cast<HandSide>(side);
            const Pose wrist{Vec3(side == 1 ? 0.2 : -0.2, 1.4, -0.43),
                             rotation_about(Vec3::UnitX(), k_half_pi)};
            sample.controllers[side].controller_ps =
                wrist * inverse(default_controller_to_hand(which, HandTuning{}));
            sample.controllers[side].grab = frame > 5;
        }
        const std::array inputs = {PlayerInput{players[0].player, {&sample, 1}, {}},
                                   PlayerInput{players[1].player, {&sample, 1}, {}}};
        step_frame(world, caches, {}, {k_step_s, inputs}, stats);
    }
    EXPECT_EQ(caches.hands.surroundings.size(), 4U);
    const auto rig_of = [&](Entity hand) {
        for (const HandSurroundings& around : caches.hands.surroundings) {
            if (around.hand == hand) {
                return around.rig;
            }
        }
        return static_cast<const HandRig*>(nullptr);
    };
    EXPECT_EQ(rig_of(players[1].hands[1]), caches.more_hand_rigs.data());
    EXPECT_EQ(rig_of(players[0].hands[1]), &caches.hand_rigs[1]);
    const auto& small = world.finger_pose.at(players[0].hands[1]).shown;
    const auto& tall = world.finger_pose.at(players[1].hands[1]).shown;
    EXPECT_NE(small[1].curl_rad, tall[1].curl_rad) << "equal angles for different fingers";
}

// A frame that cannot run changes nothing, whatever part of the world is wrong.
TEST(StepFrame, ChecksEverythingBeforeItChangesAnything) {
    ShapeLibrary shapes;
    World world;
    BodyDescription body;
    body.name = "drifting";
    body.body = {BodyKind::free, 1.0, Vec3::Ones(), 0.0, 0.4};
    body.velocity.linear_mps = Vec3(1.0, 0.0, 0.0);
    body.shape = shapes.add_sphere(0.1);
    const Entity drifting = add_body(world, body);
    FrameCaches caches(shapes);
    StageStats stats;
    step_frame(world, caches, {}, {}, stats);
    const std::uint64_t before = hash_state(world);
    world.collider.at(drifting).shape = {7};  // no such shape
    EXPECT_THROW(step_frame(world, caches, {}, {}, stats), PreconditionError);
    auto triangle = std::make_shared<Mesh>();
    triangle->positions = {{0.0, 0.0, 0.0}, {1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}};
    triangle->triangles = {{0, 1, 2}};
    world.collider.at(drifting).shape = shapes.add_mesh(triangle);  // a mesh cannot be free
    EXPECT_THROW(step_frame(world, caches, {}, {}, stats), PreconditionError);
    world.collider.at(drifting).shape = body.shape;
    world.gravity_mps2.y() = std::nan("");
    EXPECT_THROW(step_frame(world, caches, {}, {}, stats), PreconditionError);
    world.gravity_mps2.setZero();
    EXPECT_EQ(hash_state(world), before);
    step_frame(world, caches, {}, {}, stats);
    EXPECT_NEAR(world.body_pose.at(drifting).pose_ws.position.x(), 2.0 / 90.0, 1e-12);
}

}  // namespace
}  // namespace handhold::host_interface_test
