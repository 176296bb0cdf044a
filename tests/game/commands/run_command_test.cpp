#include "game/commands/run_command.hpp"

#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <unistd.h>

#include "engine/core/text_file.hpp"
#include "engine/io/gltf_writer.hpp"
#include "game/commands/climb_command.hpp"

namespace handhold::run_command_test {
namespace {

class RunCommand : public testing::Test {
  protected:
    // A folder of its own: tests run in parallel.
    RunCommand()
        : folder_(std::filesystem::path(testing::TempDir()) /
                  ("handhold_run_command_" + std::to_string(getpid()))) {
        std::filesystem::remove_all(folder_);
        std::filesystem::create_directories(folder_);
    }
    ~RunCommand() override { std::filesystem::remove_all(folder_); }

    std::string write(const std::string& name, const std::string& text) const {
        const std::filesystem::path path = folder_ / name;
        std::ofstream(path) << text;
        return path.string();
    }
    // Returns the exit status. The output is in out_ and err_.
    int run(const RunOptions& options) {
        testing::internal::CaptureStdout();
        testing::internal::CaptureStderr();
        const int status = run_command(options);
        out_ = testing::internal::GetCapturedStdout();
        err_ = testing::internal::GetCapturedStderr();
        return status;
    }
    static std::size_t lines_of(const std::string& text) {
        return static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n'));
    }

    std::filesystem::path folder_;
    std::string out_;
    std::string err_;
};

TEST_F(RunCommand, LastLineIsTheStateHashAndFilesAreWritten) {
    RunOptions options;
    options.scene = "ship";
    options.seconds = 1.0;
    options.pictures = false;
    options.out = (folder_ / "out").string();
    options.trace = (folder_ / "trace.json").string();
    ASSERT_EQ(run(options), 0) << err_;
    const std::size_t last = out_.rfind("state_hash 0x");
    ASSERT_NE(last, std::string::npos);
    EXPECT_EQ(out_.size() - last, std::string("state_hash 0x0123456789abcdef\n").size());
    for (const char* const name : {"frames.csv", "bodies.csv", "report.json", "report.html"}) {
        EXPECT_TRUE(std::filesystem::exists(folder_ / "out" / name)) << name;
    }
    const auto report = nlohmann::json::parse(read_file(folder_ / "out" / "report.json").value());
    EXPECT_EQ(report["frames"], 90);
    EXPECT_EQ("state_hash " + report["state_hash"].get<std::string>() + "\n", out_.substr(last));
    const auto trace = nlohmann::json::parse(read_file(options.trace).value());
    EXPECT_FALSE(trace["traceEvents"].empty());
}

TEST_F(RunCommand, SceneFileWithItsOwnPlayersRuns) {
    RunOptions options;
    options.scene =
        write("box.json", R"({"name": "box", "bodies": [{"name": "wall", "kind": "static",
        "shape": {"type": "box", "half_m": [1, 1, 0.1]}, "position_m": [0, 1, -1]}],
        "spawns": [{"name": "a", "position_m": [0, 0, 0]}, {"name": "b", "position_m": [3, 0, 0]}],
        "players": [{"name": "one", "spawn": "a"}, {"name": "two", "spawn": "b", "mass_kg": 60}]})");
    options.seconds = 0.5;
    EXPECT_EQ(run(options), 0) << err_;
}

TEST_F(RunCommand, SeveralPlayersAreAllInTheFilesAndTheFirstPlaysTheSession) {
    const auto first_rows = [this](int players) {
        RunOptions options;
        options.scene = "station";
        options.seconds = 1.0;
        options.players = players;
        options.pictures = false;
        options.out = (folder_ / "out").string();
        EXPECT_EQ(run(options), 0) << err_;
        const std::string csv = read_file(folder_ / "out" / "frames.csv").value();
        EXPECT_EQ(lines_of(csv), 1 + 90 * static_cast<std::size_t>(players));
        const auto report =
            nlohmann::json::parse(read_file(folder_ / "out" / "report.json").value());
        EXPECT_EQ(report["players"].size(), static_cast<std::size_t>(players));
        EXPECT_GT(report["bytes_per_player"], 1000);
        return report["players"][0]["path_m"].get<double>();
    };
    // The others climb elsewhere, so the first player's session is the same as alone.
    EXPECT_EQ(first_rows(3), first_rows(1));
}

TEST_F(RunCommand, KeepsNoFramesIfNoFilesAreWritten) {
    RunOptions options;
    options.scene = "ship";
    options.seconds = 1.0;
    options.players = 2;
    options.climbers = true;
    ASSERT_EQ(run(options), 0) << err_;
    EXPECT_NE(out_.find("90 frames at 90 Hz, 1.00 s simulated"), std::string::npos) << out_;
    EXPECT_NE(out_.find("2 players, "), std::string::npos) << out_;
}

TEST_F(RunCommand, RefusesMorePlayersThanTheSceneHasSpaceFor) {
    RunOptions options;
    options.scene = write("void.json", R"({"name": "void"})");
    options.players = 2;
    options.seconds = 0.1;
    EXPECT_EQ(run(options), 2);
    EXPECT_NE(err_.find("expected room for 2 players, found it for 1"), std::string::npos) << err_;
}

TEST_F(RunCommand, PlaysWhatTheClimbCommandRecorded) {
    ClimbOptions climb;
    climb.scene = "station";
    climb.seconds = 3.0;
    climb.out = (folder_ / "climb.csv").string();
    testing::internal::CaptureStdout();
    ASSERT_EQ(climb_command(climb), 0);
    testing::internal::GetCapturedStdout();
    RunOptions options;
    options.scene = "station";
    options.input = climb.out;
    EXPECT_EQ(run(options), 0) << err_;
    EXPECT_EQ(out_.find("grabs: 0 onsets"), std::string::npos) << out_;
    climb.spawn = "nowhere";
    testing::internal::CaptureStderr();
    EXPECT_EQ(climb_command(climb), 2);
    EXPECT_EQ(lines_of(testing::internal::GetCapturedStderr()), 1U);
}

TEST_F(RunCommand, EveryInputHasAPlayerOfItsOwn) {
    RunOptions options;
    options.scene = "station";
    options.pictures = false;
    options.out = (folder_ / "two").string();
    for (const std::uint64_t seed : {1U, 2U}) {
        ClimbOptions climb;
        climb.scene = "station";
        climb.seconds = seed == 1 ? 2.0 : 3.0;
        climb.seed = seed;
        climb.out = (folder_ / ("climb" + std::to_string(seed) + ".csv")).string();
        testing::internal::CaptureStdout();
        ASSERT_EQ(climb_command(climb), 0);
        testing::internal::GetCapturedStdout();
        if (seed == 1) {
            options.input = climb.out;
        } else {
            options.more_inputs = {climb.out};
        }
    }
    const auto report_of = [&](const char* name) {
        return nlohmann::json::parse(read_file(folder_ / name / "report.json").value());
    };
    RunOptions longer = options;
    longer.input = options.more_inputs.at(0);
    longer.more_inputs.clear();
    longer.out = (folder_ / "longer").string();
    ASSERT_EQ(run(longer), 0) << err_;
    const auto frames = report_of("longer")["frames"].get<std::size_t>();
    EXPECT_GE(frames, 270U);  // 3 s at 90 Hz
    ASSERT_EQ(run(options), 0) << err_;
    const auto report = report_of("two");
    EXPECT_EQ(report["frames"], frames);  // of the longer input
    EXPECT_EQ(report["input"], "climb1.csv, climb2.csv");
    std::ifstream rows(folder_ / "two" / "frames.csv");
    std::string line;
    std::array<std::size_t, 3> rows_of_player = {};
    while (std::getline(rows, line)) {
        const std::size_t player = line.find(',', line.find(',') + 1) + 1;
        if (line[player] >= '0' && line[player] <= '2') {
            ++rows_of_player[static_cast<std::size_t>(line[player] - '0')];
        }
    }
    EXPECT_EQ(rows_of_player, (std::array<std::size_t, 3>{frames, frames, 0}));
    options.players = 1;
    EXPECT_EQ(run(options), 2);
    EXPECT_NE(err_.find("a player for each session"), std::string::npos) << err_;
}

TEST_F(RunCommand, SamplesYearsApartAreRefusedUnlessTheLengthIsGiven) {
    const std::string header =
        "t,hx,hy,hz,hqx,hqy,hqz,hqw,lx,ly,lz,lqx,lqy,lqz,lqw,lbtn,ltrig,rx,ry,rz,rqx,rqy,rqz,rqw,"
        "rbtn,rtrig\n";
    const std::string pose =
        ",0,1.6,0,0,0,0,1,-0.2,1.2,-0.3,0,0,0,1,0,0,0.2,1.2,-0.3,0,0,0,1,0,0\n";
    RunOptions options;
    options.scene = "reach";
    options.input = write("years.csv", header + "0" + pose + "9e8" + pose);
    EXPECT_EQ(run(options), 2);
    EXPECT_EQ(lines_of(err_), 1U) << err_;
    options.seconds = 0.2;
    EXPECT_EQ(run(options), 0) << err_;
}

// Equal names give equal persistent ids: they must be a refused file, not a broken precondition.
TEST_F(RunCommand, NamesThatPlayersHandsWouldTakeAreRefusedAndInventedOnesMakeWay) {
    const std::string ball =
        R"("kind": "static", "shape": {"type": "sphere", "radius_m": 0.1}, "position_m": [0, 9, 0]})";
    RunOptions options;
    options.seconds = 0.1;
    options.scene = write("hand.json", R"({"name": "hand", "bodies": [{"name": "p/left_hand", )" +
                                           ball + R"(], "spawns": [{"name": "s"}],
        "players": [{"name": "p", "spawn": "s"}]})");
    EXPECT_EQ(run(options), 2);
    EXPECT_NE(err_.find("/players/0/name: expected names that nothing else has"), std::string::npos)
        << err_;
    options.scene = write("players.json", R"({"name": "players", "spawns": [{"name": "s"}],
        "players": [{"name": "a/left_hand", "spawn": "s"}, {"name": "a", "spawn": "s"}]})");
    EXPECT_EQ(run(options), 2);
    EXPECT_NE(err_.find("/players/1/name"), std::string::npos) << err_;
    options.scene =
        write("taken.json", R"({"name": "taken", "bodies": [{"name": "player0", )" + ball + "]}");
    EXPECT_EQ(run(options), 0) << err_;
}

TEST_F(RunCommand, BadFilesEndWithStatusTwoAndOneLine) {
    std::vector<RunOptions> wrong(5);
    wrong[0].scene = "no_such_scene";
    wrong[1].scene = (folder_ / "absent.glb").string();
    wrong[2].scene = write("broken.json", "{\"name\": ");
    wrong[3].scene = "station";
    wrong[3].input = write("broken.csv", "t,hx\n0,1\n");
    wrong[4].scene = "station";
    wrong[4].spawn = "nowhere";
    for (RunOptions& options : wrong) {
        options.out = (folder_ / "out").string();
        EXPECT_EQ(run(options), 2) << options.scene;
        EXPECT_EQ(lines_of(err_), 1U) << err_;
        EXPECT_FALSE(std::filesystem::exists(folder_ / "out" / "report.json"));
    }
}

TEST_F(RunCommand, TuningOfASceneIsCheckedWithItsPlace) {
    RunOptions options;
    options.scene =
        write("tuned.json", R"({"name": "tuned", "tuning": {"hand": {"reach_m": -1}}})");
    EXPECT_EQ(run(options), 2);
    EXPECT_NE(err_.find("/hand/reach_m"), std::string::npos) << err_;
}

// --- Snapshots in the middle of a run ---

class ResumedRun : public RunCommand {
  protected:
    // The ship's session beside a wall.
    ResumedRun() {
        options_.scene = write("wall.json", R"({"name": "wall", "session": "ship", "bodies": [
            {"name": "wall", "kind": "static", "shape": {"type": "box", "half_m": [0.1, 2, 4]},
             "position_m": [-0.6, 1, 0]}],
            "spawns": [{"name": "a"}], "players": [{"name": "one", "spawn": "a"}]})");
        options_.seconds = 2.0;
        snapshot_ = (folder_ / "half.snapshot").string();
    }
    std::string hash() { return out_.substr(out_.rfind("state_hash")); }

    RunOptions options_;
    std::string snapshot_;
};

TEST_F(ResumedRun, EndsWithTheSameHash) {
    options_.snapshot = snapshot_;
    options_.snapshot_at_s = 1.0;
    ASSERT_EQ(run(options_), 0) << err_;
    const std::string expected = hash();
    options_.snapshot.clear();
    options_.resume = snapshot_;
    ASSERT_EQ(run(options_), 0) << err_;
    EXPECT_EQ(hash(), expected);
    EXPECT_NE(out_.find("wall: 90 frames"), std::string::npos) << out_;  // the second half only
}

TEST_F(ResumedRun, OtherScenesAndPlayersAreRefused) {
    options_.snapshot = snapshot_;
    options_.snapshot_at_s = 0.1;
    options_.seconds = 0.2;
    ASSERT_EQ(run(options_), 0) << err_;
    options_.snapshot.clear();
    options_.resume = snapshot_;
    options_.players = 1;  // another player
    EXPECT_EQ(run(options_), 2);
    EXPECT_NE(err_.find("half.snapshot: expected a snapshot with the players"), std::string::npos)
        << err_;
    options_.scene = "station";
    EXPECT_EQ(run(options_), 2);
    EXPECT_NE(err_.find("half.snapshot: byte 24"), std::string::npos) << err_;
    options_.resume = (folder_ / "absent").string();
    EXPECT_EQ(run(options_), 2);
    EXPECT_EQ(lines_of(err_), 1U) << err_;
}

// The plans of climbers are not part of the world.
TEST_F(ResumedRun, ClimbersAreRefused) {
    options_.scene = "station";
    options_.seconds = 0.2;
    options_.players = 2;
    options_.snapshot = snapshot_;
    EXPECT_EQ(run(options_), 2);
    EXPECT_NE(err_.find("expected no scripted climbers with --snapshot"), std::string::npos)
        << err_;
}

TEST_F(ResumedRun, SnapshotBeyondTheSessionIsRefused) {
    options_.snapshot = snapshot_;
    options_.seconds = 0.2;
    options_.snapshot_at_s = 0.3;
    EXPECT_EQ(run(options_), 2);
    EXPECT_FALSE(std::filesystem::exists(snapshot_));
}

// A plate of 2 by 10 cm in the grip's plane x = 0.
std::string plate_glb() {
    GltfSurface plate;
    plate.group = "plate";
    plate.name = "plate";
    for (const auto& [y, z] : {std::pair(-0.01F, -0.05F), std::pair(0.01F, -0.05F),
                               std::pair(0.01F, 0.05F), std::pair(-0.01F, 0.05F)}) {
        GltfVertex vertex;
        vertex.position = {0.0F, y, z};
        vertex.normal = {1.0F, 0.0F, 0.0F};
        plate.vertices.push_back(vertex);
    }
    plate.indices = {0, 1, 2, 0, 2, 3};
    return write_glb(std::vector<GltfMaterial>(1), {&plate, 1});
}

TEST_F(RunCommand, OnlyAProfilesJointChangesWhereHandsAre) {
    ASSERT_FALSE(write_file_atomically(folder_ / "plate.glb", plate_glb()));
    const std::string profile = write("plate.json", R"({"name": "plate",
        "left": {"model": "plate.glb", "handle": {}},
        "right": {"model": "plate.glb", "handle": {}}})");
    const auto hash_with = [this](const std::string& controllers) {
        RunOptions options;
        options.scene = "ship";
        options.seconds = 1.0;
        options.models.controllers = controllers;
        EXPECT_EQ(run(options), 0) << err_;
        return out_.substr(out_.rfind("state_hash"));
    };
    const std::string without = hash_with("");
    EXPECT_EQ(hash_with("builtin"), without);
    EXPECT_NE(hash_with(profile), without);
}

TEST_F(RunCommand, RefusesABrokenControllerProfileInOneLine) {
    RunOptions options;
    options.scene = "ship";
    options.models.controllers = write("bad.json", R"({"name": "bad", "left": {"model": 3}})");
    EXPECT_EQ(run(options), 2);
    EXPECT_EQ(lines_of(err_), 1U) << err_;
    EXPECT_NE(err_.find("bad.json: /left"), std::string::npos) << err_;
}

}  // namespace
}  // namespace handhold::run_command_test
