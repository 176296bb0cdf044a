#include <algorithm>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "tests/systems/input/climb_on_a_wall.hpp"

// Effects of wrong, missing and late tracking on a player, through the whole frame.
namespace handhold::tracking_errors_test {
namespace {

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
    const Vec3 moved{random.between(-0.5, 0.5), random.between(-0.3, 0.3), 0.0};
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
    const double end_s = begin_s + random.between(0.15, 0.25);  // from here on at speed_mps
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

}  // namespace
}  // namespace handhold::tracking_errors_test
