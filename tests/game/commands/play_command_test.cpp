// Playing on the desktop: recordings, and the window on SDL's dummy display.
#include "game/commands/play_command.hpp"

#include <cstdlib>
#include <filesystem>
#include <string>

#include <gtest/gtest.h>

#include "game/assets/body_clips_asset.hpp"
#include "game/play/desktop_session.hpp"
#include "game/render/renderer.hpp"
#include "game/run/session_run.hpp"
#include "tests/game/climber/climber_scene.hpp"

namespace handhold::play_command_test {
namespace {

// Selects SDL's video driver for one test.
class VideoDriver {
  public:
    explicit VideoDriver(const char* name) {
        for (std::size_t i = 0; i < k_names.size(); ++i) {
            const char* const before = std::getenv(k_names[i]);
            before_[i] = before != nullptr ? before : "";
            ::unsetenv(k_names[i]);
        }
        if (name != nullptr) {
            ::setenv(k_names[0], name, 1);
        }
    }
    ~VideoDriver() {
        for (std::size_t i = 0; i < k_names.size(); ++i) {
            ::unsetenv(k_names[i]);
            if (!before_[i].empty()) {
                ::setenv(k_names[i], before_[i].c_str(), 1);
            }
        }
    }
    VideoDriver(const VideoDriver&) = delete;
    VideoDriver& operator=(const VideoDriver&) = delete;

  private:
    static constexpr std::array<const char*, 3> k_names = {"SDL_VIDEODRIVER", "DISPLAY",
                                                           "WAYLAND_DISPLAY"};
    std::array<std::string, 3> before_;
};

bool can_draw() {
    std::string why_not;
    return Renderer::create(64, 64, why_not).has_value();
}

// A tunnel with a rail on its left and a loose box ahead.
Scene make_desk_scene() {
    Scene scene = make_tunnel(6.0);
    BodyDescription box;
    box.name = "box";
    box.shape = scene.shapes().add_box(Vec3::Constant(0.05));
    box.body = {BodyKind::free, 2.0, Vec3::Constant(0.01), 0.0};
    box.pose_ws.position = Vec3(-0.45, 0.35, 1.4);
    scene.body_names.emplace_back("box");
    add_body(scene.world(), box);
    return scene;
}

TEST(DesktopSession, RecordingReplaysToTheSameHash) {
    constexpr hh::Pose origin_ws = hh::pose_at({-0.45, 0.35 - 1.6, 2.0});
    DesktopSession session(make_desk_scene(), origin_ws);
    session.record();
    DesktopInput input;
    const auto look = [&](double left_rad, double up_rad) {
        input.turn_left_rad = left_rad;
        input.look_up_rad = up_rad;
        session.step(input);
        input.turn_left_rad = input.look_up_rad = 0.0;
    };
    const auto play = [&](double seconds, double turn_radps) {
        for (double t_s = 0.0; t_s < seconds; t_s += DesktopSession::k_dt_s) {
            look(turn_radps * DesktopSession::k_dt_s, 0.3 * turn_radps * DesktopSession::k_dt_s);
        }
    };
    const auto grip = [&](std::size_t side) {
        return session.scene()
            .world()
            .grab.at(player_entities(session.scene().world(), session.player()).hands[side])
            .kind;
    };
    look(0.9, -0.2);
    input.grip[0] = true;
    play(0.7, 0.0);
    EXPECT_EQ(grip(0), GripKind::surface);  // the rail
    look(-0.9, 0.2);
    input.grip[1] = true;
    play(0.7, 0.0);
    EXPECT_EQ(grip(1), GripKind::held);  // the box
    play(0.5, -0.7);
    input.move = {0.5, 0.2, -0.5};
    play(0.5, 0.4);
    input.grip = {};
    play(0.4, 0.3);
    ASSERT_FALSE(session.used_sticks());

    Scene again = make_desk_scene();
    load_game_body_clips(again.host);
    const hh::Player player = add_scene_player(again, "player0", origin_ws);
    RunSettings settings;
    settings.hz = 90.0;
    const RunLog log = run_session(again, {&player, 1}, &session.recording(), settings);
    EXPECT_EQ(log.state_hash, session.world().hash());
}

TEST(PlayCommand, PlaysRecordsAndTakesAPicture) {
    if (!can_draw()) {
        GTEST_SKIP() << "nothing can be drawn here";
    }
    const VideoDriver driver("dummy");
    std::string name = (std::filesystem::temp_directory_path() / "handhold_play_XXXXXX").string();
    ASSERT_NE(::mkdtemp(name.data()), nullptr);
    const std::filesystem::path folder = name;
    PlayOptions play;
    play.scene = "playground";
    play.width_px = 64;
    play.height_px = 36;
    play.seconds = 0.5;
    play.record = (folder / "session.csv").string();
    play.picture = (folder / "last.png").string();
    EXPECT_EQ(play_command(play), 0);
    const Result<Recording> recording = load_recording(play.record);
    EXPECT_TRUE(recording);
    EXPECT_EQ(recording ? recording.value().samples.size() : 0U, 46U);
    EXPECT_TRUE(std::filesystem::exists(play.picture));
    std::filesystem::remove_all(folder);
}

TEST(PlayCommand, ReportsMissingDisplay) {
    if (!can_draw()) {
        GTEST_SKIP() << "nothing can be drawn here";
    }
    const VideoDriver driver(nullptr);
    PlayOptions play;
    play.scene = "playground";
    play.seconds = 0.1;
    testing::internal::CaptureStderr();
    EXPECT_EQ(play_command(play), 3);
    EXPECT_NE(testing::internal::GetCapturedStderr().find("no window: "), std::string::npos);
}

TEST(PlayCommand, RefusesUnusableFilesBeforePlaying) {
    PlayOptions play;
    play.spawn = "nowhere";
    testing::internal::CaptureStderr();
    EXPECT_EQ(play_command(play), 2);
    EXPECT_NE(testing::internal::GetCapturedStderr().find("nowhere"), std::string::npos);
    play.spawn.clear();
    play.record = "/no/such/folder/session.csv";
    testing::internal::CaptureStderr();
    EXPECT_EQ(play_command(play), 2);
    EXPECT_NE(testing::internal::GetCapturedStderr().find("session.csv"), std::string::npos);
}

}  // namespace
}  // namespace handhold::play_command_test
