#include <cmath>
#include <functional>
#include <limits>
#include <string>

#include <gtest/gtest.h>

#include "engine/io/gltf.hpp"
#include "tests/engine/allocation_count.hpp"
#include "tests/engine/io/gltf_builder.hpp"

namespace handhold::io_gltf_malformed_test {
namespace {

using Json = nlohmann::json;
using test::GltfBuilder;
using test::triangle_file;

struct BadFile {
    const char* what;
    const char* place;  // that the error must name
    std::function<void(GltfBuilder&)> spoil;
};

void PrintTo(const BadFile& file, std::ostream* stream) { *stream << file.what; }

class MalformedGltf : public ::testing::TestWithParam<BadFile> {};

TEST_P(MalformedGltf, IsRefusedAtItsPlace) {
    GltfBuilder builder = triangle_file();
    GetParam().spoil(builder);
    const Result<GltfLevel> level = parse_gltf_level(builder.glb(), "bad.glb");
    ASSERT_FALSE(level.ok());
    EXPECT_EQ(level.error().file, "bad.glb");
    EXPECT_EQ(level.error().place, GetParam().place) << level.error().message();
    EXPECT_EQ(level.error().expected.rfind("expected ", 0), 0U) << level.error().message();
}

const BadFile k_bad_files[] = {
    {"no version", "/asset/version", [](GltfBuilder& b) { b.json["asset"].erase("version"); }},
    {"version 1", "/asset/version", [](GltfBuilder& b) { b.json["asset"]["version"] = "1.0"; }},
    {"required compression", "/extensionsRequired/0",
     [](GltfBuilder& b) { b.json["extensionsRequired"] = {"KHR_draco_mesh_compression"}; }},
    {"nodes no array", "/nodes", [](GltfBuilder& b) { b.json["nodes"] = 3; }},
    {"node no object", "/nodes/0", [](GltfBuilder& b) { b.json["nodes"][0] = "x"; }},
    {"mesh index as text", "/nodes/0/mesh",
     [](GltfBuilder& b) { b.json["nodes"][0]["mesh"] = "0"; }},
    {"mesh index with fraction", "/nodes/0/mesh",
     [](GltfBuilder& b) { b.json["nodes"][0]["mesh"] = 0.5; }},
    {"mesh index negative", "/nodes/0/mesh",
     [](GltfBuilder& b) { b.json["nodes"][0]["mesh"] = -1; }},
    {"mesh index of 2^32", "/nodes/0/mesh",
     [](GltfBuilder& b) { b.json["nodes"][0]["mesh"] = 4294967296LL; }},
    {"no such mesh", "/nodes/0/mesh", [](GltfBuilder& b) { b.json["nodes"][0]["mesh"] = 1; }},
    {"skinned mesh", "/nodes/0/skin", [](GltfBuilder& b) { b.json["nodes"][0]["skin"] = 0; }},
    {"no such scene", "/scene", [](GltfBuilder& b) { b.json["scene"] = 1; }},
    {"no such root", "/scenes/0/nodes", [](GltfBuilder& b) { b.json["scenes"][0]["nodes"] = {5}; }},
    {"root twice", "/scenes/0/nodes",
     [](GltfBuilder& b) {
         b.json["scenes"][0]["nodes"] = {0, 0};
     }},
    {"no such child", "/nodes/0/children",
     [](GltfBuilder& b) { b.json["nodes"][0]["children"] = {9}; }},
    {"own child", "/nodes/0", [](GltfBuilder& b) { b.json["nodes"][0]["children"] = {0}; }},
    {"cycle of two", "/nodes/0",
     [](GltfBuilder& b) {
         b.json["nodes"] = {{{"mesh", 0}, {"children", {1}}}, {{"children", {0}}}};
     }},
    {"cycle out of the scene", "/nodes/1",
     [](GltfBuilder& b) {
         b.json["nodes"].push_back({{"children", {2}}});
         b.json["nodes"].push_back({{"children", {1}}});
     }},
    {"two parents", "/nodes/1/children",
     [](GltfBuilder& b) {
         b.json["nodes"] = {{{"children", {2}}}, {{"children", {2}}}, {{"mesh", 0}}};
     }},
    {"matrix of 15", "/nodes/0/matrix",
     [](GltfBuilder& b) { b.json["nodes"][0]["matrix"] = std::vector<int>(15, 1); }},
    {"matrix with perspective", "/nodes/0/matrix",
     [](GltfBuilder& b) {
         b.json["nodes"][0]["matrix"] = {1, 0, 0, 0.5, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
     }},
    {"matrix and scale", "/nodes/0/scale",
     [](GltfBuilder& b) {
         b.json["nodes"][0]["matrix"] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
         b.json["nodes"][0]["scale"] = {1, 1, 1};
     }},
    {"rotation not unit", "/nodes/0/rotation",
     [](GltfBuilder& b) {
         b.json["nodes"][0]["rotation"] = {0, 0, 0, 2};
     }},
    {"translation of text", "/nodes/0/translation/1",
     [](GltfBuilder& b) {
         b.json["nodes"][0]["translation"] = {0, "up", 0};
     }},
    {"translation too far", "/meshes/0/primitives/0/attributes/POSITION",
     [](GltfBuilder& b) {
         b.json["nodes"][0]["translation"] = {0, 1.1e7, 0};
     }},
    {"synthetic no flag", "/nodes/0/extras/synthetic",
     [](GltfBuilder& b) { b.json["nodes"][0]["extras"]["synthetic"] = "yes"; }},
    {"no primitives", "/meshes/0/primitives",
     [](GltfBuilder& b) { b.json["meshes"][0].erase("primitives"); }},
    {"no positions", "/meshes/0/primitives/0/attributes/POSITION",
     [](GltfBuilder& b) { b.json["meshes"][0]["primitives"][0]["attributes"].erase("POSITION"); }},
    {"unknown mode", "/meshes/0/primitives/0/mode",
     [](GltfBuilder& b) { b.json["meshes"][0]["primitives"][0]["mode"] = 7; }},
    {"no such position accessor", "/meshes/0/primitives/0/attributes/POSITION",
     [](GltfBuilder& b) { b.json["meshes"][0]["primitives"][0]["attributes"]["POSITION"] = 2; }},
    {"no such material", "/meshes/0/primitives/0/material",
     [](GltfBuilder& b) { b.json["meshes"][0]["primitives"][0]["material"] = 0; }},
    {"colour above 1", "/materials/0/pbrMetallicRoughness/baseColorFactor/1",
     [](GltfBuilder& b) {
         b.json["materials"] = {{{"pbrMetallicRoughness", {{"baseColorFactor", {0, 2, 0, 1}}}}}};
     }},
    {"indices no multiple of three", "/meshes/0/primitives/0",
     [](GltfBuilder& b) { b.json["accessors"][1]["count"] = 2; }},
    {"index too large", "/meshes/0/primitives/0/indices",
     [](GltfBuilder& b) { b.binary[b.binary.size() - 4] = 3; }},
    {"indices of float", "/accessors/1",
     [](GltfBuilder& b) { b.json["accessors"][1]["componentType"] = 5126; }},
    {"positions of short", "/accessors/0",
     [](GltfBuilder& b) { b.json["accessors"][0]["componentType"] = 5122; }},
    {"unknown component", "/accessors/0/componentType",
     [](GltfBuilder& b) { b.json["accessors"][0]["componentType"] = 1; }},
    {"positions of VEC2", "/accessors/0",
     [](GltfBuilder& b) { b.json["accessors"][0]["type"] = "VEC2"; }},
    {"count 0", "/accessors/0/count", [](GltfBuilder& b) { b.json["accessors"][0]["count"] = 0; }},
    {"count beyond the view", "/accessors/0",
     [](GltfBuilder& b) { b.json["accessors"][0]["count"] = 4; }},
    {"count of four thousand millions", "/accessors/0",
     [](GltfBuilder& b) { b.json["accessors"][0]["count"] = 4294967295LL; }},
    {"offset beyond the view", "/accessors/0",
     [](GltfBuilder& b) { b.json["accessors"][0]["byteOffset"] = 4; }},
    {"offset as text", "/accessors/0/byteOffset",
     [](GltfBuilder& b) { b.json["accessors"][0]["byteOffset"] = "0"; }},
    {"sparse", "/accessors/0/sparse",
     [](GltfBuilder& b) { b.json["accessors"][0]["sparse"] = Json::object(); }},
    {"zeros without a view", "/accessors/0/bufferView",
     [](GltfBuilder& b) {
         b.json["accessors"][0].erase("bufferView");
         b.json["accessors"][0]["count"] = 4294967295LL;
     }},
    {"no such view", "/accessors/0/bufferView",
     [](GltfBuilder& b) { b.json["accessors"][0]["bufferView"] = 2; }},
    {"view beyond the buffer", "/bufferViews/0",
     [](GltfBuilder& b) { b.json["bufferViews"][0]["byteLength"] = 1000; }},
    {"view begins beyond the buffer", "/bufferViews/0",
     [](GltfBuilder& b) { b.json["bufferViews"][0]["byteOffset"] = 4294967295LL; }},
    {"no such buffer", "/bufferViews/0/buffer",
     [](GltfBuilder& b) { b.json["bufferViews"][0]["buffer"] = 1; }},
    {"stride no multiple of 4", "/bufferViews/0/byteStride",
     [](GltfBuilder& b) { b.json["bufferViews"][0]["byteStride"] = 13; }},
    {"unknown element type", "/accessors/0/type",
     [](GltfBuilder& b) { b.json["accessors"][0]["type"] = "VEC5"; }},
    {"stride below the element", "/bufferViews/0/byteStride",
     [](GltfBuilder& b) { b.json["bufferViews"][0]["byteStride"] = 8; }},
    {"stride beyond the view", "/accessors/0",
     [](GltfBuilder& b) { b.json["bufferViews"][0]["byteStride"] = 16; }},
    {"buffer of 1 GB in a small file", "/buffers/0/byteLength",
     [](GltfBuilder& b) { b.json["buffers"][0]["byteLength"] = 1 << 30; }},
    {"empty buffer", "/buffers/0/byteLength",
     [](GltfBuilder& b) { b.json["buffers"][0]["byteLength"] = 0; }},
    {"second buffer without a place", "/buffers/1/uri",
     [](GltfBuilder& b) {
         b.json["buffers"].push_back({{"byteLength", 4}});
     }},
    {"no binary chunk", "/buffers/0/uri", [](GltfBuilder& b) { b.binary.clear(); }},
};
INSTANTIATE_TEST_SUITE_P(Kinds, MalformedGltf, ::testing::ValuesIn(k_bad_files));

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

// The length in the header mended, so that the cut reaches the chunks.
TEST(LoadGltfLevel, RefusesEveryTruncationWithMendedLength) {
    const std::string whole = triangle_file().glb();
    for (std::size_t length = 12; length < whole.size(); ++length) {
        std::string cut = whole.substr(0, length);
        std::string mended;
        test::append_le32(mended, length);
        cut.replace(8, 4, mended);
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
    for (const char* place : {"/buffers/0/byteLength", "/bufferViews/0/byteLength",
                              "/accessors/0/count", "/accessors/1/count"}) {
        GltfBuilder builder = triangle_file();
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
}  // namespace handhold::io_gltf_malformed_test
