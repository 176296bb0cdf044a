// Talk row 10: authored grips in whole frames, from the snap zone to the shown hand.
#include <cmath>

#include <gtest/gtest.h>

#include "components/authored_grip.hpp"
#include "systems/rigs/builtin_hand_rig.hpp"
#include "systems/snapshot/snapshot.hpp"
#include "tests/engine/allocation_count.hpp"
#include "tests/systems/frame/column_scene.hpp"
#include "tests/systems/frame/scenario.hpp"
#include "tests/systems/hand/fitted_hand.hpp"

namespace handhold::scenario_authored_grip_test {
namespace {

using test::count_of;
using test::distance;
using test::wrist_with_palm_at;

constexpr double k_rod_radius_m = 0.016;

// Authored pose of a hand with its palm down on a rod along X through the origin.
AuthoredHand over_rod(HandSide side) {
    AuthoredHand hand;
    hand.is_there = true;
    hand.wrist_bs = wrist_with_palm_at(builtin_hand_rig(side),
                                       Vec3(0.0, k_rod_radius_m + 0.002, 0.0), Vec3::UnitY());
    return hand;
}

AuthoredGrips right_grip(const AuthoredHand& hand) {
    AuthoredGrips grips;
    grips.count = 1;
    grips.grips[0].hands[index_of(HandSide::right)] = hand;
    return grips;
}

// A rod floating in front of the player; the right hand closes beside its grip at 0.1 s.
class RodScene {
  public:
    Scenario s;
    Entity rod;
    Vec3 place{0.25, 1.3, 0.1};
    // Offset of the closing hand from its authored pose, in the rod's frame; constant.
    Pose off{Vec3(0.02, 0.01, -0.02), rotation_about(Vec3::UnitY(), 0.3)};
    double release_s = 1e9;

    explicit RodScene(BodyKind kind = BodyKind::free,
                      const AuthoredGrips& grips = right_grip(over_rod(HandSide::right))) {
        const ShapeId shape = s.shapes.add_capsule(k_rod_radius_m, 0.15);
        const CentredShape lying = {shape, {}};
        const Quat along_x = rotation_about(Vec3::UnitZ(), k_half_pi);
        RigidBody body;
        body.kind = kind;
        body.mass_kg = 2.0;
        body.inertia_kgm2 = solid_inertia(s.shapes.at(lying.shape), 2.0);
        rod = s.add("rod", body, shape, {place, along_x});
        AuthoredGrips turned = grips;  // into the capsule's frame, whose y axis is the rod
        for (AuthoredGrip& grip : turned.grips) {
            for (AuthoredHand& hand : grip.hands) {
                hand.wrist_bs = Pose{Vec3::Zero(), along_x.conjugate()} * hand.wrist_bs;
            }
        }
        s.world.authored_grips.add(rod, turned);
    }
    void begin() {
        s.add_player_here();
        s.script.grabs[1] = [this](double t) { return t > 0.1 && t < release_s; };
        s.script.hands[1] = [this](double) { return hand(); };
    }
    Pose hand() const {
        return Pose{place, Quat::Identity()} * over_rod(HandSide::right).wrist_bs * off;
    }
    const RenderPose::Hand& shown() const {
        return s.world.render_pose.at(s.player.player).hands[1];
    }
    const AuthoredHold* hold() const { return s.world.authored_hold.find(s.player.hands[1]); }
};

TEST(AuthoredGripScene, HandClosingInZoneTakesGripAndObjectMovesIntoHand) {
    RodScene scene;
    scene.begin();
    scene.s.run(0.15);
    ASSERT_NE(scene.hold(), nullptr);
    EXPECT_EQ(scene.shown().grip, GripKind::authored);
    EXPECT_EQ(scene.s.grab(HandSide::right).kind, GripKind::held);
    const Vec3 origin = scene.s.origin_ws();
    double fastest_m = 0.0;
    Vec3 before = scene.s.body(scene.rod).position;
    scene.s.run(1.0, [&] {
        fastest_m = std::max(fastest_m, (scene.s.body(scene.rod).position - before).norm());
        before = scene.s.body(scene.rod).position;
        EXPECT_EQ(scene.s.origin_ws(), origin) << "the view moved";
    });
    EXPECT_LE(fastest_m, scene.s.tuning.palm.rate_mps / scene.s.hz + 1e-4);
    // The rod is in the hand as authored, and the hand is shown as tracked.
    const Pose expected_hand =
        scene.s.world.body_pose.at(scene.rod).pose_ws *
        scene.s.world.authored_grips.at(scene.rod).grips[0].hands[1].wrist_bs;
    EXPECT_LT(distance(scene.hand(), expected_hand), 1e-5);
    EXPECT_LT(distance(scene.shown().shown_ws, scene.hand()), 1e-5);
    EXPECT_LT(scene.s.grab(HandSide::right).error_m, 1e-5);
}

TEST(AuthoredGripScene, HandOutsideZoneTakesSurface) {
    RodScene scene;
    scene.off.position = Vec3(0.13, 0.0, 0.0);  // along the rod, beyond the zone
    scene.begin();
    scene.s.run(1.0);
    EXPECT_EQ(scene.hold(), nullptr);
    EXPECT_EQ(scene.shown().grip, GripKind::held);
    // An object gripped by its surface does not move into the hand.
    EXPECT_LT((scene.s.body(scene.rod).position - scene.place).norm(), 1e-5);
}

TEST(AuthoredGripScene, HandTurnedBeyondZoneAngleTakesSurface) {
    RodScene scene;
    scene.off = {Vec3::Zero(), rotation_about(Vec3::UnitY(), 1.2)};
    scene.begin();
    scene.s.run(0.3);
    EXPECT_EQ(scene.hold(), nullptr);
    EXPECT_EQ(scene.s.grab(HandSide::right).kind, GripKind::held);
}

TEST(AuthoredGripScene, IgnoresGripForOtherHand) {
    AuthoredGrips left;
    left.count = 1;
    left.grips[0].hands[0] = over_rod(HandSide::left);
    RodScene scene(BodyKind::free, left);
    scene.begin();
    scene.s.run(0.3);
    EXPECT_EQ(scene.hold(), nullptr);
}

TEST(AuthoredGripScene, PrefersHigherPriorityOverNearerGrip) {
    AuthoredGrips grips = right_grip(over_rod(HandSide::right));
    grips.count = 3;
    grips.grips[1] = grips.grips[0];
    grips.grips[1].hands[1].wrist_bs.position.x() += 0.05;
    grips.grips[2] = grips.grips[0];
    grips.grips[2].hands[1].wrist_bs.position.x() -= 0.03;
    RodScene nearest(BodyKind::free, grips);
    nearest.begin();
    nearest.s.run(0.3);
    ASSERT_NE(nearest.hold(), nullptr);
    EXPECT_EQ(nearest.hold()->grip, 0)
        << "among equal priorities, the grip that moves the palm least";
    grips.grips[1].priority = 1;
    RodScene scene(BodyKind::free, grips);
    scene.begin();
    scene.s.run(0.3);
    ASSERT_NE(scene.hold(), nullptr);
    EXPECT_EQ(scene.hold()->grip, 1);
}

TEST(AuthoredGripScene, GripBehindWallIsBlockedAndCounted) {
    RodScene scene(BodyKind::fixed);
    scene.off.position = Vec3(0.0, 0.06, 0.0);
    scene.off.rotation = Quat::Identity();
    scene.s.add_wall("sheet", Vec3(0.2, 0.005, 0.2), scene.place + Vec3(0.0, 0.045, 0.0));
    scene.begin();
    std::uint64_t blocked = 0;
    scene.s.run(0.3, [&] { blocked += count_of(scene.s.stats, Fallback::authored_grip_blocked); });
    EXPECT_EQ(blocked, 1U);
    EXPECT_EQ(scene.hold(), nullptr);
    EXPECT_EQ(scene.shown().grip, GripKind::surface);
}

TEST(AuthoredGripScene, OccupiedGripIsRefusedToSecondHand) {
    AuthoredGrips grips = right_grip(over_rod(HandSide::right));
    grips.grips[0].hands[0] = over_rod(HandSide::left);
    RodScene scene(BodyKind::free, grips);
    scene.begin();
    scene.s.script.grabs[0] = [](double t) { return t > 0.5; };
    scene.s.script.hands[0] = [&](double) {
        return Pose{scene.place, Quat::Identity()} * over_rod(HandSide::left).wrist_bs *
               Pose{Vec3(-0.03, 0.0, 0.0), Quat::Identity()};
    };
    std::uint64_t occupied = 0;
    scene.s.run(0.8,
                [&] { occupied += count_of(scene.s.stats, Fallback::authored_grip_occupied); });
    EXPECT_EQ(occupied, 1U);
    EXPECT_NE(scene.hold(), nullptr);
    EXPECT_FALSE(scene.s.world.authored_hold.contains(scene.s.player.hands[0]));
    EXPECT_EQ(scene.s.grab(HandSide::left).kind, GripKind::held);
}

TEST(AuthoredGripScene, OnFixedBodyTheShownHandMovesIntoTheGrip) {
    RodScene scene(BodyKind::fixed);
    scene.begin();
    scene.s.run(1.0);
    EXPECT_EQ(scene.s.grab(HandSide::right).kind, GripKind::surface);
    EXPECT_EQ(scene.shown().grip, GripKind::authored);
    EXPECT_LT(distance(scene.shown().shown_ws,
                       Pose{scene.place, Quat::Identity()} * over_rod(HandSide::right).wrist_bs),
              1e-6);
    EXPECT_LT(distance(scene.shown().tracked_ws, scene.hand()), 1e-6) << "the player moved";
}

TEST(AuthoredGripScene, HandTurnedFarOnFixedBodyLeavesGrip) {
    RodScene scene(BodyKind::fixed);
    scene.begin();
    std::uint64_t left = 0;
    scene.s.script.hands[1] = [&](double t) {
        Pose turned = scene.hand();
        turned.rotation = turned.rotation * rotation_about(Vec3::UnitX(), 2.6 * ease(t, 0.5, 1.5));
        return turned;
    };
    scene.s.run(2.0, [&] { left += count_of(scene.s.stats, Fallback::authored_grip_abandoned); });
    EXPECT_EQ(left, 1U);
    EXPECT_EQ(scene.shown().grip, GripKind::surface);
}

TEST(AuthoredGripScene, ReleaseLeavesGripAndThrowsWithHandVelocityOnly) {
    RodScene scene;
    scene.release_s = 0.2;  // while the rod still moves into the hand
    scene.begin();
    scene.s.run(0.4);
    EXPECT_EQ(scene.hold(), nullptr);
    EXPECT_EQ(scene.shown().grip, GripKind::none);
    EXPECT_LT(scene.s.body_velocity(scene.rod).norm(), 1e-6);
}

TEST(AuthoredGripScene, RestoredSnapshotContinuesBitForBit) {
    RodScene scene;
    scene.begin();
    scene.s.run(0.2);
    const SnapshotAssets assets(scene.s.shapes);
    std::vector<std::byte> bytes;
    save_snapshot(scene.s.world, assets, bytes);
    World restored;
    ASSERT_FALSE(restore_snapshot(bytes, assets, restored));
    EXPECT_EQ(hash_state(restored), hash_state(scene.s.world));
    EXPECT_TRUE(diff_worlds(restored, scene.s.world).empty());
    scene.s.run(0.5);
    const std::uint64_t once = hash_state(scene.s.world);
    RodScene again;
    again.begin();
    again.s.run(0.2);
    ASSERT_FALSE(restore_snapshot(bytes, assets, again.s.world));
    again.s.drop_caches();
    again.s.run(0.5);
    EXPECT_EQ(hash_state(again.s.world), once);
}

TEST(AuthoredGripScene, SnapshotWithAuthoredGrabKindIsRefused) {
    RodScene scene;
    scene.begin();
    scene.s.run(0.2);
    scene.s.world.grab.at(scene.s.player.hands[1]).kind = GripKind::authored;
    const SnapshotAssets assets(scene.s.shapes);
    std::vector<std::byte> bytes;
    save_snapshot(scene.s.world, assets, bytes);
    World restored;
    EXPECT_TRUE(restore_snapshot(bytes, assets, restored).has_value());
}

TEST(AuthoredGripScene, WarmFramesAllocateNothing) {
    if (!counts_allocations()) {
        GTEST_SKIP() << "allocations are not counted under sanitizers";
    }
    AuthoredHand posed = over_rod(HandSide::right);
    posed.is_posed.fill(true);
    for (FingerAngles& angles : posed.fingers) {
        angles.curl_rad = {0.6, 0.8, 0.4};
    }
    RodScene scene(BodyKind::fixed, right_grip(posed));
    scene.begin();
    scene.s.script.grabs[1] = [](double t) { return std::fmod(t, 0.5) > 0.1; };
    scene.s.run(2.0);
    std::size_t in_frames = 0;
    int in_grip = 0;
    for (int frame = 0; frame < 180; ++frame) {
        scene.s.prepare_step();
        const std::size_t before = allocation_count();
        scene.s.take_step();
        in_frames += allocation_count() - before;
        in_grip += scene.shown().grip == GripKind::authored ? 1 : 0;
    }
    EXPECT_EQ(in_frames, 0U);
    EXPECT_GT(in_grip, 90);
}

}  // namespace
}  // namespace handhold::scenario_authored_grip_test
