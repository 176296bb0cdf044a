#include "engine/io/gltf.hpp"

#include <array>
#include <cctype>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <string>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "engine/core/text_file.hpp"
#include "engine/math/math.hpp"
#include "tests/engine/io/gltf_builder.hpp"

namespace handhold::io_gltf_test {
namespace {

using Json = nlohmann::json;
using test::GltfBuilder;
using test::triangle_file;
using Triangle = std::array<std::uint32_t, 3>;

GltfLevel load(const GltfBuilder& builder) {
    const Result<GltfLevel> level = parse_gltf_level(builder.glb(), "test.glb");
    EXPECT_TRUE(level.ok()) << (level.ok() ? "" : level.error().message());
    return level.ok() ? level.value() : GltfLevel();
}

Vec3 normal_of(const Mesh& mesh, const Triangle& triangle) {
    const Vec3& a = mesh.positions[triangle[0]];
    return (mesh.positions[triangle[1]] - a).cross(mesh.positions[triangle[2]] - a).normalized();
}

TEST(LoadGltfLevel, ReadsTriangleWithNameAndDefaults) {
    const GltfLevel level = load(triangle_file());
    ASSERT_EQ(level.parts.size(), 1U);
    const LevelPart& part = level.parts[0];
    EXPECT_EQ(part.mesh.name, "tri");
    EXPECT_FALSE(part.synthetic);
    ASSERT_EQ(part.mesh.positions.size(), 3U);
    EXPECT_EQ(part.mesh.positions[1], Vec3(1.0, 0.0, 0.0));
    ASSERT_EQ(part.mesh.triangles.size(), 1U);
    EXPECT_EQ(part.mesh.triangles[0], (Triangle{0, 1, 2}));
    EXPECT_EQ(part.mesh.color, Mesh().color);
    EXPECT_EQ(level.dropped_triangles, 0U);
}

TEST(LoadGltfLevel, ReadsIndicesOfEveryUnsignedTypeAndNone) {
    for (int variant = 0; variant < 4; ++variant) {
        GltfBuilder builder = triangle_file();
        int indices = -1;
        switch (variant) {
            case 0:
                indices = builder.add_indices<std::uint8_t>({2, 0, 1});
                break;
            case 1:
                indices = builder.add_indices<std::uint16_t>({2, 0, 1});
                break;
            case 2:
                indices = builder.add_indices<std::uint32_t>({2, 0, 1});
                break;
            default:
                break;
        }
        builder.json["nodes"][0]["mesh"] = builder.add_mesh(0, indices);
        const GltfLevel level = load(builder);
        ASSERT_EQ(level.parts.size(), 1U);
        ASSERT_EQ(level.parts[0].mesh.triangles.size(), 1U) << variant;
        EXPECT_EQ(level.parts[0].mesh.triangles[0],
                  indices == -1 ? (Triangle{0, 1, 2}) : (Triangle{2, 0, 1}));
    }
}

// A square in the plane z = 0 as a strip and as a fan: both halves must face +z.
TEST(LoadGltfLevel, StripsAndFansFaceOneWay) {
    GltfBuilder builder;
    const int corners = builder.add_positions({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}});
    const int strip = builder.add_indices<std::uint8_t>({0, 1, 3, 2});
    builder.json["nodes"] = {{{"mesh", builder.add_mesh(corners, strip, 5)}},
                             {{"mesh", builder.add_mesh(corners, -1, 6)}}};
    const GltfLevel level = load(builder);
    ASSERT_EQ(level.parts.size(), 2U);
    for (const LevelPart& part : level.parts) {
        ASSERT_EQ(part.mesh.triangles.size(), 2U);
        for (const Triangle& triangle : part.mesh.triangles) {
            EXPECT_EQ(normal_of(part.mesh, triangle), Vec3::UnitZ());
        }
    }
}

// Closed form: a parent at (10, 0, 0), a child turned by 90 degrees about +z and scaled by 2: (1,
// 0, 0) -> (10, 2, 0).
TEST(LoadGltfLevel, BakesHierarchyOfTranslationRotationAndScale) {
    GltfBuilder builder = triangle_file();
    const double half = std::sqrt(0.5);
    builder.json["nodes"] = {{{"children", {1}}, {"translation", {10, 0, 0}}},
                             {{"mesh", 0}, {"rotation", {0, 0, half, half}}, {"scale", {2, 2, 2}}}};
    const GltfLevel level = load(builder);
    ASSERT_EQ(level.parts.size(), 1U);
    EXPECT_LT((level.parts[0].mesh.positions[1] - Vec3(10.0, 2.0, 0.0)).norm(), 1e-14);
    EXPECT_LT((level.parts[0].mesh.positions[2] - Vec3(8.0, 0.0, 0.0)).norm(), 1e-14);
    EXPECT_EQ(level.parts[0].mesh.name, "node 1");
}

TEST(LoadGltfLevel, BakesMatrixAsItsTranslationRotationAndScale) {
    GltfBuilder by_parts = triangle_file();
    by_parts.json["nodes"][0]["translation"] = {1, 2, 3};
    by_parts.json["nodes"][0]["rotation"] = {0, 1, 0, 0};  // half a turn about y: diag(-1, 1, -1)
    by_parts.json["nodes"][0]["scale"] = {2, 3, 4};
    GltfBuilder by_matrix = triangle_file();
    by_matrix.json["nodes"][0]["matrix"] = {-2, 0, 0, 0, 0, 3, 0, 0, 0, 0, -4, 0, 1, 2, 3, 1};
    const GltfLevel a = load(by_parts);
    const GltfLevel b = load(by_matrix);
    ASSERT_EQ(a.parts.size(), 1U);
    ASSERT_EQ(b.parts.size(), 1U);
    for (std::size_t i = 0; i < 3; ++i) {
        EXPECT_LT((a.parts[0].mesh.positions[i] - b.parts[0].mesh.positions[i]).norm(), 1e-14);
    }
}

TEST(LoadGltfLevel, MirroredNodeKeepsOutsideOutside) {
    GltfBuilder builder = triangle_file();  // faces +z
    builder.json["nodes"][0]["scale"] = {1, 1, -1};
    const GltfLevel level = load(builder);
    ASSERT_EQ(level.parts.size(), 1U);
    EXPECT_EQ(normal_of(level.parts[0].mesh, level.parts[0].mesh.triangles[0]), -Vec3::UnitZ());
}

TEST(LoadGltfLevel, PrimitivesOfOneNodeShareVerticesAndKeepTheirColors) {
    GltfBuilder builder = triangle_file();
    Json second = builder.json["meshes"][0]["primitives"][0];
    second["material"] = 1;
    builder.json["meshes"][0]["primitives"].push_back(second);
    builder.json["meshes"][0]["primitives"][0]["material"] = 0;
    builder.json["materials"] = {
        {{"pbrMetallicRoughness", {{"baseColorFactor", {0.25, 0.5, 0.75, 1}}}}}, Json::object()};
    const GltfLevel level = load(builder);
    ASSERT_EQ(level.parts.size(), 1U);
    const LevelPart& part = level.parts[0];
    EXPECT_EQ(part.mesh.positions.size(), 3U);
    EXPECT_EQ(part.mesh.triangles.size(), 2U);
    ASSERT_EQ(part.color_runs.size(), 2U);
    EXPECT_EQ(part.color_runs[1].first_triangle, 1U);
    EXPECT_EQ(part.color_runs[0].color, (std::array<float, 3>{0.25F, 0.5F, 0.75F}));
    EXPECT_EQ(part.color_runs[1].color,
              (std::array<float, 3>{1.0F, 1.0F, 1.0F}));  // glTF's default
    EXPECT_EQ(part.mesh.color, part.color_runs[0].color);
}

TEST(LoadGltfLevel, KeepsSyntheticMarkOfNodeOrMesh) {
    GltfBuilder of_node = triangle_file();
    of_node.json["nodes"][0]["extras"]["synthetic"] = true;
    EXPECT_TRUE(load(of_node).parts.at(0).synthetic);
    GltfBuilder of_mesh = triangle_file();
    of_mesh.json["meshes"][0]["extras"]["synthetic"] = true;
    EXPECT_TRUE(load(of_mesh).parts.at(0).synthetic);
}

TEST(LoadGltfLevel, DropsAndCountsTrianglesWithoutArea) {
    GltfBuilder builder;
    const int corners =
        builder.add_positions({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0.3F, 0, 0}, {1, 0, 0}});
    // One triangle has a corner twice by index, one by position, and one has three corners on a
    // line. The last one is good.
    const int indices = builder.add_indices<std::uint16_t>({0, 0, 2, 1, 4, 2, 0, 3, 1, 0, 1, 2});
    builder.json["nodes"] = {{{"mesh", builder.add_mesh(corners, indices)}}};
    const GltfLevel level = load(builder);
    EXPECT_EQ(level.dropped_triangles, 3U);
    ASSERT_EQ(level.parts[0].mesh.triangles.size(), 1U);
    EXPECT_EQ(level.parts[0].mesh.triangles[0], (Triangle{0, 1, 2}));
}

TEST(LoadGltfLevel, KeepsNeedlesThatRealLevelsHave) {
    GltfBuilder builder;
    const int corners = builder.add_positions({{0, 0, 0}, {6.7F, 0, 0}, {3, 1e-5F, 0}});
    builder.json["nodes"] = {{{"mesh", builder.add_mesh(corners, -1)}}};
    EXPECT_EQ(load(builder).dropped_triangles, 0U);
}

TEST(LoadGltfLevel, SkipsAndCountsPointsAndLines) {
    GltfBuilder builder = triangle_file();
    builder.json["meshes"][0]["primitives"].push_back(
        {{"attributes", {{"POSITION", 0}}}, {"mode", 1}});
    const GltfLevel level = load(builder);
    EXPECT_EQ(level.skipped_primitives, 1U);
    EXPECT_EQ(level.parts[0].mesh.triangles.size(), 1U);
}

TEST(LoadGltfLevel, ReadsInterleavedPositions) {
    GltfBuilder builder = triangle_file();
    // Positions 24 bytes apart, with something else between them.
    const int wide =
        builder.add_positions({{0, 0, 0}, {9, 9, 9}, {1, 0, 0}, {9, 9, 9}, {0, 1, 0}, {9, 9, 9}});
    builder.json["accessors"][static_cast<std::size_t>(wide)]["count"] = 3;
    builder.json["bufferViews"].back()["byteStride"] = 24;
    builder.json["nodes"][0]["mesh"] = builder.add_mesh(wide, 1);
    const GltfLevel level = load(builder);
    ASSERT_EQ(level.parts[0].mesh.positions.size(), 3U);
    EXPECT_EQ(level.parts[0].mesh.positions[2], Vec3(0.0, 1.0, 0.0));
}

TEST(LoadGltfLevel, LoadsOnlyTheDefaultScene) {
    GltfBuilder builder = triangle_file();
    builder.json["nodes"] = {{{"mesh", 0}, {"name", "a"}}, {{"mesh", 0}, {"name", "b"}}};
    builder.json["scenes"] = {{{"nodes", {0}}}, {{"nodes", {1}}}};
    builder.json["scene"] = 1;
    const GltfLevel level = load(builder);
    ASSERT_EQ(level.parts.size(), 1U);
    EXPECT_EQ(level.parts[0].mesh.name, "b");
}

TEST(LoadGltfLevel, WithoutSceneLoadsAllRootsInOrder) {
    GltfBuilder builder = triangle_file();
    builder.json.erase("scene");
    builder.json.erase("scenes");
    builder.json["nodes"] = {{{"mesh", 0}, {"name", "child"}},
                             {{"mesh", 0}, {"name", "parent"}, {"children", {0}}},
                             {{"mesh", 0}, {"name", "other"}}};
    const GltfLevel level = load(builder);
    ASSERT_EQ(level.parts.size(), 3U);
    EXPECT_EQ(level.parts[0].mesh.name, "parent");
    EXPECT_EQ(level.parts[1].mesh.name, "child");
    EXPECT_EQ(level.parts[2].mesh.name, "other");
}

TEST(LoadGltfLevel, DeepChainOfNodesNeedsNoCallStack) {
    constexpr int k_depth = 100000;
    GltfBuilder builder = triangle_file();
    builder.json["nodes"] = Json::array();
    for (int i = 0; i + 1 < k_depth; ++i) {
        builder.json["nodes"].push_back({{"children", {i + 1}}, {"translation", {0, 0, 0.001}}});
    }
    builder.json["nodes"].push_back({{"mesh", 0}});
    const GltfLevel level = load(builder);
    ASSERT_EQ(level.parts.size(), 1U);
    EXPECT_NEAR(level.parts[0].mesh.positions[0].z(), 0.001 * (k_depth - 1), 1e-6);
}

TEST(LoadGltfLevel, NeverOpensImages) {
    GltfBuilder builder = triangle_file();
    builder.json["images"] = {{{"uri", "/dev/zero"}},
                              {{"bufferView", 99}, {"mimeType", "image/png"}}};
    builder.json["textures"] = {{{"source", 7}}};
    EXPECT_EQ(load(builder).parts.size(), 1U);
}

class LoadGltfLevelFromFolder : public ::testing::Test {
  protected:
    void SetUp() override {
        folder_ = std::filesystem::temp_directory_path() /
                  ("handhold_gltf_" +
                   std::string(::testing::UnitTest::GetInstance()->current_test_info()->name()));
        std::filesystem::create_directories(folder_ / "level");
    }
    void TearDown() override { std::filesystem::remove_all(folder_); }

    // Puts the JSON beside its buffer at `buffer_path`, which the JSON names `uri`.
    Result<GltfLevel> load_with_buffer(const std::string& uri,
                                       const std::string& buffer_path) const {
        GltfBuilder builder = triangle_file();
        builder.json["buffers"][0]["uri"] = uri;
        EXPECT_FALSE(write_file_atomically(folder_ / buffer_path, builder.binary));
        EXPECT_FALSE(write_file_atomically(folder_ / "level/a.gltf", builder.json.dump()));
        return load_gltf_level(folder_ / "level/a.gltf");
    }

    std::filesystem::path folder_;
};

TEST_F(LoadGltfLevelFromFolder, ReadsExternalBuffer) {
    EXPECT_TRUE(load_with_buffer("a%20b.bin", "level/a b.bin").ok());
}

// A percent sign that begins no escape, and a file whose very name looks like one.
TEST_F(LoadGltfLevelFromFolder, ReadsBuffersWhoseNamesHavePercentSigns) {
    for (const char* name :
         {"100% a.bin", "a%.bin", "50%zz.bin", "%", "a%2", "b%20c.bin", "%%41"}) {
        EXPECT_TRUE(load_with_buffer(name, std::string("level/") + name).ok()) << name;
    }
    EXPECT_TRUE(load_with_buffer("50%25%20b.bin", "level/50% b.bin").ok());
}

// Any name of printable characters and umlauts, written as it is or escaped as RFC 3986 says.
RC_GTEST_FIXTURE_PROP(LoadGltfLevelFromFolder, ReadsBuffersOfAnyName, ()) {
    std::string name = *rc::gen::nonEmpty(rc::gen::container<std::string>(
        rc::gen::element('a', 'B', '7', '%', ' ', '#', '+', '?', '&', '(', '2', '0', 'F')));
    name += ".bin";
    std::string escaped;
    for (const char c : name) {
        std::array<char, 8> code{};
        std::snprintf(code.data(), code.size(), "%%%02X", static_cast<unsigned>(c));  // NOLINT
        escaped +=
            std::isalnum(static_cast<unsigned char>(c)) != 0 ? std::string(1, c) : code.data();
    }
    RC_ASSERT(load_with_buffer(escaped, "level/" + name).ok());
    RC_ASSERT(load_with_buffer(name, "level/" + name).ok());
    std::filesystem::remove(folder_ / "level" / name);
}

TEST(LoadGltfLevel, FilesInMemoryReadNoOthers) {
    GltfBuilder builder = triangle_file();
    builder.json["buffers"][0]["uri"] = "CMakeLists.txt";
    const Result<GltfLevel> level = parse_gltf_level(builder.json.dump(), {});
    ASSERT_FALSE(level.ok());
    EXPECT_EQ(level.error().place, "/buffers/0/uri");
    EXPECT_EQ(level.error().expected,
              "expected a data URI or a .glb, as the file is in memory, found CMakeLists.txt");
}

TEST_F(LoadGltfLevelFromFolder, RefusesBufferOutsideItsFolder) {
    EXPECT_FALSE(load_with_buffer("../secret.bin", "secret.bin").ok());
    EXPECT_FALSE(load_with_buffer("%2e%2e/secret.bin", "secret.bin").ok());
    EXPECT_FALSE(load_with_buffer((folder_ / "secret.bin").string(), "secret.bin").ok());
}

TEST_F(LoadGltfLevelFromFolder, RefusesExternalBufferOfOtherLength) {
    GltfBuilder builder = triangle_file();
    builder.json["buffers"][0]["uri"] = "a.bin";
    EXPECT_FALSE(write_file_atomically(folder_ / "level/a.bin", builder.binary.substr(1)));
    EXPECT_FALSE(write_file_atomically(folder_ / "level/a.gltf", builder.json.dump()));
    const Result<GltfLevel> level = load_gltf_level(folder_ / "level/a.gltf");
    ASSERT_FALSE(level.ok());
    EXPECT_NE(level.error().message().find("a.bin"), std::string::npos);
}

TEST(LoadGltfLevel, ReadsBufferInDataUri) {
    // 36 bytes of zeros are 48 "A"; a triangle without area is dropped, but it was read. "%41" is
    // an escaped "A".
    const char* text = R"({"asset":{"version":"2.0"},
        "buffers":[{"byteLength":36,"uri":"data:application/octet-stream;base64,)"
                       "AAAAAAAAAAAA%41AAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAA"
                       R"("}],
        "bufferViews":[{"buffer":0,"byteLength":36}],
        "accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3"}],
        "meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],"nodes":[{"mesh":0}]})";
    const Result<GltfLevel> level = parse_gltf_level(text, "test.gltf");
    ASSERT_TRUE(level.ok()) << level.error().message();
    EXPECT_EQ(level.value().dropped_triangles, 1U);
}

}  // namespace
}  // namespace handhold::io_gltf_test
