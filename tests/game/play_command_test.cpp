// The window, on SDL's display that shows nothing: the whole way from the desk to the recording.
#include "game/play_command.hpp"

#include <cstdlib>
#include <filesystem>
#include <string>

#include <gtest/gtest.h>

#include "game/render/renderer.hpp"
#include "game/run_command.hpp"

namespace handhold {
namespace {

std::string last_line(const std::string& text) {
    const std::string whole = text.substr(0, text.find_last_not_of('\n') + 1);
    return whole.substr(whole.find_last_of('\n') + 1);
}

TEST(PlayCommand, SessionIsRecordedAndPlaysAgainToTheSameHash) {
    std::string why_not;
    if (!Renderer::create(64, 64, why_not)) {
        GTEST_SKIP() << why_not;
    }
    ::setenv("SDL_VIDEODRIVER", "dummy", 1);
    const auto folder = std::filesystem::temp_directory_path() / "handhold_play_test";
    std::filesystem::create_directories(folder);
    PlayOptions play;
    play.scene = "playground";
    play.width_px = 64;
    play.height_px = 36;
    play.seconds = 0.5;
    play.record = (folder / "session.csv").string();
    play.picture = (folder / "last.png").string();
    testing::internal::CaptureStdout();
    const int played = play_command(play);
    const std::string hash = last_line(testing::internal::GetCapturedStdout());
    ASSERT_EQ(played, 0);
    EXPECT_GT(std::filesystem::file_size(folder / "last.png"), 0U);

    RunOptions run;
    run.scene = play.scene;
    run.input = play.record;
    run.players = 1;
    testing::internal::CaptureStdout();
    EXPECT_EQ(run_command(run), 0);
    EXPECT_EQ(last_line(testing::internal::GetCapturedStdout()), hash);
    EXPECT_EQ(hash.rfind("state_hash 0x", 0), 0U);
    std::filesystem::remove_all(folder);
}

TEST(PlayCommand, UnknownSpawnIsRefused) {
    PlayOptions play;
    play.spawn = "nowhere";
    testing::internal::CaptureStderr();
    EXPECT_EQ(play_command(play), 2);
    EXPECT_NE(testing::internal::GetCapturedStderr().find("nowhere"), std::string::npos);
}

}  // namespace
}  // namespace handhold
