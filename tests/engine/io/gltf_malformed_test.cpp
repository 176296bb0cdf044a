// Documents with one wrong field: the error names the field's place.
#include <cmath>
#include <functional>
#include <string>

#include <gtest/gtest.h>

#include "engine/io/gltf.hpp"
#include "tests/engine/io/gltf_builder.hpp"

namespace handhold::io_gltf_malformed_test {
namespace {

using Json = nlohmann::json;
using test::GltfBuilder;
using test::make_compressed;
using test::triangle_file;

struct BadFile {
    const char* what;
    const char* place;  // the place that the error must name
    std::function<void(GltfBuilder&)> spoil;
};

// Overwrites positions of the triangle; every overwritten value is (2, 2, 2).
Json& make_sparse(GltfBuilder& b, const std::vector<std::uint16_t>& indices) {
    const std::size_t views = b.json["bufferViews"].size();
    b.add_indices(indices);
    b.add_positions(std::vector<std::array<float, 3>>(indices.size(), {2, 2, 2}));
    Json& sparse = b.json["accessors"][0]["sparse"];
    sparse = {{"count", indices.size()},
              {"indices", {{"bufferView", views}, {"componentType", 5123}}},
              {"values", {{"bufferView", views + 1}}}};
    return sparse;
}

Json& instances_of(GltfBuilder& b) {
    return b.json["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"];
}

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
    {"required extension that nobody supports", "/extensionsRequired/1",
     [](GltfBuilder& b) {
         b.json["extensionsRequired"] = {"KHR_mesh_quantization", "ACME_folded_geometry"};
     }},
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
    {"unknown mode", "/meshes/0/primitives/0/mode",
     [](GltfBuilder& b) { b.json["meshes"][0]["primitives"][0]["mode"] = 7; }},
    {"no such position accessor", "/meshes/0/primitives/0/attributes/POSITION",
     [](GltfBuilder& b) { b.json["meshes"][0]["primitives"][0]["attributes"]["POSITION"] = 2; }},
    {"no such material", "/meshes/0/primitives/0/material",
     [](GltfBuilder& b) { b.json["meshes"][0]["primitives"][0]["material"] = 0; }},
    {"colour as text", "/materials/0/pbrMetallicRoughness/baseColorFactor/1",
     [](GltfBuilder& b) {
         b.json["materials"] = {
             {{"pbrMetallicRoughness", {{"baseColorFactor", {0, "red", 0, 1}}}}}};
     }},
    {"indices no multiple of three", "/meshes/0/primitives/0",
     [](GltfBuilder& b) { b.json["accessors"][1]["count"] = 2; }},
    {"index too large", "/meshes/0/primitives/0/indices",
     [](GltfBuilder& b) { b.binary[b.binary.size() - 4] = 3; }},
    {"indices of float", "/accessors/1",
     [](GltfBuilder& b) { b.json["accessors"][1]["componentType"] = 5126; }},
    {"positions of unsigned int", "/accessors/0",
     [](GltfBuilder& b) { b.json["accessors"][0]["componentType"] = 5125; }},
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
    {"empty sparse", "/accessors/0/sparse/count",
     [](GltfBuilder& b) { b.json["accessors"][0]["sparse"] = Json::object(); }},
    {"more sparse elements than elements", "/accessors/0/sparse/count",
     [](GltfBuilder& b) {
         make_sparse(b, {0, 1, 2, 3});
     }},
    {"sparse index out of range", "/accessors/0/sparse/indices",
     [](GltfBuilder& b) { make_sparse(b, {3}); }},
    {"sparse index twice", "/accessors/0/sparse/indices",
     [](GltfBuilder& b) {
         make_sparse(b, {1, 1});
     }},
    {"sparse indices beyond their view", "/accessors/0/sparse/indices",
     [](GltfBuilder& b) { make_sparse(b, {1})["indices"]["byteOffset"] = 2; }},
    {"sparse values beyond their view", "/accessors/0/sparse/values",
     [](GltfBuilder& b) { make_sparse(b, {1})["values"]["byteOffset"] = 4294967295LL; }},
    {"sparse indices of float", "/accessors/0/sparse/indices/componentType",
     [](GltfBuilder& b) { make_sparse(b, {1})["indices"]["componentType"] = 5126; }},
    {"no such sparse view", "/accessors/0/sparse/values/bufferView",
     [](GltfBuilder& b) { make_sparse(b, {1})["values"]["bufferView"] = 99; }},
    {"compressed bytes that are none", "/bufferViews/0/extensions/EXT_meshopt_compression",
     [](GltfBuilder& b) { make_compressed(b); }},
    {"compressed bytes beyond the buffer", "/bufferViews/0/extensions/EXT_meshopt_compression",
     [](GltfBuilder& b) { make_compressed(b)["byteLength"] = 4294967295LL; }},
    {"compressed elements of 1 GB", "/bufferViews/0/extensions/EXT_meshopt_compression",
     [](GltfBuilder& b) { make_compressed(b)["count"] = 1 << 26; }},
    {"compressed elements of 6 bytes", "/bufferViews/0/extensions/EXT_meshopt_compression",
     [](GltfBuilder& b) { make_compressed(b)["byteStride"] = 6; }},
    {"unknown compression", "/bufferViews/0/extensions/EXT_meshopt_compression/mode",
     [](GltfBuilder& b) { make_compressed(b)["mode"] = "BEST"; }},
    {"unknown filter", "/bufferViews/0/extensions/EXT_meshopt_compression/filter",
     [](GltfBuilder& b) { make_compressed(b)["filter"] = "BEST"; }},
    {"no such compressed buffer", "/bufferViews/0/extensions/EXT_meshopt_compression/buffer",
     [](GltfBuilder& b) { make_compressed(b)["buffer"] = 9; }},
    {"Draco bytes that are none", "/meshes/0/primitives/0/extensions/KHR_draco_mesh_compression",
     [](GltfBuilder& b) {
         b.json["meshes"][0]["primitives"][0]["extensions"]["KHR_draco_mesh_compression"] = {
             {"bufferView", 0}, {"attributes", {{"POSITION", 0}}}};
         b.json["accessors"][0].erase("bufferView");  // no uncompressed geometry beside it
     }},
    {"instances of no kind", "/nodes/0/extensions/EXT_mesh_gpu_instancing/attributes",
     [](GltfBuilder& b) { instances_of(b) = Json::object(); }},
    {"instances of differing counts",
     "/nodes/0/extensions/EXT_mesh_gpu_instancing/attributes/SCALE",
     [](GltfBuilder& b) {
         instances_of(b) = {{"TRANSLATION", 0}, {"SCALE", b.add_positions({{1, 1, 1}})}};
     }},
    {"instances of indices", "/accessors/1",
     [](GltfBuilder& b) {
         instances_of(b) = {{"TRANSLATION", 1}};
     }},
    {"no such instances", "/nodes/0/extensions/EXT_mesh_gpu_instancing/attributes/ROTATION",
     [](GltfBuilder& b) {
         instances_of(b) = {{"ROTATION", 9}};
     }},
    {"instance not finite", "/nodes/0/extensions/EXT_mesh_gpu_instancing/attributes",
     [](GltfBuilder& b) {
         instances_of(b) = {{"SCALE", b.add_positions({{1, std::nanf(""), 1}})}};
     }},
    {"buffer outside the folder", "/buffers/1/uri",
     [](GltfBuilder& b) {
         b.json["buffers"].push_back({{"byteLength", 4}, {"uri", "a/../../b.bin"}});
     }},
    {"buffer elsewhere", "/buffers/1/uri",
     [](GltfBuilder& b) {
         b.json["buffers"].push_back({{"byteLength", 4}, {"uri", "https://example.org/b.bin"}});
     }},
    {"data URI that is not base64", "/buffers/1/uri",
     [](GltfBuilder& b) {
         b.json["buffers"].push_back({{"byteLength", 3}, {"uri", "data:;base64,A*=="}});
     }},
    {"data URI that is too short", "/buffers/1/byteLength",
     [](GltfBuilder& b) {
         b.json["buffers"].push_back({{"byteLength", 4}, {"uri", "data:;base64,AAAA"}});
     }},
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

}  // namespace
}  // namespace handhold::io_gltf_malformed_test
