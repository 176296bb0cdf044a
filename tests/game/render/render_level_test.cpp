// Real levels as pictures.
#include <algorithm>
#include <array>
#include <filesystem>

#include <gtest/gtest.h>

#include "game/mesh/level_meshes.hpp"
#include "game/mesh/primitives.hpp"
#include "game/render/renderer.hpp"
#include "tests/places.hpp"

namespace handhold::render_level_test {
namespace {

TEST(LevelMeshes, OneMeshPerColourWithItsOwnVertices) {
    constexpr std::array<float, 3> k_red = {1.0F, 0.0F, 0.0F};
    constexpr std::array<float, 3> k_blue = {0.0F, 0.0F, 1.0F};
    LevelPart part;
    part.mesh = make_box(Vec3(1.0, 1.0, 1.0));  // two per face
    part.mesh.name = "room";
    part.color_runs = {{0, k_red}, {2, k_blue}, {10, k_red}};
    GltfLevel level;
    level.parts = {part, part};
    const std::vector<LevelMesh> meshes = make_level_meshes(level);
    ASSERT_EQ(meshes.size(), 4U);
    EXPECT_EQ(meshes[0].mesh.color, k_red);
    EXPECT_EQ(meshes[0].mesh.triangles.size(), 4U);
    EXPECT_EQ(meshes[1].mesh.color, k_blue);
    EXPECT_EQ(meshes[1].mesh.triangles.size(), 8U);
    EXPECT_EQ(meshes[0].mesh.name, "room");
    const auto& first = part.mesh.triangles[2];
    for (std::size_t corner = 0; corner < 3; ++corner) {
        EXPECT_EQ(meshes[1].mesh.positions[meshes[1].mesh.triangles[0][corner]],
                  part.mesh.positions[first[corner]]);
    }
}

TEST(LevelMeshes, RealStationFillsThePicture) {
    const std::filesystem::path path = data_dir() / "level" / "station_render.glb";
    if (!std::filesystem::exists(path)) {
        GTEST_SKIP() << path << " is absent";
    }
    std::string why_not;
    std::optional<Renderer> renderer = Renderer::create(320, 180, why_not);
    if (!renderer) {
        GTEST_SKIP() << "no picture can be drawn here: " << why_not;
    }
    const Result<GltfLevel> level = load_gltf_level(path);
    ASSERT_TRUE(level) << level.error().message();
    RenderFrame frame;
    for (const LevelMesh& part : make_level_meshes(level.value())) {
        frame.instances.push_back({renderer->add_mesh(part.mesh), {}, std::nullopt, part.look});
    }
    // In the middle of its second node, towards the laboratory: closed on all sides except for
    // seams.
    frame.camera.pose_ws = look_along(Vec3(0.0, 0.0, 1.5), Vec3(0.0, 0.0, 1.0), Vec3::UnitY());
    Image image;
    renderer->draw(frame, image);
    int dark = 0;
    for (std::size_t i = 0; i < image.rgba.size(); i += 4) {
        dark += std::max({image.rgba[i], image.rgba[i + 1], image.rgba[i + 2]}) < 4 ? 1 : 0;
    }
    EXPECT_LT(dark, 320 * 180 / 20);
}

}  // namespace
}  // namespace handhold::render_level_test
