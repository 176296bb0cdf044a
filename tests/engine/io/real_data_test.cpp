#include <algorithm>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <map>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "engine/io/gltf.hpp"
#include "engine/io/gltf_skin.hpp"
#include "tests/places.hpp"

// The folder's SOURCE.md and MANIFEST.json say what is in the files.
namespace handhold::io_real_data_test {
namespace {

namespace fs = std::filesystem;

const fs::path k_data = data_dir();

std::vector<fs::path> files_below(const char* folder) {
    std::vector<fs::path> files;
    if (fs::exists(k_data / folder)) {
        for (const fs::directory_entry& entry : fs::recursive_directory_iterator(k_data / folder)) {
            if (entry.path().extension() == ".glb") {
                files.push_back(entry.path());
            }
        }
    }
    std::sort(files.begin(), files.end());
    return files;
}

std::size_t count_triangles(const GltfLevel& level) {
    std::size_t count = 0;
    for (const LevelPart& part : level.parts) {
        count += part.mesh.triangles.size();
    }
    return count;
}

// Oracle: the sum of the accessors' counts, read from the file's JSON without our reader.
std::size_t count_triangles_in_json(const fs::path& path) {
    std::ifstream stream(path, std::ios::binary);
    std::string bytes((std::istreambuf_iterator<char>(stream)), std::istreambuf_iterator<char>());
    std::uint32_t length = 0;
    std::memcpy(&length, bytes.data() + 12, sizeof length);
    const nlohmann::json json = nlohmann::json::parse(bytes.substr(20, length));
    std::size_t count = 0;
    for (const nlohmann::json& node : json["nodes"]) {
        if (!node.contains("mesh")) {
            continue;
        }
        for (const nlohmann::json& primitive :
             json["meshes"][node["mesh"].get<std::size_t>()]["primitives"]) {
            const std::size_t accessor =
                primitive.contains("indices")
                    ? primitive["indices"].get<std::size_t>()
                    : primitive["attributes"]["POSITION"].get<std::size_t>();
            count += json["accessors"][accessor]["count"].get<std::size_t>() / 3;
        }
    }
    return count;
}

void expect_sound(const GltfLevel& level, const fs::path& path) {
    for (const LevelPart& part : level.parts) {
        for (const auto& triangle : part.mesh.triangles) {
            for (const std::uint32_t corner : triangle) {
                ASSERT_LT(corner, part.mesh.positions.size()) << path;
            }
        }
        for (const Vec3& position : part.mesh.positions) {
            ASSERT_LT(position.norm(), 100.0) << path;  // a hand, a tool or a station, in metres
        }
    }
}

TEST(RealMeshes, RigidOnesLoadWithEveryTriangle) {
    std::size_t loaded = 0;
    for (const char* folder : {"objects", "nasty", "level", "controllers"}) {
        for (const fs::path& path : files_below(folder)) {
            if (path.filename() == "der_gear_nan_vertex.glb") {
                continue;  // below
            }
            const Result<GltfLevel> level = load_gltf_level(path);
            ASSERT_TRUE(level.ok()) << level.error().message();
            EXPECT_GT(count_triangles(level.value()), 0U) << path;
            EXPECT_EQ(count_triangles(level.value()) + level.value().dropped_triangles,
                      count_triangles_in_json(path))
                << path;
            expect_sound(level.value(), path);
            ++loaded;
        }
    }
    if (loaded == 0) {
        GTEST_SKIP() << "no " << k_data;
    }
}

TEST(RealMeshes, NanVertexIsRefusedWithItsPlace) {
    const fs::path path = k_data / "nasty/der_gear_nan_vertex.glb";
    if (!fs::exists(path)) {
        GTEST_SKIP() << "no " << k_data;
    }
    const Result<GltfLevel> level = load_gltf_level(path);
    ASSERT_FALSE(level.ok());
    EXPECT_EQ(level.error().place, "/meshes/0/primitives/0/attributes/POSITION");
}

TEST(RealMeshes, SkinnedHandsAndBodiesAreRefusedByTheirSkin) {
    const std::vector<fs::path> hands = files_below("hands");
    const std::vector<fs::path> bodies = files_below("body");
    if (hands.empty() && bodies.empty()) {
        GTEST_SKIP() << "no " << k_data;
    }
    std::vector<fs::path> all = hands;
    all.insert(all.end(), bodies.begin(), bodies.end());
    for (const fs::path& path : all) {
        const Result<GltfLevel> level = load_gltf_level(path);
        if (path.filename() == "nasa_valkyrie.glb") {  // rigid parts on nodes
            ASSERT_TRUE(level.ok()) << level.error().message();
            expect_sound(level.value(), path);
        } else {
            ASSERT_FALSE(level.ok()) << path;
            EXPECT_NE(level.error().place.find("/skin"), std::string::npos)
                << level.error().message();
        }
    }
}

// SOURCE.md of level/: triangles by module.
TEST(RealMeshes, StationHasItsModulesAndMarksItsFillers) {
    const fs::path path = k_data / "level/station.glb";
    if (!fs::exists(path)) {
        GTEST_SKIP() << "no " << k_data;
    }
    const Result<GltfLevel> level = load_gltf_level(path);
    ASSERT_TRUE(level.ok()) << level.error().message();
    const std::map<std::string, std::size_t> published = {
        {"node_2", 31365}, {"us_lab", 25126}, {"jpm", 20372}, {"node_1", 26142}};
    std::size_t modules = 0;
    std::size_t fillers = 0;
    for (const LevelPart& part : level.value().parts) {
        if (const auto module = published.find(part.mesh.name); module != published.end()) {
            EXPECT_EQ(part.mesh.triangles.size(), module->second) << part.mesh.name;
            ++modules;
        }
        EXPECT_EQ(part.synthetic, part.mesh.name.rfind("filler_", 0) == 0) << part.mesh.name;
        fillers += part.synthetic ? 1 : 0;
    }
    EXPECT_EQ(modules, published.size());
    EXPECT_GT(fillers, 0U);
    EXPECT_EQ(level.value().dropped_triangles, 0U);  // "zero-area and duplicate triangles removed"
}

// README.md of the cases. Each is a file as other programs export it.
TEST(RealMeshes, ExportedFilesLoadWithTheirNotes) {
    const fs::path cases = k_data / "../cases";
    if (!fs::exists(cases / "figure_sparse_morph/fig.glb")) {
        GTEST_SKIP() << "no " << cases;
    }
    for (const char* name : {"level_quantized", "level_emissive"}) {
        const Result<GltfLevel> level = load_gltf_level(cases / name / "l.glb");
        ASSERT_TRUE(level.ok()) << level.error().message();
        EXPECT_EQ(count_triangles(level.value()), 12U) << name;  // a box
        EXPECT_EQ(level.value().notes.empty(), std::string(name) == "level_quantized");
    }
    const Result<SkinnedMesh> morph = load_gltf_figure(cases / "figure_sparse_morph/fig.glb");
    ASSERT_TRUE(morph.ok()) << morph.error().message();
    ASSERT_EQ(morph.value().notes.size(), 1U);
    EXPECT_NE(morph.value().notes[0].find("morph targets: 1"), std::string::npos);
    const Result<SkinnedMesh> joints = load_gltf_figure(cases / "figure_joints_1/fig.glb");
    ASSERT_TRUE(joints.ok()) << joints.error().message();
    EXPECT_EQ(joints.value().positions.size(), 2064U);
}

// SOURCE.md of nasty/: "600 duplicate and 80 degenerate triangles added".
TEST(RealMeshes, AddedDegenerateTrianglesAreCounted) {
    const fs::path path = k_data / "nasty/der_spot_duplicates_degenerates.glb";
    if (!fs::exists(path)) {
        GTEST_SKIP() << "no " << k_data;
    }
    const Result<GltfLevel> level = load_gltf_level(path);
    ASSERT_TRUE(level.ok()) << level.error().message();
    EXPECT_EQ(level.value().dropped_triangles, 80U);
}

}  // namespace
}  // namespace handhold::io_real_data_test
