// A headset's session without a headset: what is recorded, and what the controllers shake with.
#include "game/headset/headset_session.hpp"

#include <cstdlib>
#include <filesystem>
#include <string>

#include <gtest/gtest.h>

#include "game/assets/body_clips_asset.hpp"
#include "game/commands/headset_command.hpp"
#include "game/devices/headset_hands.hpp"
#include "game/run/session_run.hpp"
#include "game/view/player_models.hpp"
#include "tests/game/climber/climber_scene.hpp"

namespace handhold::headset_session_test {
namespace {

constexpr double k_hz = 72.0;
constexpr double k_dt_s = 1.0 / k_hz;
constexpr double k_wall_x_m = -1.0;  // of the tunnel's left wall

// Someone in the middle of the tunnel whose left palm faces the left wall at a distance.
HeadsetReading facing_wall(double palm_to_wall_m, double squeeze, double z_m = -0.3) {
    const hh::Vec3 right_palm = hand_shape(hh::World()).palm_center_m;
    HeadsetReading reading;
    reading.head_ps = hh::k_origin;
    // The back of the hand to the right, the fingers ahead.
    hh::Pose hand = hh::k_origin;
    hand.rotation = hh::rotation_about(hh::k_z, -k_half_pi);
    hh::Vec3 palm = right_palm;
    palm.x *= -1.0;
    hand.position = hh::Vec3{k_wall_x_m + palm_to_wall_m, 0.0, z_m} - hand.rotation * palm;
    reading.hands[0].grip_ps = hand * hh::inverse(hand_in_grip(HH_LEFT, right_palm));
    reading.hands[0].squeeze = squeeze;
    reading.hands[1].grip_ps = hh::pose_at({0.3, -0.3, -0.2});
    return reading;
}

void step(HeadsetSession& session, const HeadsetReading& reading, HeadsetMemory& memory) {
    session.step(read_headset(reading, session.t_s(), hand_shape(session.world()), memory), {},
                 k_dt_s);
}

TEST(HeadsetSession, PalmThatComesNearShakesALittleAndAGripMoreEachOnce) {
    HeadsetSession session(make_tunnel(4.0), hh::k_origin);
    HeadsetMemory memory;
    const auto shakes = [&](double palm_to_wall_m, double squeeze) {
        step(session, facing_wall(palm_to_wall_m, squeeze), memory);
        return session.pulses();
    };
    EXPECT_EQ(shakes(0.06, 0.0)[0].duration_s, 0.0);
    const HapticPulse touch = shakes(0.01, 0.0)[0];
    EXPECT_GT(touch.duration_s, 0.0);
    EXPECT_EQ(shakes(0.01, 0.0)[0].duration_s, 0.0);  // still there
    const HapticPulse grip = shakes(0.01, 1.0)[0];
    EXPECT_GT(grip.amplitude, touch.amplitude);
    EXPECT_GT(grip.duration_s, touch.duration_s);
    EXPECT_EQ(shakes(0.01, 1.0)[0].duration_s, 0.0);
    EXPECT_EQ(session.pulses()[1].duration_s, 0.0);
    EXPECT_EQ(shakes(0.01, 0.0)[0].duration_s, 0.0);  // lets go, still near
    EXPECT_EQ(shakes(0.06, 0.0)[0].duration_s, 0.0);
    EXPECT_GT(shakes(0.01, 0.0)[0].duration_s, 0.0);
}

TEST(HeadsetSession, HeadGoesWhereTheGrippingHandPutsIt) {
    HeadsetSession session(make_tunnel(4.0), hh::k_origin);
    HeadsetMemory memory;
    step(session, facing_wall(0.01, 0.0), memory);
    step(session, facing_wall(0.01, 1.0), memory);
    const auto head_ws = [&] {
        return session.scene().world().render_pose.at(entity_of(session.player())).head_ws.position;
    };
    const Vec3 begin_ws = head_ws();
    for (int i = 1; i <= 30; ++i) {
        step(session, facing_wall(0.01, 1.0, -0.3 + 0.01 * i), memory);
        EXPECT_LT((head_ws() - begin_ws - Vec3(0.0, 0.0, -0.01 * i)).norm(), 1e-6);
    }
}

// Played again at the display's rate, a recording repeats every bit; a hand out of sight and a
// calibration are in it.
TEST(HeadsetSession, RecordingPlaysAgainBitForBitAtTheDisplaysRate) {
    HeadsetSession session(make_tunnel(4.0), hh::k_origin);
    session.record();
    HeadsetMemory memory;
    for (int i = 0; i < 90; ++i) {
        HeadsetReading reading = facing_wall(0.01, i > 10 && i < 60 ? 1.0 : 0.0, -0.3 + 0.005 * i);
        if (i > 40 && i < 50) {
            reading.hands[0] = {};
        }
        hh_commands commands{};
        commands.calibrate = i > 70;
        session.step(read_headset(reading, session.t_s(), hand_shape(session.world()), memory),
                     commands, k_dt_s);
    }
    EXPECT_FALSE(session.used_sticks());
    const std::filesystem::path file = testing::TempDir() + "headset_session_test.csv";
    ASSERT_FALSE(save_recording(file, session.recording()));
    const Result<Recording> recording = load_recording(file);
    std::filesystem::remove(file);
    ASSERT_TRUE(recording);
    Scene scene = make_tunnel(4.0);
    load_game_body_clips(scene.host);
    const hh::Player player = add_scene_player(scene, "player0", hh::k_origin);
    RunSettings settings;
    settings.hz = k_hz;
    const RunLog log = run_session(scene, {&player, 1}, &recording.value(), settings);
    EXPECT_EQ(log.frames.size(), 90U);
    EXPECT_EQ(log.state_hash, session.world().hash());
}

TEST(HeadsetCommand, WithoutARuntimeItSaysSoAndEndsAsWithoutAWindow) {
    ::setenv("XR_RUNTIME_JSON", "/nowhere/runtime.json", 1);
    PlayOptions options;
    options.scene = "playground";
    options.xr_headless = true;
    testing::internal::CaptureStderr();
    EXPECT_EQ(headset_command(options), 3);
    const std::string said = testing::internal::GetCapturedStderr();
    ::unsetenv("XR_RUNTIME_JSON");
    EXPECT_TRUE(said.starts_with("play --xr: no OpenXR")) << said;
    EXPECT_EQ(said.find('\n'), said.size() - 1) << said;
}

}  // namespace
}  // namespace handhold::headset_session_test
