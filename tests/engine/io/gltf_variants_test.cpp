#include "tests/engine/io/gltf_variants.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "engine/io/gltf.hpp"
#include "engine/io/gltf_skin.hpp"

// Round trips: what an independent writer encodes in any way that glTF allows is read back.
namespace handhold::io_gltf_variants_test {
namespace {

using Json = nlohmann::json;
using test::encode_elements;
using test::EncodedElements;
using test::GltfBuilder;
using test::quantize;
using test::QuantizedPositions;
using test::Random;
using test::RandomMesh;
using test::triangle_file;
using test::VariantBuilder;

constexpr int k_rounds = 200;

// Corners that a codec may rotate but not reverse.
std::array<std::uint32_t, 3> rotated(std::array<std::uint32_t, 3> triangle) {
    std::rotate(triangle.begin(), std::min_element(triangle.begin(), triangle.end()),
                triangle.end());
    return triangle;
}

std::vector<std::array<std::uint32_t, 3>> triangles_of(const std::vector<std::uint32_t>& indices,
                                                       std::uint32_t first) {
    std::vector<std::array<std::uint32_t, 3>> triangles;
    for (std::size_t i = 0; i < indices.size(); i += 3) {
        triangles.push_back(
            rotated({first + indices[i], first + indices[i + 1], first + indices[i + 2]}));
    }
    return triangles;
}

Json array_of(const Vec3& v) { return {v.x(), v.y(), v.z()}; }

// A node whose transform undoes the quantisation.
Json dequantizing_node(const QuantizedPositions& quantized, int mesh) {
    return {{"mesh", mesh},
            {"translation", array_of(quantized.offset)},
            {"scale", array_of(Vec3::Constant(quantized.scale))}};
}

TEST(GltfVariants, RandomLevelsAreReadWithinQuantisation) {
    Random random(1);
    for (int round = 0; round < k_rounds; ++round) {
        const RandomMesh source(random);
        const QuantizedPositions quantized = quantize(source.positions, random);
        VariantBuilder builder;
        const int positions = builder.add_elements(quantized.elements, "VEC3", 3, random);
        const int indices = builder.add_indices(source.indices, source.positions.size(), random);
        builder.gltf.json["nodes"] =
            Json::array({dequantizing_node(quantized, builder.gltf.add_mesh(positions, indices))});
        const Result<GltfLevel> level = parse_gltf_level(builder.glb(), "level.glb");
        ASSERT_TRUE(level.ok()) << round << ": " << level.error().message();
        const Mesh& mesh = level.value().parts.at(0).mesh;
        ASSERT_EQ(mesh.positions.size(), source.positions.size());
        for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
            ASSERT_LE((mesh.positions[i] - source.positions[i]).cwiseAbs().maxCoeff(),
                      quantized.tolerance_m)
                << round << ", vertex " << i;
        }
        EXPECT_EQ(3 * (mesh.triangles.size() + level.value().dropped_triangles),
                  source.indices.size());
        if (level.value().dropped_triangles == 0) {
            std::vector<std::array<std::uint32_t, 3>> found;
            for (const auto& triangle : mesh.triangles) {
                found.push_back(rotated(triangle));
            }
            EXPECT_EQ(found, triangles_of(source.indices, 0)) << round;
        }
    }
}

// Closed form: p = T R S of the instance, then the node.
TEST(GltfVariants, RandomInstancesStandWhereTheirTransformsSay) {
    Random random(2);
    for (int round = 0; round < k_rounds; ++round) {
        const RandomMesh source(random);
        const auto count = static_cast<std::size_t>(random.between(1, 6));
        std::vector<Vec3> translations;
        std::vector<Vec3> scales;
        std::vector<Eigen::Vector4d> rotations;
        for (std::size_t i = 0; i < count; ++i) {
            translations.push_back(random.vector(50));
            rotations.push_back(random.rotation().coeffs());
            scales.push_back(random.vector(2));  // may mirror
        }
        const bool is_quantized = random.between(0, 1) < 0.5;
        std::vector<Eigen::Vector4d> coded = rotations;
        for (Eigen::Vector4d& rotation : coded) {
            rotation *= is_quantized ? 32767.0 : 1.0;
        }
        VariantBuilder builder;
        const EncodedElements elements = encode_elements(source.positions, 5126, false);
        const int positions = builder.add_elements(elements, "VEC3", 3, random);
        const int mesh = builder.gltf.add_mesh(positions, builder.gltf.add_indices(source.indices));
        Json attributes;
        attributes["TRANSLATION"] =
            builder.add_elements(encode_elements(translations, 5126, false), "VEC3", 3, random);
        attributes["ROTATION"] = builder.add_elements(
            encode_elements(coded, is_quantized ? 5122 : 5126, is_quantized), "VEC4", 4, random);
        attributes["SCALE"] =
            builder.add_elements(encode_elements(scales, 5126, false), "VEC3", 3, random);
        const Vec3 shift = random.vector(5);
        builder.gltf.json["nodes"] = {{{"mesh", mesh}, {"translation", array_of(shift)}}};
        builder.gltf.json["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"] =
            attributes;
        const std::string glb = builder.glb();
        const Result<GltfLevel> level = parse_gltf_level(glb, "level.glb");
        const Result<SkinnedMesh> figure = parse_gltf_figure(glb, "figure.glb");
        ASSERT_TRUE(level.ok()) << round << ": " << level.error().message();
        ASSERT_TRUE(figure.ok()) << round << ": " << figure.error().message();
        ASSERT_EQ(level.value().parts.size(), 1U);
        const Mesh& found = level.value().parts[0].mesh;
        const std::size_t vertices = source.positions.size();
        ASSERT_EQ(found.positions.size(), count * vertices);
        ASSERT_EQ(figure.value().positions.size(), count * vertices);
        for (std::size_t i = 0; i < found.positions.size(); ++i) {
            const std::size_t k = i / vertices;
            const Vec3 scaled = scales[k].cwiseProduct(source.positions[i % vertices]);
            const Vec3 expected = shift + translations[k] + Quat(rotations[k]) * scaled;
            const double tolerance_m = (is_quantized ? 2e-4 : 1e-5) * (scaled.norm() + 10.0);
            ASSERT_LE((found.positions[i] - expected).norm(), tolerance_m) << round;
            ASSERT_LE((figure.value().positions[i] - expected).norm(), tolerance_m) << round;
        }
        // The field faces +Y; a mirrored instance does so in its mirrored frame.
        for (std::size_t t = 0; t < found.triangles.size(); ++t) {
            const auto& [a, b, c] = found.triangles[t];
            const std::size_t k = a / vertices;
            const Vec3 normal = (found.positions[b] - found.positions[a])
                                    .cross(found.positions[c] - found.positions[a]);
            const Vec3 outside = Quat(rotations[k]) * Vec3(0, scales[k].y() < 0 ? -1 : 1, 0);
            EXPECT_GT(normal.dot(outside), 0.0) << round;
        }
    }
}

// Normals of a byte with padding, meshopt's octahedral filter, weights of any type.
TEST(GltfVariants, RandomSkinsKeepTheFourHeaviestJointsOfEight) {
    Random random(3);
    for (int round = 0; round < k_rounds; ++round) {
        const RandomMesh source(random);
        const std::size_t joints = 12;
        const std::size_t vertices = source.positions.size();
        const bool has_second_set = random.between(0, 1) < 0.7;
        const std::size_t sets = has_second_set ? 2 : 1;
        constexpr std::array<int, 3> k_types = {5126, 5121, 5123};
        const int type = k_types[static_cast<std::size_t>(random.between(0, 2.999))];
        const double unit = type == 5126 ? 1.0 : test::largest_of(type);
        std::vector<std::vector<std::array<double, 4>>> joint_elements(sets);
        std::vector<std::vector<std::array<double, 4>>> weight_elements(sets);
        std::vector<std::array<double, joints>> expected(vertices);
        for (std::size_t i = 0; i < vertices; ++i) {
            expected[i].fill(0.0);
            const bool is_unweighted = random.between(0, 1) < 0.05;
            for (std::size_t set = 0; set < sets; ++set) {
                std::array<double, 4> names{};
                std::array<double, 4> weights{};
                for (std::size_t k = 0; k < 4; ++k) {
                    // Entries without weight name joints that do not exist.
                    const bool is_used = !is_unweighted && random.between(0, 1) < 0.8;
                    names[k] = is_used ? std::floor(random.between(0, joints - 0.001)) : 200.0;
                    weights[k] = is_used ? std::round(random.between(0, 1) * 255) / 255 : 0.0;
                    if (type != 5126) {
                        weights[k] = std::round(weights[k] * unit);
                    }
                    if (weights[k] > 0.0) {
                        expected[i][static_cast<std::size_t>(names[k])] += weights[k];
                    }
                }
                joint_elements[set].push_back(names);
                weight_elements[set].push_back(weights);
            }
        }
        VariantBuilder builder;
        const EncodedElements elements = encode_elements(source.positions, 5126, false);
        const int positions = builder.add_elements(elements, "VEC3", 3, random);
        const int indices = builder.add_indices(source.indices, vertices, random);
        const int mesh = builder.gltf.add_mesh(positions, indices);
        const double up = type == 5126 ? 127.0 : 1.0;
        const std::vector<Vec3> normals(vertices, Vec3(0, up, 0));
        Json& attributes = builder.gltf.json["meshes"][0]["primitives"][0]["attributes"];
        attributes["NORMAL"] = builder.add_elements(
            encode_elements(normals, type == 5126 ? 5120 : 5126, type == 5126), "VEC3", 3, random);
        for (std::size_t set = 0; set < sets; ++set) {
            attributes["JOINTS_" + std::to_string(set)] = builder.add_elements(
                encode_elements(joint_elements[set], random.between(0, 1) < 0.5 ? 5121 : 5123,
                                false),
                "VEC4", 4, random);
            attributes["WEIGHTS_" + std::to_string(set)] = builder.add_elements(
                encode_elements(weight_elements[set], type, type != 5126), "VEC4", 4, random);
        }
        Json nodes = Json::array();
        Json names = Json::array();
        for (std::size_t k = 0; k < joints; ++k) {
            nodes.push_back({{"name", "joint" + std::to_string(k)}});
            names.push_back(k);
        }
        nodes.push_back({{"mesh", mesh}, {"skin", 0}});
        builder.gltf.json["nodes"] = nodes;
        builder.gltf.json["skins"] = {{{"joints", names}}};
        const Result<SkinnedMesh> skin = parse_gltf_skin(builder.glb(), "skin.glb");
        ASSERT_TRUE(skin.ok()) << round << ": " << skin.error().message();
        ASSERT_EQ(skin.value().weights.size(), vertices);
        for (std::size_t i = 0; i < vertices; ++i) {
            EXPECT_NEAR((skin.value().normals[i] - Vec3::UnitY()).norm(), 0.0, 1e-6);
            const SkinWeights& found = skin.value().weights[i];
            std::array<double, joints> by_joint{};
            float sum = 0.0F;
            for (std::size_t k = 0; k < 4; ++k) {
                by_joint[found.joint[k]] += static_cast<double>(found.weight[k]);
                sum += found.weight[k];
            }
            EXPECT_NEAR(sum, 1.0F, 1e-5F);
            std::array<double, joints> heaviest = expected[i];
            std::sort(heaviest.begin(), heaviest.end(), std::greater<>());
            const double total = heaviest[0] + heaviest[1] + heaviest[2] + heaviest[3];
            if (total == 0.0) {
                EXPECT_EQ(by_joint[0], 1.0);
                continue;
            }
            std::sort(by_joint.begin(), by_joint.end(), std::greater<>());
            for (std::size_t k = 0; k < 4; ++k) {
                EXPECT_NEAR(by_joint[k], heaviest[k] / total, 1e-5) << round << ", " << i;
            }
            for (std::size_t k = 0; k < 4; ++k) {
                if (found.weight[k] > 0.0F) {
                    EXPECT_NEAR(static_cast<double>(found.weight[k]),
                                expected[i][found.joint[k]] / total, 1e-5);
                }
            }
        }
    }
}

// The encoder's error: octahedral coordinates of 8 bits are within 0.02 of the direction.
TEST(GltfVariants, FilteredAttributesAreDecoded) {
    Random random(4);
    for (int round = 0; round < 50; ++round) {
        const RandomMesh source(random);
        const std::size_t vertices = source.positions.size();
        std::vector<float> directions;
        std::vector<float> numbers;
        std::vector<Vec3> normals;
        for (std::size_t i = 0; i < vertices; ++i) {
            normals.push_back(random.direction());
            for (int k = 0; k < 4; ++k) {
                directions.push_back(k < 3 ? static_cast<float>(normals[i][k]) : 0.0F);
            }
            for (int k = 0; k < 3; ++k) {
                numbers.push_back(static_cast<float>(source.positions[i][k]));
            }
        }
        EncodedElements normal_elements;
        normal_elements.bytes.resize(4 * vertices);
        normal_elements.element_bytes = 4;
        normal_elements.count = vertices;
        normal_elements.component_type = 5120;
        normal_elements.is_normalized = true;
        meshopt_encodeFilterOct(normal_elements.bytes.data(), vertices, 4, 8, directions.data());
        EncodedElements position_elements;
        position_elements.bytes.resize(12 * vertices);
        position_elements.element_bytes = 12;
        position_elements.count = vertices;
        meshopt_encodeFilterExp(position_elements.bytes.data(), vertices, 12, 20, numbers.data());
        VariantBuilder builder;
        const auto add = [&](const EncodedElements& elements, const char* filter) {
            const std::size_t view = builder.add_elements_view(elements, true);
            builder.gltf
                .json["bufferViews"][view]["extensions"]["EXT_meshopt_compression"]["filter"] =
                filter;
            return builder.add_accessor(view, elements, "VEC3");
        };
        const int positions = add(position_elements, "EXPONENTIAL");
        const int mesh = builder.gltf.add_mesh(positions, builder.gltf.add_indices(source.indices));
        builder.gltf.json["meshes"][0]["primitives"][0]["attributes"]["NORMAL"] =
            add(normal_elements, "OCTAHEDRAL");
        builder.gltf.json["nodes"] = {{{"mesh", mesh}}};
        const Result<SkinnedMesh> figure = parse_gltf_figure(builder.glb(), "figure.glb");
        ASSERT_TRUE(figure.ok()) << round << ": " << figure.error().message();
        for (std::size_t i = 0; i < vertices; ++i) {
            EXPECT_LE((figure.value().positions[i] - source.positions[i]).norm(),
                      1e-5 * (source.positions[i].norm() + 20.0));
            EXPECT_LE((figure.value().normals[i] - normals[i]).norm(), 0.03);
        }
    }
}

TEST(GltfVariants, MorphTargetsAreIgnoredWithANote) {
    GltfBuilder builder = triangle_file();
    builder.json["accessors"].push_back({{"componentType", 5126}, {"count", 3}, {"type", "VEC3"}});
    builder.json["meshes"][0]["primitives"][0]["targets"] = {{{"POSITION", 2}}, {{"POSITION", 2}}};
    const Result<GltfLevel> level = parse_gltf_level(builder.glb(), "face.glb");
    ASSERT_TRUE(level.ok()) << level.error().message();
    ASSERT_EQ(level.value().notes.size(), 1U);
    EXPECT_EQ(level.value().notes[0], "face.glb: ignored morph targets: 2");
}

TEST(GltfVariants, FactorsBeyondOneAreClampedWithANote) {
    GltfBuilder builder = triangle_file();
    builder.json["materials"] = {
        {{"pbrMetallicRoughness", {{"baseColorFactor", {2, 0.5, -1, 1}}, {"roughnessFactor", 1.5}}},
         {"emissiveFactor", {3, 3, 3}}}};
    builder.json["meshes"][0]["primitives"][0]["material"] = 0;
    const Result<GltfLevel> level = parse_gltf_level(builder.glb(), "lamp.glb");
    ASSERT_TRUE(level.ok()) << level.error().message();
    const ColorRun& run = level.value().parts.at(0).color_runs.at(0);
    EXPECT_EQ(run.color, (std::array<float, 3>{1.0F, 0.5F, 0.0F}));
    EXPECT_EQ(run.gloss, 0.0F);
    EXPECT_EQ(run.emissive, 1.0F);
    ASSERT_EQ(level.value().notes.size(), 1U);
    EXPECT_EQ(level.value().notes[0], "lamp.glb: material factors clamped to [0, 1]: 6");
}

TEST(GltfVariants, OptionalExtensionsAreIgnoredAndUnknownOnesNoted) {
    GltfBuilder builder = triangle_file();
    builder.json["extensionsUsed"] = {"KHR_materials_unlit", "ACME_smell\n\x1b[31m"};
    builder.json["extensionsRequired"] = {"KHR_materials_unlit", "KHR_texture_transform"};
    builder.json["extensions"] = {{"ACME_smell", "roses"}};
    const Result<GltfLevel> level = parse_gltf_level(builder.glb(), "rose.glb");
    ASSERT_TRUE(level.ok()) << level.error().message();
    ASSERT_EQ(level.value().notes.size(), 1U);
    EXPECT_EQ(level.value().notes[0], R"(rose.glb: ignored extensions: ACME_smell\x0a\x1b[31m)");
}

TEST(GltfVariants, PrimitivesWithoutTrianglesAreSkippedWithANote) {
    GltfBuilder builder = triangle_file();
    Json& primitives = builder.json["meshes"][0]["primitives"];
    primitives.push_back({{"attributes", {{"POSITION", 0}}}, {"mode", 0}});
    primitives.push_back({{"attributes", Json::object()}});
    const Result<GltfLevel> level = parse_gltf_level(builder.glb(), "lines.glb");
    ASSERT_TRUE(level.ok()) << level.error().message();
    EXPECT_EQ(level.value().parts.at(0).mesh.triangles.size(), 1U);
    ASSERT_EQ(level.value().notes.size(), 1U);
    EXPECT_NE(level.value().notes[0].find(": 2"), std::string::npos);
}

}  // namespace
}  // namespace handhold::io_gltf_variants_test
