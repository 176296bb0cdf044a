// Both hands on one free body, through whole frames (solver.md: feasible by construction). Expected
// values are closed forms of the hands' motion.
#include <algorithm>
#include <cmath>
#include <optional>

#include <gtest/gtest.h>

#include "tests/systems/frame/scenario.hpp"

namespace handhold::scenario_two_hands_test {
namespace {

constexpr double k_half_length_m = 0.4;

HandSide other_side(HandSide side) {
    return side == HandSide::left ? HandSide::right : HandSide::left;
}

// Upper bound of the displacement of any point of the bar between two poses.
double jump_m(const Pose& a, const Pose& b) {
    const Pose between = inverse(a) * b;
    return between.position.norm() + k_half_length_m * rotation_to_vector(between.rotation).norm();
}

// A bar under both palms, 20 cm to either side. Hands share a rigid motion (`carried`); relative to
// the bar each also moves `along` it, twists about it (`twist`), and moves `aside`.
struct Bar {
    Scenario s;
    Entity bar;
    Pose rest[k_hand_count];
    HandSide first = HandSide::left;
    std::function<Pose(double)> carried = [](double) { return Pose{}; };
    std::function<double(double)> along[k_hand_count] = {[](double) { return 0.0; },
                                                         [](double) { return 0.0; }};
    std::function<double(double)> twist[k_hand_count] = {[](double) { return 0.0; },
                                                         [](double) { return 0.0; }};

    // The wall's face is at z = `wall_z` and faces +z.
    explicit Bar(HandSide first_hand, double mass_kg = 2.0, std::optional<double> wall_z = {})
        : first(first_hand) {
        const Vec3 half_m(k_half_length_m, 0.02, 0.02);
        bar = s.add_crate("bar", mass_kg, Vec3(0.0, 1.2 - 0.025, 0.0), half_m);
        if (wall_z) {
            s.add_wall("wall", Vec3(2.0, 2.0, 0.05), Vec3(0.0, 1.0, *wall_z - 0.05));
        }
        s.add_player_here();
        for (const HandSide side : {HandSide::left, HandSide::right}) {
            const std::size_t i = index_of(side);
            const double x = side == HandSide::left ? -0.2 : 0.2;
            rest[i] = {hand_for_palm(s, Vec3(x, 1.2, 0.0)), Quat::Identity()};
            s.script.hands[i] = [this, i](double t) { return hand_ps(i, t); };
        }
        hold(0.05, 0.2);
    }
    Bar(const Bar&) = delete;
    Bar& operator=(const Bar&) = delete;

    Pose hand_ps(std::size_t i, double t) const {
        const Pose on_bar{rest[i].position + along[i](t) * Vec3::UnitX(),
                          rotation_about(Vec3::UnitX(), twist[i](t)) * rest[i].rotation};
        return carried(t) * on_bar;
    }
    void hold(double first_s, double second_s, double first_until_s = 1e9,
              double second_until_s = 1e9) {
        s.script.grabs[index_of(first)] = [=](double t) {
            return t > first_s && t < first_until_s;
        };
        s.script.grabs[index_of(other_side(first))] = [=](double t) {
            return t > second_s && t < second_until_s;
        };
    }
    std::size_t first_index() const { return index_of(first); }
    std::size_t second_index() const { return index_of(other_side(first)); }
    bool leads_both() const {
        return s.grab(HandSide::left).two_handed && s.grab(HandSide::right).two_handed;
    }
    Pose hand(std::size_t i) const {
        return Pose{s.origin(), Quat::Identity()} * hand_ps(i, s.t_s());
    }
    Pose in_hand(std::size_t i) const { return inverse(hand(i)) * s.body(bar); }
};

// Rotates so slowly that the chord of a hand's arc within a frame is within 2e-7 m of the arc.
Pose slow_carry(double t) {
    return {Vec3(0.3 * t, -0.1 * t, 0.2 * t), rotation_about(Vec3(0.6, 0.0, 0.8), 0.1 * t)};
}
Pose lively_carry(double t) {
    const double w = ease(t, 0.3, 0.8);
    return {w * Vec3(0.2 * std::sin(5 * t), 0.15 * std::cos(4 * t), 0.1 * std::sin(7 * t)),
            rotation_from_vector(w * Vec3(0.3 * std::sin(3 * t), 0.5 * std::sin(4 * t), 0.2))};
}

class DrivePair : public testing::TestWithParam<HandSide> {};

TEST_P(DrivePair, FirstHandKeepsItsPointAndTheSecondItsLineWhileTheirDistanceVaries) {
    Bar b(GetParam());
    b.carried = lively_carry;
    b.along[b.second_index()] = [](double t) {
        return 0.05 * ease(t, 0.3, 0.4) * std::sin(6.0 * t);
    };
    const Vec3 before = b.s.origin_ws();
    int led = 0;
    double worst_m = 0.0;
    b.s.run(3.0, [&] {
        ASSERT_EQ(b.s.origin_ws(), before);  // bitwise
        led += b.leads_both() ? 1 : 0;
        worst_m = std::max(worst_m, b.s.grab(b.first).error_m);
        // The error along the bar only.
        const double slid_m = std::abs(b.along[b.second_index()](b.s.t_s()));
        if (b.leads_both()) {
            EXPECT_NEAR(b.s.grab(other_side(b.first)).error_m, slid_m, 1e-6);
        }
    });
    EXPECT_GT(led, 240);
    EXPECT_LE(worst_m, 1e-6);
}

TEST_P(DrivePair, TwistOfTheBarIsTheMeanOfTheHands) {
    Bar b(GetParam());
    b.carried = lively_carry;
    b.twist[0] = [](double t) { return 2.0 * ease(t, 0.3, 1.2); };
    b.twist[1] = [](double t) { return -1.6 * ease(t, 0.3, 1.0); };  // 206 degrees apart
    b.s.run(2.0, [&] {
        const double t = b.s.t_s();
        const double mean = t > 0.25 ? 0.5 * (b.twist[0](t) + b.twist[1](t)) : 0.0;
        const Quat expected = b.carried(t).rotation * rotation_about(Vec3::UnitX(), mean);
        ASSERT_LE(jump_m({Vec3::Zero(), expected}, {Vec3::Zero(), b.s.body(b.bar).rotation}), 1e-6)
            << t;
    });
    EXPECT_TRUE(b.leads_both());
}

TEST_P(DrivePair, JoiningMovesNothing) {
    Bar b(GetParam());
    b.hold(0.05, 0.5047);  // within a frame
    b.carried = slow_carry;
    b.twist[b.second_index()] = [](double) { return 0.7; };  // the hand closes at any orientation
    const Vec3 before = b.s.origin_ws();
    b.s.run(0.4);
    const Pose held = b.in_hand(b.first_index());
    b.s.run(0.5, [&] {
        ASSERT_EQ(b.s.origin_ws(), before);
        ASSERT_LE(jump_m(held, b.in_hand(b.first_index())), 1e-6) << b.s.t_s();
    });
    EXPECT_TRUE(b.leads_both());
}

// After the hands moved along and about the bar, either one releases while both move on as one.
TEST_P(DrivePair, LeavingMovesNothing) {
    for (const bool first_leaves : {true, false}) {
        Bar b(GetParam());
        b.hold(0.05, 0.2, first_leaves ? 1.2047 : 1e9, first_leaves ? 1e9 : 1.2047);
        b.carried = slow_carry;
        b.along[1] = [](double t) { return 0.03 * ease(t, 0.4, 0.8); };
        b.twist[0] = [](double t) { return 0.6 * ease(t, 0.4, 0.9); };
        b.twist[1] = [](double t) { return -0.2 * ease(t, 0.4, 0.9); };
        const Vec3 before = b.s.origin_ws();
        b.s.run(1.0);
        ASSERT_TRUE(b.leads_both());
        const std::size_t staying = first_leaves ? b.second_index() : b.first_index();
        const Pose held = b.in_hand(staying);
        b.s.run(0.6, [&] {
            ASSERT_EQ(b.s.origin_ws(), before);
            ASSERT_LE(jump_m(held, b.in_hand(staying)), 1e-6) << b.s.t_s();
        });
        EXPECT_FALSE(b.s.grab(HandSide::left).two_handed || b.s.grab(HandSide::right).two_handed);
        EXPECT_LE(b.s.grab(first_leaves ? other_side(b.first) : b.first).error_m, 1e-7);
    }
}

// From one hand to the other and back: one after the other, in one frame, and in one frame with the
// first hand opening before the second closes.
TEST_P(DrivePair, PassingFromHandToHandMovesNothing) {
    for (const double late_s : {0.03, 0.002, -0.002}) {
        Bar b(GetParam());
        const double pass_s = 0.5 + 4.0 / 900.0;
        b.hold(0.05, pass_s, pass_s + late_s);
        const auto first_once = b.s.script.grabs[b.first_index()];
        b.s.sample_hz = 1800.0;
        b.s.script.grabs[b.first_index()] = [=](double t) { return first_once(t) || t > 0.8; };
        b.carried = slow_carry;
        const Vec3 before = b.s.origin_ws();
        b.s.run(0.4);
        const Pose held = inverse(b.carried(b.s.t_s())) * b.s.body(b.bar);
        b.s.run(0.8, [&] {
            ASSERT_EQ(b.s.origin_ws(), before);
            const Pose now = inverse(b.carried(b.s.t_s())) * b.s.body(b.bar);
            ASSERT_LE(jump_m(held, now), 1e-6) << b.s.t_s() << " " << late_s;
        });
        EXPECT_TRUE(b.leads_both());
        EXPECT_LT(b.s.grab(other_side(b.first)).since_s, b.s.grab(b.first).since_s);
    }
}

// While the hands pass each other there is no line between them: the bar neither spins nor jumps.
TEST_P(DrivePair, HandsThatMeetLeaveTheBarToTheFirst) {
    Bar b(GetParam());
    const double inward = b.second_index() == 1 ? -1.0 : 1.0;
    b.along[b.second_index()] = [=](double t) {
        return inward * 0.39 * ease(t, 0.4, 1.0) * (1.0 - ease(t, 1.2, 1.8));
    };
    b.s.tuning.hand.max_stretch_m = 1.0;
    std::uint64_t close = 0;
    const Vec3 before = b.s.origin_ws();
    b.s.run(0.35);
    const Pose held = b.s.body(b.bar);
    b.s.run(1.85, [&] {
        close += b.s.fallbacks(Fallback::hands_too_close);
        ASSERT_EQ(b.s.origin_ws(), before);
        ASSERT_LE(jump_m(held, b.s.body(b.bar)), 1e-6) << b.s.t_s();
    });
    EXPECT_GT(close, 10U);
    EXPECT_TRUE(b.leads_both());
}

TEST_P(DrivePair, SecondHandReleasesIfItSlidesTooFarAndTheBarStays) {
    Bar b(GetParam());
    const double outward = b.second_index() == 1 ? 1.0 : -1.0;
    b.along[b.second_index()] = [=](double t) { return outward * 0.35 * ease(t, 0.4, 1.0); };
    b.twist[b.first_index()] = [](double t) { return 0.4 * ease(t, 0.4, 0.5); };
    std::uint64_t stretched = 0;
    b.s.run(0.55);
    const Pose held = b.s.body(b.bar);
    b.s.run(0.65, [&] {
        stretched += b.s.fallbacks(Fallback::grip_stretched);
        ASSERT_LE(jump_m(held, b.s.body(b.bar)), 1e-6) << b.s.t_s();
    });
    EXPECT_EQ(stretched, 1U);
    EXPECT_EQ(b.s.grab(b.first).kind, GripKind::held);
    EXPECT_EQ(b.s.grab(other_side(b.first)).kind, GripKind::none);
}

// Hand errors that no row resists must not push the player off what the bar touches (decision 6).
TEST_P(DrivePair, HandErrorsOnABarAtAWallDoNotPushThePlayer) {
    Bar b(GetParam(), 2.0, -0.02 - 5e-6);
    b.along[b.second_index()] = [](double t) { return 0.03 * ease(t, 0.3, 0.4) * std::sin(9 * t); };
    const Vec3 before = b.s.origin_ws();
    std::uint64_t contacts = 0;
    b.s.run(1.5, [&] {
        contacts += b.s.stats.contacts;
        ASSERT_EQ(b.s.origin_ws(), before);
    });
    EXPECT_GT(contacts, 100U);
    EXPECT_TRUE(b.leads_both());
}

// A throw by both hands, which twist about the line: v_com = v_first + w x (com - first).
TEST_P(DrivePair, ThrownByBothLeavesWithTheirMotionAtItsCentre) {
    Bar b(GetParam());
    const double until_s = 0.505;
    b.hold(0.05, 0.2, until_s, until_s);
    const Vec3 velocity_mps(0.4, 0.2, -1.0);
    const Vec3 spin_radps(2.0, 0.0, 0.0);
    b.carried = [=](double t) {
        return Pose{velocity_mps * std::max(0.0, t - 0.3), Quat::Identity()};
    };
    b.twist[0] = b.twist[1] = [=](double t) { return spin_radps.x() * std::max(0.0, t - 0.3); };
    b.s.run(0.5);
    ASSERT_TRUE(b.leads_both());
    b.s.run(2.0 / 90.0);
    ASSERT_EQ(b.s.grab(HandSide::left).kind, GripKind::none);
    ASSERT_EQ(b.s.grab(HandSide::right).kind, GripKind::none);
    const double released_end_s = std::ceil(until_s * b.s.hz) / b.s.hz;
    const Quat turned = rotation_from_vector(spin_radps * (released_end_s - 0.3));
    const Vec3 arm = turned * (Vec3(0.0, 1.175, 0.0) - b.rest[b.first_index()].position);
    EXPECT_LE((b.s.body_spin(b.bar) - spin_radps).norm(), 1e-6);
    EXPECT_LE((b.s.body_velocity(b.bar) - (velocity_mps + spin_radps.cross(arm))).norm(), 1e-5);
}

// Hands that move in opposite directions rotate the line by atan(0.5 t), t since they began.
TEST_P(DrivePair, BarSpinsAsTheLineBetweenThemTurns) {
    Bar b(GetParam());
    const auto turned_rad = [](double t) { return std::atan(0.5 * std::max(0.0, t - 0.3)); };
    for (const std::size_t side : {0U, 1U}) {
        const double z_mps = side == 0 ? 0.1 : -0.1;  // 0.4 m apart
        b.s.script.hands[side] = [&b, side, z_mps](double t) {
            Pose hand = b.hand_ps(side, t);
            hand.position.z() += z_mps * std::max(0.0, t - 0.3);
            return hand;
        };
    }
    b.s.run(0.3);
    b.s.run(0.7, [&] {
        const double t = b.s.t_s();
        const Quat turned = rotation_about(Vec3::UnitY(), turned_rad(t));
        const double spin_radps = (turned_rad(t) - turned_rad(t - 1.0 / 90.0)) * 90.0;
        ASSERT_LE(jump_m({Vec3::Zero(), turned}, {Vec3::Zero(), b.s.body(b.bar).rotation}), 1e-6);
        ASSERT_LE((b.s.body_spin(b.bar) - spin_radps * Vec3::UnitY()).norm(), 1e-6) << t;
    });
}

TEST_P(DrivePair, MomentumIsExchangedExactlyIfKappaIsOne) {
    Bar b(GetParam(), 30.0);
    b.s.tuning.locomotion.drift_drag_per_s = 0.0;
    b.s.tuning.locomotion.release_speed_max_mps = 1e6;
    b.s.tuning.locomotion.object_speed_max_mps = 1e6;
    b.s.tuning.phases.kappa_light_kg = 0.0;
    b.s.tuning.phases.kappa_heavy_kg = 1.0;
    b.hold(0.05, 0.2, 1.3, 1.0);
    b.s.world.player_velocity.at(b.s.player.player).linear_mps = Vec3(0.02, 0.01, -0.01);
    b.carried = lively_carry;
    b.along[0] = [](double t) { return 0.03 * std::sin(6 * t); };
    b.twist[1] = [](double t) { return 0.4 * std::sin(4 * t); };
    const auto momentum = [&] {
        return Vec3(80.0 * b.s.velocity() + 30.0 * b.s.body_velocity(b.bar));
    };
    const Vec3 before = momentum();
    int led = 0;
    b.s.run(1.5, [&] {
        led += b.leads_both() ? 1 : 0;
        const double size = 80.0 * b.s.velocity().norm() + before.norm();
        ASSERT_LE((momentum() - before).norm(), 1e-9 * size);
        Vec3 linear = Vec3::Zero();
        Vec3 angular = Vec3::Zero();
        double scale = 0.0;
        for (std::size_t i = 0; i < MomentumLedger::receiver_count; ++i) {
            linear += b.s.stats.ledger.linear_kgmps[i];
            angular += b.s.stats.ledger.angular_kgm2ps[i];
            scale +=
                b.s.stats.ledger.linear_kgmps[i].norm() + b.s.stats.ledger.angular_kgm2ps[i].norm();
        }
        ASSERT_LE(linear.norm() + angular.norm(), 1e-12 * scale);
    });
    EXPECT_GT(led, 60);
}

INSTANTIATE_TEST_SUITE_P(FirstHand, DrivePair, testing::Values(HandSide::left, HandSide::right),
                         [](const auto& of) {
                             return of.param == HandSide::left ? "left" : "right";
                         });

// Mirrored in the plane x = 0 between the hands: the left hand of one world is the right hand of
// the other.
TEST(TwoHandsMirrored, MirroredHandsMoveAMirroredBar) {
    const auto mirror_pose = [](const Pose& pose) {
        const Quat& r = pose.rotation;
        return Pose{Vec3(-pose.position.x(), pose.position.y(), pose.position.z()),
                    Quat(r.w(), r.x(), -r.y(), -r.z())};
    };
    Bar here(HandSide::left);
    Bar there(HandSide::right);
    here.carried = lively_carry;
    there.carried = [=](double t) { return mirror_pose(lively_carry(t)); };
    here.along[1] = [](double t) { return 0.04 * std::sin(5 * t); };
    there.along[0] = [](double t) { return -0.04 * std::sin(5 * t); };
    here.twist[1] = there.twist[0] = [](double t) { return 0.8 * ease(t, 0.3, 1.0); };
    here.hold(0.05, 0.2, 1.1);
    there.hold(0.05, 0.2, 1.1);
    for (int frame = 0; frame < 135; ++frame) {
        here.s.step();
        there.s.step();
        ASSERT_LE(jump_m(mirror_pose(here.s.body(here.bar)), there.s.body(there.bar)), 1e-6)
            << frame;
    }
}

}  // namespace
}  // namespace handhold::scenario_two_hands_test
