#include "systems/grab/update_grabs.hpp"

#include <algorithm>
#include <memory>
#include <vector>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "components/play_space.hpp"
#include "tests/systems/grab/closing_hands.hpp"

namespace handhold::update_grabs_test {
namespace {

TEST(UpdateGrabs, ClosingHandGripsTheSurfaceUnderItsPalm) {
    Grabs grabs;
    grabs.add_floor(1.0);
    grabs.close(k_right, Vec3(0.3, 1.05, -0.2));
    grabs.run();
    const Grab& grab = grabs.grab.at(k_right);
    EXPECT_EQ(grab.kind, GripKind::surface);
    EXPECT_EQ(grab.phase, GrabPhase::fresh);
    EXPECT_EQ(grab.body, k_wall);
    // Straight below the palm, on the box's top, half a metre above its centre.
    EXPECT_LT((grab.hit_bs - Vec3(0.3, 0.5, -0.2)).norm(), 1e-9);
    EXPECT_LT((grab.hit_normal_bs - Vec3::UnitY()).norm(), 1e-9);
    EXPECT_EQ(grabs.stats.grab_onsets, 1U);
    EXPECT_EQ(grabs.stats.grabs_gripped, 1U);
    EXPECT_EQ(count_of_all(grabs.stats), 0U);
    EXPECT_EQ(grabs.grab.at(k_left).kind, GripKind::none);
}

TEST(UpdateGrabs, RayBeginsBehindThePalmSoThatASunkPalmGripsToo) {
    Grabs grabs;
    grabs.add_floor(1.0);
    grabs.close(k_right, Vec3(0.0, 1.0 - 0.9 * grabs.tuning.hand.ray_back_m, 0.0));
    grabs.run();
    EXPECT_LT((grabs.grab.at(k_right).hit_bs - Vec3(0.0, 0.5, 0.0)).norm(), 1e-9);
}

TEST(UpdateGrabs, WhereTheRayMissesTheNearestSurfaceInReachIsGripped) {
    Grabs grabs;
    grabs.add_floor(1.0);
    // The palm looks up, away from the floor 6 cm below it.
    grabs.close(k_left, Vec3(0.5, 1.06, 0.0), rotation_about(Vec3::UnitZ(), k_pi));
    grabs.run();
    const Grab& grab = grabs.grab.at(k_left);
    EXPECT_EQ(grab.kind, GripKind::surface);
    EXPECT_LT((grab.hit_bs - Vec3(0.5, 0.5, 0.0)).norm(), 1e-9);
    EXPECT_LT((grab.hit_normal_bs - Vec3::UnitY()).norm(), 1e-9);
}

// A bar beside the palm, off the palm ray, which hits the panel behind it.
struct BarBesideThePalm {
    Grabs grabs;
    double distance_m;  // of the bar from the palm

    BarBesideThePalm(Random& random, double half_m, double from_m, double to_m)
        : grabs(random.pose(5.0)), distance_m(random.between(from_m, to_m)) {
        constexpr Entity k_bar = k_rock;
        grabs.add_floor(1.0);
        const double x = random.between(-0.5, 0.5);
        const Vec3 palm(x, 1.03, random.between(-0.5, 0.5));
        const Quat turn = rotation_about(Vec3::UnitY(), random.between(-k_pi, k_pi));
        const Vec3 center = palm + turn * Vec3((distance_m + half_m), 0.0, 0.0);
        grabs.add_body(k_bar, {BodyKind::fixed, 0.0, Vec3::Zero(), 0.0},
                       grabs.shapes.add_box(Vec3(half_m, half_m, 0.6)), {center, turn});
        const double yaw = random.between(-k_pi, k_pi);
        grabs.close(k_right, palm, rotation_about(Vec3::UnitY(), yaw));
    }
};

TEST(UpdateGrabs, RailWithinThreeCentimetresIsPreferredToThePanelUnderThePalm) {
    Random random(4901);
    for (int i = 0; i < 200; ++i) {
        BarBesideThePalm near(random, 0.016, 0.004, 0.0299);
        near.grabs.run();
        EXPECT_EQ(near.grabs.grab.at(k_right).body, k_rock) << near.distance_m;
        BarBesideThePalm far(random, 0.016, 0.0301, 0.06);
        far.grabs.run();
        EXPECT_EQ(far.grabs.grab.at(k_right).body, k_wall) << far.distance_m;
        BarBesideThePalm block(random, 0.07, 0.004, 0.03);
        block.grabs.run();
        EXPECT_EQ(block.grabs.grab.at(k_right).body, k_wall) << "fingers cannot go round a block";
    }
}

// A floor and a wall of one triangle mesh: the inner corner is no edge that fingers go round.
TEST(UpdateGrabs, RailIsPreferredInTheInnerCornerOfAMeshToo) {
    Mesh room;
    room.positions = {{-1.0, 1.0, -1.0}, {1.0, 1.0, -1.0}, {1.0, 1.0, 1.0},
                      {-1.0, 1.0, 1.0},  {1.0, 2.0, -1.0}, {1.0, 2.0, 1.0}};
    room.triangles = {{0, 2, 1}, {0, 3, 2}, {1, 2, 4}, {2, 5, 4}};
    for (const double from_wall_m : {0.025, 0.03, 0.035, 0.04}) {
        Grabs grabs;
        grabs.add_body(k_wall, {BodyKind::fixed, 0.0, Vec3::Zero(), 0.0},
                       grabs.shapes.add_mesh(std::make_shared<const Mesh>(room)), {});
        const Vec3 palm(1.0 - from_wall_m, 1.03, 0.0);
        grabs.add_body(k_rock, {BodyKind::fixed, 0.0, Vec3::Zero(), 0.0},
                       grabs.shapes.add_box(Vec3(0.016, 0.016, 0.6)),
                       {palm - Vec3(0.036, 0.0, 0.0), Quat::Identity()});
        grabs.close(k_right, palm);
        grabs.run();
        EXPECT_EQ(grabs.grab.at(k_right).body, k_rock) << from_wall_m;
    }
}

TEST(UpdateGrabs, PanelOfHigherPriorityIsPreferredToARail) {
    Random random(4902);
    BarBesideThePalm bar(random, 0.016, 0.01, 0.02);
    bar.grabs.grab_rule.add(k_wall).priority = 1;
    bar.grabs.run();
    EXPECT_EQ(bar.grabs.grab.at(k_right).body, k_wall);
}

TEST(UpdateGrabs, NothingInReachIsCountedAndGripsNothing) {
    Grabs grabs;
    grabs.add_floor(1.0);
    grabs.close(k_left, Vec3(0.5, 1.0 + grabs.tuning.hand.reach_m + 0.001, 0.0),
                rotation_about(Vec3::UnitZ(), k_pi));
    grabs.run();
    EXPECT_EQ(grabs.grab.at(k_left).kind, GripKind::none);
    EXPECT_EQ(count_of(grabs.stats, Fallback::grab_no_surface), 1U);
    EXPECT_EQ(grabs.stats.grab_onsets, 1U);
    EXPECT_EQ(grabs.stats.grabs_gripped, 0U);
}

TEST(UpdateGrabs, HandGripsWhereItWasAtTheEdgeNotAtTheFramesEnd) {
    Grabs grabs;
    grabs.add_floor(1.0);
    grabs.close(k_right, Vec3(0.3, 1.05, 0.0));
    grabs.hand.at(k_right).pose_ps = {Vec3(0.0, 5.0, 0.0), Quat::Identity()};
    grabs.run();
    EXPECT_LT((grabs.grab.at(k_right).hit_bs - Vec3(0.3, 0.5, 0.0)).norm(), 1e-9);
}

TEST(UpdateGrabs, KindOfGripFollowsFromTheBody) {
    const double heavy_kg = PhaseTuning{}.heavy_body_kg;
    const std::vector<std::pair<RigidBody, GripKind>> cases = {
        {{BodyKind::fixed, 0.0, Vec3::Zero(), 0.0}, GripKind::surface},
        {{BodyKind::kinematic, 0.0, Vec3::Zero(), 0.0}, GripKind::surface},
        {{BodyKind::free, 0.999 * heavy_kg, Vec3::Constant(1.0), 0.0}, GripKind::held},
        {{BodyKind::free, heavy_kg, Vec3::Constant(1.0), 0.0}, GripKind::surface}};
    for (const auto& [rigid, kind] : cases) {
        Grabs grabs;
        grabs.add_body(k_rock, rigid, grabs.shapes.add_sphere(0.08),
                       {Vec3(0.0, 1.0, 0.0), Quat::Identity()});
        grabs.close(k_right, Vec3(0.0, 1.1, 0.0));
        grabs.run();
        EXPECT_EQ(grabs.grab.at(k_right).kind, kind) << rigid.mass_kg;
        const bool ignored = grabs.head_ignores.at(k_player).bodies[0] == k_rock;
        EXPECT_EQ(ignored, kind == GripKind::held);
    }
}

TEST(UpdateGrabs, HeadsAreNothingToHoldOnTo) {
    Grabs grabs;
    grabs.add_head(Vec3(0.0, 1.0, 0.0));
    grabs.close(k_right, Vec3(0.0, 1.13, 0.0));
    grabs.run();
    EXPECT_EQ(grabs.grab.at(k_right).kind, GripKind::none);
    EXPECT_EQ(count_of(grabs.stats, Fallback::grab_no_surface), 1U);
}

TEST(UpdateGrabs, HeadInTheWayHidesNoSurface) {
    // Along the ray, the head's top is at 1.06 m and the floor at 1.0 m.
    Grabs behind;
    behind.add_floor(1.0);
    behind.add_head(Vec3(0.0, 0.95, 0.0));
    behind.close(k_right, Vec3(0.0, 1.1, 0.0));
    behind.run();
    EXPECT_EQ(behind.grab.at(k_right).body, k_wall);
    EXPECT_LT((behind.grab.at(k_right).hit_bs - Vec3(0.0, 0.5, 0.0)).norm(), 1e-9);

    // beside the palm and nearer than the floor
    Grabs beside;
    beside.add_floor(1.0);
    beside.add_head(Vec3(0.14, 1.08, 0.0));
    beside.close(k_right, Vec3(0.0, 1.08, 0.0), rotation_about(Vec3::UnitZ(), k_pi));
    beside.run();
    EXPECT_EQ(beside.grab.at(k_right).body, k_wall);
}

TEST(UpdateGrabs, OpeningHandIsReleasingWithItsGripUnchanged) {
    Grabs grabs;
    grabs.add_floor(1.0);
    grabs.close(k_right, Vec3(0.3, 1.05, 0.0));
    grabs.run();
    grabs.grab.at(k_right).phase = GrabPhase::holding;
    grabs.hand.at(k_right).edge = GrabEdge::release;
    grabs.run();
    EXPECT_EQ(grabs.grab.at(k_right).phase, GrabPhase::releasing);
    EXPECT_EQ(grabs.grab.at(k_right).body, k_wall);
    EXPECT_EQ(count_of_all(grabs.stats), 0U);
}

TEST(UpdateGrabs, WithoutAnEdgeNothingChanges) {
    Grabs grabs;
    grabs.add_floor(1.0);
    grabs.close(k_right, Vec3(0.3, 1.05, 0.0));
    grabs.run();
    for (const Entity hand : {k_left, k_right}) {
        grabs.hand.at(hand).edge = GrabEdge::none;
        grabs.grab.at(hand).phase = hand == k_right ? GrabPhase::holding : GrabPhase::none;
    }
    grabs.run();
    EXPECT_EQ(grabs.grab.at(k_right).phase, GrabPhase::holding);
    EXPECT_EQ(grabs.grab.at(k_left).kind, GripKind::none);
    EXPECT_EQ(grabs.stats.grab_onsets, 0U);
}

TEST(UpdateGrabs, HandLetsGoOfABodyThatIsGone) {
    Grabs grabs;
    grabs.add_rock(k_rock, 5.0, Vec3(0.0, 1.0, 0.0));
    grabs.close(k_right, Vec3(0.0, 1.1, 0.0));
    grabs.run();
    ASSERT_EQ(grabs.grab.at(k_right).kind, GripKind::held);
    grabs.hand.at(k_right).edge = GrabEdge::none;
    grabs.body.remove(k_rock);
    grabs.body_pose.remove(k_rock);
    grabs.persistent_id.remove(k_rock);
    grabs.proxies.clear();
    grabs.run();
    EXPECT_EQ(grabs.grab.at(k_right).kind, GripKind::none);
    EXPECT_EQ(grabs.grab.at(k_right).phase, GrabPhase::none);
    EXPECT_EQ(count_of(grabs.stats, Fallback::grip_body_gone), 1U);
}

TEST(UpdateGrabs, HandLetsGoWhereItIsStretchedFartherThanAllowed) {
    for (const double excess_m : {-0.001, 0.001}) {
        Grabs grabs;
        grabs.add_floor(1.0);
        grabs.close(k_right, Vec3(0.3, 1.05, 0.0));
        grabs.run();
        grabs.hand.at(k_right).edge = GrabEdge::none;
        grabs.grab.at(k_right).error_m = grabs.tuning.hand.max_stretch_m + excess_m;
        grabs.run();
        const bool lets_go = excess_m > 0.0;
        EXPECT_EQ(grabs.grab.at(k_right).kind == GripKind::none, lets_go);
        EXPECT_EQ(count_of(grabs.stats, Fallback::grip_stretched), lets_go ? 1U : 0U);
    }
}

// The hand that is stretched more releases; if equal, the hand that closed later; if they closed at
// the same time, the left one. The order of rows must not matter.
TEST(UpdateGrabs, OfTwoStretchedHandsOnlyOneLetsGo) {
    struct Case {
        double left_more_m;
        double left_later_s;
        Entity lets_go;
    };
    for (const Case& one :
         {Case{0.02, -0.5, k_left}, Case{-0.02, 0.5, k_right}, Case{0.0, 0.5, k_left},
          Case{0.0, -0.5, k_right}, Case{0.0, 0.0, k_left}}) {
        for (const auto& hands : {std::initializer_list<Entity>{k_left, k_right},
                                  std::initializer_list<Entity>{k_right, k_left}}) {
            Grabs grabs({}, hands);
            grabs.add_floor(1.0);
            grabs.close(k_left, Vec3(-0.3, 1.05, 0.0));
            grabs.close(k_right, Vec3(0.3, 1.05, 0.0));
            grabs.run();
            for (const Entity hand : hands) {
                grabs.hand.at(hand).edge = GrabEdge::none;
                Grab& grab = grabs.grab.at(hand);
                grab.error_m = grabs.tuning.hand.max_stretch_m + 0.03;
                grab.since_s = 1.0;
                if (hand == k_left) {
                    grab.error_m += one.left_more_m;
                    grab.since_s += one.left_later_s;
                }
            }
            grabs.run();
            EXPECT_EQ(count_of(grabs.stats, Fallback::grip_stretched), 1U);
            for (const Entity hand : hands) {
                EXPECT_EQ(grabs.grab.at(hand).kind == GripKind::none, hand == one.lets_go);
            }
        }
    }
}

// One hand keeps a rock while the other grips and drops many. The held rock must stay in the list.
TEST(UpdateGrabs, HeldBodyStaysIgnoredWhilePlacesAreFree) {
    Grabs grabs;
    grabs.add_rock(k_rock, 5.0, Vec3(-1.0, 1.0, 0.0));
    for (std::uint32_t i = 0; i < 20; ++i) {
        grabs.add_rock(entity(10 + i), 5.0, Vec3(i, 1.0, 0.0));
    }
    grabs.close(k_left, Vec3(-1.0, 1.1, 0.0));
    grabs.run();
    grabs.hand.at(k_left).edge = GrabEdge::none;
    HeadIgnores& ignores = grabs.head_ignores.at(k_player);
    for (std::uint32_t i = 0; i < 20; ++i) {
        grabs.close(k_right, Vec3(i, 1.1, 0.0));
        grabs.run();
        ASSERT_EQ(grabs.grab.at(k_right).body, entity(10 + i));
        EXPECT_EQ(count_of(grabs.stats, Fallback::head_ignores_full), 0U);
        EXPECT_EQ(std::ranges::count(ignores.bodies, k_rock), 1);
        std::ranges::replace(ignores.bodies, entity(10 + i), k_no_entity);  // as find_contacts does
    }
}

TEST(UpdateGrabs, FullIgnoreListIsCountedAndTakesTheNewBody) {
    Grabs grabs;
    constexpr std::uint32_t k_rocks = HeadIgnores::k_capacity + 1;
    for (std::uint32_t i = 0; i < k_rocks; ++i) {
        grabs.add_rock(entity(10 + i), 5.0, Vec3(i, 1.0, 0.0));
        grabs.close(k_right, Vec3(i, 1.1, 0.0));
        grabs.run();
        EXPECT_EQ(count_of(grabs.stats, Fallback::head_ignores_full), i + 1 == k_rocks ? 1U : 0U);
        EXPECT_EQ(std::ranges::count(grabs.head_ignores.at(k_player).bodies, entity(10 + i)), 1);
    }
}

TEST(UpdateGrabs, BodyTakenByBothHandsIsIgnoredOnce) {
    Grabs grabs;
    grabs.add_rock(k_rock, 5.0, Vec3(0.0, 1.0, 0.0));
    grabs.close(k_left, Vec3(-0.01, 1.1, 0.0));
    grabs.close(k_right, Vec3(0.01, 1.1, 0.0));
    grabs.run();
    EXPECT_EQ(grabs.grab.at(k_left).body, k_rock);
    EXPECT_EQ(grabs.grab.at(k_right).body, k_rock);
    EXPECT_EQ(std::ranges::count(grabs.head_ignores.at(k_player).bodies, k_rock), 1);
}

// --- Properties ----------------------------------------------------------------------------------

struct Reach {
    Vec3 palm;
    Quat rotation;
};
Reach random_reach(Random& random) {
    return {Vec3{random.between(-0.5, 0.5), random.between(1.0, 1.06), random.between(-0.5, 0.5)},
            rotation_from_vector(random.vector(0.5))};
}

RC_GTEST_PROP(UpdateGrabs, MirroredHandGripsTheMirroredPoint, (std::uint64_t seed)) {
    Random random(seed);
    const Reach reach = random_reach(random);
    const Pose mirror = test::mirrored(Pose{reach.palm, reach.rotation});
    Grabs grabs;
    grabs.tuning.hand.palm_center_m.x() = 0.02;
    grabs.add_floor(1.0);
    grabs.close(k_right, reach.palm, reach.rotation);
    grabs.close(k_left, mirror.position, mirror.rotation);
    grabs.run();
    RC_ASSERT(
        (grabs.grab.at(k_left).hit_bs - test::mirrored(grabs.grab.at(k_right).hit_bs)).norm() <
        1e-9);
    RC_ASSERT(grabs.grab.at(k_left).kind == GripKind::surface);
}

RC_GTEST_PROP(UpdateGrabs, MovedAndRotatedWorldIsGrippedAtTheSamePoint, (std::uint64_t seed)) {
    Random random(seed);
    const Reach reach = random_reach(random);
    Grabs here;
    Grabs there(random.pose(1e4));
    for (Grabs* const grabs : {&here, &there}) {
        grabs->add_floor(1.0);
        grabs->close(k_right, reach.palm, reach.rotation);
        grabs->run();
    }
    RC_ASSERT(there.grab.at(k_right).kind == GripKind::surface);
    RC_ASSERT((there.grab.at(k_right).hit_bs - here.grab.at(k_right).hit_bs).norm() < 1e-6);
    RC_ASSERT((there.grab.at(k_right).hit_normal_bs - here.grab.at(k_right).hit_normal_bs).norm() <
              1e-9);
}

TEST(UpdateGrabs, OrderOfHandsAndBodiesDoesNotMatter) {
    Grabs forth;
    forth.add_floor(1.0);
    forth.add_rock(k_rock, 5.0, Vec3(0.5, 1.3, 0.0));
    Grabs back({}, {k_right, k_left});
    back.add_rock(k_rock, 5.0, Vec3(0.5, 1.3, 0.0));
    back.add_floor(1.0);
    for (Grabs* const grabs : {&forth, &back}) {
        grabs->close(k_left, Vec3(-0.5, 1.05, 0.0));
        grabs->close(k_right, Vec3(0.5, 1.4, 0.0));
        grabs->run();
        EXPECT_EQ(grabs->grab.at(k_left).body, k_wall);
        EXPECT_EQ(grabs->grab.at(k_right).body, k_rock);
    }
    EXPECT_EQ(forth.grab.at(k_left).hit_bs, back.grab.at(k_left).hit_bs);
    EXPECT_EQ(forth.grab.at(k_right).hit_bs, back.grab.at(k_right).hit_bs);
}

}  // namespace
}  // namespace handhold::update_grabs_test
