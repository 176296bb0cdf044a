#include <algorithm>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "tests/systems/input/climb_on_a_wall.hpp"

// Recentring of the play space, through the whole frame.
namespace handhold::tracking_errors_test {
namespace {

// Head and hands jump by one turn about +Y and one translation, between two samples.
struct Recentring {
    double at_s = 0.0;
    Pose space;  // the old space in the new one
    Pose of(double t_s, const Pose& pose) const { return t_s < at_s ? pose : space * pose; }

    explicit Recentring(Random& random) {
        at_s = random.between(0.5, 0.6);
        const double turn_rad = random.between(-3.1, 3.1);
        space = {random.vector(2.0), rotation_about(Vec3::UnitY(), turn_rad)};
    }
    void apply_to(DeviceScript& script) const {
        script.head = [*this, head = script.head](double t_s) { return of(t_s, head(t_s)); };
        for (auto& hand : script.hands) {
            hand = [*this, was = hand](double t_s) { return of(t_s, was(t_s)); };
        }
    }
};

RC_GTEST_PROP(TrackingErrors, RecentringMovesNeitherViewNorGrip, (std::uint64_t seed)) {
    Random random(seed);
    Climb climb(random);
    Scenario& scenario = climb.scenario;
    const Vec3 palm(-0.3, 1.1, -0.3);
    const Entity rock = scenario.add_rock("rock", 1.0, palm - Vec3(0.0, 0.09, 0.0));
    scenario.drop_caches();
    scenario.script.hands[0] = [&](double) {
        return Pose{palm - Vec3(-scenario.tuning.hand.palm_center_m.x(),
                                scenario.tuning.hand.palm_center_m.y(),
                                scenario.tuning.hand.palm_center_m.z()),
                    Quat::Identity()};
    };
    scenario.script.grabs[0] = scenario.script.grabs[1];
    const Recentring recentring(random);
    recentring.apply_to(scenario.script);
    scenario.run(0.45);
    const Vec3 before = view(scenario);
    const Pose rock_before = scenario.body(rock);
    std::uint64_t counted = 0;
    double moved_m = 0.0;
    scenario.run(0.5, [&] {
        counted += scenario.fallbacks(Fallback::space_recentred);
        moved_m = std::max(moved_m, (view(scenario) - before).norm());
    });
    RC_ASSERT(counted == 1U);
    RC_ASSERT(moved_m < 1e-6);
    RC_ASSERT((scenario.body(rock).position - rock_before.position).norm() < 1e-6);
    RC_ASSERT(climb.grips());
    RC_ASSERT(scenario.grab(HandSide::left).kind == GripKind::held);
    const Quat look = scenario.world.render_pose.at(scenario.player.player).head_ws.rotation;
    RC_ASSERT(rotation_to_vector(look).norm() < 1e-6);
}

// The head goes on at its velocity: a recentring changes the path by less than a millimetre.
RC_GTEST_PROP(TrackingErrors, RecentringOfAMovingPlayerLeavesThePath, (std::uint64_t seed)) {
    Random plan(seed);
    const Recentring recentring(plan);
    const double hz = plan.between(30.0, 144.0);
    const double sample_hz = plan.between(72.0, 500.0);
    const Vec3 nod = plan.vector(0.1);    // 0.4 m/s
    const Vec3 shake = plan.vector(0.2);  // 0.6 rad/s
    const Vec3 pull = plan.vector(0.1);
    std::vector<Pose> heads[2];
    for (const bool recentres : {false, true}) {
        Random random(seed);
        Climb climb(random);
        Scenario& scenario = climb.scenario;
        scenario.hz = hz;
        scenario.sample_hz = sample_hz;
        scenario.script.head = [&](double t_s) {
            return Pose{Vec3(0.0, 1.6, 0.0) + sine(2.0 * t_s) * nod,
                        rotation_from_vector(sine(2.0 * t_s) * shake)};
        };
        scenario.script.hands[1] = [&](double t_s) {
            return Pose{climb.hand.position + sine(3.0 * std::max(0.0, t_s - 0.2)) * pull,
                        climb.hand.rotation};
        };
        if (recentres) {
            recentring.apply_to(scenario.script);
        }
        scenario.run(1.0, [&] {
            heads[recentres ? 1 : 0].push_back(
                scenario.world.render_pose.at(scenario.player.player).head_ws);
        });
    }
    for (std::size_t frame = 0; frame < heads[0].size(); ++frame) {
        RC_ASSERT((heads[0][frame].position - heads[1][frame].position).norm() < 1e-3);
        RC_ASSERT(
            rotation_to_vector(heads[0][frame].rotation.conjugate() * heads[1][frame].rotation)
                .norm() < 2e-3);
    }
}

TEST(TrackingErrors, ThrustKeepsItsDirectionAfterARecentring) {
    Scenario scenario;
    scenario.tuning.locomotion.thruster_mps2 = 1.0;
    scenario.tuning.locomotion.drift_drag_per_s = 0.0;
    scenario.add_player_here();
    const Quat turn = rotation_about(Vec3::UnitY(), k_half_pi);
    const Pose space{Vec3(1.0, 0.0, 0.5), turn};
    scenario.script.head = [&](double t_s) {
        const Pose head{Vec3(0.0, 1.6, 0.6), Quat::Identity()};
        return t_s < 0.5 ? head : space * head;
    };
    for (auto& hand : scenario.script.hands) {
        hand = [&, was = hand](double t_s) { return t_s < 0.5 ? was(t_s) : space * was(t_s); };
    }
    scenario.run(0.6);
    scenario.commands.thrust_ps = turn * -Vec3::UnitZ();  // ahead, as the device has it now
    scenario.run(0.5);
    EXPECT_LT((scenario.velocity() - Vec3(0.0, 0.0, -0.5)).norm(), 1e-9);
}

// One device that jumps is no recentring: its own errors do not turn the play space.
RC_GTEST_PROP(TrackingErrors, OneJumpingDeviceRecentresNothing, (std::uint64_t seed)) {
    Random random(seed);
    Climb climb(random);
    Scenario& scenario = climb.scenario;
    const Recentring jump(random);
    const int which = static_cast<int>(random.between(0.0, 2.999));
    if (which == 2) {
        scenario.script.head = [jump, was = scenario.script.head](double t_s) {
            return jump.of(t_s, was(t_s));
        };
    } else {
        auto& hand = scenario.script.hands[which];
        hand = [jump, was = hand](double t_s) { return jump.of(t_s, was(t_s)); };
    }
    scenario.run(1.0, [&] { RC_ASSERT(scenario.fallbacks(Fallback::space_recentred) == 0U); });
}

}  // namespace
}  // namespace handhold::tracking_errors_test
