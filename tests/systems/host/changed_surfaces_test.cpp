// Surfaces and shapes that change while hands are on them or near them, and the ids of shapes.
#include <array>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>
#include <handhold/handhold.hpp>
#include <handhold/math.hpp>
#include <rapidcheck/gtest.h>

#include "tests/random.hpp"
#include "tests/systems/host/host_scene.hpp"

namespace handhold::changed_surfaces_test {
namespace {

using namespace test;

using Joints = std::array<hh_hand_joint, HH_HAND_JOINT_COUNT>;

Joints joints_of(const HostScene& scene, hh::Side side) {
    Joints joints{};
    EXPECT_EQ(
        hh_player_hand_joints(scene.world.get(), scene.player, side, HH_SPACE_WORLD, joints.data()),
        HH_OK);
    return joints;
}

// A plate of cells x cells squares with 0.6 m edges, around the origin; its face looks along +z.
hh::Mesh plate(std::uint32_t cells, double bump_m) {
    std::vector<float> xyz;
    std::vector<std::uint32_t> indices;
    for (std::uint32_t row = 0; row <= cells; ++row) {
        for (std::uint32_t column = 0; column <= cells; ++column) {
            xyz.push_back(0.6F * (static_cast<float>(column) / static_cast<float>(cells) - 0.5F));
            xyz.push_back(0.6F * (static_cast<float>(row) / static_cast<float>(cells) - 0.5F));
            xyz.push_back(static_cast<float>(bump_m));
        }
    }
    for (std::uint32_t row = 0; row < cells; ++row) {
        for (std::uint32_t column = 0; column < cells; ++column) {
            const std::uint32_t corner = row * (cells + 1) + column;
            for (const std::uint32_t index : {corner, corner + 1, corner + cells + 2, corner,
                                              corner + cells + 2, corner + cells + 1}) {
                indices.push_back(index);
            }
        }
    }
    return hh::Mesh(xyz, indices);
}

// A body without a shape in front of the right hand; its surface is at z = -0.5.
struct Plated : HostScene {
    hh::Body body{};

    explicit Plated(std::uint32_t cells) {
        hh_body_def def = hh::body_def();
        def.kind = HH_KINEMATIC;
        def.pose.position = {0.2, 1.4, -0.5};
        body = *world.add(def);
        set(cells, 0.0);
    }
    void set(std::uint32_t cells, double bump_m) {
        const hh::Mesh mesh = plate(cells, bump_m);
        is_good = is_good && world.set_surface(body, mesh);
    }
    hh_result hold() {
        step();  // the hand is known then
        return hh_hand_hold(world.get(), player, HH_RIGHT, body, nullptr);
    }
};

// Triangles of a hand's surface may not exist in the new mesh.
RC_GTEST_PROP(ChangedSurfaces, HandsFollowAnySurfaceTheirBodyGets, (std::uint64_t seed)) {
    Random random(seed);
    Plated scene(40);
    const bool is_authored = random.between(0.0, 1.0) < 0.5;
    if (is_authored) {
        hh_grip_def grip = hh::grip_def();
        grip.hands[HH_RIGHT].is_used = true;
        grip.hands[HH_RIGHT].wrist = hh::pose_at({0.0, 0.0, 0.07}, k_palm_ahead);
        RC_ASSERT(static_cast<bool>(scene.world.add_grip(scene.body, grip)));
    }
    RC_ASSERT(scene.hold() == HH_OK);
    scene.closed[HH_RIGHT] = true;
    scene.step(5);
    RC_ASSERT(scene.hand(HH_RIGHT).grip != HH_GRIP_NONE);
    for (int change = 0; change < 4; ++change) {
        const auto cells = static_cast<std::uint32_t>(random.between(1.0, 40.0));
        scene.set(cells, random.between(-0.01, 0.01));
        scene.step(3);
        RC_ASSERT(scene.is_good);
        RC_ASSERT(scene.hand(HH_RIGHT).grip != HH_GRIP_NONE);
    }
}

// The new mesh has as many triangles as the old one.
TEST(ChangedSurfaces, HandsAreFittedAgainToADeformedSurface) {
    Plated scene(8);
    ASSERT_EQ(scene.hold(), HH_OK);
    scene.closed[HH_RIGHT] = true;
    scene.step(30);
    const hh::Vec3 before = joints_of(scene, HH_RIGHT)[HH_HAND_PALM].pose.position;
    constexpr double k_bump_m = 0.02;
    scene.set(8, k_bump_m);
    scene.step(60);
    const hh::Vec3 after = joints_of(scene, HH_RIGHT)[HH_HAND_PALM].pose.position;
    EXPECT_GT(after.z - before.z, 0.5 * k_bump_m);
    EXPECT_LT(after.z - before.z, 1.5 * k_bump_m);
    EXPECT_TRUE(scene.is_good);
}

// A hand on one body does not move when another one changes.
RC_GTEST_PROP(ChangedSurfaces, HandsElsewhereKeepTheirPose, (std::uint64_t seed)) {
    Random random(seed);
    std::array<HostScene, 2> scenes;
    std::array<hh::Body, 2> doors{};
    for (std::size_t i = 0; i < 2; ++i) {
        scenes[i].add_wall();
        hh_body_def door = crate(scenes[i].world, {3.0, 1.4, -0.6});
        door.kind = HH_KINEMATIC;
        doors[i] = *scenes[i].world.add(door);
        scenes[i].closed[HH_RIGHT] = true;
        scenes[i].hand_at[HH_RIGHT].x += random.between(-1.0, 1.0) * (i == 0 ? 0.05 : 0.0);
        scenes[i].hand_at[HH_RIGHT] = scenes[0].hand_at[HH_RIGHT];
        scenes[i].step(10);
    }
    RC_ASSERT(scenes[0].hand(HH_RIGHT).grip == HH_GRIP_SURFACE);
    for (int change = 0; change < 3; ++change) {
        const double size_m = random.between(0.05, 0.2);
        RC_ASSERT(static_cast<bool>(
            scenes[1].world.set_shape(doors[1], *scenes[1].world.add_box({0.1, size_m, 0.1}))));
        for (int frame = 0; frame < 5; ++frame) {
            scenes[0].step();
            scenes[1].step();
            const Joints a = joints_of(scenes[0], HH_RIGHT);
            const Joints b = joints_of(scenes[1], HH_RIGHT);
            for (std::size_t i = 0; i < a.size(); ++i) {
                RC_ASSERT(a[i].pose.position == b[i].pose.position);
                RC_ASSERT(a[i].pose.rotation == b[i].pose.rotation);
            }
        }
    }
}

// An order for a hand stays if the body that it holds changes before the step.
TEST(ChangedSurfaces, AnOrderOfTheHostStays) {
    HostScene scene;
    hh_body_def def = crate(scene.world, {0.2, 1.4, -0.6});
    def.kind = HH_KINEMATIC;
    std::array<hh::Body, 2> bodies{};
    bodies[0] = *scene.world.add(def);
    def.pose.position.x += 0.02;
    bodies[1] = *scene.world.add(def);
    scene.closed[HH_RIGHT] = true;
    scene.step(3);
    const hh::Body held = scene.hand(HH_RIGHT).body;
    ASSERT_TRUE(held.index == bodies[0].index || held.index == bodies[1].index);
    const hh::Body other = held.index == bodies[0].index ? bodies[1] : bodies[0];
    ASSERT_EQ(hh_hand_grip(scene.world.get(), scene.player, HH_RIGHT, other), HH_OK);
    ASSERT_TRUE(scene.world.set_shape(held, hh::Shape{}));
    scene.step();
    EXPECT_EQ(scene.hand(HH_RIGHT).grip, HH_GRIP_SURFACE);
    EXPECT_EQ(scene.hand(HH_RIGHT).body.index, other.index);
}

// A wheel that the host turns about its centre gets a shape with another centre of mass: who hangs
// on it leaves it at the speed of the same point.
RC_GTEST_PROP(ChangedSurfaces, ThePivotOfAMovedBodyChangesNoSpeed, (std::uint64_t seed)) {
    Random random(seed);
    const double rate_radps = random.between(0.3, 1.5);
    const std::array<double, 2> masses_kg = {1.0, random.between(1.0, 20.0)};
    std::array<double, 2> left_mps{};
    for (std::size_t i = 0; i < 2; ++i) {
        HostScene scene;
        hh_body_def def = hh::body_def();
        def.kind = HH_KINEMATIC;
        def.shape = *scene.world.add_box({1.0, 1.0, 0.1});
        def.pose.position = {0.0, 1.4, -0.6};
        const hh::Body wheel = *scene.world.add(def);
        scene.hand_at[HH_RIGHT] = {0.8, 1.4, -0.43};
        scene.closed[HH_RIGHT] = true;
        scene.step(3);
        int frame = 0;
        const auto turn = [&](int steps) {
            for (const int end = frame + steps; frame < end;) {
                const double half_rad = 0.5 * rate_radps * ++frame * k_step_s;
                const hh::Pose told = hh::pose_at(
                    def.pose.position, {0.0, 0.0, std::sin(half_rad), std::cos(half_rad)});
                RC_ASSERT(static_cast<bool>(scene.world.move_kinematic(wheel, told)));
                scene.step();
            }
        };
        turn(20);
        RC_ASSERT(scene.hand(HH_RIGHT).grip == HH_GRIP_SURFACE);
        if (i == 1) {  // the same plate in two halves, of which one is heavier
            const hh::Shape half = *scene.world.add_box({0.5, 1.0, 0.1});
            const std::array<hh_compound_part, 2> parts = {
                hh_compound_part{half, hh::pose_at({-0.5, 0.0, 0.0}, {0.0, 0.0, 0.0, 1.0}),
                                 masses_kg[0]},
                hh_compound_part{half, hh::pose_at({0.5, 0.0, 0.0}, {0.0, 0.0, 0.0, 1.0}),
                                 masses_kg[1]}};
            hh::Shape compound{};
            RC_ASSERT(hh_shape_add_compound(scene.world.get(), parts.data(), parts.size(),
                                            &compound) == HH_OK);
            RC_ASSERT(static_cast<bool>(scene.world.set_shape(wheel, compound)));
        }
        scene.closed[HH_RIGHT] = false;
        turn(2);
        RC_ASSERT(scene.hand(HH_RIGHT).grip == HH_GRIP_NONE);
        left_mps[i] = hh::length(scene.world.pose(scene.player)->velocity_mps);
    }
    RC_ASSERT(left_mps[0] > 0.5 * rate_radps * 0.8);
    RC_ASSERT(std::abs(left_mps[1] - left_mps[0]) < 0.02 * left_mps[0]);
}

// --- Shapes of heads -----------------------------------------------------------------------------

// Heads of players of another size may get the index of a removed shape.
TEST(HostShapes, IdsOfRemovedShapesStayInvalidWhateverIsAdded) {
    HostScene scene;
    for (int round = 1; round <= 10; ++round) {
        const std::array<hh::Vec3, 4> corners = {hh::Vec3{0.0, 0.0, 0.0}, hh::Vec3{0.3, 0.0, 0.0},
                                                 hh::Vec3{0.0, 0.2, 0.0}, hh::Vec3{0.0, 0.0, 0.1}};
        const hh::Shape hull = *scene.world.add_hull(corners);
        ASSERT_EQ(hh_shape_remove(scene.world.get(), hull), HH_OK);
        scene.step();
        hh_player_def def = hh::player_def();
        def.scale = 1.0 + 0.1 * round;
        const hh::Player other = *scene.world.add(def);
        EXPECT_FALSE(hh_shape_is_valid(scene.world.get(), hull));
        EXPECT_EQ(hh_shape_remove(scene.world.get(), hull), HH_ERROR_HANDLE);
        ASSERT_TRUE(scene.world.remove(other));
        scene.step();
    }
    EXPECT_TRUE(scene.is_good);
}

TEST(HostShapes, PlayersOfEveryScaleGetAHead) {
    for (const double radius_m : {0.02, 0.05, 0.5}) {
        HostScene scene;
        ASSERT_TRUE(scene.world.tune("head.radius_m", radius_m));
        for (const double scale : {0.01, 0.03, 1.0, 100.0}) {
            hh_player_def def = hh::player_def();
            def.scale = scale;
            EXPECT_TRUE(scene.world.add(def)) << radius_m << ' ' << scale;
        }
    }
}

}  // namespace
}  // namespace handhold::changed_surfaces_test
