// A headset's session without a headset: what is recorded, and what the controllers shake with.
#include "game/headset/headset_session.hpp"

#include <cstdlib>
#include <filesystem>
#include <string>

#include <gtest/gtest.h>

#include "game/commands/headset_command.hpp"
#include "game/devices/headset_hands.hpp"
#include "game/run/session_run.hpp"
#include "game/view/player_models.hpp"
#include "tests/game/climber/climber_scene.hpp"

namespace handhold::headset_session_test {
namespace {

constexpr double k_hz = 72.0;
constexpr double k_dt_s = 1.0 / k_hz;
constexpr Vec3::Scalar k_wall_x_m = -1.0;  // of the tunnel's left wall

// Someone in the middle of the tunnel whose left palm faces the left wall at a distance.
HeadsetReading facing_wall(double palm_to_wall_m, double squeeze, double z_m = -0.3) {
    const HandTuning tuning;
    HeadsetReading reading;
    reading.head_ps = Pose{};
    // The back of the hand to the right, the fingers ahead.
    Pose hand;
    hand.rotation = rotation_about(Vec3::UnitZ(), -k_half_pi);
    Vec3 palm = tuning.palm_center_m;
    palm.x() *= -1.0;
    hand.position = Vec3(k_wall_x_m + palm_to_wall_m, 0.0, z_m) - hand.rotation * palm;
    reading.hands[0].grip_ps = hand * inverse(hand_in_grip(HandSide::left, tuning));
    reading.hands[0].squeeze = squeeze;
    reading.hands[1].grip_ps = Pose{Vec3(0.3, -0.3, -0.2), Quat::Identity()};
    return reading;
}

void step(HeadsetSession& session, const HeadsetReading& reading, HeadsetMemory& memory) {
    session.step(read_headset(reading, session.t_s(), session.scene().tuning.hand, memory), {},
                 k_dt_s);
}

TEST(HeadsetSession, PalmThatComesNearShakesALittleAndAGripMoreEachOnce) {
    HeadsetSession session(make_tunnel(4.0), {});
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
    HeadsetSession session(make_tunnel(4.0), {});
    HeadsetMemory memory;
    step(session, facing_wall(0.01, 0.0), memory);
    step(session, facing_wall(0.01, 1.0), memory);
    const auto head_ws = [&] {
        return session.scene().world.render_pose.at(session.player().player).head_ws.position;
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
    HeadsetSession session(make_tunnel(4.0), {});
    session.record();
    HeadsetMemory memory;
    for (int i = 0; i < 90; ++i) {
        HeadsetReading reading = facing_wall(0.01, i > 10 && i < 60 ? 1.0 : 0.0, -0.3 + 0.005 * i);
        if (i > 40 && i < 50) {
            reading.hands[0] = {};
        }
        PlayerCommands commands;
        commands.calibrate = i > 70;
        session.step(read_headset(reading, session.t_s(), session.scene().tuning.hand, memory),
                     commands, k_dt_s);
    }
    EXPECT_FALSE(session.used_sticks());
    const std::filesystem::path file = testing::TempDir() + "headset_session_test.csv";
    ASSERT_FALSE(save_recording(file, session.recording()));
    const Result<Recording> recording = load_recording(file);
    std::filesystem::remove(file);
    ASSERT_TRUE(recording);
    Scene scene = make_tunnel(4.0);
    FrameCaches caches(*scene.shapes, scene.grip_meshes.get());
    caches.body_clips = session.caches().body_clips;
    const PlayerEntities player = add_scene_player(scene, {"player0", {}, 80.0});
    RunSettings settings;
    settings.hz = k_hz;
    const RunLog log = run_session(scene, caches, {player}, &recording.value(), settings);
    EXPECT_EQ(log.frames.size(), 90U);
    EXPECT_EQ(log.state_hash, hash_state(session.scene().world));
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
