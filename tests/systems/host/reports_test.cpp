// What a host is told of a step: impulses and what a hand held.
#include <algorithm>
#include <cmath>
#include <optional>

#include <gtest/gtest.h>
#include <handhold/handhold.hpp>
#include <rapidcheck/gtest.h>

#include "tests/systems/host/host_scene.hpp"

namespace handhold::host_reports_test {
namespace {

using namespace test;

std::optional<hh::Event> find_event(const HostScene& scene, hh_event_kind kind) {
    const auto events = scene.world.events();
    const auto found = std::ranges::find(events, kind, &hh::Event::kind);
    return found != events.end() ? std::optional(*found) : std::nullopt;
}

// The crate alone stops with m v. More can only come from the player and the hand that hold it.
RC_GTEST_PROP(HostImpulses, HeldCrateHitsAWallWithAtMostThePlayersMomentum, ()) {
    const double mass_kg = 0.1 * static_cast<double>(*rc::gen::inRange(1, 1000));
    const double speed_mps = 0.1 * static_cast<double>(*rc::gen::inRange(1, 20));
    HostScene scene;
    hh_body_def def = crate(scene.world, {0.2, 1.4, -0.6});
    def.mass_kg = mass_kg;
    RC_ASSERT(static_cast<bool>(scene.world.add(def)));
    hh_body_def wall = hh::body_def();
    wall.shape = *scene.world.add_box({3.0, 3.0, 0.1});
    wall.pose.position = {0.0, 1.5, -1.0};
    RC_ASSERT(static_cast<bool>(scene.world.add(wall)));
    scene.closed[HH_RIGHT] = true;
    scene.step(5);
    RC_ASSERT(scene.hand(HH_RIGHT).grip == HH_GRIP_HELD);
    const double most_ns = (hh::player_def().mass_kg + 2.0 * mass_kg) * speed_mps;
    bool has_hit = false;
    for (int i = 0; i < 300 && scene.hand_at[HH_RIGHT].z > -0.7; ++i) {
        scene.hand_at[HH_RIGHT].z -= speed_mps * k_step_s;
        scene.step();
        const hh::Vec3 hand_ns = scene.hand(HH_RIGHT).force_impulse_ns;
        RC_ASSERT(std::hypot(hand_ns.x, hand_ns.y, hand_ns.z) < 1.001 * most_ns + 1e-6);
        if (const auto hit = find_event(scene, HH_EVENT_CONTACT_BEGAN)) {
            has_hit = true;
            RC_ASSERT(hit->impulse_ns > 0.0);
            RC_ASSERT(hit->impulse_ns < 1.001 * most_ns);
        }
    }
    RC_ASSERT(scene.is_good && has_hit);
}

// A body of 1 t or more is a wall to a light crate in a hand: it gains what the player loses.
RC_GTEST_PROP(HostImpulses, HeldCrateGivesAHeavyBodyOnlyThePlayersMomentum, ()) {
    const double mass_kg = 100.0 * static_cast<double>(*rc::gen::inRange(10, 300));
    const double speed_mps = 0.1 * static_cast<double>(*rc::gen::inRange(2, 15));
    HostScene scene;
    hh_body_def def = crate(scene.world, {0.2, 1.4, -0.6});
    RC_ASSERT(static_cast<bool>(scene.world.add(def)));
    hh_body_def heavy = hh::body_def();
    heavy.kind = HH_DYNAMIC;
    heavy.mass_kg = mass_kg;
    heavy.shape = *scene.world.add_box({0.5, 0.5, 0.1});
    heavy.pose.position = {0.2, 1.4, -1.0};
    const hh::Body body = *scene.world.add(heavy);
    scene.closed[HH_RIGHT] = true;
    scene.step(5);
    RC_ASSERT(scene.hand(HH_RIGHT).grip == HH_GRIP_HELD);
    for (int i = 0; i < 300 && scene.hand_at[HH_RIGHT].z > -0.7; ++i) {
        scene.hand_at[HH_RIGHT].z -= speed_mps * k_step_s;
        scene.step();
    }
    hh::Vec3 velocity{};
    RC_ASSERT(hh_body_velocity(scene.world.get(), body, &velocity, nullptr) == HH_OK);
    const double player_mps = scene.world.pose(scene.player)->velocity_mps.z;
    RC_ASSERT(velocity.z < 0.0);
    RC_ASSERT(player_mps > 0.2 * speed_mps);  // pushed back
    // The crate, 2 kg, moves with the hand.
    const double most_ns = 2.0 * 2.0 * speed_mps;
    RC_ASSERT(std::fabs(mass_kg * velocity.z + hh::player_def().mass_kg * player_mps) < most_ns);
}

TEST(HostEvents, GrippedPlayerWhoIsRemovedIsNamedAsAPlayer) {
    HostScene scene;
    hh_player_def def = hh::player_def();
    def.origin = hh::pose_at({0.2, -0.2, -0.56});
    const hh::Player other = *scene.world.add(def);
    ASSERT_TRUE(scene.world.use_wrists(other));
    const auto step = [&] {
        hh::Sample mine = scene.sample();
        hh::Sample theirs = mine;
        theirs.grab[HH_LEFT] = theirs.grab[HH_RIGHT] = false;
        theirs.hands[HH_LEFT].position = {-0.6, 1.0, -0.3};
        theirs.hands[HH_RIGHT].position = {0.6, 1.0, -0.3};
        const std::array inputs = {hh::input(scene.player, {&mine, 1}),
                                   hh::input(other, {&theirs, 1})};
        ASSERT_TRUE(scene.world.step(k_step_s, inputs));
    };
    for (int i = 0; i < 20; ++i) {
        step();
    }
    scene.closed[HH_RIGHT] = true;
    for (int i = 0; i < 10; ++i) {
        step();
    }
    ASSERT_TRUE(scene.hand(HH_RIGHT).other == other);
    ASSERT_TRUE(scene.world.remove(other));
    scene.step();
    const auto slipped = find_event(scene, HH_EVENT_SLIPPED);
    ASSERT_TRUE(slipped);
    EXPECT_EQ(slipped->reason, HH_REASON_BODY_GONE);
    EXPECT_TRUE(slipped->other == other);
    EXPECT_TRUE(slipped->body == hh_body{});
}

}  // namespace
}  // namespace handhold::host_reports_test
