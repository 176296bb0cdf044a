// A recording is played back frame by frame, with its buttons' commands.
#include "game/session/playback.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "game/run/session_run.hpp"
#include "tests/game/climber/climber_scene.hpp"

namespace handhold::playback_test {
namespace {

// A player in T-pose, eyes at 1.75 m and controllers 1.6 m apart, who holds menu buttons from 0.5 s
// on.
Recording t_pose(bool with_left, bool with_right) {
    Recording recording;
    for (int i = 0; i < 180; ++i) {
        RecordedSample sample;
        sample.t_s = 100.0 + i / 90.0;
        sample.head.position = {0.0, 1.75, 0.0};
        for (const double x : {-0.8, 0.8}) {
            RecordedHand& hand = sample.hands[x < 0.0 ? 0 : 1];
            hand.controller.position = {x, 1.5, 0.0};
            const bool holds = (x < 0.0 ? with_left : with_right) && sample.t_s > 100.5;
            hand.buttons = holds ? k_button_menu : 0;
        }
        recording.samples.push_back(sample);
    }
    return recording;
}

BodyMeasures play(const Recording& recording) {
    Scene scene = make_void();
    const hh::Player player = add_scene_player(scene, "player0", hh::k_origin);
    run_session(scene, {&player, 1}, &recording, {90.0, 0.0, 1});
    return scene.world().body_measures.at(entity_of(player));
}

TEST(Playback, BothMenuButtonsCalibrate) {
    const BodyMeasures found = play(t_pose(true, true));
    EXPECT_NEAR(found.eye_height_m, 1.75, 1e-9);
    EXPECT_NEAR(found.shoulder_width_m + 2.0 * (found.upper_arm_m + found.forearm_m), 1.6, 0.1);
}

// Meanwhile the size is estimated from play, at 3.5 cm/s.
TEST(Playback, OneMenuButtonDoesNot) {
    for (const bool left : {false, true}) {
        EXPECT_NEAR(play(t_pose(left, !left)).eye_height_m, BodyMeasures{}.eye_height_m, 0.06);
    }
}

TEST(Playback, CalibrationStartsWithTheFirstSampleInTheFrameThatAsks) {
    Playback playback(t_pose(true, true));
    for (int frame = 1; frame < 120; ++frame) {
        const double end_s = frame / 90.0;
        playback.window(end_s);
        if (std::abs(end_s - 0.5) > 1e-6) {
            EXPECT_EQ(playback.commands().calibrate, end_s > 0.5) << end_s;
        }
    }
}

}  // namespace
}  // namespace handhold::playback_test
