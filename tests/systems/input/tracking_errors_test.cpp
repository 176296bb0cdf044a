#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "tests/random.hpp"
#include "tests/systems/frame/scenario.hpp"

// Effects of wrong, missing and late tracking on a player, through the whole frame.
namespace handhold::tracking_errors_test {
namespace {

using test::Random;

constexpr double k_nan = std::numeric_limits<double>::quiet_NaN();
constexpr double k_sample_rates_hz[] = {30.0, 60.0, 72.0, 90.0, 120.0, 144.0, 500.0, 1000.0};

double pick_rate(Random& random) {
    return k_sample_rates_hz[static_cast<std::size_t>(random.between(0.0, 7.999))];
}

Pose lost() { return {Vec3::Constant(k_nan), Quat::Identity()}; }

Vec3 view(const Scenario& scenario) {
    return scenario.world.render_pose.at(scenario.player.player).head_ws.position;
}

// Right hand on a wall of which it grips the front; the palm faces it.
struct Climb {
    Scenario scenario;
    Pose hand;  // at rest

    explicit Climb(Random& random) {
        scenario.fits_hands = false;
        scenario.hz = random.between(30.0, 144.0);
        scenario.sample_hz = pick_rate(random);
        scenario.add_wall("wall", Vec3(3.0, 3.0, 0.2), Vec3(0.0, 1.2, -0.7));
        const Quat to_wall = rotation_about(Vec3::UnitX(), k_half_pi);  // the palm looks to -Z
        const Vec3 palm(0.2, 1.2, -0.49);
        hand = {palm - to_wall * scenario.tuning.hand.palm_center_m, to_wall};
        scenario.script.head = [](double) { return Pose{Vec3(0.0, 1.6, 0.0), Quat::Identity()}; };
        scenario.script.hands[1] = [this](double) { return hand; };
        scenario.script.grabs[1] = [](double t_s) { return t_s > 0.1; };
        scenario.add_player_here();
    }
    Climb(const Climb&) = delete;
    Climb& operator=(const Climb&) = delete;

    bool grips() const { return scenario.grab(HandSide::right).kind == GripKind::surface; }
    // The farthest that the view moved in any frame.
    double run_and_measure(double seconds) {
        if (scenario.world.clock.frame == 0) {
            scenario.step();
        }
        double farthest_m = 0.0;
        Vec3 before = view(scenario);
        scenario.run(seconds, [&] {
            farthest_m = std::max(farthest_m, (view(scenario) - before).norm());
            before = view(scenario);
        });
        return farthest_m;
    }
};

// One error of a device: what it reports from one time to another.
struct Error {
    double from_s = 0.0;
    double to_s = 0.0;
    int kind = 0;
    Pose wrong;
    Pose of(const Pose& truth) const {
        switch (kind) {
            case 0:
                return lost();
            case 1:
                return {};  // asleep
            case 2:
                return {Vec3::Zero(), Quat(0.0, 0.0, 0.0, 0.0)};
            case 3:
                return {truth.position + wrong.position, truth.rotation};
            default:
                return wrong;
        }
    }
};

RC_GTEST_PROP(TrackingErrors, NeverMoveTheViewFasterThanAHand, (std::uint64_t seed)) {
    Random random(seed);
    Climb climb(random);
    const Vec3 swing = random.vector(0.15);
    const double rate = random.between(1.0, 8.0);
    std::vector<Error> errors;
    for (double t_s = 0.5; t_s < 2.5;) {
        Error error;
        error.from_s = t_s + random.between(0.0, 0.3);
        error.to_s = error.from_s + std::pow(10.0, random.between(-3.0, -0.2));
        error.kind = static_cast<int>(random.between(0.0, 4.999));
        error.wrong = random.pose(1.0);
        t_s = error.to_s;
        errors.push_back(error);
    }
    climb.scenario.script.hands[1] = [&](double t_s) {
        const Pose truth{climb.hand.position + sine(rate * std::max(0.0, t_s - 0.3)) * swing,
                         climb.hand.rotation};
        for (const Error& error : errors) {
            if (t_s >= error.from_s && t_s < error.to_s) {
                return error.of(truth);
            }
        }
        return truth;
    };
    const double max_m = climb.scenario.tuning.tracking.max_hand_speed_mps / climb.scenario.hz;
    RC_ASSERT(climb.run_and_measure(3.0) <= max_m + 1e-6);
}

RC_GTEST_PROP(TrackingErrors, ShortErrorMovesNothingAndTheGripGoesOn, (std::uint64_t seed)) {
    Random random(seed);
    Climb climb(random);
    Error error;
    error.from_s = random.between(0.5, 0.6);
    error.to_s = error.from_s + random.between(0.0, 0.03);
    error.kind = static_cast<int>(random.between(0.0, 4.999));
    // Farther than a hand moves within the error.
    error.wrong = {0.5 * random.direction(), random.rotation()};
    if (error.kind > 3) {
        error.wrong.position += climb.hand.position;
    }
    climb.scenario.script.hands[1] = [&](double t_s) {
        return t_s >= error.from_s && t_s < error.to_s ? error.of(climb.hand) : climb.hand;
    };
    climb.scenario.run(0.45);
    const Vec3 before = view(climb.scenario);
    RC_ASSERT(climb.run_and_measure(0.5) < 1e-6);
    RC_ASSERT((view(climb.scenario) - before).norm() < 1e-6);
    RC_ASSERT(climb.grips());
}

RC_GTEST_PROP(TrackingErrors, LossOfAnyLengthResumesWithoutAJump, (std::uint64_t seed)) {
    Random random(seed);
    Climb climb(random);
    const double from_s = random.between(0.5, 0.6);
    // One sample at least.
    const double to_s =
        from_s + std::pow(10.0, random.between(-2.0, 0.3)) + 1.1 / climb.scenario.sample_hz;
    // Along the wall: the palm can hold on there.
    const Vec3 moved(random.between(-0.5, 0.5), random.between(-0.3, 0.3), 0.0);
    const int kind = static_cast<int>(random.between(0.0, 2.999));
    climb.scenario.script.hands[1] = [&](double t_s) {
        const Pose truth{climb.hand.position + ease(t_s, from_s, to_s) * moved,
                         climb.hand.rotation};
        return t_s >= from_s && t_s < to_s ? Error{0.0, 0.0, kind, {}}.of(truth) : truth;
    };
    RC_ASSERT(climb.run_and_measure(to_s + 0.3) < 0.0201);
    RC_ASSERT(climb.grips());
}

RC_GTEST_PROP(TrackingErrors, SleepingControllerGripsNothing, (std::uint64_t seed)) {
    Random random(seed);
    Climb climb(random);
    const double wakes_s = random.between(0.3, 1.0);
    climb.scenario.add_wall("floor", Vec3(3.0, 0.05, 3.0), Vec3(0.0, -0.05, 0.0));
    climb.scenario.drop_caches();
    climb.scenario.script.grabs[1] = [](double) { return true; };
    climb.scenario.script.hands[1] = [&](double t_s) {
        return t_s < wakes_s ? Pose{} : climb.hand;
    };
    climb.scenario.run(wakes_s - 2.0 / climb.scenario.hz - 2.0 / climb.scenario.sample_hz, [&] {
        RC_ASSERT(climb.scenario.grab(HandSide::right).kind == GripKind::none);
    });
    RC_ASSERT(climb.run_and_measure(0.5) < 1e-6);
    RC_ASSERT(climb.grips());
}

// Twice as fast as errors are allowed to be.
RC_GTEST_PROP(TrackingErrors, FastHandIsBelievedAndItsThrowKeepsItsVelocity, (std::uint64_t seed)) {
    Random random(seed);
    Scenario scenario;
    scenario.fits_hands = false;
    scenario.hz = random.between(30.0, 144.0);
    scenario.sample_hz = k_sample_rates_hz[static_cast<std::size_t>(random.between(1.0, 7.999))];
    scenario.tuning.locomotion.object_speed_max_mps = 100.0;
    const Vec3 palm(0.2, 1.2, -0.2);
    const Entity rock = scenario.add_rock("rock", 1.0, palm - Vec3(0.0, 0.09, 0.0));
    Vec3 along = random.direction();
    along.z() = -std::abs(along.z());  // away from the head
    const double speed_mps = random.between(0.5, 16.0);
    const double begin_s = 0.3;
    const double end_s = begin_s + random.between(0.15, 0.25);  // at its speed; then it goes on
    scenario.tuning.hand.max_arm_m = 100.0;
    const auto travel = [&](double t_s) {
        // Constant acceleration, then constant velocity.
        const double push_s = std::clamp(t_s - begin_s, 0.0, end_s - begin_s);
        return 0.5 * speed_mps / (end_s - begin_s) * push_s * push_s +
               speed_mps * std::max(0.0, t_s - end_s);
    };
    scenario.script.hands[1] = [&](double t_s) {
        return Pose{hand_for_palm(scenario, palm) + travel(t_s) * along, Quat::Identity()};
    };
    const double lets_go_s = end_s + 0.1;
    scenario.script.grabs[1] = [&](double t_s) { return t_s > 0.1 && t_s < lets_go_s; };
    scenario.add_player_here();
    scenario.run(lets_go_s + 0.15,
                 [&] { RC_ASSERT(scenario.fallbacks(Fallback::hand_implausible) == 0U); });
    RC_ASSERT((scenario.body_velocity(rock) - speed_mps * along).norm() < 0.01 * speed_mps);
}

// --- Held bodies ---------------------------------------------------------------------------------

RC_GTEST_PROP(TrackingErrors, HeldBodyComesBackIntoTheHandAtABoundedRate, (std::uint64_t seed)) {
    Random random(seed);
    Scenario scenario;
    scenario.fits_hands = false;
    scenario.hz = random.between(30.0, 144.0);
    scenario.sample_hz = pick_rate(random);
    const Vec3 palm(0.2, 1.2, -0.4);
    const Entity rock =
        scenario.add_rock("rock", random.between(0.2, 50.0), palm - Vec3(0.0, 0.09, 0.0));
    const double from_s = random.between(0.5, 0.6);
    const double to_s = from_s + random.between(0.0, 1.0);
    const Pose first{hand_for_palm(scenario, palm), Quat::Identity()};
    const Pose second{first.position + random.vector(0.6), random.rotation()};
    const int kind = static_cast<int>(random.between(0.0, 3.999));
    scenario.script.hands[1] = [&](double t_s) {
        return t_s < from_s              ? first
               : t_s >= to_s || kind > 2 ? second
                                         : Error{0.0, 0.0, kind, {}}.of(second);
    };
    scenario.script.grabs[1] = [](double t_s) { return t_s > 0.1; };
    scenario.add_player_here();
    scenario.run(0.45);
    const Pose held = inverse(first) * scenario.body(rock);
    Vec3 before = scenario.body(rock).position;
    const Vec3 view_before = view(scenario);
    double speed_mps = 0.0;
    scenario.run(to_s + 2.5 - 0.45, [&] {
        speed_mps =
            std::max(speed_mps, scenario.hz * (scenario.body(rock).position - before).norm());
        before = scenario.body(rock).position;
    });
    RC_ASSERT(scenario.grab(HandSide::right).kind == GripKind::held);
    const Pose at_end = inverse(second) * scenario.body(rock);
    RC_ASSERT((at_end.position - held.position).norm() < 1e-3);
    RC_ASSERT((view(scenario) - view_before).norm() < 1e-9);
    // A rotation may take the rock, 0.15 m from the wrist, along at 80 rad/s: 0.1 m count a radian.
    RC_ASSERT(speed_mps <= 2.5 * scenario.tuning.tracking.max_hand_speed_mps);
}

RC_GTEST_PROP(TrackingErrors, PalmThatComesBackFarFromItsSurfaceLetsGo, (std::uint64_t seed)) {
    Random random(seed);
    Climb climb(random);
    const double from_s = random.between(0.5, 0.6);
    const double to_s = from_s + random.between(0.05, 1.0);
    const double away_m = random.between(0.05, 0.6);
    climb.scenario.script.hands[1] = [&](double t_s) {
        return t_s < from_s ? climb.hand
               : t_s < to_s
                   ? lost()
                   : Pose{climb.hand.position + Vec3(0.0, 0.0, away_m), climb.hand.rotation};
    };
    std::uint64_t let_go = 0;
    climb.scenario.run(to_s + 0.2,
                       [&] { let_go += climb.scenario.fallbacks(Fallback::grip_out_of_reach); });
    const double palm_to_wall_m = 0.01 + away_m;
    if (std::abs(palm_to_wall_m - climb.scenario.tuning.hand.max_stretch_m) > 1e-6) {
        const bool is_far = palm_to_wall_m > climb.scenario.tuning.hand.max_stretch_m;
        RC_ASSERT(let_go == (is_far ? 1U : 0U));
        RC_ASSERT(climb.grips() == !is_far);
    }
    RC_ASSERT(climb.scenario.velocity().norm() < 1e-9);
}

// --- Recentring ----------------------------------------------------------------------------------

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
