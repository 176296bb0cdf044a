// Worlds built from scene files.
#include "game/scene/scene.hpp"

#include <gtest/gtest.h>

#include "systems/frame/frame.hpp"

namespace handhold::scene_test {
namespace {

Scene build(const std::string& json) {
    const Result<SceneFile> file = parse_scene_file(json, "scene.json");
    EXPECT_TRUE(file.ok()) << (file.ok() ? "" : file.error().message());
    Result<Scene> scene = build_scene(file.value(), "scene.json");
    EXPECT_TRUE(scene.ok()) << (scene.ok() ? "" : scene.error().message());
    return std::move(scene.value());
}

const char* const k_lift = R"({
    "name": "lift",
    "bodies": [{"name": "lift", "kind": "kinematic", "shape": {"type": "sphere", "radius_m": 1},
        "motion": {"path": {"period_s": 8, "poses": [
            {"position_m": [1, 0, 0]}, {"position_m": [0, 0, -1]},
            {"position_m": [-1, 0, 0]}, {"position_m": [0, 0, 1]}]}}}],
    "lamps": [{"position_m": [0, 2, 0], "color": [1, 1, 1], "reach_m": 3}],
    "world_transform": {"position_m": [10, 20, 30], "rotation_xyzw": [0, 1, 0, 0]}
})";

// Half a turn about Y: x and z change sign.
TEST(BuildScene, PathIsFollowedInTheWorldAndBeginsAtItsFirstPose) {
    Scene scene = build(k_lift);
    const Entity lift = find_by_id(scene.world(), persistent_id_from_name("lift"));
    EXPECT_LT((scene.world().body_pose.at(lift).pose_ws.position - Vec3(9.0, 20.0, 30.0)).norm(),
              1e-12);
    // The spline through four points of a unit circle passes each at 3 / (2 step) of the chord
    // between its neighbours: 1.5 * 2 / (2 * 2 s) here.
    EXPECT_NEAR(scene.world().body_velocity.at(lift).linear_mps.norm(), 0.75, 1e-12);
    FrameCaches caches(scene.shapes(), &scene.grip_meshes());
    StageStats stats;
    for (int frame = 0; frame < 4; ++frame) {
        step_frame(scene.world(), caches, scene.tuning(), {0.5, {}}, stats);
    }
    EXPECT_LT((scene.world().body_pose.at(lift).pose_ws.position - Vec3(10.0, 20.0, 31.0)).norm(),
              1e-12);
}

TEST(BuildScene, LampsAreInTheWorld) {
    const Scene scene = build(k_lift);
    ASSERT_EQ(scene.lamps.size(), 1U);
    EXPECT_LT((scene.lamps[0].position_ws - Vec3(10.0, 22.0, 30.0)).norm(), 1e-12);
}

TEST(BuildScene, BodyIsDrawnByItsVisual) {
    const Result<SceneFile> file = parse_scene_file(
        R"({"name": "a", "bodies": [{"name": "b", "kind": "free", "mass_kg": 1,
            "shape": {"type": "sphere", "radius_m": 0.1}, "visual": "b.glb"}]})",
        "dir/scene.json");
    ASSERT_TRUE(file.ok()) << file.error().message();
    const auto give = [](const std::filesystem::path& path) -> Result<GltfLevel> {
        EXPECT_EQ(path, std::filesystem::path("dir/b.glb"));
        GltfLevel level;
        LevelPart part;
        part.mesh.positions = {Vec3::Zero(), Vec3::UnitX(), Vec3::UnitY()};
        part.mesh.triangles = {{0, 1, 2}};
        part.color_runs = {{0, {0.5F, 0.25F, 0.125F}, 2.0F, 0.5F, 0.75F}};
        level.parts.push_back(part);
        return level;
    };
    const Result<Scene> scene = build_scene(file.value(), "dir/scene.json", give);
    ASSERT_TRUE(scene.ok());
    ASSERT_EQ(scene.value().visuals.size(), 1U);
    const SceneVisual& visual = scene.value().visuals[0];
    EXPECT_EQ(visual.mesh->triangles.size(), 1U);
    EXPECT_EQ(visual.mesh->color, (Color{0.5F, 0.25F, 0.125F}));
    EXPECT_EQ(visual.look.emissive, 2.0F);
    EXPECT_EQ(visual.look.opacity, 0.5F);
    EXPECT_EQ(scene.value().shapes().at(scene.value().world().collider.elements()[0].shape).kind,
              ShapeKind::sphere);
}

}  // namespace
}  // namespace handhold::scene_test
