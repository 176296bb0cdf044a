// `handhold-lab grip` as an external program: its format, exit status, and output files.
#include <sys/wait.h>

#include "engine/io/gltf_writer.hpp"
#include "lab_files.hpp"
#include "tests/places.hpp"

namespace handhold::lab::grip_command_test {
namespace {

using Json = nlohmann::json;

// A beam of 40 by 4 by 4 cm along x.
std::string beam_glb() {
    const std::array<float, 3> half_m = {0.2F, 0.02F, 0.02F};
    GltfSurface beam;
    beam.group = "beam";
    beam.name = "beam";
    for (std::size_t axis = 0; axis < 3; ++axis) {
        for (const float side : {-1.0F, 1.0F}) {
            const auto first = static_cast<std::uint32_t>(beam.vertices.size());
            const std::size_t u = (axis + 1) % 3;
            const std::size_t v = (axis + 2) % 3;
            for (const auto& [a, b] : {std::pair(-1.0F, -1.0F), std::pair(1.0F, -1.0F),
                                       std::pair(1.0F, 1.0F), std::pair(-1.0F, 1.0F)}) {
                GltfVertex vertex;
                vertex.position[axis] = side * half_m[axis];
                vertex.position[u] = a * half_m[u];
                vertex.position[v] = b * half_m[v];
                vertex.normal[axis] = side;
                beam.vertices.push_back(vertex);
            }
            for (const std::uint32_t corner : {0U, 1U, 2U, 0U, 2U, 3U}) {
                const std::uint32_t turned = corner == 0 ? 0 : 4 - corner;
                beam.indices.push_back(first + (side > 0.0F ? corner : turned));
            }
        }
    }
    return write_glb(std::vector<GltfMaterial>(1), {&beam, 1});
}

// Palms face down: one on the beam's top, one a metre above.
const char* const k_placements =
    R"({"id":7,"wrist":{"position_m":[0.0,0.045,0.085],"rotation_xyzw":[0,0,0,1]}})"
    "\n"
    R"({"id":-2,"wrist":{"position_m":[0.0,1.0,0.08],"rotation_xyzw":[0,0,0,1]},"note":"far"})"
    "\n";

class GripCommand : public LabTest {
  protected:
    GripCommand() {
        EXPECT_FALSE(write_file_atomically(folder_ / "beam.glb", beam_glb()));
        EXPECT_FALSE(write_file_atomically(folder_ / "places.jsonl", k_placements));
    }
    std::string path(const std::string& name) const {
        return "\"" + (folder_ / name).string() + "\"";
    }
    std::string files() const {
        return "--mesh " + path("beam.glb") + " --placements " + path("places.jsonl") + " --out " +
               path("out.jsonl");
    }
    int run(const std::string& arguments) {
        const std::string command =
            "\"" + lab_program().string() + "\" grip " + arguments + " 2>" + path("err");
        const int status = std::system(command.c_str());
        err_ = text_of(folder_ / "err");
        return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
    }
    std::vector<Json> hands() const {
        std::vector<Json> lines;
        std::istringstream text(text_of(folder_ / "out.jsonl"));
        for (std::string line; std::getline(text, line);) {
            lines.push_back(Json::parse(line));
        }
        return lines;
    }
    bool has_output() const { return std::filesystem::exists(folder_ / "out.jsonl"); }

    std::string err_;
};

void expect_fields(const Json& json, std::initializer_list<const char*> fields) {
    for (const char* field : fields) {
        EXPECT_TRUE(json.contains(field)) << field;
    }
}

TEST_F(GripCommand, WritesEveryFieldOfItsFormat) {
    ASSERT_EQ(run(files()), 0) << err_;
    const auto lines = hands();
    ASSERT_EQ(lines.size(), 2U);
    const Json& hand = lines[0];
    EXPECT_EQ(hand["id"], 7);
    EXPECT_EQ(hand["gripped"], true);
    EXPECT_EQ(hand["reason"], "");
    expect_fields(hand, {"wrist", "sync_mm", "sync_deg", "surface", "capsules", "fingers", "us"});
    expect_fields(hand["surface"], {"triangle", "point_m", "normal"});
    EXPECT_NEAR(hand["surface"]["point_m"][1].get<double>(), 0.02, 1e-6);  // the beam's top
    EXPECT_NEAR(hand["surface"]["normal"][1].get<double>(), 1.0, 1e-6);
    EXPECT_LT(hand["surface"]["triangle"].get<int>(), 12);
    expect_fields(hand["us"], {"search", "palm", "fingers", "total"});
    EXPECT_GT(hand["us"]["total"].get<double>(), 0.0);
    ASSERT_EQ(hand["fingers"].size(), 5U);
    std::size_t links = 0;
    for (const Json& finger : hand["fingers"]) {
        expect_fields(finger, {"name", "discs", "visited", "walked", "contact_link", "fallback"});
        EXPECT_GT(finger["discs"].get<int>(), 0);
        links += finger["curl_rad"].size();
    }
    std::size_t finger_capsules = 0;
    for (const Json& capsule : hand["capsules"]) {
        expect_fields(capsule, {"finger", "link", "a_m", "b_m", "radius_m"});
        finger_capsules += capsule["finger"] != "palm" ? 1U : 0U;
    }
    EXPECT_EQ(finger_capsules, links);
    EXPECT_GT(hand["capsules"].size(), finger_capsules);
}

// A grip of 21 frames, in which the wrist turns by 0.01 rad a frame.
std::string turning_grip() {
    Json grip = {{"recording", "made up"}, {"hand", "right"}, {"us", Json::array()}};
    for (int frame = 0; frame < 21; ++frame) {
        const double half_rad = 0.005 * frame;
        grip["us"].push_back(40.0);
        grip["wrists"].push_back(
            {{"position_m", {0.0, 0.0, 0.0}},
             {"rotation_xyzw", {std::sin(half_rad), 0.0, 0.0, std::cos(half_rad)}}});
    }
    return grip.dump() + "\n";
}

TEST_F(GripCommand, WarmFramesNeedMotionsOfThatLength) {
    EXPECT_EQ(run(files() + " --warm-frames 20"), 1);
    EXPECT_FALSE(write_file_atomically(folder_ / "grips.jsonl", turning_grip()));
    EXPECT_EQ(run(files() + " --warm-frames 21 --motions " + path("grips.jsonl")), 2);
    EXPECT_NE(err_.find("expected a grip of more than 21 frames"), std::string::npos) << err_;
    EXPECT_FALSE(write_file_atomically(folder_ / "grips.jsonl", "\n{\"wrists\": 3}\n"));
    EXPECT_EQ(run(files() + " --warm-frames 20 --motions " + path("grips.jsonl")), 2);
    EXPECT_NE(err_.find("grips.jsonl: line 2"), std::string::npos) << err_;
}

TEST_F(GripCommand, WritesEveryWarmFrame) {
    EXPECT_FALSE(write_file_atomically(folder_ / "grips.jsonl", turning_grip()));
    ASSERT_EQ(run(files() + " --warm-frames 20 --motions " + path("grips.jsonl") + " --warm-json " +
                  path("warm.json")),
              0)
        << err_;
    const Json warm = Json::parse(text_of(folder_ / "warm.json"));
    // One of the two hands grips; it has four fingers and a thumb of three joints each.
    for (const char* const name : {"moving_us", "stand_us"}) {
        ASSERT_EQ(warm[name].size(), 20U) << name;
        for (const Json& us : warm[name]) {
            EXPECT_GT(us.get<double>(), 0.0) << name;
        }
    }
    EXPECT_EQ(warm["joint_frames"], 20 * 15);
    EXPECT_TRUE(warm["pops_a_disc"].is_array());
    EXPECT_LE(warm["jumps"].get<int>(), 20 * 15);
    EXPECT_LE(warm["shown_jumps"].get<int>(), 20 * 15);
}

TEST_F(GripCommand, HandsWithNothingInReachGiveAReason) {
    ASSERT_EQ(run(files()), 0) << err_;
    const Json hand = hands()[1];
    EXPECT_EQ(hand["id"], -2);
    EXPECT_EQ(hand["gripped"], false);
    EXPECT_NE(hand["reason"], "");
    EXPECT_TRUE(hand["surface"].is_null());
    EXPECT_EQ(hand["sync_mm"], 0.0);
    EXPECT_EQ(hand["wrist"]["position_m"][1], 1.0);
    EXPECT_EQ(hand["fingers"].size(), 5U);
}

TEST_F(GripCommand, CapsulesOfAFingerAreConnected) {
    ASSERT_EQ(
        run(files() + " --hand left --fingers talk --search bfs --palm ray --grip-edge-mm 11"), 0)
        << err_;
    const Json hand = hands()[0];
    for (std::size_t i = 1; i < hand["capsules"].size(); ++i) {
        const Json& before = hand["capsules"][i - 1];
        const Json& capsule = hand["capsules"][i];
        if (capsule["finger"] == before["finger"] && capsule["finger"] != "palm") {
            for (std::size_t axis = 0; axis < 3; ++axis) {
                EXPECT_NEAR(before["b_m"][axis].get<double>(), capsule["a_m"][axis].get<double>(),
                            1e-12);
            }
        }
    }
}

TEST_F(GripCommand, WithoutSyncThePalmStaysAtItsTrackedPose) {
    ASSERT_EQ(run(files() + " --sync off"), 0) << err_;
    const Json hand = hands()[0];
    EXPECT_EQ(hand["sync_mm"], 0.0);
    EXPECT_EQ(hand["wrist"]["position_m"], Json({0.0, 0.045, 0.085}));
}

TEST_F(GripCommand, BaselinesWriteTheSameFormat) {
    for (const auto& [fingers, discs] : {std::pair("talk", 1), std::pair("spheres", 0)}) {
        ASSERT_EQ(run(files() + " --fingers " + fingers), 0) << err_;
        const auto lines = hands();
        ASSERT_EQ(lines.size(), 2U);
        EXPECT_EQ(lines[0]["gripped"], true);
        EXPECT_EQ(lines[1]["gripped"], false);
        expect_fields(lines[0], {"wrist", "sync_mm", "sync_deg", "surface", "capsules", "us"});
        EXPECT_GT(lines[0]["us"]["fingers"].get<double>(), 0.0);
        ASSERT_EQ(lines[0]["fingers"].size(), 5U);
        for (const Json& finger : lines[0]["fingers"]) {
            expect_fields(finger, {"name", "visited", "walked", "contact_link", "fallback"});
            EXPECT_EQ(finger["discs"], discs) << finger["name"];
        }
    }
}

// Earlier scripts give a search alone.
TEST_F(GripCommand, SearchWithoutFingersMeansTheTalks) {
    ASSERT_EQ(run(files() + " --search bfs"), 0) << err_;
    const std::vector<Json> alone = hands();
    ASSERT_EQ(run(files() + " --search bfs --fingers talk"), 0) << err_;
    const std::vector<Json> named = hands();
    ASSERT_EQ(alone.size(), named.size());
    for (std::size_t i = 0; i < alone.size(); ++i) {
        EXPECT_EQ(alone[i]["capsules"], named[i]["capsules"]);
        EXPECT_EQ(alone[i]["fingers"], named[i]["fingers"]);
    }
}

TEST_F(GripCommand, RefusesWrongFlagsAndLeavesNoOutput) {
    for (const char* flag :
         {"--hand middle", "--sync maybe", "--search dijkstra", "--search bfs --fingers fit",
          "--grip-edge-mm 0", "--grip-edge-mm wide", "--palm none", "--fingers nails",
          "--depth 3"}) {
        EXPECT_EQ(run(files() + " " + flag), 1) << flag;
        EXPECT_FALSE(err_.empty());
        EXPECT_FALSE(has_output());
    }
    EXPECT_EQ(run("--mesh " + path("beam.glb")), 1);
}

TEST_F(GripCommand, BadFileGivesOneErrorLineAndNoOutput) {
    const auto expect_refused = [&](const std::string& arguments, const std::string& said) {
        EXPECT_EQ(run(arguments), 2) << arguments;
        EXPECT_EQ(std::count(err_.begin(), err_.end(), '\n'), 1) << err_;
        EXPECT_NE(err_.find(said), std::string::npos) << err_;
        EXPECT_FALSE(has_output());
    };
    const std::string out = " --out " + path("out.jsonl");
    expect_refused("--mesh " + path("no.glb") + " --placements " + path("places.jsonl") + out,
                   "no.glb");
    expect_refused("--mesh " + path("beam.glb") + " --placements " + path("no.jsonl") + out,
                   "no.jsonl");
    expect_refused(files() + " --rig " + path("no.glb"), "no.glb");
    const std::string good(k_placements);
    for (const std::string& bad :
         {std::string("{\"id\":0}"), std::string("nonsense"),
          std::string(R"({"id":0,"wrist":{"position_m":[0,0],"rotation_xyzw":[0,0,0,1]}})"),
          std::string(R"({"id":0,"wrist":{"position_m":[0,0,0],"rotation_xyzw":[0,0,0,0]}})"),
          std::string(R"({"id":0,"wrist":{"position_m":[0,0,1e99],"rotation_xyzw":[0,0,0,1]}})")}) {
        EXPECT_FALSE(write_file_atomically(folder_ / "places.jsonl", good + bad));
        expect_refused(files(), "line 3");
    }
    EXPECT_FALSE(write_file_atomically(folder_ / "places.jsonl", good));
    expect_refused("--mesh " + path("beam.glb") + " --placements " + path("places.jsonl") +
                       " --out " + path("absent/out.jsonl"),
                   "absent");
}

}  // namespace
}  // namespace handhold::lab::grip_command_test
