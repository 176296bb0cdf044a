// Files that are cut off, have a flipped bit, or claim more than they hold.
#include <cstring>
#include <limits>
#include <string>
#include <string_view>

#include <gtest/gtest.h>

#include "engine/io/gltf.hpp"
#include "tests/engine/allocation_count.hpp"
#include "tests/engine/io/gltf_builder.hpp"

namespace handhold::io_gltf_damaged_test {
namespace {

using Json = nlohmann::json;
using test::GltfBuilder;
using test::make_compressed;
using test::triangle_file;

TEST(LoadGltfLevel, RefusesPositionsThatAreNotFinite) {
    for (const float bad :
         {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity(),
          std::numeric_limits<float>::max()}) {
        GltfBuilder builder = triangle_file();
        std::memcpy(builder.binary.data() + 16, &bad, sizeof bad);
        const Result<GltfLevel> level = parse_gltf_level(builder.glb(), "bad.glb");
        ASSERT_FALSE(level.ok());
        EXPECT_NE(level.error().expected.find("vertex 1"), std::string::npos)
            << level.error().message();
    }
}

TEST(LoadGltfLevel, RefusesEveryTruncation) {
    const std::string whole = triangle_file().glb();
    for (std::size_t length = 0; length < whole.size(); ++length) {
        const Result<GltfLevel> level = parse_gltf_level(whole.substr(0, length), "cut.glb");
        ASSERT_FALSE(level.ok()) << length;
        EXPECT_FALSE(level.error().place.empty()) << length;
    }
}

// The length in the header is corrected, so that the cut reaches the chunks.
TEST(LoadGltfLevel, RefusesEveryTruncationWithCorrectedLength) {
    const std::string whole = triangle_file().glb();
    for (std::size_t length = 12; length < whole.size(); ++length) {
        std::string cut = whole.substr(0, length);
        std::string corrected;
        test::append_le32(corrected, length);
        cut.replace(8, 4, corrected);
        EXPECT_FALSE(parse_gltf_level(cut, "cut.glb").ok()) << length;
    }
}

TEST(LoadGltfLevel, AnyFlippedBitGivesSoundMeshOrOneError) {
    const std::string whole = triangle_file().glb();
    for (std::size_t bit = 0; bit < 8 * whole.size(); ++bit) {
        std::string flipped = whole;
        flipped[bit / 8] =
            static_cast<char>(static_cast<unsigned char>(flipped[bit / 8]) ^ (1U << (bit % 8)));
        const Result<GltfLevel> level = parse_gltf_level(flipped, "flipped.glb");
        if (!level) {
            EXPECT_EQ(level.error().file, "flipped.glb");
            EXPECT_FALSE(level.error().expected.empty());
            continue;
        }
        for (const LevelPart& part : level.value().parts) {
            for (const Vec3& position : part.mesh.positions) {
                ASSERT_LE(position.cwiseAbs().maxCoeff(), k_max_level_coordinate_m) << bit;
            }
            for (const auto& triangle : part.mesh.triangles) {
                for (const std::uint32_t corner : triangle) {
                    ASSERT_LT(corner, part.mesh.positions.size()) << bit;
                }
            }
        }
    }
}

TEST(LoadGltfLevel, RefusesManyNodesThatMultiplyOneLargeMesh) {
    GltfBuilder builder;
    constexpr std::size_t k_vertices = 30000;
    constexpr std::size_t k_nodes = 1000;
    const int positions = builder.add_positions(std::vector<std::array<float, 3>>(k_vertices));
    const int mesh = builder.add_mesh(positions, -1);
    builder.json["nodes"] = std::vector<Json>(k_nodes, {{"mesh", mesh}});
    const Result<GltfLevel> level = parse_gltf_level(builder.glb(), "many.glb");
    ASSERT_FALSE(level.ok());
    EXPECT_NE(level.error().expected.find("at most"), std::string::npos);
}

TEST(LoadGltfLevel, ClaimsOfGigabytesTakeNoMemory) {
    for (const char* place :
         {"/buffers/0/byteLength", "/bufferViews/0/byteLength", "/accessors/0/count",
          "/accessors/1/count", "/bufferViews/0/extensions/EXT_meshopt_compression/count",
          "/bufferViews/0/extensions/EXT_meshopt_compression/byteLength"}) {
        GltfBuilder builder = triangle_file();
        if (std::string_view(place).find("meshopt") != std::string_view::npos) {
            make_compressed(builder);
        }
        builder.json[Json::json_pointer(place)] = 1LL << 30;
        const std::string glb = builder.glb();
        const std::size_t before = allocated_bytes();
        EXPECT_FALSE(parse_gltf_level(glb, "claim.glb").ok()) << place;
        EXPECT_LT(allocated_bytes() - before, std::size_t{1} << 20U) << place;
    }
}

TEST(LoadGltfLevel, ContainersThatClaimGigabytesTakeNoMemory) {
    for (const std::size_t length_at : {8U, 12U}) {  // of the file, of its first chunk
        std::string glb = triangle_file().glb();
        glb.replace(length_at, 4, std::string("\0\0\0\x40", 4));
        const std::size_t before = allocated_bytes();
        EXPECT_FALSE(parse_gltf_level(glb, "claim.glb").ok()) << length_at;
        EXPECT_LT(allocated_bytes() - before, std::size_t{1} << 20U) << length_at;
    }
}

// Elements that are zero take no bytes in the file.
TEST(LoadGltfLevel, ZerosThatAreNotInTheFileTakeNoMemory) {
    GltfBuilder builder = triangle_file();
    builder.json["accessors"][0].erase("bufferView");
    builder.json["accessors"][0]["count"] = 1 << 24;
    const std::string glb = builder.glb();
    const std::size_t before = allocated_bytes();
    EXPECT_FALSE(parse_gltf_level(glb, "claim.glb").ok());
    EXPECT_LT(allocated_bytes() - before, std::size_t{1} << 20U);
}

TEST(LoadGltfLevel, NamesTheRequiredExtensionInOneShortLine) {
    GltfBuilder builder = triangle_file();
    builder.json["extensionsRequired"] = {"ACME_geometry\n\x1b[31m" + std::string(5000, 'x')};
    const Result<GltfLevel> level = parse_gltf_level(builder.glb(), "a\nb.glb");
    ASSERT_FALSE(level.ok());
    const std::string message = level.error().message();
    EXPECT_NE(message.find("ACME_geometry"), std::string::npos) << message;
    EXPECT_LT(message.size(), 300U);
    for (const char c : message) {
        EXPECT_GE(static_cast<unsigned char>(c), 0x20) << message;
    }
}

TEST(LoadGltfLevel, RefusesJsonNestedTooDeeply) {
    const std::string deep = std::string(100000, '[');
    const Result<GltfLevel> level = parse_gltf_level(R"({"extras":)" + deep, "deep.gltf");
    ASSERT_FALSE(level.ok());
    EXPECT_NE(level.error().expected.find("64 levels"), std::string::npos);
}

TEST(LoadGltfLevel, RefusesAbsentFileAndFolder) {
    for (const char* path : {"/no/such/file.glb", "/tmp", "/dev/zero"}) {
        const Result<GltfLevel> level = load_gltf_level(path);
        ASSERT_FALSE(level.ok());
        EXPECT_EQ(level.error().file, path);
    }
}

}  // namespace
}  // namespace handhold::io_gltf_damaged_test
