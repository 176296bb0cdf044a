#include "game/scene/scene_file.hpp"

#include <filesystem>
#include <functional>
#include <string>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "engine/core/text_file.hpp"
#include "tests/places.hpp"

namespace handhold::scene_file_test {
namespace {

using Json = nlohmann::json;

// The text between ```json and ``` in the scene format's document.
std::string document_example() {
    const std::string text = read_file(source_dir() / "docs/reference/scene_format.md").value();
    const std::string opening = "```json\n";
    const std::size_t begin = text.find(opening) + opening.size();
    return text.substr(begin, text.find("```", begin) - begin);
}

SceneFile parse(const std::string& text) {
    const Result<SceneFile> scene = parse_scene_file(text, "scenes/a.json");
    EXPECT_TRUE(scene.ok()) << (scene.ok() ? "" : scene.error().message());
    return scene.ok() ? scene.value() : SceneFile();
}

TEST(SceneFile, ExampleOfItsDocumentLoads) {
    const SceneFile scene = parse(document_example());
    EXPECT_EQ(scene.name, "airlock");
    EXPECT_EQ(scene.reference_velocity_mps, Vec3(0.0, 0.0, -20.0));
    ASSERT_EQ(scene.levels.size(), 1U);
    EXPECT_EQ(scene.levels[0].file, std::filesystem::path("scenes/assets/module.glb"));

    ASSERT_EQ(scene.bodies.size(), 7U + 12U);
    const SceneBody& crate = scene.bodies[0];
    EXPECT_EQ(crate.kind, BodyKind::free);
    EXPECT_EQ(crate.shape.kind, ShapeKind::box);
    EXPECT_EQ(crate.shape.half_m, Vec3(0.3, 0.2, 0.4));
    EXPECT_EQ(crate.mass_kg, 50.0);
    EXPECT_EQ(crate.inertia_kgm2, Vec3(3.4, 4.2, 2.2));
    EXPECT_EQ(crate.velocity_mps, Vec3(0.0, 0.0, 0.1));
    EXPECT_EQ(crate.angular_velocity_radps, Vec3(0.0, 0.2, 0.0));
    EXPECT_EQ(crate.color, (std::array<float, 3>{0.8F, 0.4F, 0.1F}));
    EXPECT_EQ(crate.restitution, 0.3);
    const SceneBody& shuttle = scene.bodies[1];
    EXPECT_EQ(shuttle.kind, BodyKind::kinematic);
    EXPECT_EQ(shuttle.shape.file, std::filesystem::path("scenes/assets/shuttle.glb"));
    EXPECT_EQ(shuttle.motion.velocity_mps, Vec3(0.0, 0.0, -20.0));
    EXPECT_TRUE(shuttle.motion.turns_with_body);
    EXPECT_EQ(scene.bodies[2].shape.kind, ShapeKind::capsule);
    EXPECT_EQ(scene.bodies[2].kind, BodyKind::fixed);
    EXPECT_EQ(scene.bodies[3].shape.radius_m, 0.1);
    EXPECT_EQ(scene.bodies[3].visual, std::filesystem::path("scenes/assets/beacon.glb"));
    EXPECT_TRUE(scene.bodies[2].visual.empty());
    ASSERT_EQ(scene.lamps.size(), 1U);
    EXPECT_EQ(scene.lamps[0].color, (Color{0.5F, 0.47F, 0.42F}));
    EXPECT_EQ(scene.lamps[0].reach_m, 4.0);
    const SceneBody& lift = scene.bodies[4];
    ASSERT_TRUE(lift.motion.path.has_value());
    EXPECT_EQ(lift.motion.path->period_s, 12.0);
    ASSERT_EQ(lift.motion.path->poses.size(), 3U);
    EXPECT_EQ(lift.motion.path->poses[2].position, Vec3(5.0, 4.0, 0.0));
    EXPECT_EQ(lift.pose.position, Vec3(3.0, 0.0, 0.0));
    EXPECT_EQ(scene.bodies[5].friction, 0.8);
    EXPECT_EQ(crate.friction, 0.4);
    ASSERT_EQ(scene.joints.size(), 3U + 13U);
    EXPECT_EQ(scene.joints[1].handle, "knob");
    EXPECT_EQ(scene.joints[3].name, "hose/joint/0");

    ASSERT_EQ(scene.spawns.size(), 2U);
    // A yaw of 90 degrees turns left: from -Z to -X.
    EXPECT_LT((scene.spawns[0].pose.rotation * -Vec3::UnitZ() + Vec3::UnitX()).norm(), 1e-12);
    ASSERT_EQ(scene.players.size(), 2U);
    EXPECT_EQ(scene.players[0].mass_kg, 80.0);
    EXPECT_EQ(scene.players[1].spawn, "hatch");
    ASSERT_TRUE(scene.session.has_value());
    EXPECT_EQ(scene.session->file, std::filesystem::path("scenes/sessions/airlock.csv"));
    EXPECT_EQ(scene.world_transform.position, Vec3(10000.0, 0.0, 0.0));
    EXPECT_EQ(Json::parse(scene.tuning_json), Json::parse(R"({"head": {"radius_m": 0.12}})"));
}

TEST(SceneFile, NameAloneIsAScene) {
    const SceneFile scene = parse(R"({"name": "empty"})");
    EXPECT_TRUE(scene.bodies.empty());
    EXPECT_FALSE(scene.session.has_value());
    EXPECT_EQ(scene.tuning_json, "{}");
    EXPECT_EQ(scene.world_transform.position, Vec3(Vec3::Zero()));
}

TEST(SceneFile, SessionMayBeBuiltIn) {
    const SceneFile scene = parse(R"({"name": "a", "session": "wave"})");
    ASSERT_TRUE(scene.session.has_value());
    EXPECT_EQ(scene.session->built_in, "wave");
    EXPECT_TRUE(scene.session->file.empty());
}

TEST(SceneFile, KinematicBodyWithoutMotionStandsStill) {
    const SceneFile scene = parse(
        R"({"name": "a", "bodies": [{"name": "b", "kind": "kinematic", "shape": {"type": "sphere", "radius_m": 1}}]})");
    ASSERT_EQ(scene.bodies.size(), 1U);
    EXPECT_EQ(scene.bodies[0].motion.velocity_mps, Vec3(Vec3::Zero()));
}

TEST(SceneFile, AbsolutePathsStayAbsolute) {
    EXPECT_EQ(parse(R"({"name": "a", "levels": [{"file": "/b/../c.glb"}]})").levels[0].file,
              std::filesystem::path("/c.glb"));
}

struct BadScene {
    const char* what;
    const char* place;  // JSON pointer that the error must name
    std::function<void(Json&)> spoil;
};
void PrintTo(const BadScene& scene, std::ostream* stream) { *stream << scene.what; }

class MalformedScene : public ::testing::TestWithParam<BadScene> {};

TEST_P(MalformedScene, IsRefusedAtItsPlace) {
    Json scene = Json::parse(document_example());
    GetParam().spoil(scene);
    const Result<SceneFile> result = parse_scene_file(scene.dump(), "bad.json");
    ASSERT_FALSE(result.ok());
    EXPECT_EQ(result.error().file, "bad.json");
    EXPECT_EQ(result.error().place, GetParam().place) << result.error().message();
    EXPECT_NE(result.error().expected.find("found "), std::string::npos)
        << result.error().message();
}

const BadScene k_bad_scenes[] = {
    {"no object", "", [](Json& s) { s = Json::array(); }},
    {"no name", "/name", [](Json& s) { s.erase("name"); }},
    {"empty name", "/name", [](Json& s) { s["name"] = ""; }},
    {"unknown key", "/gravity_mps2", [](Json& s) { s["gravity_mps2"] = 9.81; }},
    {"two numbers", "/reference_velocity_mps",
     [](Json& s) {
         s["reference_velocity_mps"] = {1, 2};
     }},
    {"bodies no array", "/bodies", [](Json& s) { s["bodies"] = Json::object(); }},
    {"body no object", "/bodies/0", [](Json& s) { s["bodies"][0] = 1; }},
    {"name taken", "/bodies/1/name", [](Json& s) { s["bodies"][1]["name"] = "crate"; }},
    {"player's name taken", "/players/0/name", [](Json& s) { s["players"][0]["name"] = "crate"; }},
    {"spawn's name taken", "/spawns/1/name", [](Json& s) { s["spawns"][1]["name"] = "door"; }},
    {"unknown kind", "/bodies/0/kind", [](Json& s) { s["bodies"][0]["kind"] = "dynamic"; }},
    {"unknown shape", "/bodies/0/shape/type",
     [](Json& s) { s["bodies"][0]["shape"]["type"] = "cone"; }},
    {"no shape", "/bodies/0/shape", [](Json& s) { s["bodies"][0].erase("shape"); }},
    {"flat box", "/bodies/0/shape/half_m/1",
     [](Json& s) { s["bodies"][0]["shape"]["half_m"][1] = 0; }},
    {"thinner than a shape may be", "/bodies/0/shape/half_m/2",
     [](Json& s) { s["bodies"][0]["shape"]["half_m"][2] = 0.9e-3; }},
    {"larger than a shape may be", "/bodies/0/shape/half_m/0",
     [](Json& s) { s["bodies"][0]["shape"]["half_m"][0] = 1.01e4; }},
    {"box with a radius", "/bodies/0/shape/radius_m",
     [](Json& s) { s["bodies"][0]["shape"]["radius_m"] = 1; }},
    {"capsule without height", "/bodies/2/shape/half_height_m",
     [](Json& s) { s["bodies"][2]["shape"].erase("half_height_m"); }},
    {"free mesh", "/bodies/0/shape/type",
     [](Json& s) {
         s["bodies"][0]["shape"] = {{"type", "mesh"}, {"file", "x.glb"}};
     }},
    {"free without mass", "/bodies/0/mass_kg", [](Json& s) { s["bodies"][0].erase("mass_kg"); }},
    {"mass 0", "/bodies/0/mass_kg", [](Json& s) { s["bodies"][0]["mass_kg"] = 0; }},
    {"mass negative", "/bodies/0/mass_kg", [](Json& s) { s["bodies"][0]["mass_kg"] = -2; }},
    {"mass of text", "/bodies/0/mass_kg", [](Json& s) { s["bodies"][0]["mass_kg"] = "50"; }},
    {"inertia of no body", "/bodies/0/inertia_kgm2",
     [](Json& s) {
         s["bodies"][0]["inertia_kgm2"] = {1, 1, 2.1};
     }},
    {"static with mass", "/bodies/2/mass_kg", [](Json& s) { s["bodies"][2]["mass_kg"] = 1; }},
    {"static with motion", "/bodies/2/motion",
     [](Json& s) { s["bodies"][2]["motion"] = Json::object(); }},
    {"free with motion", "/bodies/0/motion",
     [](Json& s) { s["bodies"][0]["motion"] = Json::object(); }},
    {"kinematic with velocity", "/bodies/1/velocity_mps",
     [](Json& s) {
         s["bodies"][1]["velocity_mps"] = {1, 0, 0};
     }},
    {"motion with unknown key", "/bodies/1/motion/spin",
     [](Json& s) { s["bodies"][1]["motion"]["spin"] = 1; }},
    {"flag as number", "/bodies/1/motion/turns_with_body",
     [](Json& s) { s["bodies"][1]["motion"]["turns_with_body"] = 1; }},
    {"path beside a velocity", "/bodies/4/motion/velocity_mps",
     [](Json& s) {
         s["bodies"][4]["motion"]["velocity_mps"] = {0, 0, 1};
     }},
    {"path beside a place", "/bodies/4/position_m",
     [](Json& s) {
         s["bodies"][4]["position_m"] = {0, 0, 1};
     }},
    {"path of one pose", "/bodies/4/motion/path/poses",
     [](Json& s) { s["bodies"][4]["motion"]["path"]["poses"] = Json::array({Json::object()}); }},
    {"path of 17 poses", "/bodies/4/motion/path/poses",
     [](Json& s) {
         s["bodies"][4]["motion"]["path"]["poses"] = Json::array();
         for (int i = 0; i < 17; ++i) {
             s["bodies"][4]["motion"]["path"]["poses"].push_back(Json::object());
         }
     }},
    {"path without a period", "/bodies/4/motion/path/period_s",
     [](Json& s) { s["bodies"][4]["motion"]["path"].erase("period_s"); }},
    {"path that turns half around", "/bodies/4/motion/path/poses/0",
     [](Json& s) {
         s["bodies"][4]["motion"]["path"]["poses"][1]["rotation_xyzw"] = {0, 1, 0, 0};
     }},
    {"pose of a path with a speed", "/bodies/4/motion/path/poses/1/velocity_mps",
     [](Json& s) {
         s["bodies"][4]["motion"]["path"]["poses"][1]["velocity_mps"] = {0, 0, 1};
     }},
    {"too fast", "/bodies/0/velocity_mps/2",
     [](Json& s) { s["bodies"][0]["velocity_mps"][2] = 3e8; }},
    {"too far", "/bodies/0/position_m/0", [](Json& s) { s["bodies"][0]["position_m"][0] = 1e7; }},
    {"rotation not unit", "/levels/0/rotation_xyzw",
     [](Json& s) {
         s["levels"][0]["rotation_xyzw"] = {0, 0, 0, 0.9};
     }},
    {"restitution above 1", "/bodies/0/restitution",
     [](Json& s) { s["bodies"][0]["restitution"] = 1.1; }},
    {"colour above 1", "/bodies/0/color/0", [](Json& s) { s["bodies"][0]["color"][0] = 255; }},
    {"null", "/bodies/0/color", [](Json& s) { s["bodies"][0]["color"] = nullptr; }},
    {"lamp without a colour", "/lamps/0/color", [](Json& s) { s["lamps"][0].erase("color"); }},
    {"lamp without reach", "/lamps/0/reach_m", [](Json& s) { s["lamps"][0]["reach_m"] = 0; }},
    {"visual as number", "/bodies/3/visual", [](Json& s) { s["bodies"][3]["visual"] = 1; }},
    {"level without file", "/levels/0/file", [](Json& s) { s["levels"][0].erase("file"); }},
    {"yaw and rotation", "/spawns/0/yaw_deg",
     [](Json& s) {
         s["spawns"][0]["rotation_xyzw"] = {0, 0, 0, 1};
     }},
    {"no such spawn", "/players/0/spawn", [](Json& s) { s["players"][0]["spawn"] = "window"; }},
    {"session as number", "/session", [](Json& s) { s["session"] = 1; }},
    {"session without file", "/session/file", [](Json& s) { s["session"] = Json::object(); }},
    {"tuning no object", "/tuning", [](Json& s) { s["tuning"] = 3; }},
    {"transform with scale", "/world_transform/scale",
     [](Json& s) { s["world_transform"]["scale"] = 2; }},
};
INSTANTIATE_TEST_SUITE_P(Kinds, MalformedScene, ::testing::ValuesIn(k_bad_scenes));

TEST(SceneFile, EveryTruncationIsRefused) {
    const std::string example = document_example();
    const std::string whole = example.substr(0, example.find_last_of('}') + 1);
    for (std::size_t length = 0; length < whole.size(); ++length) {
        const Result<SceneFile> scene = parse_scene_file(whole.substr(0, length), "cut.json");
        ASSERT_FALSE(scene.ok()) << length;
        EXPECT_EQ(scene.error().place.rfind("line ", 0), 0U) << scene.error().message();
    }
}

TEST(SceneFile, FlippedBitsGiveASceneOrOneErrorWithItsFile) {
    const std::string whole = document_example();
    for (std::size_t bit = 0; bit < 8 * whole.size(); bit += 3) {
        std::string flipped = whole;
        flipped[bit / 8] =
            static_cast<char>(static_cast<unsigned char>(flipped[bit / 8]) ^ (1U << (bit % 8)));
        const Result<SceneFile> scene = parse_scene_file(flipped, "flipped.json");
        if (!scene) {
            EXPECT_EQ(scene.error().file, "flipped.json");
            EXPECT_FALSE(scene.error().expected.empty());
        }
    }
}

TEST(SceneFile, AbsentFileIsAnError) {
    EXPECT_EQ(load_scene_file("/no/such/scene.json").error().file, "/no/such/scene.json");
}

}  // namespace
}  // namespace handhold::scene_file_test
