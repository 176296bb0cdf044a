// A station's description and the files made from it.
#include "game/levels/station_scene.hpp"

#include <filesystem>
#include <functional>
#include <set>
#include <string>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "engine/collision/collision_world.hpp"
#include "game/assets/assets.hpp"
#include "game/levels/built_in_scenes.hpp"
#include "game/levels/load_scene.hpp"
#include "game/levels/station_tools.hpp"
#include "game/run/session_run.hpp"
#include "game/scene/scene_file_writer.hpp"
#include "systems/frame/frame.hpp"

namespace handhold::station_scene_test {
namespace {

using Json = nlohmann::json;

// A folder that is removed at the end of the test.
class Folder {
  public:
    Folder()
        : path_(std::filesystem::path(testing::TempDir()) /
                ("station_" +
                 std::string(testing::UnitTest::GetInstance()->current_test_info()->name()))) {
        std::filesystem::remove_all(path_);
    }
    ~Folder() { std::filesystem::remove_all(path_); }
    Folder(const Folder&) = delete;
    Folder& operator=(const Folder&) = delete;
    const std::filesystem::path& path() const { return path_; }

  private:
    std::filesystem::path path_;
};

StationScene own_station() {
    StationScene station = make_station_scene(own_station_description());
    add_session_spawn(station.scene);
    return station;
}

std::uint64_t hash_after(Scene& scene, double seconds) {
    const Recording session = *make_built_in_session("station");
    const PlayerEntities player =
        add_scene_player(scene, {"player0", from_host(scene.spawns.front().pose_ws), 80.0});
    return run_session(scene, player_ids({&player, 1}), &session, {90.0, seconds, 1}).state_hash;
}

TEST(StationFiles, PlayToTheBuiltInScenesStateHash) {
    const Folder folder;
    const auto error = write_station(own_station(), folder.path());
    ASSERT_FALSE(error.has_value()) << error->message();
    Result<Scene> read = load_scene((folder.path() / "station.json").string());
    ASSERT_TRUE(read.ok()) << read.error().message();
    Scene built_in = *make_built_in_scene("station");
    EXPECT_EQ(read.value().world().body.size(), built_in.world().body.size());
    EXPECT_EQ(hash_after(read.value(), 5.0), hash_after(built_in, 5.0));
}

TEST(StationFiles, AreTheSameBytesEveryTime) {
    const StationScene once = own_station();
    const StationScene again = own_station();
    EXPECT_EQ(write_scene_file(once.scene), write_scene_file(again.scene));
    ASSERT_EQ(once.models.size(), again.models.size());
    for (std::size_t i = 0; i < once.models.size(); ++i) {
        EXPECT_EQ(write_model_glb(once.models[i].structure),
                  write_model_glb(again.models[i].structure));
    }
}

TEST(StationFiles, LevelReadBackHasEveryTriangleAndLook) {
    const StationScene station = own_station();
    for (const StationModel& model : station.models) {
        SCOPED_TRACE(model.file);
        const Result<GltfLevel> read =
            parse_gltf_level(write_model_glb(model.structure), model.file);
        ASSERT_TRUE(read.ok()) << read.error().message();
        const GltfLevel given = level_of(model.structure);
        EXPECT_EQ(given.dropped_triangles, 0U);
        EXPECT_EQ(read.value().dropped_triangles, 0U);
        ASSERT_EQ(read.value().parts.size(), given.parts.size());
        for (std::size_t i = 0; i < given.parts.size(); ++i) {
            const LevelPart& a = given.parts[i];
            const LevelPart& b = read.value().parts[i];
            EXPECT_EQ(a.mesh.name, b.mesh.name);
            ASSERT_EQ(a.mesh.triangles.size(), b.mesh.triangles.size());
            for (std::size_t t = 0; t < a.mesh.triangles.size(); ++t) {
                for (std::size_t corner = 0; corner < 3; ++corner) {
                    ASSERT_EQ(a.mesh.positions[a.mesh.triangles[t][corner]],
                              b.mesh.positions[b.mesh.triangles[t][corner]]);
                }
            }
            EXPECT_EQ(a.color_runs[0].color, b.color_runs[0].color);
            EXPECT_NEAR(a.color_runs[0].emissive, b.color_runs[0].emissive, 1e-6);
            EXPECT_EQ(a.color_runs[0].opacity, b.color_runs[0].opacity);
            EXPECT_NEAR(a.color_runs[0].gloss, b.color_runs[0].gloss, 1e-6);
        }
    }
}

TEST(StationFiles, SceneReadBackIsTheSameText) {
    const std::string text = write_scene_file(own_station().scene);
    const Result<SceneFile> read = parse_scene_file(text, "station.json");
    ASSERT_TRUE(read.ok()) << read.error().message();
    EXPECT_EQ(write_scene_file(read.value()), text);
}

TEST(StationTools, FloatClearOfEverythingAtFirst) {
    Scene scene = *make_built_in_scene("station");
    FrameCaches caches(scene.shapes(), &scene.grip_meshes());
    std::vector<ColliderProxy> proxies;
    for (std::size_t row = 0; row < scene.world().body.size(); ++row) {
        const Entity body = scene.world().body.owners()[row];
        const Pose& pose = scene.world().body_pose.at(body).pose_ws;
        proxies.push_back({scene.world().persistent_id.at(body).value,
                           scene.world().collider.at(body).shape, pose, pose,
                           scene.world().body.elements()[index].kind == BodyKind::free});
    }
    std::sort(proxies.begin(), proxies.end(),
              [](const ColliderProxy& a, const ColliderProxy& b) { return a.id < b.id; });
    CollisionWorld world(scene.shapes());
    world.set_proxies(proxies);
    std::vector<ContactPoint> contacts;
    world.find_contacts({0.03, 0.005}, contacts);
    EXPECT_TRUE(contacts.empty());
}

// Handles, lenses and the drill's bit protrude.
TEST(StationTools, CollidersHoldWhatIsSeenToNineCentimetres) {
    for (int type = 0; type <= static_cast<int>(ToolType::helmet); ++type) {
        const ToolModel model = make_tool(static_cast<ToolType>(type));
        SCOPED_TRACE(tool_type_name(static_cast<ToolType>(type)));
        EXPECT_GT(model.mass_kg, 0.1);
        EXPECT_LT(model.mass_kg, 12.0);
        for (const Mesh& part : model.visual.parts) {
            for (const Vec3& p : part.positions) {
                double outside_m = 0.0;
                if (model.shape.kind == ShapeKind::box) {
                    outside_m = (p.cwiseAbs() - model.shape.half_m).cwiseMax(0.0).norm();
                } else {
                    const double half =
                        model.shape.kind == ShapeKind::capsule ? model.shape.half_height_m : 0.0;
                    const Vec3 core(0.0, std::clamp(p.y(), -half, half), 0.0);
                    outside_m = (p - core).norm() - model.shape.radius_m;
                }
                ASSERT_LT(outside_m, 0.09) << p.transpose();
            }
        }
    }
}

// --- The description -----------------------------------------------------------------------------

Result<StationDescription> parse(const Json& json) {
    return parse_station_description(json.dump(), "bad.json");
}

struct BadStation {
    const char* what;
    const char* place;
    std::function<void(Json&)> spoil;
};
void PrintTo(const BadStation& station, std::ostream* stream) { *stream << station.what; }

class MalformedStation : public ::testing::TestWithParam<BadStation> {};

TEST_P(MalformedStation, IsRefusedAtItsPlace) {
    Json json = Json::parse(game_asset("station.json"));
    GetParam().spoil(json);
    const Result<StationDescription> result = parse(json);
    ASSERT_FALSE(result.ok());
    EXPECT_EQ(result.error().file, "bad.json");
    EXPECT_EQ(result.error().place, GetParam().place) << result.error().message();
    EXPECT_NE(result.error().expected.find("found "), std::string::npos);
}

// Sections of game/assets/station.json: 0 node, 1 hab, 2 airlock, 3 lab, 4 cupola, 5 junction.
const BadStation k_bad_stations[] = {
    {"no sections", "/sections", [](Json& s) { s.erase("sections"); }},
    {"unknown key", "/gravity", [](Json& s) { s["gravity"] = 1; }},
    {"unknown type", "/sections/1/type", [](Json& s) { s["sections"][1]["type"] = "pub"; }},
    {"name taken", "/sections/1/name", [](Json& s) { s["sections"][1]["name"] = "node"; }},
    {"name with a slash", "/sections/1/name", [](Json& s) { s["sections"][1]["name"] = "a/b"; }},
    {"no racks", "/sections/1/racks", [](Json& s) { s["sections"][1].erase("racks"); }},
    {"too many racks", "/sections/1/racks", [](Json& s) { s["sections"][1]["racks"] = 65; }},
    {"racks of a node", "/sections/0/racks", [](Json& s) { s["sections"][0]["racks"] = 2; }},
    {"walls of another length", "/sections/1/walls/right",
     [](Json& s) {
         s["sections"][1]["walls"]["right"] = {"bunk", "bunk"};
     }},
    {"unknown rack", "/sections/1/walls/right/0",
     [](Json& s) { s["sections"][1]["walls"]["right"][0] = "piano"; }},
    {"attached to nothing", "/sections/1/attach/to",
     [](Json& s) { s["sections"][1]["attach"]["to"] = "moon"; }},
    {"attached to a later one", "/sections/1/attach/to",
     [](Json& s) { s["sections"][1]["attach"]["to"] = "junction"; }},
    {"port taken", "/sections/2/attach/port",
     [](Json& s) { s["sections"][2]["attach"]["port"] = "+z"; }},
    {"port through which the node hangs", "/sections/6/attach/port",
     [](Json& s) { s["sections"][6]["attach"]["port"] = "-z"; }},
    {"end without a hatch", "/sections/5/attach/to",
     [](Json& s) { s["sections"][5]["attach"]["to"] = "hab"; }},
    {"place beside attach", "/sections/1/position_m",
     [](Json& s) {
         s["sections"][1]["position_m"] = {0, 0, 0};
     }},
    {"rail that ends before it starts", "/sections/1/rails/0/to_m",
     [](Json& s) { s["sections"][1]["rails"][0]["to_m"] = 0.1; }},
    {"hose of one point", "/sections/1/hoses/0/points_m",
     [](Json& s) {
         s["sections"][1]["hoses"][0]["points_m"] = Json::array({{0, 0, 0}});
     }},
    {"hose that stands still", "/sections/1/hoses/0/points_m/1",
     [](Json& s) {
         s["sections"][1]["hoses"][0]["points_m"][1] = s["sections"][1]["hoses"][0]["points_m"][0];
     }},
    {"unknown tool", "/tools/0/type", [](Json& s) { s["tools"][0]["type"] = "hammer"; }},
    {"tool name taken", "/tools/1/name", [](Json& s) { s["tools"][1]["name"] = "wrench"; }},
    {"spawn that looks up", "/spawns/0/ahead",
     [](Json& s) {
         s["spawns"][0]["ahead"] = {0, 1, 0};
     }},
};
INSTANTIATE_TEST_SUITE_P(Kinds, MalformedStation, ::testing::ValuesIn(k_bad_stations));

TEST(StationDescription, SmallestOneBuilds) {
    const Json json = {
        {"name", "small"},
        {"sections",
         {{{"name", "n"}, {"type", "node"}, {"accent", {0.1, 0.2, 0.3}}, {"seed", 1}}}}};
    const Result<StationDescription> read = parse(json);
    ASSERT_TRUE(read.ok()) << read.error().message();
    const Structure made = make_station(read.value());
    EXPECT_GE(made.parts.size(), 5U);
    EXPECT_GE(made.rails.size(), 8U);  // beside its four doors
}

TEST(StationDescription, EveryCutIsRefused) {
    const std::string whole(game_asset("station.json"));
    for (std::size_t length = 0; length + 2 < whole.size(); length += 97) {
        EXPECT_FALSE(parse_station_description(whole.substr(0, length), "cut.json").ok());
    }
}

}  // namespace
}  // namespace handhold::station_scene_test
