// A camera rig at hh_player_pose.origin shows the devices where the library has them, whatever the
// devices do.
#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "systems/host/host_call.hpp"
#include "tests/systems/host/host_scene.hpp"

namespace handhold::host_recentring_test {
namespace {

using namespace test;

constexpr double k_pi = 3.14159265358979323846;

hh::Pose level_pose(double turn_rad, hh::Vec3 position) {
    return hh::pose_at(position, {0.0, std::sin(0.5 * turn_rad), 0.0, std::cos(0.5 * turn_rad)});
}
// a * b by the library's own convention: b in a's frame.
hh::Pose product(const hh::Pose& a, const hh::Pose& b) {
    return to_c(unchecked_pose(a) * unchecked_pose(b));
}

// Devices that move slowly in the room, told in a space that lies at `space` in the room.
struct Devices {
    HostScene scene;
    hh::Pose space = hh::pose_at({});
    double seconds = 0.0;
    bool is_left_seen = true;

    hh::Sample in_room() const {
        hh::Sample sample = scene.sample();
        sample.head.position = {0.05 * std::sin(seconds), 1.6, 0.1 * std::sin(0.7 * seconds)};
        sample.hands[HH_LEFT].position = {-0.3, 1.1 + 0.1 * std::sin(seconds), -0.2};
        sample.hand_tracked[HH_LEFT] = is_left_seen;
        return sample;
    }
    hh::Sample sample() const {
        hh::Sample sample = in_room();
        const hh::Pose room_in_space = to_c(inverse(unchecked_pose(space)));
        sample.head = product(room_in_space, sample.head);
        for (hh::Pose& hand : sample.hands) {
            hand = product(room_in_space, hand);
        }
        return sample;
    }
    hh::Sample step() {
        seconds += k_step_s;
        const hh::Sample now = sample();
        scene.is_good =
            scene.is_good && scene.world.step(k_step_s, hh::input(scene.player, {&now, 1}));
        return now;
    }
    // How far a rig at the told origin draws head and hands from where the library has them.
    double rig_error_m(const hh::Sample& now) const {
        const hh_player_pose pose = *scene.world.pose(scene.player);
        double error_m = distance_m(product(pose.origin, now.head).position, pose.head.position);
        for (const std::size_t side : {0U, 1U}) {
            if (now.hand_tracked[side] != 0) {
                error_m =
                    std::max(error_m, distance_m(product(pose.origin, now.hands[side]).position,
                                                 pose.hands[side].tracked.position));
            }
        }
        return error_m;
    }
    bool has_event(hh_event_kind kind) const {
        const auto events = scene.world.events();
        return std::ranges::find(events, kind, &hh::Event::kind) != events.end();
    }
};

hh::Pose any_recentring() {
    const auto share = [] { return 1e-3 * *rc::gen::inRange(-1000, 1001); };
    return level_pose(k_pi * share(), {2.0 * share(), 0.5 * share(), 2.0 * share()});
}

// Guessed, announced, in a pause, with a hand out of sight, gripping or not, and around teleports.
RC_GTEST_PROP(HostRecentring, RigAtTheOriginShowsTheDevicesInEveryFrame, ()) {
    Devices devices;
    devices.scene.add_wall();
    devices.scene.closed[HH_RIGHT] = *rc::gen::arbitrary<bool>();
    const bool announces = *rc::gen::arbitrary<bool>();
    for (int i = 0; i < 20; ++i) {
        RC_ASSERT(devices.rig_error_m(devices.step()) < 1e-9);
    }
    bool is_teleported = false;  // at the end of the round before
    for (int round = 0; round < 4; ++round) {
        const hh::Vec3 head_before = devices.scene.world.pose(devices.scene.player)->head.position;
        const hh::Pose change = any_recentring();
        devices.is_left_seen = *rc::gen::inRange(0, 4) != 0;
        devices.space = product(devices.space, change);
        if (announces) {
            RC_ASSERT(hh_player_recenter(devices.scene.world.get(), devices.scene.player, change) ==
                      HH_OK);
        }
        for (int i = 0; i < 15; ++i) {
            RC_ASSERT(devices.rig_error_m(devices.step()) < 1e-9);
            if (i == 0) {
                RC_ASSERT(!announces || devices.has_event(HH_EVENT_RECENTRED));
                // A frame of the devices' own motion, at most 0.12 m/s. A teleport just before may
                // have put the head into the wall, which pushes it out.
                const hh::Vec3 head = devices.scene.world.pose(devices.scene.player)->head.position;
                double pushed_m = 0.0;
                RC_ASSERT(hh_player_push_back(devices.scene.world.get(), devices.scene.player,
                                              &pushed_m) == HH_OK);
                RC_ASSERT(!announces ||
                          distance_m(head, head_before) < 0.01 + (is_teleported ? pushed_m : 0.0));
            }
        }
        is_teleported = *rc::gen::inRange(0, 3) == 0;
        if (is_teleported) {
            const hh::Pose there = level_pose(0.3 * round, {1.0 * round, 0.0, 0.0});
            RC_ASSERT(static_cast<bool>(devices.scene.world.teleport(devices.scene.player, there)));
            // Where the host put the origin, it is.
            RC_ASSERT(distance_m(devices.scene.world.pose(devices.scene.player)->origin.position,
                                 there.position) < 1e-9);
            RC_ASSERT(devices.rig_error_m(devices.step()) < 1e-9);
        }
        if (*rc::gen::inRange(0, 3) == 0) {
            const hh::Sample now = devices.sample();
            const hh_player_input input = hh::input(devices.scene.player, {&now, 1});
            RC_ASSERT(static_cast<bool>(devices.scene.world.step_pose_only(k_step_s, {&input, 1})));
            RC_ASSERT(devices.rig_error_m(now) < 1e-9);
        }
    }
    RC_ASSERT(devices.scene.is_good);
}

// The view, the hand and the grip stay in the world.
TEST(HostRecentring, MovesNothingInTheWorldWhileAHandGrips) {
    for (const double degrees : {5.0, 30.0, 57.0, 90.0, 180.0, -120.0}) {
        for (const bool announces : {false, true}) {
            Devices devices;
            devices.scene.add_wall();
            devices.scene.closed[HH_RIGHT] = true;
            for (int i = 0; i < 60; ++i) {
                devices.step();
            }
            const hh_player_pose before = *devices.scene.world.pose(devices.scene.player);
            ASSERT_EQ(before.hands[HH_RIGHT].grip, HH_GRIP_SURFACE);
            const hh::Pose change = level_pose(degrees * k_pi / 180.0, {0.2, 0.0, 0.1});
            devices.space = product(devices.space, change);
            if (announces) {
                ASSERT_EQ(
                    hh_player_recenter(devices.scene.world.get(), devices.scene.player, change),
                    HH_OK);
            }
            devices.step();
            EXPECT_TRUE(devices.has_event(HH_EVENT_RECENTRED)) << degrees << announces;
            const hh_player_pose after = *devices.scene.world.pose(devices.scene.player);
            EXPECT_EQ(after.hands[HH_RIGHT].grip, HH_GRIP_SURFACE) << degrees << announces;
            // A frame of the devices' own motion, at most 0.15 m/s.
            EXPECT_LT(distance_m(after.head.position, before.head.position), 2e-3) << degrees;
            EXPECT_LT(distance_m(after.hands[HH_RIGHT].tracked.position,
                                 before.hands[HH_RIGHT].tracked.position),
                      1e-6)
                << degrees << announces;
        }
    }
}

// A host that turns the player in its samples: with the guess off the view follows by the whole
// turn in that frame, hands with it, and a gripping hand takes a new anchor instead of moving the
// player.
TEST(HostRecentring, TurnsInTheSamplesAreFollowedWithoutTheGuess) {
    for (const double degrees : {9.5, 19.0, 45.0, 180.0}) {
        for (const bool grips : {false, true}) {
            Devices devices;
            devices.scene.add_wall();
            devices.scene.closed[HH_RIGHT] = grips;
            ASSERT_EQ(
                hh_player_set_recenter_guess(devices.scene.world.get(), devices.scene.player, 0),
                HH_OK);
            for (int i = 0; i < 60; ++i) {
                devices.step();
            }
            const hh_player_pose before = *devices.scene.world.pose(devices.scene.player);
            devices.space = level_pose(degrees * k_pi / 180.0, {});
            for (int i = 0; i < 10; ++i) {
                EXPECT_LT(devices.rig_error_m(devices.step()), 1e-9) << degrees << grips;
                EXPECT_FALSE(devices.has_event(HH_EVENT_RECENTRED));
            }
            const hh_player_pose after = *devices.scene.world.pose(devices.scene.player);
            // Less is a motion that a hand can make, and pulls the player.
            if (degrees >= 45.0 || !grips) {
                EXPECT_LT(distance_m(after.origin.position, before.origin.position), 0.02)
                    << degrees << grips;
            }
        }
    }
}

TEST(HostRecentring, RefusesAChangeThatTilts) {
    HostScene scene;
    scene.step();
    const hh::Pose tilted = hh::pose_at({}, {0.1, 0.0, 0.0, std::sqrt(0.99)});
    EXPECT_EQ(hh_player_recenter(scene.world.get(), scene.player, tilted), HH_ERROR_VALUE);
    EXPECT_EQ(hh_player_recenter(scene.world.get(), {}, hh_identity_pose()), HH_ERROR_HANDLE);
}

}  // namespace
}  // namespace handhold::host_recentring_test
