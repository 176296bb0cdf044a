// Hostile input: nothing that players or tracking do may stop, corrupt or blow up the simulation,
// and every fallback is counted.
#include <array>
#include <limits>

#include <gtest/gtest.h>

#include "tests/systems/frame/scenario.hpp"

namespace handhold::scenario_hostile_test {
namespace {

// Reproducible numbers in [0, 1).
class Dice {
  public:
    explicit Dice(std::uint64_t seed) : state_(seed) {}
    double roll() {
        state_ += 0x9e3779b97f4a7c15ULL;
        return static_cast<double>(mix64(state_) >> 11U) * 0x1.0p-53;
    }
    Vec3 vector(double size) {
        const double x = roll();
        const double y = roll();
        const double z = roll();
        return size * Vec3(2.0 * x - 1.0, 2.0 * y - 1.0, 2.0 * z - 1.0);
    }

  private:
    std::uint64_t state_;
};

TEST(Jam, BoxPulledIntoANarrowGapStaysThereAndIsCounted) {
    Scenario s;
    const double gap_m = 0.14;
    const double half_m = 0.08;
    s.add_wall("left", Vec3(0.3, 0.5, 0.3), Vec3(-0.3 - 0.5 * gap_m, 0.9, -0.6));
    s.add_wall("right", Vec3(0.3, 0.5, 0.3), Vec3(0.3 + 0.5 * gap_m, 0.9, -0.6));
    const Vec3 palm(0.0, 1.2, 0.0);
    const Entity box =
        s.add_crate("box", 2.0, palm - Vec3(0.0, half_m + 0.005, 0.0), Vec3::Constant(half_m));
    s.add_player_here();
    const Vec3 hand = hand_for_palm(s, palm);
    s.script.grabs[1] = [](double t) { return t > 0.05; };
    s.script.hands[1] = [=](double t) {
        return Pose{hand - Vec3(0.0, 0.0, 0.5 * ease(t, 0.3, 1.0)), Quat::Identity()};
    };
    s.run(2.0, [&] {
        ASSERT_TRUE(s.origin().allFinite());
        ASSERT_LE(s.velocity().norm(), s.tuning.locomotion.release_speed_max_mps + 1e-9);
        // A box of 16 cm does not fit into 14 cm: it stays outside the gap and the player is pushed
        // away.
        ASSERT_GE(s.body(box).position.z() - half_m, -0.3 - 1e-3);
    });
    EXPECT_GT(s.origin().z(), 0.1);
}

TEST(Jam, HeadBetweenClosingWallsIsCountedAndFinite) {
    Scenario s;
    s.add_wall("wall", Vec3(0.1, 1.0, 1.0), Vec3(-0.3, 1.6, 0.6));
    const Entity press = s.add_wall("press", Vec3(0.1, 1.0, 1.0), Vec3(0.5, 1.6, 0.6));
    s.set_motion(press, Vec3(-0.3, 0.0, 0.0), Vec3::Zero());
    s.add_player_here();
    std::uint64_t unresolved = 0;
    s.run(1.5, [&] {
        ASSERT_TRUE(s.origin().allFinite());
        ASSERT_LE(s.origin().norm(), 1.0);
        unresolved += s.fallbacks(Fallback::contacts_unresolved);
    });
    EXPECT_GT(unresolved, 0U);  // the final gap is narrower than the head
}

TEST(HandJumps, KilometreJumpReleasesTheGripWithoutAThrow) {
    Scenario s;
    s.add_wall("wall", Vec3(2.0, 0.05, 2.0), Vec3(0.0, 1.0, 0.0));
    s.add_player_here();
    const Vec3 hand = hand_for_palm(s, Vec3(0.3, 1.06, 0.1));
    s.script.grabs[1] = [](double t) { return t > 0.05 && t < 0.6; };
    s.script.hands[1] = [=](double t) {
        return Pose{t > 0.3 && t < 0.35 ? Vec3(hand + Vec3(0.0, 5000.0, 0.0)) : hand,
                    Quat::Identity()};
    };
    s.run(1.0, [&] { ASSERT_TRUE(s.origin().allFinite()); });
    EXPECT_LE(s.velocity().norm(), s.tuning.locomotion.release_speed_max_mps + 1e-9);
}

TEST(TrackingLoss, FreezesTheHandAndResumesWithoutAJump) {
    Scenario s;
    s.add_wall("wall", Vec3(2.0, 0.05, 2.0), Vec3(0.0, 1.0, 0.0));
    s.add_player_here();
    const Vec3 hand = hand_for_palm(s, Vec3(0.3, 1.06, 0.1));
    const double nan = std::numeric_limits<double>::quiet_NaN();
    s.script.grabs[1] = [](double t) { return t > 0.05; };
    s.script.hands[1] = [=](double t) {
        if (t > 0.4 && t < 1.0) {
            return Pose{Vec3(nan, nan, nan), Quat(nan, nan, nan, nan)};
        }
        return Pose{t < 0.7 ? hand : Vec3(hand + Vec3(0.0, 0.2, 0.2)), Quat::Identity()};
    };
    Vec3 before = s.origin();
    std::uint64_t reanchored = 0;
    s.run(1.5, [&] {
        ASSERT_LE((s.origin() - before).norm(), 1e-6);
        before = s.origin();
        reanchored += s.fallbacks(Fallback::grip_reanchored);
    });
    EXPECT_EQ(reanchored, 1U);
    EXPECT_EQ(s.grab(HandSide::right).kind, GripKind::surface);
}

TEST(GrippedBody, IsReleasedIfDestroyed) {
    Scenario s;
    const Entity rock = s.add_rock("rock", 5.0, Vec3(0.3, 1.115, 0.0));
    s.add_player_here();
    const Vec3 hand = hand_for_palm(s, Vec3(0.3, 1.2, 0.0));
    s.script.hands[1] = [=](double) { return Pose{hand, Quat::Identity()}; };
    s.script.grabs[1] = [](double t) { return t > 0.05; };
    s.run(0.5);
    ASSERT_EQ(s.grab(HandSide::right).kind, GripKind::held);
    ASSERT_TRUE(destroy(s.world, rock));
    s.step();
    EXPECT_EQ(s.grab(HandSide::right).kind, GripKind::none);
    EXPECT_EQ(s.fallbacks(Fallback::grip_body_gone), 1U);
    s.run(0.5);
}

// Hands that jerk, jump, vanish and press buttons at random, in a room with loose bodies, on a
// moving floor.
class RandomPlay : public testing::TestWithParam<std::uint64_t> {};

TEST_P(RandomPlay, StaysFiniteInsideAndBelowASpeedLimit) {
    Scenario s;
    Dice dice(GetParam());
    s.tuning.contact.margin_m = 0.02;
    const auto wall = [&s](const char* name, const Vec3& half_m, const Vec3& center) {
        return s.add_wall(name, half_m, center);
    };
    wall("floor", Vec3(2.0, 0.2, 2.0), Vec3(0.0, 0.0, 0.0));
    wall("ceiling", Vec3(2.0, 0.2, 2.0), Vec3(0.0, 3.0, 0.0));
    wall("west", Vec3(0.2, 2.0, 2.0), Vec3(-1.5, 1.5, 0.0));
    wall("east", Vec3(0.2, 2.0, 2.0), Vec3(1.5, 1.5, 0.0));
    wall("north", Vec3(2.0, 2.0, 0.2), Vec3(0.0, 1.5, -1.5));
    wall("south", Vec3(2.0, 2.0, 0.2), Vec3(0.0, 1.5, 1.5));
    for (int i = 0; i < 5; ++i) {
        s.add_rock("rock" + std::to_string(i), 0.5 + 4.0 * i, Vec3(-0.6 + 0.3 * i, 0.9, 0.7));
        s.add_crate("crate" + std::to_string(i), 1.0 + 10.0 * i, Vec3(-0.6 + 0.3 * i, 2.2, -0.7),
                    Vec3(0.1, 0.06, 0.08));
    }
    const Entity spinner = wall("spinner", Vec3(0.6, 0.05, 0.05), Vec3(0.0, 0.7, -0.6));
    s.set_motion(spinner, Vec3::Zero(), Vec3(0.0, 1.0, 0.0));
    s.add_player_here(Vec3(0.0, 0.0, -0.4));

    struct Hand {
        Vec3 at, to;
        bool grab;
        bool lost;
    };
    std::array<Hand, 2> hands = {{{Vec3(-0.3, 1.3, 0.2), Vec3(-0.3, 1.3, 0.2), false, false},
                                  {Vec3(0.3, 1.3, 0.2), Vec3(0.3, 1.3, 0.2), false, false}}};
    for (std::size_t side = 0; side < 2; ++side) {
        s.script.hands[side] = [&hands, side](double t) {
            const double nan = std::numeric_limits<double>::quiet_NaN();
            const Hand& hand = hands[side];
            return Pose{
                hand.lost ? Vec3(nan, nan, nan) : hand.at,
                rotation_from_vector(Vec3(std::sin(t), std::sin(1.7 * t), std::sin(0.6 * t)))};
        };
        s.script.grabs[side] = [&hands, side](double) { return hands[side].grab; };
    }
    // Bodies bounce off what they hit, and the spinner adds speed.
    const double fastest_mps = s.tuning.locomotion.release_speed_max_mps + 4.0;
    s.run(60.0, [&] {
        for (Hand& hand : hands) {
            hand.at += 0.15 * (hand.to - hand.at);
            if (dice.roll() < 0.03) {
                hand.to = Vec3(0.0, 1.4, 0.3) + dice.vector(0.6);
            }
            if (dice.roll() < 0.004) {
                hand.at += dice.vector(0.8);  // a jump
            }
            if (dice.roll() < 0.03) {
                hand.grab = !hand.grab;
            }
            if (dice.roll() < 0.01) {
                hand.lost = !hand.lost;
            }
        }
        ASSERT_TRUE(s.origin().allFinite()) << "frame " << s.world.clock.frame;
        ASSERT_LE(s.velocity().norm(), fastest_mps) << "frame " << s.world.clock.frame;
        ASSERT_LE(s.head_center().cwiseAbs().maxCoeff(), 3.5) << "frame " << s.world.clock.frame;
        for (const BodyPose& body : s.world.body_pose.elements()) {
            ASSERT_TRUE(is_valid(body.pose_ws));
        }
    });
    for (std::size_t index = 0; index < s.world.body.size(); ++index) {
        EXPECT_LE(s.world.body_pose.elements()[index].pose_ws.position.norm(), 5.0)
            << "left the room, element " << index;
    }
}
INSTANTIATE_TEST_SUITE_P(Seeds, RandomPlay, testing::Range<std::uint64_t>(1, 9));

}  // namespace
}  // namespace handhold::scenario_hostile_test
