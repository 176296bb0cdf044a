// Bodies that change while hands hold them: mass, kind, material and shape.
#include <array>
#include <cmath>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "tests/random.hpp"
#include "tests/systems/host/host_scene.hpp"

namespace handhold::changed_bodies_test {
namespace {

using namespace test;

// A player who holds a crate in front of the right hand; its face is at z = -0.5.
struct Holding : HostScene {
    hh::Body body{};
    double t_s = 0.0;

    explicit Holding(hh_body_kind kind) {
        hh_body_def def = crate(world, {0.2, 1.4, -0.6});
        def.kind = kind;
        body = *world.add(def);
        closed[HH_RIGHT] = true;
        step(3);
    }
    // The hand moves, and the wrist must stay in its anchor.
    void move(int steps) {
        for (int i = 0; i < steps; ++i) {
            t_s += k_step_s;
            hand_at[HH_RIGHT] = {0.2 + 0.05 * std::sin(3.0 * t_s), 1.4,
                                 -0.43 + 0.04 * std::sin(2.0 * t_s)};
            step();
            EXPECT_LT(hand(HH_RIGHT).error_m, 1e-6);
        }
    }
    // The wrist in the body's frame.
    hh::Pose anchor() const { return hand(HH_RIGHT).anchor; }
};

RC_GTEST_PROP(ChangedBodies, GripsStayWhateverKindAndMassTheBodyGets, (std::uint64_t seed)) {
    Random random(seed);
    constexpr std::array k_kinds = {HH_STATIC, HH_KINEMATIC, HH_DYNAMIC};
    const auto any_kind = [&] {
        return k_kinds[static_cast<std::size_t>(random.between(0.0, 3.0))];
    };
    Holding scene(any_kind());
    RC_ASSERT(scene.hand(HH_RIGHT).body.index == scene.body.index);
    for (int change = 0; change < 4; ++change) {
        scene.move(5);
        const hh::Vec3 anchor = scene.anchor().position;
        const hh_body_kind kind = any_kind();
        const double mass_kg = std::pow(10.0, random.between(-1.0, 4.0));
        RC_ASSERT(static_cast<bool>(scene.world.set_kind(scene.body, kind, mass_kg)));
        RC_ASSERT(static_cast<bool>(scene.world.set_material(scene.body, {0.3, 0.2})));
        scene.move(5);
        const hh_hand_state hand = scene.hand(HH_RIGHT);
        const bool is_held =
            kind == HH_DYNAMIC && mass_kg < *scene.world.tuning("phases.heavy_body_kg");
        RC_ASSERT(hand.grip == (is_held ? HH_GRIP_HELD : HH_GRIP_SURFACE));
        RC_ASSERT(distance_m(hand.anchor.position, anchor) < 1e-6);
        RC_ASSERT(scene.log == "grab right;");
        RC_ASSERT(scene.is_good);
    }
    scene.closed[HH_RIGHT] = false;
    scene.step(2);
    RC_ASSERT(scene.log == "grab right;release right;");
}

RC_GTEST_PROP(ChangedBodies, HeldBodyKeepsGripWithAnyMass, (std::uint64_t seed)) {
    Random random(seed);
    Holding scene(HH_DYNAMIC);
    scene.move(5);
    const hh::Vec3 anchor = scene.anchor().position;
    const double mass_kg = std::pow(10.0, random.between(-3.0, 5.0));
    RC_ASSERT(static_cast<bool>(scene.world.set_mass(scene.body, mass_kg)));
    RC_ASSERT(*scene.world.mass_kg(scene.body) == mass_kg);
    scene.move(20);
    RC_ASSERT(distance_m(scene.anchor().position, anchor) < 1e-6);
    RC_ASSERT(scene.log == "grab right;");
}

// Hulls with the same face under the hand but other centres of mass and principal axes.
RC_GTEST_PROP(ChangedBodies, ShapesWithTheSameFaceChangeWithoutASlip, (std::uint64_t seed)) {
    Random random(seed);
    Holding scene(random.between(0.0, 1.0) < 0.5 ? HH_DYNAMIC : HH_KINEMATIC);
    for (int change = 0; change < 3; ++change) {
        scene.move(4);
        const hh::Pose anchor = scene.anchor();
        const hh::Pose pose = *scene.world.pose(scene.body);
        std::vector<hh::Vec3> points = {
            {-0.1, -0.1, 0.1}, {0.1, -0.1, 0.1}, {0.1, 0.1, 0.1}, {-0.1, 0.1, 0.1}};
        for (int i = 0; i < 5; ++i) {
            const double x = random.between(-0.3, 0.3);
            const double y = random.between(-0.3, 0.3);
            points.push_back({x, y, random.between(-0.5, -0.05)});
        }
        const auto hull = scene.world.add_hull(points);
        RC_ASSERT(static_cast<bool>(hull));
        RC_ASSERT(static_cast<bool>(scene.world.set_shape(scene.body, *hull)));
        RC_ASSERT(scene.world.shape(scene.body)->index == hull->index);
        const hh::Pose now = *scene.world.pose(scene.body);
        RC_ASSERT(distance_m(now.position, pose.position) < 1e-12);
        RC_ASSERT(distance_m(scene.anchor().position, anchor.position) < 1e-9);
        scene.move(6);
        RC_ASSERT(distance_m(scene.anchor().position, anchor.position) < 1e-6);
        RC_ASSERT(scene.log == "grab right;");
        RC_ASSERT(scene.is_good);
    }
}

TEST(ChangedBodies, HandsLeaveASurfaceThatIsGone) {
    for (const bool is_small : {true, false}) {
        Holding scene(HH_KINEMATIC);
        const hh::Shape tiny = *scene.world.add_box({0.01, 0.01, 0.01});
        EXPECT_TRUE(scene.world.set_shape(scene.body, is_small ? tiny : hh::Shape{}));
        scene.hand_at[HH_RIGHT] = {0.2, 1.4, -0.43};
        scene.step(2);
        EXPECT_EQ(scene.log, "grab right;release right by_host;") << is_small;
    }
}

TEST(ChangedBodies, BadNumbersChangeNothing) {
    Holding scene(HH_DYNAMIC);
    const std::uint64_t before = scene.world.hash();
    EXPECT_EQ(scene.world.set_mass(scene.body, -1.0).result(), HH_ERROR_VALUE);
    EXPECT_EQ(scene.world.set_mass(scene.body, std::nan("")).result(), HH_ERROR_VALUE);
    EXPECT_EQ(scene.world.set_material(scene.body, {-1.0, 0.0}).result(), HH_ERROR_VALUE);
    EXPECT_EQ(scene.world.set_material(scene.body, {0.4, 2.0}).result(), HH_ERROR_VALUE);
    EXPECT_EQ(scene.world.set_kind(scene.body, static_cast<hh_body_kind>(7)).result(),
              HH_ERROR_VALUE);
    EXPECT_EQ(scene.world.set_kind(scene.body, HH_DYNAMIC, 0.0).result(), HH_ERROR_VALUE);
    EXPECT_EQ(scene.world.set_shape(scene.body, {}).result(), HH_ERROR_VALUE);
    EXPECT_EQ(scene.world.set_shape(scene.body, {99, 1}).result(), HH_ERROR_HANDLE);
    EXPECT_EQ(scene.world.hash(), before);
    EXPECT_TRUE(scene.world.set_kind(scene.body, HH_STATIC));
    EXPECT_EQ(scene.world.set_mass(scene.body, 1.0).result(), HH_ERROR_STATE);
}

}  // namespace
}  // namespace handhold::changed_bodies_test
