#include "engine/io/gltf_skin_writer.hpp"

#include <gtest/gtest.h>

#include "engine/core/check.hpp"

namespace handhold::io_gltf_skin_writer_test {
namespace {

GltfSkin two_jointed() {
    GltfSkin skin;
    skin.name = "arm";
    skin.joints = {{"upper", -1, {Vec3(1, 2, 3), rotation_about(Vec3::UnitY(), 0.4)}, {}},
                   {"lower", 0, {Vec3(1, 1, 3), rotation_about(Vec3::UnitX(), -1.0)}, {}}};
    skin.joints[1].numbers = {{"one", {0.25}}, {"three", {1.0, -2.0, 3.5}}};
    GltfSkinSurface surface;
    for (const auto& [x, y] : {std::pair(0.0F, 0.0F), {1.0F, 0.0F}, {0.0F, 1.0F}}) {
        surface.vertices.push_back({{x, y, 0.5F}, {0.0F, 0.0F, 1.0F}});
        surface.weights.push_back({{0, 1, 0, 0}, {0.75F, 0.25F, 0.0F, 0.0F}});
    }
    surface.indices = {0, 1, 2};
    skin.surfaces = {surface};
    return skin;
}
const GltfMaterial k_red = {"red", {0.5F, 0.25F, 0.125F}, 0.0F, 1.0F, 0.5F};

TEST(WriteSkinnedGlb, IsReadBackAsItWasGiven) {
    const GltfSkin given = two_jointed();
    const Result<SkinnedMesh> read =
        parse_gltf_skin(write_skinned_glb(std::span(&k_red, 1), given), "arm.glb");
    ASSERT_TRUE(read.ok()) << read.error().message();
    const SkinnedMesh& skin = read.value();
    ASSERT_EQ(skin.joints.size(), 2U);
    for (std::size_t i = 0; i < 2; ++i) {
        EXPECT_EQ(skin.joints[i].name, given.joints[i].name);
        EXPECT_EQ(skin.joints[i].parent, given.joints[i].parent);
        EXPECT_EQ(skin.joints[i].numbers, given.joints[i].numbers);
        EXPECT_NEAR((skin.joints[i].bind_ms.position - given.joints[i].bind_ms.position).norm(),
                    0.0, 1e-12);
        EXPECT_LT(skin.joints[i].bind_ms.rotation.angularDistance(given.joints[i].bind_ms.rotation),
                  1e-7);
    }
    ASSERT_EQ(skin.positions.size(), 3U);
    EXPECT_NEAR((skin.positions[1] - Vec3(1, 0, 0.5)).norm(), 0.0, 1e-6);
    EXPECT_NEAR((skin.normals[1] - Vec3::UnitZ()).norm(), 0.0, 1e-6);
    EXPECT_EQ(skin.weights[1].joint, given.surfaces[0].weights[1].joint);
    EXPECT_EQ(skin.weights[1].weight, given.surfaces[0].weights[1].weight);
    ASSERT_EQ(skin.color_runs.size(), 1U);
    EXPECT_EQ(skin.color_runs[0].color, k_red.color);
    EXPECT_FLOAT_EQ(skin.color_runs[0].gloss, 0.5F);
}

TEST(WriteSkinnedGlb, RefusesWhatIsNotThere) {
    GltfSkin skin = two_jointed();
    skin.surfaces[0].weights[0].joint[0] = 2;
    EXPECT_THROW(write_skinned_glb(std::span(&k_red, 1), skin), PreconditionError);
    skin = two_jointed();
    skin.joints[0].parent = 1;
    EXPECT_THROW(write_skinned_glb(std::span(&k_red, 1), skin), PreconditionError);
    skin = two_jointed();
    skin.surfaces.clear();
    EXPECT_THROW(write_skinned_glb(std::span(&k_red, 1), skin), PreconditionError);
    EXPECT_THROW(write_skinned_glb({}, two_jointed()), PreconditionError);
}

}  // namespace
}  // namespace handhold::io_gltf_skin_writer_test
