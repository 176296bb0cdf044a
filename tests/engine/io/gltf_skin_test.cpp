#include "engine/io/gltf_skin.hpp"

#include <cmath>
#include <functional>
#include <numbers>

#include <gtest/gtest.h>

#include "tests/engine/io/gltf_builder.hpp"
#include "tests/places.hpp"

namespace handhold::io_gltf_skin_test {
namespace {

using test::GltfBuilder;

template <typename T>
std::string raw(const std::vector<T>& values) {
    std::string bytes(values.size() * sizeof(T), '\0');
    std::memcpy(bytes.data(), values.data(), bytes.size());
    return bytes;
}

// A strip along +X with two joints above it, the second at x = 1, turned by 90 degrees about Z.
// Both are below a node that scales by 0.5 and lifts by 2. The mesh's own node is elsewhere, which
// must have no effect (specification, 3.7.3.3).
GltfBuilder strip_file() {
    GltfBuilder builder;
    const int positions = builder.add_positions({{0, 0, 0}, {2, 0, 0}, {2, 1, 0}, {0, 1, 0}});
    const int indices = builder.add_indices<std::uint16_t>({0, 1, 2, 0, 2, 3});
    const int joints = builder.add_accessor(
        raw<std::uint8_t>({0, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0}), 5121, "VEC4", 4);
    const int weights = builder.add_accessor(
        raw<float>({1, 0, 0, 0, 1, 0, 0, 0, 2, 0, 0, 0, 0.25F, 0.75F, 0, 0}), 5126, "VEC4", 4);
    // Inverse binds, column by column: the first identity; the second undoes a turn and a move.
    const int binds =
        builder.add_accessor(raw<float>({1, 0,  0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1,  //
                                         0, -1, 0, 0, 1, 0, 0, 0, 0, 0, 1, 0, 0, 1, 0, 1}),
                             5126, "MAT4", 2);
    const int mesh = builder.add_mesh(positions, indices);
    auto& attributes = builder.json["meshes"][0]["primitives"][0]["attributes"];
    attributes["JOINTS_0"] = joints;
    attributes["WEIGHTS_0"] = weights;
    const double half = std::sqrt(0.5);
    builder.json["nodes"] = {
        {{"name", "lift"},
         {"translation", {0, 2, 0}},
         {"scale", {0.5, 0.5, 0.5}},
         {"children", {1, 3}}},
        {{"name", "first"}, {"children", {2}}},
        {{"name", "second"}, {"translation", {1, 0, 0}}, {"rotation", {0, 0, half, half}}},
        {{"name", "strip"}, {"mesh", mesh}, {"skin", 0}, {"translation", {50, 0, 0}}}};
    builder.json["skins"] = {{{"inverseBindMatrices", binds}, {"joints", {1, 2}}}};
    builder.json["scenes"] = {{{"nodes", {0}}}};
    builder.json["scene"] = 0;
    return builder;
}

TEST(GltfSkin, StandsAsItsNodesPoseIt) {
    const Result<SkinnedMesh> skin = parse_gltf_skin(strip_file().glb(), "strip.glb");
    ASSERT_TRUE(skin.ok()) << skin.error().message();
    const SkinnedMesh& mesh = skin.value();
    ASSERT_EQ(mesh.positions.size(), 4U);
    // The inverse binds undo the rest pose. Only the node above remains: half the size, 2 up.
    const std::array<Vec3, 4> expected = {Vec3(0, 2, 0), Vec3(1, 2, 0), Vec3(1, 2.5, 0),
                                          Vec3(0, 2.5, 0)};
    for (std::size_t i = 0; i < 4; ++i) {
        EXPECT_NEAR((mesh.positions[i] - expected[i]).norm(), 0.0, 1e-6);
        // computed: the file has none
        EXPECT_NEAR((mesh.normals[i] - Vec3::UnitZ()).norm(), 0.0, 1e-6);
    }
    ASSERT_EQ(mesh.joints.size(), 2U);
    EXPECT_EQ(mesh.joints[1].name, "second");
    EXPECT_EQ(mesh.joints[0].parent, -1);
    EXPECT_EQ(mesh.joints[1].parent, 0);
    EXPECT_NEAR((mesh.joints[1].bind_ms.position - Vec3(0.5, 2, 0)).norm(), 0.0, 1e-12);
    const Quat quarter = rotation_about(Vec3::UnitZ(), std::numbers::pi / 2.0);
    EXPECT_LT(mesh.joints[1].bind_ms.rotation.angularDistance(quarter), 1e-7);
    EXPECT_EQ(mesh.triangles.size(), 2U);
    ASSERT_EQ(mesh.color_runs.size(), 1U);
}

TEST(GltfSkin, WeightsAddUpToOne) {
    const Result<SkinnedMesh> skin = parse_gltf_skin(strip_file().glb(), "strip.glb");
    ASSERT_TRUE(skin.ok());
    for (const SkinWeights& weights : skin.value().weights) {
        EXPECT_NEAR(weights.weight[0] + weights.weight[1], 1.0F, 1e-6F);
    }
    EXPECT_EQ(skin.value().weights[2].weight[0], 1.0F);  // 2 in the file
    EXPECT_EQ(skin.value().weights[3].weight[1], 0.75F);
}

struct BadSkin {
    const char* what;
    const char* place;
    std::function<void(GltfBuilder&)> spoil;
};
void PrintTo(const BadSkin& file, std::ostream* stream) { *stream << file.what; }

nlohmann::json& attributes_of(GltfBuilder& b) {
    return b.json["meshes"][0]["primitives"][0]["attributes"];
}
void put_float(GltfBuilder& b, int accessor, std::size_t index, float value) {
    const std::size_t view = b.json["accessors"][static_cast<std::size_t>(accessor)]["bufferView"];
    const std::size_t offset = b.json["bufferViews"][view]["byteOffset"];
    std::memcpy(b.binary.data() + offset + 4 * index, &value, 4);
}

const BadSkin k_bad_skins[] = {
    {"no skin", "/nodes", [](GltfBuilder& b) { b.json["nodes"][3].erase("skin"); }},
    {"no such skin", "/nodes/3/skin", [](GltfBuilder& b) { b.json["nodes"][3]["skin"] = 1; }},
    {"two skins", "/nodes/4/skin",
     [](GltfBuilder& b) {
         b.json["skins"].push_back(b.json["skins"][0]);
         b.json["nodes"].push_back({{"mesh", 0}, {"skin", 1}});
         b.json["nodes"][0]["children"].push_back(4);
     }},
    {"skins no array", "/skins", [](GltfBuilder& b) { b.json["skins"] = 1; }},
    {"no joints", "/skins/0/joints",
     [](GltfBuilder& b) { b.json["skins"][0]["joints"] = nlohmann::json::array(); }},
    {"joint no node", "/skins/0/joints/1",
     [](GltfBuilder& b) { b.json["skins"][0]["joints"][1] = 9; }},
    {"joint as text", "/skins/0/joints/1",
     [](GltfBuilder& b) { b.json["skins"][0]["joints"][1] = "2"; }},
    {"joint twice", "/skins/0/joints/1",
     [](GltfBuilder& b) { b.json["skins"][0]["joints"][1] = 1; }},
    {"squashed joint", "/nodes/2",
     [](GltfBuilder& b) {
         b.json["nodes"][2]["scale"] = {1, 2, 1};
         b.json["skins"][0].erase("inverseBindMatrices");
     }},
    {"joint of no size", "/nodes/2",
     [](GltfBuilder& b) {
         b.json["nodes"][2]["scale"] = {0, 0, 0};
         b.json["skins"][0].erase("inverseBindMatrices");
     }},
    {"too few binds", "/skins/0/inverseBindMatrices",
     [](GltfBuilder& b) { b.json["accessors"][4]["count"] = 1; }},
    {"binds no matrices", "/accessors/0",
     [](GltfBuilder& b) { b.json["skins"][0]["inverseBindMatrices"] = 0; }},
    {"bind not finite", "/skins/0/inverseBindMatrices",
     [](GltfBuilder& b) { put_float(b, 4, 3 * 4, NAN); }},
    {"no weights", "/meshes/0/primitives/0/attributes/WEIGHTS_0",
     [](GltfBuilder& b) { attributes_of(b).erase("WEIGHTS_0"); }},
    {"joints as floats", "/accessors/3", [](GltfBuilder& b) { attributes_of(b)["JOINTS_0"] = 3; }},
    {"second joints without weights", "/meshes/0/primitives/0/attributes/WEIGHTS_1",
     [](GltfBuilder& b) { attributes_of(b)["JOINTS_1"] = 2; }},
    {"attribute as text", "/meshes/0/primitives/0/attributes/NORMAL",
     [](GltfBuilder& b) { attributes_of(b)["NORMAL"] = "x"; }},
    {"fewer normals than vertices", "/meshes/0/primitives/0/attributes/NORMAL",
     [](GltfBuilder& b) {
         attributes_of(b)["NORMAL"] = b.add_positions({{0, 0, 1}});
     }},
    {"no such joint", "/meshes/0/primitives/0/attributes/JOINTS_0",
     [](GltfBuilder& b) { b.json["skins"][0]["joints"] = {1}; }},
    {"negative weight", "/meshes/0/primitives/0/attributes/WEIGHTS_0",
     [](GltfBuilder& b) { put_float(b, 3, 0, -1.0F); }},
    {"weight no number", "/meshes/0/primitives/0/attributes/WEIGHTS_0",
     [](GltfBuilder& b) { put_float(b, 3, 0, NAN); }},
    {"position not finite", "/meshes/0/primitives/0/attributes/POSITION",
     [](GltfBuilder& b) { put_float(b, 0, 0, INFINITY); }},
    {"only lines", "/meshes",
     [](GltfBuilder& b) { b.json["meshes"][0]["primitives"][0]["mode"] = 1; }},
    {"no such material", "/meshes/0/primitives/0/material",
     [](GltfBuilder& b) { b.json["meshes"][0]["primitives"][0]["material"] = 0; }},
};

class MalformedSkin : public ::testing::TestWithParam<BadSkin> {};

TEST_P(MalformedSkin, IsRefusedAtItsPlace) {
    GltfBuilder builder = strip_file();
    GetParam().spoil(builder);
    const Result<SkinnedMesh> skin = parse_gltf_skin(builder.glb(), "bad.glb");
    ASSERT_FALSE(skin.ok());
    EXPECT_EQ(skin.error().place, GetParam().place) << skin.error().message();
    EXPECT_EQ(skin.error().expected.rfind("expected ", 0), 0U) << skin.error().message();
}

INSTANTIATE_TEST_SUITE_P(Files, MalformedSkin, ::testing::ValuesIn(k_bad_skins));

TEST(GltfSkinRealData, BothHandsLoad) {
    for (const char* name : {"generic_hand_left.glb", "generic_hand_right.glb"}) {
        const std::filesystem::path path = data_dir() / "hands" / name;
        if (!std::filesystem::exists(path)) {
            GTEST_SKIP() << "no such data";
        }
        const Result<SkinnedMesh> skin = load_gltf_skin(path);
        ASSERT_TRUE(skin.ok()) << skin.error().message();
        EXPECT_EQ(skin.value().joints.size(), 25U);  // SOURCE.md of the data
        EXPECT_EQ(skin.value().triangles.size(), 2314U);
        EXPECT_EQ(skin.value().positions.size(), 1360U);
    }
}

// Besides the strip, there is a triangle without a skin on a node that mirrors. The skin's own node
// is a joint that moves no vertex.
TEST(GltfFigure, EveryNodeIsAJointAndMeshesGoWithTheirNode) {
    GltfBuilder builder = strip_file();
    const int positions = builder.add_positions({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}});
    const int mesh = builder.add_mesh(positions, -1);
    builder.json["nodes"].push_back(
        {{"name", "flag"}, {"mesh", mesh}, {"translation", {0, 0, 4}}, {"scale", {-1, 1, 1}}});
    builder.json["nodes"][2]["children"] = {4};  // on the second joint, which is turned by 90
    const Result<SkinnedMesh> figure = parse_gltf_figure(builder.glb(), "figure.glb");
    ASSERT_TRUE(figure.ok()) << figure.error().message();
    const SkinnedMesh& found = figure.value();
    ASSERT_EQ(found.joints.size(), 5U);
    ASSERT_EQ(found.positions.size(), 7U);
    const auto joint = [&](const char* name) {
        for (std::size_t i = 0; i < found.joints.size(); ++i) {
            if (found.joints[i].name == name) {
                return i;
            }
        }
        return std::size_t{99};
    };
    ASSERT_LT(joint("flag"), 5U);
    EXPECT_EQ(found.joints[joint("flag")].parent, static_cast<std::int32_t>(joint("second")));
    EXPECT_EQ(found.joints[joint("second")].parent, static_cast<std::int32_t>(joint("first")));
    // (1, 0, 0) of the flag: mirrored, turned to -Y, half the size, from the second joint.
    std::size_t flag = 0;
    while (found.weights[flag].joint[0] != joint("flag")) {
        ++flag;
    }
    EXPECT_NEAR((found.positions[flag] - Vec3(0.5, 2, 2)).norm(), 0.0, 1e-6);
    EXPECT_NEAR((found.positions[flag + 1] - Vec3(0.5, 1.5, 2)).norm(), 0.0, 1e-6);
    // The outside stays outside: the triangle's winding was reversed together with the mirroring.
    for (const auto& [a, b, c] : found.triangles) {
        if (a >= flag && a < flag + 3) {
            const Vec3 area = (found.positions[b] - found.positions[a])
                                  .cross(found.positions[c] - found.positions[a]);
            EXPECT_GT(area.z(), 0.0);
        }
    }
}

// A ramp on a mirroring node that is scaled to twice the height. Its normal stays perpendicular to
// it, on the side from which its triangle is visible.
TEST(GltfFigure, NormalsStaySquareToWhatIsScaled) {
    for (const double x : {1.0, -1.0}) {
        GltfBuilder builder;
        const int mesh =
            builder.add_mesh(builder.add_positions({{0, 0, 0}, {1, 1, 0}, {0, 0, -1}}), -1);
        const float half = std::sqrt(0.5F);
        const std::array<float, 3> normal = {-half, half, 0};
        builder.json["meshes"][0]["primitives"][0]["attributes"]["NORMAL"] =
            builder.add_positions({normal, normal, normal});
        builder.json["nodes"] = {{{"mesh", mesh}, {"scale", {x, 2, 1}}}};
        const Result<SkinnedMesh> figure = parse_gltf_figure(builder.glb(), "ramp.glb");
        ASSERT_TRUE(figure.ok()) << figure.error().message();
        const auto& [a, b, c] = figure.value().triangles.at(0);
        const auto& at = figure.value().positions;
        const Vec3 square = (at[b] - at[a]).cross(at[c] - at[a]).normalized();
        for (const Vec3& found : figure.value().normals) {
            EXPECT_NEAR((found - square).norm(), 0.0, 1e-6) << x;
        }
    }
}

// Skins mirrored by a node above their joints: the outside stays outside.
TEST(GltfFigure, SkinsMayBeMirrored) {
    GltfBuilder builder = strip_file();
    builder.json["nodes"][0]["scale"] = {-0.5, 0.5, 0.5};
    const Result<SkinnedMesh> figure = parse_gltf_figure(builder.glb(), "strip.glb");
    ASSERT_TRUE(figure.ok()) << figure.error().message();
    for (const auto& [a, b, c] : figure.value().triangles) {
        const auto& at = figure.value().positions;
        EXPECT_GT((at[b] - at[a]).cross(at[c] - at[a]).z(), 0.0);
    }
    for (const Vec3& normal : figure.value().normals) {
        EXPECT_NEAR((normal - Vec3::UnitZ()).norm(), 0.0, 1e-6);
    }
}

TEST(GltfFigure, RefusesSkinsThatNameAJointTwiceOrNone) {
    for (const nlohmann::json& joints : {nlohmann::json({1, 1}), nlohmann::json::array()}) {
        GltfBuilder builder = strip_file();
        builder.json["skins"][0]["joints"] = joints;
        EXPECT_FALSE(parse_gltf_figure(builder.glb(), "strip.glb").ok()) << joints;
    }
}

TEST(GltfFigure, NeedsTriangles) {
    GltfBuilder builder;
    builder.json["nodes"] = {{{"name", "alone"}}};
    EXPECT_FALSE(parse_gltf_figure(builder.glb(), "alone.glb").ok());
}

}  // namespace
}  // namespace handhold::io_gltf_skin_test
