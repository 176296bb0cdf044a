// The sheet of help in a headset: where it stands and what shows it.
#include "game/headset/headset_panel.hpp"

#include <numbers>

#include <gtest/gtest.h>
#include <handhold/math.hpp>

namespace handhold::headset_panel_test {
namespace {

constexpr double k_near = 1e-12;

// Both calibrate buttons, and a head.
HeadsetReading reading(bool left, bool right, const hh::Pose& head = hh::k_origin) {
    HeadsetReading made;
    made.head_ps = head;
    made.hands[HH_LEFT].calibrate = left;
    made.hands[HH_RIGHT].calibrate = right;
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
    const hh::Vec3 eyes{0.3, 1.6, -0.2};
    const hh::Quat about = hh::rotation_about(hh::k_y, 0.7);
    const hh::Vec3 ahead = about * -hh::k_z;
    for (const double up_rad :
         {0.0, 0.6, -0.9, 1.5, -1.5, 0.5 * std::numbers::pi, -0.5 * std::numbers::pi}) {
        const hh::Pose head{eyes, hh::normalized(about * hh::rotation_about(hh::k_x, up_rad))};
        const hh::Pose pose = panel_before(head);
        const hh::Vec3 expected = eyes + ahead - HeadsetPanel::k_below_m * hh::k_y;
        EXPECT_LT(hh::length(pose.position - expected), 1e-9) << up_rad;
        EXPECT_LT(hh::length(pose.rotation * hh::k_z - hh::normalized(eyes - expected)), 1e-9);
        EXPECT_GT((pose.rotation * hh::k_y).y, 0.9);
        EXPECT_NEAR((pose.rotation * hh::k_x).y, 0.0, k_near);
    }
}

TEST(HeadsetPanel, StaysWhereItWasShown) {
    HeadsetPanel panel;
    panel.follow(reading(true, false));
    panel.follow(reading(false, false));
    const hh::Pose shown = panel.pose_ps();
    panel.follow(reading(false, false, {hh::Vec3{1.0, 2.0, 3.0}, hh::k_no_turn}));
    EXPECT_TRUE(panel.pose_ps().position == shown.position);
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
