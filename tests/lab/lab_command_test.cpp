// `handhold-lab` as an external program: exit status, messages, files.
#include <sys/wait.h>

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
          "solve --scene chain --json x --holder none", "dissolve"}) {
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
              "us_per_step", "iterations", "momentum_residual"}) {
            EXPECT_TRUE(figures.contains(field)) << field;
        }
        std::size_t grabs = 0;
        for (const auto& joint : figures["joints"]) {
            grabs += joint["type"] == "grab" ? 1U : 0U;
        }
        EXPECT_EQ(parse_rows(text_of(csv)).size(), 3 * (figures["bodies"].size() + grabs));
    }
}

}  // namespace
}  // namespace handhold::lab::lab_command_test
