// `handhold-lab` as an external program: exit status, messages, files.
#include <cmath>
#include <cstdlib>
#include <fstream>

#include <nlohmann/json.hpp>
#include <sys/wait.h>

#include "game/net/transport.hpp"
#include "lab_files.hpp"
#include "tests/places.hpp"
#include "tools/lab/lab_scene.hpp"

namespace handhold::lab::lab_command_test {
namespace {

class LabCommand : public LabTest {
  protected:
    // Returns the exit status; standard error is in err_.
    int run(const std::string& arguments) {
        const std::string err = (folder_ / "err").string();
        const int status = std::system(
            ("\"" + lab_program().string() + "\" " + arguments + " 2>\"" + err + "\"").c_str());
        err_ = text_of(err);
        return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
    }
    std::string json() const { return "--json \"" + (folder_ / "a.json").string() + "\""; }

    std::string err_;
};

TEST_F(LabCommand, RefusesWrongFlagsWithTheUsage) {
    for (const char* arguments :
         {"", "solve", "solve --scene chain", "solve --scene nowhere --json x",
          "solve --scene chain --json x --links 1", "solve --scene chain --json x --masses heavy",
          "solve --scene chain --json x --solver jolt", "solve --scene chain --json x --frames 0",
          "solve --scene chain --json x --holder none", "match --json x --sockets nowhere",
          "match --sockets arena", "match --json x --freeze-s 5", "proxy", "proxy --to 0",
          "dissolve"}) {
        EXPECT_EQ(run(arguments), 1) << arguments;
        EXPECT_NE(err_.find("Usage:"), std::string::npos) << arguments;
    }
}

TEST_F(LabCommand, NamesWhatASolverOrHolderCannotExpress) {
    EXPECT_EQ(run("solve --scene push_off --solver bullet --frames 2 " + json()), 1);
    EXPECT_NE(err_.find("kappa"), std::string::npos);
    EXPECT_EQ(run("solve --scene lean_in --holder kinematic --frames 2 " + json()), 1);
    EXPECT_NE(err_.find("--holder player"), std::string::npos);
    EXPECT_FALSE(std::filesystem::exists(folder_ / "a.json"));
}

TEST_F(LabCommand, LeavesNoFileIfItCannotWrite) {
    const std::string nowhere = (folder_ / "absent" / "a.json").string();
    EXPECT_EQ(run("solve --scene chain --frames 2 --json \"" + nowhere + "\""), 2);
    EXPECT_NE(err_.find(nowhere), std::string::npos);
    EXPECT_EQ(run("solve --scene chain --frames 2 " + json() + " --csv \"" + nowhere + "\""), 2);
    EXPECT_FALSE(std::filesystem::exists(folder_ / "a.json"));
}

// Every field of the contract, and a row for every body, player and hand in every frame.
TEST_F(LabCommand, WritesCompleteFilesForEveryScene) {
    for (const std::string_view scene : scene_names()) {
        SCOPED_TRACE(std::string(scene));
        const std::string csv = (folder_ / "a.csv").string();
        ASSERT_EQ(run("solve --scene " + std::string(scene) + " --links 6 --frames 3 --hz 72 " +
                      json() + " --csv \"" + csv + "\""),
                  0)
            << err_;
        EXPECT_EQ(err_, "");
        const auto figures = nlohmann::json::parse(text_of(folder_ / "a.json"));
        for (const char* field :
             {"scene", "solver", "hz", "bodies", "planes", "joints", "joint_error_mm",
              "joint_error_deg", "grab_error_mm", "player_error_mm", "penetration_mm",
              "us_per_step", "us_per_solve", "us_per_frame", "iterations", "momentum_residual"}) {
            EXPECT_TRUE(figures.contains(field)) << field;
        }
        // Each of the three contains the one before it.
        EXPECT_LE(figures["us_per_solve"]["max"], figures["us_per_step"]["max"]);
        EXPECT_LE(figures["us_per_step"]["max"], figures["us_per_frame"]["max"]);
        std::size_t grabs = 0;
        for (const auto& joint : figures["joints"]) {
            grabs += joint["type"] == "grab" ? 1U : 0U;
        }
        EXPECT_EQ(parse_rows(text_of(csv)).size(), 3 * (figures["bodies"].size() + grabs));
    }
}

// Exit status 0 says that pairs shared, threw and held each other where they should.
TEST_F(LabCommand, PlaysAMatchOfPairsWhoDoDifferentThings) {
    const std::string match = "match --scene together --rtt-ms 60 --jitter-ms 10 --loss 0.02 ";
    ASSERT_EQ(run(match + "--peers 4 --seconds 3.5 " + json()), 0) << err_;
    const auto sharing = nlohmann::json::parse(text_of(folder_ / "a.json"));
    EXPECT_EQ(sharing.at("hashes_different"), 0);
    EXPECT_EQ(sharing.at("throws"), 4);  // one a player
    EXPECT_GT(sharing.at("shared_holds"), 180);
    EXPECT_EQ(sharing.at("player_holds"), 0);
    ASSERT_EQ(run(match + "--first-pair 3 --peers 2 --seconds 5.5 " + json()), 0) << err_;
    const auto holding = nlohmann::json::parse(text_of(folder_ / "a.json"));
    EXPECT_GT(holding.at("player_holds"), 45);
    // Before anybody holds another player.
    EXPECT_EQ(run(match + "--first-pair 3 --peers 2 --seconds 3.5 " + json()), 3);
    EXPECT_NE(err_.find("nobody held another player"), std::string::npos);
}

// A person who waves, and presses a button: there a rock is waiting.
TEST_F(LabCommand, PlaysAMatchOfRecordedPeople) {
    std::ofstream csv(folder_ / "person.csv");
    csv << "t,hx,hy,hz,hqx,hqy,hqz,hqw,lx,ly,lz,lqx,lqy,lqz,lqw,lbtn,ltrig,"
           "rx,ry,rz,rqx,rqy,rqz,rqw,rbtn,rtrig\n";
    for (int i = 0; i < 270; ++i) {
        const double t = i / 90.0;
        csv << t << ",0.5,1.6,0.2,0,0,0,1," << 0.2 + 0.2 * std::sin(5.0 * t)
            << ",1.2,-0.2,0,0,0,1,0,0,0.8,1.1,-0.3,0,0,0,1," << (i > 120 ? 2 : 0) << ",0\n";
    }
    csv.close();
    ASSERT_EQ(run("match --scene recorded --peers 2 --rtt-ms 100 --jitter-ms 0 --seconds 7 "
                  "--input \"" +
                  (folder_ / "person.csv").string() + "\" " + json()),
              0)
        << err_;
    const auto figures = nlohmann::json::parse(text_of(folder_ / "a.json"));
    EXPECT_GE(figures.at("grips"), 2);
    // The round trip, and packets that wait for a tick on their way.
    EXPECT_GE(figures.at("others_age_ms").at("median"), 100.0);
    EXPECT_LE(figures.at("others_age_ms").at("median"), 150.0);
    EXPECT_GT(figures.at("others_shown_error_mm").at("p95"), 1.0);

    EXPECT_EQ(run("match --scene recorded " + json()), 1);
    EXPECT_NE(err_.find("--input"), std::string::npos);
    EXPECT_EQ(run("match --scene crawl --input x.csv " + json()), 1);
    EXPECT_EQ(run("match --scene recorded --input absent.csv " + json()), 2);
    EXPECT_NE(err_.find("absent.csv"), std::string::npos);
}

// Needs the wall's clock. Exit status 0 says that hashes and own hands were compared and are equal,
// and that somebody gripped, went back and was filled.
TEST_F(LabCommand, PlaysAMatchOfProcessesOverSockets) {
    if (std::getenv("HANDHOLD_REALTIME_TESTS") == nullptr || !has_network()) {
        GTEST_SKIP() << "bounds of the wall's clock: set HANDHOLD_REALTIME_TESTS";
    }
    ASSERT_EQ(run("match --sockets arena --peers 2 --rtt-ms 60 --jitter-ms 10 --seconds 8 "
                  "--freeze-s 1 " +
                  json()),
              0)
        << err_;
    const auto figures = nlohmann::json::parse(text_of(folder_ / "a.json"));
    EXPECT_EQ(figures.at("network").at("transport"), "ws");
    EXPECT_EQ(figures.at("hashes_different"), 0);
    EXPECT_EQ(figures.at("own_hand").at("unexplained"), 0);
    EXPECT_EQ(figures.at("states"), 2);
    EXPECT_GT(figures.at("freeze").at("filled"), 45);  // half of the ticks that it slept
    EXPECT_GT(figures.at("freeze").at("others_ticks_per_s"), 60.0);
    EXPECT_GE(figures.at("join_s").at("median"), 0.06);  // a round trip at least
}

}  // namespace
}  // namespace handhold::lab::lab_command_test
