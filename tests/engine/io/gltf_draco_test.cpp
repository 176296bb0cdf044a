#include <algorithm>
#include <string>
#include <vector>

#include <draco/compression/encode.h>
#include <draco/mesh/triangle_soup_mesh_builder.h>
#include <gtest/gtest.h>

#include "engine/io/gltf.hpp"
#include "engine/io/gltf_skin.hpp"
#include "tests/engine/io/gltf_variants.hpp"

// Built only with Draco, whose encoder is the oracle.
namespace handhold::io_gltf_draco_test {
namespace {

using test::GltfBuilder;
using test::Random;
using test::RandomMesh;
using test::VariantBuilder;

constexpr int k_position_bits = 14;
constexpr std::size_t k_joints = 5;

// Every vertex follows one joint that its height chooses, with weight 1, and has normal +Y.
struct Compressed {
    std::string bytes;
    int position = 0, normal = 0, joints = 0, weights = 0;  // attributes' unique ids
};

std::size_t joint_of(const Vec3& position) {
    return static_cast<std::size_t>(std::abs(position.y()) * 50.0) % k_joints;
}

Compressed compress(const RandomMesh& source, bool is_sequential) {
    using Attribute = draco::GeometryAttribute;
    draco::TriangleSoupMeshBuilder builder;
    builder.Start(static_cast<int>(source.indices.size() / 3));
    const int position = builder.AddAttribute(Attribute::POSITION, 3, draco::DT_FLOAT32);
    const int normal = builder.AddAttribute(Attribute::NORMAL, 3, draco::DT_FLOAT32);
    const int joints = builder.AddAttribute(Attribute::GENERIC, 4, draco::DT_UINT8);
    const int weights = builder.AddAttribute(Attribute::GENERIC, 4, draco::DT_UINT16);
    for (std::size_t i = 0; i < source.indices.size(); i += 3) {
        std::array<std::array<float, 3>, 3> at{};
        std::array<std::array<std::uint8_t, 4>, 3> names{};
        for (std::size_t corner = 0; corner < 3; ++corner) {
            const Vec3& from = source.positions[source.indices[i + corner]];
            for (std::size_t k = 0; k < 3; ++k) {
                at[corner][k] = static_cast<float>(from[static_cast<int>(k)]);
            }
            names[corner][0] = static_cast<std::uint8_t>(joint_of(from));
        }
        const std::array<float, 3> up = {0, 1, 0};
        const std::array<std::uint16_t, 4> whole = {65535, 0, 0, 0};
        const draco::FaceIndex face(static_cast<std::uint32_t>(i / 3));
        builder.SetAttributeValuesForFace(position, face, at[0].data(), at[1].data(), at[2].data());
        builder.SetAttributeValuesForFace(normal, face, up.data(), up.data(), up.data());
        builder.SetAttributeValuesForFace(joints, face, names[0].data(), names[1].data(),
                                          names[2].data());
        builder.SetAttributeValuesForFace(weights, face, whole.data(), whole.data(), whole.data());
    }
    const std::unique_ptr<draco::Mesh> mesh = builder.Finalize();
    draco::Encoder encoder;
    encoder.SetEncodingMethod(is_sequential ? draco::MESH_SEQUENTIAL_ENCODING
                                            : draco::MESH_EDGEBREAKER_ENCODING);
    encoder.SetAttributeQuantization(Attribute::POSITION, k_position_bits);
    encoder.SetAttributeQuantization(Attribute::NORMAL, 10);
    draco::EncoderBuffer buffer;
    EXPECT_TRUE(encoder.EncodeMeshToBuffer(*mesh, &buffer).ok());
    const auto id = [&](int attribute) {
        return static_cast<int>(mesh->attribute(attribute)->unique_id());
    };
    return {{buffer.data(), buffer.size()}, id(position), id(normal), id(joints), id(weights)};
}

// A skin of k_joints joints whose only primitive is compressed.
std::string write_glb(const Compressed& compressed, const RandomMesh& source) {
    VariantBuilder builder;
    const std::size_t view = builder.add_view(compressed.bytes, 0);
    auto& json = builder.gltf.json;
    const auto add = [&](int component_type, const char* type, bool is_normalized) {
        json["accessors"].push_back({{"componentType", component_type},
                                     {"count", source.positions.size()},
                                     {"type", type},
                                     {"normalized", is_normalized}});
        return json["accessors"].size() - 1;
    };
    nlohmann::json primitive;
    primitive["attributes"] = {{"POSITION", add(5126, "VEC3", false)},
                               {"NORMAL", add(5126, "VEC3", false)},
                               {"JOINTS_0", add(5121, "VEC4", false)},
                               {"WEIGHTS_0", add(5123, "VEC4", true)}};
    primitive["extensions"]["KHR_draco_mesh_compression"] = {{"bufferView", view},
                                                             {"attributes",
                                                              {{"POSITION", compressed.position},
                                                               {"NORMAL", compressed.normal},
                                                               {"JOINTS_0", compressed.joints},
                                                               {"WEIGHTS_0", compressed.weights}}}};
    json["meshes"] = {{{"primitives", {primitive}}}};
    json["nodes"] = {{{"mesh", 0}, {"skin", 0}}};
    json["skins"] = {{{"joints", nlohmann::json::array()}}};
    for (std::size_t i = 0; i < k_joints; ++i) {
        json["nodes"].push_back({{"name", "joint" + std::to_string(i)}});
        json["skins"][0]["joints"].push_back(i + 1);
    }
    builder.glb();  // completes the JSON
    json["extensionsRequired"].push_back("KHR_draco_mesh_compression");
    return builder.gltf.glb();
}

// Vertices and triangles come in an order of the encoder's choice: each source triangle must be
// found, with its winding.
TEST(GltfDraco, RandomSkinsAreReadWithinQuantisation) {
    Random random(1);
    for (int round = 0; round < 60; ++round) {
        const RandomMesh source(random);
        const Result<SkinnedMesh> skin =
            parse_gltf_skin(write_glb(compress(source, round % 2 == 0), source), "compressed.glb");
        ASSERT_TRUE(skin.ok()) << round << ": " << skin.error().message();
        const SkinnedMesh& mesh = skin.value();
        ASSERT_EQ(3 * mesh.triangles.size(), source.indices.size());
        Vec3 low = source.positions.front();
        Vec3 high = low;
        for (const Vec3& position : source.positions) {
            low = low.cwiseMin(position);
            high = high.cwiseMax(position);
        }
        const double tolerance_m = (high - low).maxCoeff() / (1 << k_position_bits) * 2.0;
        for (std::size_t i = 0; i < source.indices.size(); i += 3) {
            const bool is_found = std::any_of(
                mesh.triangles.begin(), mesh.triangles.end(), [&](const auto& triangle) {
                    for (std::size_t turn = 0; turn < 3; ++turn) {
                        bool is_same = true;
                        for (std::size_t k = 0; k < 3; ++k) {
                            const Vec3& a = mesh.positions[triangle[(turn + k) % 3]];
                            const Vec3& b = source.positions[source.indices[i + k]];
                            is_same = is_same && (a - b).norm() <= tolerance_m;
                        }
                        if (is_same) {
                            return true;
                        }
                    }
                    return false;
                });
            EXPECT_TRUE(is_found) << round << ", triangle " << i / 3;
        }
        for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
            EXPECT_NEAR((mesh.normals[i] - Vec3::UnitY()).norm(), 0.0, 0.01);
            EXPECT_EQ(mesh.weights[i].weight[0], 1.0F);
            const bool is_joint_of_a_near_vertex = std::any_of(
                source.positions.begin(), source.positions.end(), [&](const Vec3& position) {
                    return (position - mesh.positions[i]).norm() <= tolerance_m &&
                           joint_of(position) == mesh.weights[i].joint[0];
                });
            EXPECT_TRUE(is_joint_of_a_near_vertex) << round << ", vertex " << i;
        }
    }
}

TEST(GltfDraco, DamagedDataIsRefusedOrSound) {
    Random random(2);
    const RandomMesh source(random);
    const Compressed whole = compress(source, false);
    for (int round = 0; round < 300; ++round) {
        Compressed damaged = whole;
        for (int i = 0; i < 1 + round % 3; ++i) {
            const auto at = static_cast<std::size_t>(
                random.between(0, static_cast<double>(whole.bytes.size()) - 0.001));
            damaged.bytes[at] =
                static_cast<char>(static_cast<unsigned char>(random.between(0, 255.999)));
        }
        const Result<SkinnedMesh> skin = parse_gltf_skin(write_glb(damaged, source), "damaged.glb");
        for (std::size_t i = 0; skin && i < skin.value().triangles.size(); ++i) {
            for (const std::uint32_t corner : skin.value().triangles[i]) {
                ASSERT_LT(corner, skin.value().positions.size());
            }
        }
    }
}

}  // namespace
}  // namespace handhold::io_gltf_draco_test
