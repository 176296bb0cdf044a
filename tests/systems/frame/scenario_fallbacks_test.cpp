// Fallbacks of the solve are counted if and only if they happen.
#include <gtest/gtest.h>

#include "tests/systems/frame/scenario.hpp"

namespace handhold::scenario_fallbacks_test {
namespace {

// A player holds a wall while a press moves against the head: both cannot be satisfied.
struct PressedClimber {
    Scenario s;
    Entity press;
    std::uint64_t contradictions = 0;

    explicit PressedClimber(double press_mps) {
        s.tuning.hand.max_stretch_m = 10.0;  // the grip is not released
        s.add_wall("wall", Vec3(1.0, 0.05, 1.0), Vec3(0.0, 1.0, 0.0));
        press = s.add_wall("press", Vec3(0.1, 0.3, 0.3), Vec3(-0.35, 1.6, 0.65));
        s.set_motion(press, Vec3(press_mps, 0.0, 0.0), Vec3::Zero());
        s.add_player_here();
        const Vec3 hand = hand_for_palm(s, Vec3(0.3, 1.06, 0.1));
        s.script.hands[1] = [=](double) { return Pose{hand, Quat::Identity()}; };
        s.script.grabs[1] = [](double t) { return t > 0.05; };
        s.run(1.0, [&] { contradictions += s.fallbacks(Fallback::contacts_contradict); });
    }
    // Gap between the head's collider and the press's face.
    double gap_m() const {
        return s.head_center().x() - s.tuning.head.radius_m - (s.body(press).position.x() + 0.1);
    }
};

TEST(ContactsContradict, GripYieldsIfAPressReachesTheHolder) {
    const PressedClimber pressed(0.4);
    EXPECT_GT(pressed.contradictions, 10U);
    // The press's face ends at x = 0.15 m: the head is outside it, and the hand's error is as large
    // as the push.
    EXPECT_GE(pressed.gap_m(), -1e-3);
    EXPECT_LE(pressed.gap_m(), 5e-3);
    const double pushed_m = 0.15 + pressed.s.tuning.head.radius_m;
    EXPECT_NEAR(pressed.s.origin().x(), pushed_m, 5e-3);
    EXPECT_NEAR(pressed.s.grab(HandSide::right).error_m, pushed_m, 5e-3);
}

TEST(ContactsContradict, NothingIsCountedIfThePressIsAtRest) {
    EXPECT_EQ(PressedClimber(0.0).contradictions, 0U);
}

// A rock is shoved into a corner of two walls: the contact that the first round's result makes is
// found only in the next.
std::uint64_t exhausted_rounds(int max_rounds) {
    Scenario s;
    s.tuning.contact.max_rounds = max_rounds;
    s.add_wall("wall", Vec3(1.0, 1.0, 0.05), Vec3(0.0, 1.0, -0.5));
    s.add_wall("side", Vec3(0.05, 1.0, 1.0), Vec3(0.5, 1.0, 0.0));
    const Vec3 palm(0.3, 1.385, 0.0);
    s.add_rock("rock", 5.0, palm - Vec3(0.0, 0.085, 0.0));
    s.add_player_here();
    const Vec3 hand = hand_for_palm(s, palm);
    s.script.grabs[1] = [](double t) { return t > 0.05; };
    s.script.hands[1] = [=](double t) {
        return Pose{hand + ease(t, 0.2, 0.4) * Vec3(0.3, 0.0, -0.8), Quat::Identity()};
    };
    std::uint64_t exhausted = 0;
    s.run(0.6, [&] { exhausted += s.fallbacks(Fallback::contact_rounds_exhausted); });
    return exhausted;
}

TEST(ContactRounds, ExhaustionIsCounted) {
    EXPECT_GT(exhausted_rounds(1), 0U);
    EXPECT_EQ(exhausted_rounds(Tuning{}.contact.max_rounds), 0U);
}

}  // namespace
}  // namespace handhold::scenario_fallbacks_test
