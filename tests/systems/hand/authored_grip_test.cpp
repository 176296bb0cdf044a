// Talk row 10: authored grips, from the snap zone to the shown hand.
#include "components/authored_grip.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "fitted_hand.hpp"
#include "systems/hand/shared/finger_chain.hpp"
#include "systems/rigs/authored_hand.hpp"
#include "systems/rigs/hand_kinematics.hpp"
#include "systems/snapshot.hpp"
#include "tests/engine/allocation_count.hpp"
#include "tests/systems/frame/scenario.hpp"

namespace handhold::authored_grip_test {
namespace {

using test::count_of;
using test::distance;
using test::FittedHand;
using test::k_unbudgeted_s;
using test::Random;
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

// --- Grips as data -------------------------------------------------------------------------------
// ---------------------------------------------------------------------------------

// Expected: the reflection of every joint of the hand.
TEST(AuthoredGrip, MirroredHandHasMirroredPoints) {
    Random random(77);
    const HandRig right = builtin_hand_rig(HandSide::right);
    const HandRig left = builtin_hand_rig(HandSide::left);
    for (int axis = 0; axis < 3; ++axis) {
        AuthoredHand hand = over_rod(HandSide::right);
        hand.wrist_bs = random.pose();
        const AuthoredHand image = mirror_authored_hand(hand, axis);
        for (std::size_t f = 0; f < right.fingers.size(); ++f) {
            const FingerAngles angles = coupled_angles(right.fingers[f], 0.4);
            const auto points = finger_points(right.fingers[f], angles);
            const auto images = finger_points(left.fingers[f], angles);
            for (std::size_t i = 0; i < points.size(); ++i) {
                Vec3 expected = transform_point(hand.wrist_bs, points[i]);
                expected[axis] = -expected[axis];
                EXPECT_LT((transform_point(image.wrist_bs, images[i]) - expected).norm(), 1e-12);
            }
        }
        const AuthoredHand again = mirror_authored_hand(image, axis);
        EXPECT_EQ(again.wrist_bs.position, hand.wrist_bs.position);
        EXPECT_EQ(again.wrist_bs.rotation.coeffs(), hand.wrist_bs.rotation.coeffs());
    }
}

TEST(AuthoredGrip, AnglesOfLinksInvertsLinkFrames) {
    Random random(78);
    const HandRig rig = builtin_hand_rig(HandSide::left);
    for (int turn = 0; turn < 50; ++turn) {
        for (const FingerRig& finger : rig.fingers) {
            FingerAngles angles = coupled_angles(finger, random.between(0.0, 1.0));
            angles.curl_rad[1] += random.between(-0.2, 0.2);
            if (finger.name == FingerName::thumb) {
                angles.opposition_rad =
                    random.between(finger.lower_opposition_rad, finger.upper_opposition_rad);
            }
            const auto frames = finger_link_frames(finger, angles);
            std::array<Quat, k_max_links> links;
            for (std::size_t i = 0; i < finger.link_count; ++i) {
                links[i] = frames[i].rotation;
            }
            const FingerAngles found = angles_of_links(finger, {links.data(), finger.link_count});
            EXPECT_NEAR(found.opposition_rad, angles.opposition_rad, 1e-12);
            for (std::size_t i = 0; i < finger.link_count; ++i) {
                EXPECT_NEAR(found.curl_rad[i], angles.curl_rad[i], 1e-12);
            }
        }
    }
}

// --- Fitting a hand to a grip --------------------------------------------------------------------

struct AuthoredGripOnFloor : testing::Test {
    GripMesh floor = build_grip_mesh(test::make_floor_mesh());
    const HandRig rig = builtin_hand_rig(HandSide::right);
    const Pose closed = wrist_with_palm_at(rig, {0.02, 0.05, 0.03}, Vec3::UnitY());
    AuthoredHand grip;

    AuthoredGripOnFloor() {
        grip.is_there = true;
        grip.wrist_bs = wrist_with_palm_at(rig, {0.0, 0.03, 0.0}, Vec3(0.1, 1.0, 0.0).normalized());
        for (std::size_t f = 0; f < k_finger_count; ++f) {
            grip.is_posed[f] = true;
            grip.fingers[f].curl_rad = {0.1, 0.15, 0.05};
        }
        grip.fingers[0].opposition_rad = -1.0;
    }
};

TEST_F(AuthoredGripOnFloor, PalmMovesToAuthoredPoseAtPalmRate) {
    FittedHand hand(floor, closed);
    hand.hands.front().authored = &grip;
    const double dt_s = 1.0 / 90.0;
    Pose before = closed;
    double travel_m = 0.0;
    for (int frame = 0; frame < 90; ++frame) {
        hand.frame(dt_s);
        const double step_m = (hand.shown_bs().position - before.position).norm();
        EXPECT_LE(step_m, hand.tuning.palm.rate_mps * dt_s + 1e-9);
        travel_m += step_m;
        before = hand.shown_bs();
    }
    EXPECT_LT(distance(hand.shown_bs(), grip.wrist_bs), 1e-9);
    EXPECT_GT(travel_m, 0.9 * (grip.wrist_bs.position - closed.position).norm());
    // After leaving the grip the palm is fitted to the surface again.
    hand.hands.front().authored = nullptr;
    hand.frame(k_unbudgeted_s);
    EXPECT_GT(distance(hand.shown_bs(), grip.wrist_bs), 0.01);
}

TEST_F(AuthoredGripOnFloor, FingersTakeAuthoredPoseAtClosingRate) {
    FittedHand hand(floor, grip.wrist_bs);
    hand.hands.front().authored = &grip;
    hand.tuning.finger.close_radps = 1.0;
    hand.frame(0.01);
    for (std::size_t f = 0; f < rig.fingers.size(); ++f) {
        EXPECT_EQ(hand.pose().target[f].curl_rad, grip.fingers[f].curl_rad) << f;
        EXPECT_LE(hand.pose().shown[f].curl_rad[1], 0.01 + 1e-12) << f;
    }
    hand.frame(k_unbudgeted_s);
    EXPECT_EQ(hand.pose().shown[0].opposition_rad, -1.0);
    EXPECT_EQ(hand.pose().shown[2].curl_rad, grip.fingers[2].curl_rad);
    EXPECT_EQ(count_of(hand.stats, Fallback::authored_finger_rejected), 0U);
}

// Oracle: find_penetration, which has its own tests.
TEST_F(AuthoredGripOnFloor, PenetratingAuthoredFingerIsFittedAndCounted) {
    grip.fingers[1].curl_rad = {1.2, 0.3, 0.1};  // through the floor
    FittedHand hand(floor, grip.wrist_bs);
    hand.hands.front().authored = &grip;
    hand.frame(k_unbudgeted_s);
    EXPECT_EQ(count_of(hand.stats, Fallback::authored_finger_rejected), 1U);
    const HingeChain chain = finger_chain(rig.fingers[1], 0.0, hand.shown_bs());
    for (const Capsule& capsule : chain_capsules(chain, hand.pose().target[1].curl_rad)) {
        EXPECT_LT(find_penetration(capsule, hand.hands.front().meshes).depth_m, 1.5e-3);
    }
    EXPECT_EQ(hand.pose().target[2].curl_rad, grip.fingers[2].curl_rad);
}

// The palm rises from the floor, where its authored fingers penetrate, to 3 cm above it, where they
// are just clear.
struct AuthoredGripRisingPalm : AuthoredGripOnFloor {
    const Pose low = wrist_with_palm_at(rig, {0.0, 0.004, 0.0}, Vec3::UnitY());
    const double dt_s = 1.0 / 90.0;

    AuthoredGripRisingPalm() {
        grip.wrist_bs = wrist_with_palm_at(rig, {0.0, 0.03, 0.0}, Vec3::UnitY());
        for (const std::size_t f : {0U, 1U}) {
            while (depth_m(f) == 0.0 && turn_rad(f) < 1.5) {
                turn_rad(f) += 0.01;
            }
            turn_rad(f) -= 0.02;
        }
    }
    // The angle that turns the finger towards the floor.
    double& turn_rad(std::size_t f) {
        return f == 0 ? grip.fingers[f].opposition_rad : grip.fingers[f].curl_rad[0];
    }
    double depth_m(std::size_t f) {
        const HingeChain chain =
            finger_chain(rig.fingers[f], grip.fingers[f].opposition_rad, grip.wrist_bs);
        const std::vector<PlacedMesh> meshes = {{&floor, {}}};
        double deepest_m = 0.0;
        for (const Capsule& capsule : chain_capsules(chain, grip.fingers[f].curl_rad)) {
            deepest_m = std::max(deepest_m, find_penetration(capsule, meshes).depth_m);
        }
        return deepest_m;
    }
};

TEST_F(AuthoredGripRisingPalm, FingersTakeAuthoredPoseIfClearAtTheEnd) {
    for (const double reuse_travel_m : {1e-6, 0.01}) {
        FittedHand hand(floor, low);
        hand.tuning.finger.reuse_travel_m = reuse_travel_m;
        hand.hands.front().authored = &grip;
        for (const std::size_t f : {0U, 1U}) {
            ASSERT_LT(turn_rad(f), 1.4) << "finger " << f << " misses the floor";
        }
        for (int frame = 0; frame < 60; ++frame) {
            hand.frame(dt_s);
        }
        EXPECT_LT(distance(hand.shown_bs(), grip.wrist_bs), 1e-9);
        for (std::size_t f = 0; f < rig.fingers.size(); ++f) {
            EXPECT_EQ(hand.pose().target[f].curl_rad, grip.fingers[f].curl_rad)
                << "finger " << f << " reuse_travel_m " << reuse_travel_m;
        }
        EXPECT_EQ(count_of(hand.stats, Fallback::authored_finger_rejected), 0U);
    }
}

TEST_F(AuthoredGripRisingPalm, PenetratingFingersAreCountedOnce) {
    for (const std::size_t f : {0U, 1U}) {
        turn_rad(f) += 0.3;
    }
    for (const double reuse_travel_m : {1e-6, 0.01}) {
        FittedHand hand(floor, low);
        hand.tuning.finger.reuse_travel_m = reuse_travel_m;
        hand.tuning.finger.close_radps = 0.5;  // slow
        hand.hands.front().authored = &grip;
        for (int frame = 0; frame < 90; ++frame) {
            hand.frame(dt_s);
        }
        EXPECT_EQ(count_of(hand.stats, Fallback::authored_finger_rejected), 2U);
    }
}

TEST_F(AuthoredGripOnFloor, FingersWithoutAuthoredPoseCloseOnSurface) {
    grip.is_posed.fill(false);
    FittedHand hand(floor, grip.wrist_bs);
    hand.hands.front().authored = &grip;
    hand.frame(k_unbudgeted_s);
    for (std::size_t f = 1; f < rig.fingers.size(); ++f) {
        EXPECT_GE(hand.traces[0][f].contact_link, 0) << f;
    }
}

// --- Through the whole frame ---------------------------------------------------------------------

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
}  // namespace handhold::authored_grip_test
