#include "engine/io/gltf_writer.hpp"

#include <array>
#include <limits>
#include <string>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "engine/core/check.hpp"
#include "engine/io/gltf.hpp"
#include "tests/engine/io/gltf_builder.hpp"

namespace handhold::io_gltf_writer_test {
namespace {

using Json = nlohmann::json;

constexpr float k_tiny = std::numeric_limits<float>::denorm_min();

const std::array<GltfMaterial, 2> k_materials = {{{"paint", {0.1F, 0.2F, 0.3F}, 0.0F, 1.0F, 0.75F},
                                                  {"lamp", {1.0F, 0.5F, 0.25F}, 3.0F, 0.5F, 0.0F}}};

GltfSurface triangle(const std::string& group, const std::string& name, std::size_t material) {
    GltfSurface surface;
    surface.group = group;
    surface.name = name;
    // Numbers that no rounding to fewer digits would keep.
    surface.vertices = {{{0.1F, k_tiny, -1.0F / 3.0F}, {0.0F, 0.0F, 1.0F}},
                        {{16777215.0F / 2.0F, 0.0F, 0.0F}, {0.0F, 0.0F, 1.0F}},
                        {{0.0F, 1e-20F, 2.0F}, {0.0F, 0.0F, 1.0F}}};
    surface.indices = {0, 1, 2};
    surface.material = material;
    return surface;
}

std::string two_rooms() {
    const std::array<GltfSurface, 3> surfaces = {
        triangle("a", "a/paint", 0), triangle("a", "a/lamp", 1), triangle("b", "b/paint", 0)};
    return write_glb(k_materials, surfaces);
}

Json json_of(const std::string& glb) {
    const auto byte = [&glb](std::size_t at) {
        return static_cast<std::size_t>(static_cast<unsigned char>(glb.at(at)));
    };
    const std::size_t length = byte(12) | byte(13) << 8 | byte(14) << 16 | byte(15) << 24;
    return Json::parse(glb.substr(20, length));
}

TEST(WriteGlb, IsReadBackBitForBitWithItsMaterials) {
    const Result<GltfLevel> level = parse_gltf_level(two_rooms(), "rooms.glb");
    ASSERT_TRUE(level.ok()) << level.error().message();
    ASSERT_EQ(level.value().parts.size(), 3U);
    const GltfSurface given = triangle("", "", 0);
    for (const LevelPart& part : level.value().parts) {
        ASSERT_EQ(part.mesh.positions.size(), 3U);
        for (std::size_t i = 0; i < 3; ++i) {
            for (int axis = 0; axis < 3; ++axis) {
                EXPECT_EQ(part.mesh.positions[i][axis],
                          static_cast<double>(
                              given.vertices[i].position[static_cast<std::size_t>(axis)]));
            }
        }
    }
    EXPECT_EQ(level.value().parts[1].mesh.name, "a/lamp");
    const ColorRun& paint = level.value().parts[0].color_runs[0];
    EXPECT_EQ(paint.color, k_materials[0].color);
    EXPECT_EQ(paint.emissive, 0.0F);
    EXPECT_EQ(paint.opacity, 1.0F);
    EXPECT_NEAR(paint.gloss, 0.75F, 1e-6F);
    const ColorRun& lamp = level.value().parts[1].color_runs[0];
    EXPECT_NEAR(lamp.emissive, 3.0F, 1e-6F);
    EXPECT_EQ(lamp.opacity, 0.5F);
}

TEST(WriteGlb, HasANodeAGroupAboveThoseOfItsSurfaces) {
    const Json json = json_of(two_rooms());
    EXPECT_EQ(json["scenes"][0]["nodes"], Json::array({0, 3}));
    EXPECT_EQ(json["nodes"][0]["name"], "a");
    EXPECT_EQ(json["nodes"][0]["children"], Json::array({1, 2}));
    EXPECT_EQ(json["nodes"][3]["children"], Json::array({4}));
}

// What the specification asks of every file (3.6.2.5: bounds of positions; 3.6.2.4: alignment).
TEST(WriteGlb, GivesBoundsOfPositionsAndAlignedViews) {
    const Json json = json_of(two_rooms());
    const Json& accessor =
        json["accessors"]
            [json["meshes"][0]["primitives"][0]["attributes"]["POSITION"].get<std::size_t>()];
    EXPECT_EQ(accessor["min"][2].get<float>(), -1.0F / 3.0F);
    EXPECT_EQ(accessor["max"][0].get<float>(), 16777215.0F / 2.0F);
    for (const Json& view : json["bufferViews"]) {
        EXPECT_EQ(view["byteOffset"].get<std::size_t>() % 4, 0U);
    }
}

TEST(WriteGlb, RefusesSurfacesThatAreNotWhole) {
    const auto write = [](const GltfSurface& surface) {
        return write_glb(k_materials, std::array<GltfSurface, 1>{surface});
    };
    GltfSurface empty = triangle("a", "a", 0);
    empty.indices.clear();
    EXPECT_THROW(write(empty), PreconditionError);
    GltfSurface beyond = triangle("a", "a", 0);
    beyond.indices[2] = 3;
    EXPECT_THROW(write(beyond), PreconditionError);
    EXPECT_THROW(write(triangle("a", "a", 2)), PreconditionError);
}

TEST(LoadGltfLevel, MaterialsWithoutMeaningAreRefusedAtTheirPlace) {
    const auto error_of = [](Json material) {
        test::GltfBuilder builder = test::triangle_file();
        builder.json["materials"] = Json::array({std::move(material)});
        const Result<GltfLevel> level = parse_gltf_level(builder.glb(), "bad.glb");
        EXPECT_FALSE(level.ok());
        return level.ok() ? std::string() : level.error().place;
    };
    EXPECT_EQ(error_of({{"pbrMetallicRoughness", {{"roughnessFactor", "rough"}}}}),
              "/materials/0/pbrMetallicRoughness/roughnessFactor");
    EXPECT_EQ(error_of({{"emissiveFactor", {0, 0}}}), "/materials/0/emissiveFactor");
    EXPECT_EQ(error_of({{"alphaMode", 3}}), "/materials/0/alphaMode");
    EXPECT_EQ(error_of({{"extensions",
                         {{"KHR_materials_emissive_strength", {{"emissiveStrength", "much"}}}}}}),
              "/materials/0/extensions/KHR_materials_emissive_strength/emissiveStrength");
}

}  // namespace
}  // namespace handhold::io_gltf_writer_test
