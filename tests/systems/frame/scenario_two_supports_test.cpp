// Two hands on immovable supports: one fixed body, or two that separate. Expected values are closed
// forms of hands and supports.
#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "tests/systems/frame/scenario.hpp"

namespace handhold::scenario_two_supports_test {
namespace {

constexpr double k_jump_m = 1e-5;
constexpr double k_palm_m = 1.06;  // a centimetre above the support

bool holds(const Scenario& s, HandSide side) { return s.grab(side).kind == GripKind::surface; }

Vec3 palm_of(HandSide side) { return {side == HandSide::left ? -0.3 : 0.3, k_palm_m, 0.1}; }
Vec3 hand_of(const Scenario& s, HandSide side) {
    const double mirror = side == HandSide::left ? -1.0 : 1.0;
    return palm_of(side) - Vec3(mirror, 1.0, 1.0).cwiseProduct(s.tuning.hand.palm_center_m);
}

// The right hand holds, the left one joins, one of them releases. Both have the same motion, at up
// to 0.9 m/s and 3.6 m/s^2: the head moves by its opposite, whichever hand holds.
void join_and_leave_a_wall(HandSide leaving, double sample_hz) {
    Scenario s;
    s.sample_hz = sample_hz;
    s.add_wall("floor", Vec3(2.0, 0.05, 2.0), Vec3(0.0, 1.0, 0.0));
    s.add_player_here();
    const auto motion = [](double t_s) {
        const Vec3 wave(0.2 * std::sin(4.0 * t_s), 0.1 * std::sin(6.0 * t_s),
                        0.1 * std::cos(5.0 * t_s));
        return Vec3(ease(t_s, 0.2, 0.6) * wave);
    };
    for (const HandSide side : {HandSide::left, HandSide::right}) {
        const Vec3 hand = hand_of(s, side);
        const double from_s = side == HandSide::left ? 0.9 : 0.05;
        const double to_s = side == leaving ? 1.6 : 1e9;
        s.script.hands[index_of(side)] = [=](double t_s) {
            return Pose{hand + motion(t_s), Quat::Identity()};
        };
        s.script.grabs[index_of(side)] = [=](double t_s) { return t_s > from_s && t_s < to_s; };
    }
    int both = 0;
    s.run(2.2, [&] {
        ASSERT_LE((s.origin() + motion(s.t_s())).norm(), k_jump_m) << s.t_s();
        both += holds(s, HandSide::left) && holds(s, HandSide::right) ? 1 : 0;
    });
    EXPECT_GT(both, 50);
    EXPECT_FALSE(holds(s, leaving));
    EXPECT_TRUE(holds(s, leaving == HandSide::left ? HandSide::right : HandSide::left));
}

TEST(TwoSupports, JoiningAndLeavingAWallDoNotMoveTheHead) {
    for (const double sample_hz : {90.0, 1000.0}) {
        join_and_leave_a_wall(HandSide::left, sample_hz);
    }
}

TEST(TwoSupports, PassingAWallFromHandToHandDoesNotMoveTheHead) {
    for (const double sample_hz : {90.0, 1000.0}) {
        join_and_leave_a_wall(HandSide::right, sample_hz);
    }
}

// The hands' targets are 20 cm farther apart than the supports: each has half the error when one
// support is destroyed.
TEST(TwoSupports, DestroyingOneSupportDoesNotMoveTheHead) {
    for (const HandSide gone : {HandSide::left, HandSide::right}) {
        Scenario s;
        Entity supports[k_hand_count];
        for (const HandSide side : {HandSide::left, HandSide::right}) {
            const bool is_left = side == HandSide::left;
            const Vec3 under(palm_of(side).x(), 1.0, 0.1);
            supports[index_of(side)] =
                s.add_wall(is_left ? "left" : "right", Vec3(0.28, 0.05, 0.5), under);
            const Vec3 hand = hand_of(s, side);
            s.script.hands[index_of(side)] = [=](double t_s) {
                const double away_m = side == gone ? 0.2 * ease(t_s, 0.2, 0.8) : 0.0;
                return Pose{hand + Vec3(is_left ? -away_m : away_m, 0.0, 0.0), Quat::Identity()};
            };
            s.script.grabs[index_of(side)] = [](double t_s) { return t_s > 0.05; };
        }
        s.add_player_here();
        s.run(1.0);
        ASSERT_NEAR(s.grab(HandSide::left).error_m, 0.1, 1e-6);
        const Vec3 before = s.origin();
        ASSERT_NEAR(std::abs(before.x()), 0.1, 1e-6);
        ASSERT_TRUE(destroy(s.world, supports[index_of(gone)]));
        s.run(0.3, [&] { ASSERT_LE((s.origin() - before).norm(), k_jump_m); });
        EXPECT_FALSE(holds(s, gone));
        EXPECT_TRUE(holds(s, gone == HandSide::left ? HandSide::right : HandSide::left));
    }
}

// One hand holds a wall, the other pulls a drawer that is at its end: each has half the error when
// one of them lets go, is lost or loses what it holds. The other keeps what it has.
TEST(TwoSupports, LettingGoBesideADrawerAtItsEndDoesNotMoveTheHead) {
    enum class End { opened, lost, destroyed };
    for (const End end : {End::opened, End::lost, End::destroyed}) {
        for (const HandSide leaving : {HandSide::left, HandSide::right}) {
            constexpr double k_end_s = 1.2;
            Scenario s;
            const Vec3 half_m(0.28, 0.05, 0.5);
            const Entity wall = s.add_wall("wall", half_m, Vec3(-0.3, 1.0, 0.1));
            const Entity drawer = s.add_crate("drawer", 4.0, Vec3(0.3, 1.0, 0.1), half_m);
            Joint slider;
            slider.kind = JointKind::slider;
            slider.limited = true;
            slider.lower = -0.4;
            slider.upper = 0.0;
            slider.b = drawer;
            add_joint(s.world, {"slider", joint_at(s.world, slider,
                                                   Pose{Vec3(0.3, 1.0, 0.1), Quat::Identity()})});
            for (const HandSide side : {HandSide::left, HandSide::right}) {
                const Vec3 hand = hand_of(s, side);
                s.script.hands[index_of(side)] = [=](double t_s) {
                    const double away_m = side == HandSide::right ? 0.2 * ease(t_s, 0.2, 0.8) : 0.0;
                    return Pose{hand + Vec3(away_m, 0.0, 0.0), Quat::Identity()};
                };
                s.script.grabs[index_of(side)] = [=](double t_s) {
                    return t_s > 0.05 && (end != End::opened || side != leaving || t_s < k_end_s);
                };
            }
            s.add_player_here();
            s.run(1.0);
            ASSERT_EQ(s.grab(HandSide::right).kind, GripKind::held);
            ASSERT_NEAR(s.grab(HandSide::left).error_m, 0.1, 1e-3);
            const Vec3 before = s.origin();
            if (end == End::destroyed) {
                ASSERT_TRUE(destroy(s.world, leaving == HandSide::left ? wall : drawer));
            } else if (end == End::lost) {
                s.world.grab.at(s.player.hands[index_of(leaving)]).error_m = 1.0;  // beyond reach
            }
            s.run(0.6, [&] {
                ASSERT_LE((s.origin() - before).norm(), 1e-3)
                    << static_cast<int>(end) << ' ' << s.t_s();
            });
            EXPECT_EQ(s.grab(leaving).kind, GripKind::none);
            EXPECT_NE(s.grab(leaving == HandSide::left ? HandSide::right : HandSide::left).kind,
                      GripKind::none);
        }
    }
}

// One support moves left, the other right and faster. The head moves with the support that is held,
// then with the mean of both, and with the first again after the second hand is overstretched.
TEST(TwoSupports, PartingSupportsAreSharedUntilTheSecondHandReleases) {
    constexpr double k_left_mps = -0.2;
    constexpr double k_right_mps = 0.3;
    Scenario s;
    const auto add_half = [&](const char* name, HandSide side, double speed_mps) {
        const Vec3 under(palm_of(side).x(), 1.0, 0.1);
        s.set_motion(s.add_wall(name, Vec3(0.28, 0.05, 0.5), under), Vec3(speed_mps, 0.0, 0.0),
                     Vec3::Zero());
        const Vec3 hand = hand_of(s, side);
        s.script.hands[index_of(side)] = [hand](double) { return Pose{hand, Quat::Identity()}; };
    };
    add_half("left", HandSide::left, k_left_mps);
    add_half("right", HandSide::right, k_right_mps);
    s.add_player_here();
    s.script.grabs[0] = [](double t_s) { return t_s > 0.3; };
    s.script.grabs[1] = [](double t_s) { return t_s > 0.05; };
    double last_x = 0.0;
    int held_frames = 0;
    int shared_frames = 0;
    std::uint64_t let_go = 0;
    const double mean_mps = 0.5 * (k_left_mps + k_right_mps);
    s.run(2.0, [&] {
        const double step_mps = (s.origin().x() - last_x) * s.hz;
        last_x = s.origin().x();
        let_go += s.fallbacks(Fallback::grip_stretched);
        if (!holds(s, HandSide::right)) {
            ASSERT_EQ(held_frames, 0);
            return;
        }
        ++held_frames;
        if (holds(s, HandSide::left)) {
            ++shared_frames;
            ASSERT_NEAR(s.grab(HandSide::left).error_m, s.grab(HandSide::right).error_m, 1e-6);
            ASSERT_LE(s.grab(HandSide::left).error_m,
                      s.tuning.hand.max_stretch_m + 0.25 / s.hz + 1e-6);
        }
        // In the frame of the grip, part of the motion is still the old one.
        const bool is_first = held_frames == 1 || shared_frames == 1;
        const double expected_mps = holds(s, HandSide::left) ? mean_mps : k_right_mps;
        if (!is_first || (shared_frames == 1 && !holds(s, HandSide::left))) {
            ASSERT_NEAR(step_mps, expected_mps, k_jump_m * s.hz) << s.t_s();
        } else {
            ASSERT_GE(step_mps, std::min(0.0, mean_mps) - k_jump_m * s.hz);
            ASSERT_LE(step_mps, k_right_mps + k_jump_m * s.hz);
        }
    });
    EXPECT_EQ(let_go, 1U);
    EXPECT_FALSE(holds(s, HandSide::left));
    EXPECT_TRUE(holds(s, HandSide::right));
    // 0.3 m at a quarter of a metre a second.
    EXPECT_NEAR(shared_frames, 1.2 * s.hz, 2.0);
}

}  // namespace
}  // namespace handhold::scenario_two_supports_test
