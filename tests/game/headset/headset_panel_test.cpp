// The sheet of help in a headset: where it stands and what shows it.
#include "game/headset/headset_panel.hpp"

#include <gtest/gtest.h>

namespace handhold::headset_panel_test {
namespace {

constexpr double k_near = 1e-12;

// Both calibrate buttons, and a head.
HeadsetReading reading(bool left, bool right, const Pose& head = {}) {
    HeadsetReading made;
    made.head_ps = head;
    made.hands[index_of(HandSide::left)].calibrate = left;
    made.hands[index_of(HandSide::right)].calibrate = right;
    return made;
}

TEST(HeadsetPanel, LeftButtonByItselfShowsItAndPutsItAway) {
    HeadsetPanel panel;
    for (const bool shown : {true, false, true}) {
        panel.follow(reading(true, false));
        EXPECT_EQ(panel.shows(), !shown);  // not before it is let go
        panel.follow(reading(true, false));
        panel.follow(reading(false, false));
        EXPECT_EQ(panel.shows(), shown);
    }
    panel.follow(reading(false, true));
    panel.follow(reading(false, false));
    EXPECT_TRUE(panel.shows());
}

TEST(HeadsetPanel, WhoAsksToBeMeasuredDoesNotAskForHelp) {
    HeadsetPanel panel;
    const bool pressed[][2] = {{true, false}, {true, true}, {true, false}, {false, false},
                               {false, true}, {true, true}, {false, true}, {false, false}};
    for (const auto& [left, right] : pressed) {
        panel.follow(reading(left, right));
        EXPECT_FALSE(panel.shows());
    }
    panel.follow(reading(true, false));
    panel.follow(reading(false, false));
    EXPECT_TRUE(panel.shows());
}

// Level, a metre ahead of the eyes and 18 cm below them, upright; its +Z goes to them.
TEST(HeadsetPanel, StandsBeforeTheHeadWhereverItLooks) {
    const Vec3 eyes(0.3, 1.6, -0.2);
    const Quat about = rotation_about(Vec3::UnitY(), 0.7);
    const Vec3 ahead = about * -Vec3::UnitZ();
    for (const double up_rad : {0.0, 0.6, -0.9, 1.5, -1.5, k_half_pi, -k_half_pi}) {
        const Pose head{eyes, (about * rotation_about(Vec3::UnitX(), up_rad)).normalized()};
        const Pose pose = panel_before(head);
        const Vec3 expected = eyes + ahead - HeadsetPanel::k_below_m * Vec3::UnitY();
        EXPECT_LT((pose.position - expected).norm(), 1e-9) << up_rad;
        EXPECT_LT((pose.rotation * Vec3::UnitZ() - (eyes - expected).normalized()).norm(), 1e-9);
        EXPECT_GT((pose.rotation * Vec3::UnitY()).y(), 0.9);
        EXPECT_NEAR((pose.rotation * Vec3::UnitX()).y(), 0.0, k_near);
    }
}

TEST(HeadsetPanel, StaysWhereItWasShown) {
    HeadsetPanel panel;
    panel.follow(reading(true, false));
    panel.follow(reading(false, false));
    const Pose shown = panel.pose_ps();
    panel.follow(reading(false, false, {Vec3(1.0, 2.0, 3.0), Quat::Identity()}));
    EXPECT_EQ(panel.pose_ps().position, shown.position);
}

// A head out of sight has none before it: it stands where the head was last; never seen, nowhere.
TEST(HeadsetPanel, NeedsAHeadThatWasSeen) {
    HeadsetPanel panel;
    HeadsetReading blind = reading(true, false);
    blind.head_ps.reset();
    panel.follow(blind);
    blind.hands[0].calibrate = false;
    panel.follow(blind);
    EXPECT_FALSE(panel.shows());
}

}  // namespace
}  // namespace handhold::headset_panel_test
