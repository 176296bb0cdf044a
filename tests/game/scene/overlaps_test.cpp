#include "game/scene/overlaps.hpp"

#include <gtest/gtest.h>

#include "game/scene/scene_file.hpp"

namespace handhold::overlaps_test {
namespace {

// Balls of 0.1 m along x; the third is tied to the second.
Scene row_of_balls(double second_m, double third_m) {
    const auto ball = [](const char* name, double x_m) {
        return std::string(R"({"name": ")") + name +
               R"(", "kind": "free", "mass_kg": 1, "shape": {"type": "sphere", "radius_m": 0.1},
                "position_m": [)" +
               std::to_string(x_m) + ", 0, 0]}";
    };
    const std::string text =
        R"({"name": "row", "bodies": [)" + ball("a", 0.0) + "," + ball("b", second_m) + "," +
        ball("c", third_m) +
        R"(], "joints": [{"name": "tie", "type": "ball", "a": "b", "b": "c"}]})";
    const Result<SceneFile> file = parse_scene_file(text, "row.json");
    EXPECT_TRUE(file.ok()) << file.error().message();
    return std::move(build_scene(file.value(), "row.json").value());
}

TEST(Overlaps, DeepestPairsAreNamedAndTiedOnesLeftOut) {
    Scene scene = row_of_balls(0.15, 0.16);
    const std::vector<SpawnOverlap> found = find_overlaps(scene, {});
    ASSERT_EQ(found.size(), 2U);  // a with b and c; b and c are tied
    EXPECT_EQ(found[0].a, "a");
    EXPECT_EQ(found[0].b, "b");
    EXPECT_NEAR(found[0].depth_m, 0.05, 1e-6);
    EXPECT_NEAR(found[1].depth_m, 0.04, 1e-6);
}

TEST(Overlaps, TouchingBodiesAreFine) {
    Scene scene = row_of_balls(0.2, 0.4);
    EXPECT_TRUE(find_overlaps(scene, {}).empty());
}

TEST(Overlaps, HeadsInBodiesAndInEachOtherAreFound) {
    Scene scene = row_of_balls(1.0, 2.0);
    std::vector<PlayerEntities> players;
    for (const double x_m : {0.0, 0.05, 5.0}) {
        Pose origin;
        origin.position = Vec3(x_m, -1.6, 0.0);
        players.push_back(
            add_scene_player(scene, {"p" + std::to_string(players.size()), origin, 80.0}));
    }
    const std::vector<SpawnOverlap> found = find_overlaps(scene, players);
    ASSERT_EQ(found.size(), 3U);  // two heads in ball a, and in each other
    for (const SpawnOverlap& overlap : found) {
        EXPECT_NE(overlap.a.find("the head of player"), std::string::npos);
    }
}

}  // namespace
}  // namespace handhold::overlaps_test
