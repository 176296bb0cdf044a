#include "game/commands/shot_list.hpp"

#include <filesystem>

#include <gtest/gtest.h>

#include "engine/core/text_file.hpp"
#include "tests/places.hpp"

namespace handhold::shot_list_test {
namespace {

TEST(ShotList, ReadsMembersAndFillsInDefaults) {
    const auto shots = parse_shots(R"({"shots": [
        {"name": "a_1", "scene": "ship", "at_s": 2},
        {"name": "b", "scene": "ship", "at_s": 3, "until_s": 4.5, "view": "hand", "side": "left",
         "from_m": [1, 2, 3], "free": true, "fov_deg": 40, "gizmos": ["fingers", "palm rays"], "marks": false,
         "caption": "Fingers"}]})",
                                   "list.json");
    ASSERT_TRUE(shots.ok());
    ASSERT_EQ(shots.value().size(), 2U);
    const Shot& picture = shots.value()[0];
    EXPECT_EQ(picture.view, ShotView::eyes);
    EXPECT_EQ(picture.until_s, picture.at_s);
    EXPECT_EQ(picture.gizmos, k_no_gizmos);
    EXPECT_FALSE(picture.free);
    EXPECT_TRUE(picture.marks);
    const Shot& film = shots.value()[1];
    EXPECT_EQ(film.until_s, 4.5);
    EXPECT_EQ(film.side, HandSide::left);
    EXPECT_EQ(film.from_m, Vec3(1.0, 2.0, 3.0));
    EXPECT_TRUE(film.gizmos[static_cast<std::size_t>(Gizmo::fingers)]);
    EXPECT_TRUE(film.gizmos[static_cast<std::size_t>(Gizmo::palm_rays)]);
    EXPECT_FALSE(film.gizmos[static_cast<std::size_t>(Gizmo::arms)]);
    EXPECT_TRUE(film.free);
    EXPECT_FALSE(film.marks);
}

// A picture at the start time of a clip is taken before it.
TEST(ShotList, RefusesShotsThatOverlapAClipOfTheSameScene) {
    const auto list = [](const char* scene, double at_s) {
        return std::string(R"({"shots": [{"name": "a", "scene": "s", "at_s": 1, "until_s": 3},)") +
               R"({"name": "b", "scene": ")" + scene + R"(", "at_s": )" + std::to_string(at_s) +
               "}]}";
    };
    EXPECT_TRUE(parse_shots(list("s", 1.0), "f"));
    EXPECT_TRUE(parse_shots(list("s", 3.0), "f"));
    EXPECT_TRUE(parse_shots(list("t", 2.0), "f"));
    const auto within = parse_shots(list("s", 2.0), "f");
    ASSERT_FALSE(within);
    EXPECT_EQ(within.error().place, "/shots/1/at_s");
}

TEST(ShotList, ErrorNamesPlaceAndExpectation) {
    const struct {
        const char* member;
        const char* place;
    } refused[] = {{R"("name": "../a")", "/shots/0/name"},
                   {R"("view": "sideways")", "/shots/0/view"},
                   {R"("view": "body")", "/shots/0"},
                   {R"("side": "both")", "/shots/0/side"},
                   {R"("until_s": 0.5)", "/shots/0/until_s"},
                   {R"("fov_deg": 190)", "/shots/0/fov_deg"},
                   {R"("gizmos": ["everything"])", "/shots/0/gizmos/0"},
                   {R"("zoom": 2)", "/shots/0"}};
    for (const auto& bad : refused) {
        std::string shot = R"({"scene": "ship", "at_s": 1)";
        if (std::string(bad.member).find("\"name\"") == std::string::npos) {
            shot += R"(, "name": "a")";
        }
        const auto shots =
            parse_shots(R"({"shots": [)" + shot + ", " + bad.member + "}]}", "list.json");
        ASSERT_FALSE(shots.ok()) << bad.member;
        EXPECT_EQ(shots.error().file, "list.json");
        EXPECT_EQ(shots.error().place.substr(0, std::string(bad.place).size()), bad.place)
            << bad.member;
    }
    const auto twice = parse_shots(R"({"shots": [{"name": "a", "scene": "ship", "at_s": 1},
                                                 {"name": "a", "scene": "ship", "at_s": 2}]})",
                                   "list.json");
    ASSERT_FALSE(twice.ok());
    EXPECT_EQ(twice.error().place, "/shots/1/name");
}

TEST(ShotList, RefusesMisspeltSceneAnywhereInTheList) {
    const auto folder = std::filesystem::path(testing::TempDir());
    const auto load = [&](const std::string& scene) {
        const auto file = folder / "shots_of_scenes.json";
        const std::string text = R"({"shots": [{"name": "a", "scene": "ship", "at_s": 1},
                                               {"name": "b", "scene": ")" +
                                 scene + R"(", "at_s": 1}]})";
        EXPECT_FALSE(write_file_atomically(file, text));
        return load_shots(file);
    };
    EXPECT_TRUE(load("station"));
    ASSERT_FALSE(write_file_atomically(folder / "a_scene.json", "{}"));
    EXPECT_TRUE(load((folder / "a_scene.json").string()));
    for (const std::string scene : {"sttion", "no/such/scene.json"}) {
        const auto shots = load(scene);
        ASSERT_FALSE(shots.ok()) << scene;
        EXPECT_EQ(shots.error().place, "/shots/1/scene");
        EXPECT_NE(shots.error().expected.find(scene), std::string::npos);
    }
}

TEST(ShotList, ListsOfTheProjectNameExistingScenes) {
    for (const char* name : {"pictures.json", "film.json"}) {
        const auto shots = load_shots(source_dir() / "tools/shots" / name);
        EXPECT_TRUE(shots.ok()) << (shots.ok() ? "" : shots.error().message());
    }
}

}  // namespace
}  // namespace handhold::shot_list_test
