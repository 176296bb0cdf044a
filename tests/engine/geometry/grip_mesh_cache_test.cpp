#include "engine/geometry/grip_mesh_cache.hpp"

#include <filesystem>
#include <fstream>

#include <gtest/gtest.h>

#include "broken_meshes.hpp"

namespace handhold::grip_mesh_cache_test {
namespace {

namespace fs = std::filesystem;
using test::Random;

// A temporary folder, removed with the test.
struct Folder {
    fs::path path = fs::temp_directory_path() /
                    ("handhold_grip_cache_" +
                     std::to_string(::testing::UnitTest::GetInstance()->random_seed()) +
                     ::testing::UnitTest::GetInstance()->current_test_info()->name());
    Folder() { fs::remove_all(path); }
    ~Folder() { fs::remove_all(path); }
};

void expect_same(const SurfaceGraph& a, const SurfaceGraph& b) {
    EXPECT_EQ(a.positions, b.positions);
    EXPECT_EQ(a.triangles, b.triangles);
    EXPECT_EQ(a.neighbours, b.neighbours);
    EXPECT_EQ(a.normals, b.normals);
    EXPECT_EQ(a.source_triangle, b.source_triangle);
    EXPECT_EQ(a.report.kept, b.report.kept);
    EXPECT_EQ(a.report.parts, b.report.parts);
    EXPECT_EQ(a.report.cut_in, b.report.cut_in);
}

void expect_same(const GripMesh& a, const GripMesh& b) {
    expect_same(a.contact, b.contact);
    expect_same(a.search, b.search);
    EXPECT_EQ(a.turned, b.turned);
    EXPECT_EQ(a.full_triangles, b.full_triangles);
    Random random(850);
    for (int i = 0; i < 50; ++i) {
        const Vec3 point = random.vector(0.3);
        EXPECT_EQ(a.contact_bvh.closest_point(point, 1.0)->point,
                  b.contact_bvh.closest_point(point, 1.0)->point);
    }
}

Mesh make_level(std::uint64_t seed) {
    Random random(seed);
    return test::with_flips(test::with_holes(test::make_clean_ball(0.2, 30, 40), 0.05, random), 0.1,
                            random);
}

std::vector<fs::path> files_in(const fs::path& folder) {
    std::vector<fs::path> files;
    for (const auto& entry : fs::directory_iterator(folder)) {
        files.push_back(entry.path());
    }
    return files;
}

std::string bytes_of(const fs::path& file) {
    std::ifstream stream(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
}

void overwrite(const fs::path& file, const std::string& bytes) {
    std::ofstream(file, std::ios::binary) << bytes;
}

TEST(GripMeshCache, ReturnsWhatWasBuilt) {
    const Folder folder;
    const Mesh mesh = make_level(1);
    const GripMesh built = build_grip_mesh(mesh);
    expect_same(cached_grip_mesh(mesh, {}, folder.path), built);
    ASSERT_EQ(files_in(folder.path).size(), 1U);
    const auto stamp = fs::last_write_time(files_in(folder.path)[0]);
    expect_same(cached_grip_mesh(mesh, {}, folder.path), built);
    EXPECT_EQ(fs::last_write_time(files_in(folder.path)[0]), stamp);
}

TEST(GripMeshCache, ReadsFileInsteadOfBuilding) {
    // Another grip mesh under the key: returned only if the file is read.
    const Folder folder;
    const Mesh mesh = make_level(1);
    (void)cached_grip_mesh(mesh, {}, folder.path);
    const GripMesh other = build_grip_mesh(make_level(2));
    overwrite(files_in(folder.path)[0], write_grip_mesh(other, grip_mesh_key(mesh, {})));
    expect_same(cached_grip_mesh(mesh, {}, folder.path), other);
}

TEST(GripMeshCache, KeyDependsOnMeshAndEverySetting) {
    const Mesh mesh = make_level(1);
    std::vector<std::uint64_t> keys = {grip_mesh_key(mesh, {}), grip_mesh_key(make_level(2), {})};
    Mesh moved = mesh;
    moved.positions[7].x() += 1e-15;
    keys.push_back(grip_mesh_key(moved, {}));
    Mesh turned = mesh;
    std::swap(turned.triangles[3][0], turned.triangles[3][1]);
    keys.push_back(grip_mesh_key(turned, {}));
    for (int i = 0; i < 11; ++i) {
        GripMeshSettings settings;
        double* const fields[] = {&settings.weld.point_m,       &settings.weld.seam_m,
                                  &settings.weld.seam_per_size, &settings.weld.seam_per_edge,
                                  &settings.shape_tolerance_m,  &settings.search.deviation_m,
                                  &settings.search.edge_m,      &settings.contact.deviation_m,
                                  &settings.contact.edge_m,     &settings.contact_share,
                                  &settings.flip_below_m};
        *fields[i] += 1e-6;
        keys.push_back(grip_mesh_key(mesh, settings));
    }
    std::sort(keys.begin(), keys.end());
    EXPECT_EQ(std::adjacent_find(keys.begin(), keys.end()), keys.end());
}

TEST(GripMeshCache, RejectsEveryDamagedFile) {
    const Mesh mesh = make_level(3);
    const std::uint64_t key = grip_mesh_key(mesh, {});
    const std::string bytes = write_grip_mesh(build_grip_mesh(mesh), key);
    ASSERT_TRUE(read_grip_mesh(bytes, key).has_value());
    EXPECT_FALSE(read_grip_mesh(bytes, key + 1));
    EXPECT_FALSE(read_grip_mesh({}, key));
    EXPECT_FALSE(read_grip_mesh(bytes + std::string(8, '\0'), key));
    Random random(851);
    for (int i = 0; i < 300; ++i) {
        const auto at = static_cast<std::size_t>(
            random.between(0.0, static_cast<double>(i < 40 ? 32 : bytes.size())));
        std::string damaged = bytes;
        damaged[at] = static_cast<char>(damaged[at] ^ (1 << (i % 8)));
        EXPECT_FALSE(read_grip_mesh(damaged, key)) << at;
        EXPECT_FALSE(read_grip_mesh(std::string_view(bytes).substr(0, at), key)) << at;
    }
}

TEST(GripMeshCache, ReplacesDamagedFile) {
    const Folder folder;
    const Mesh mesh = make_level(4);
    const GripMesh built = cached_grip_mesh(mesh, {}, folder.path);
    const fs::path file = files_in(folder.path)[0];
    const std::string whole = bytes_of(file);
    for (const std::string& damaged :
         {std::string(), whole.substr(0, whole.size() / 2), std::string("a picture"),
          whole.substr(8), std::string(whole.size(), '\xff')}) {
        overwrite(file, damaged);
        expect_same(cached_grip_mesh(mesh, {}, folder.path), built);
        EXPECT_EQ(bytes_of(file), whole);
    }
    EXPECT_EQ(files_in(folder.path).size(), 1U);  // no temporary file is left
}

TEST(GripMeshCache, BuildsWithoutUsableDirectory) {
    const Folder folder;
    const Mesh mesh = make_level(5);
    const GripMesh built = build_grip_mesh(mesh);
    expect_same(cached_grip_mesh(mesh, {}, {}), built);
    // A path that cannot become a directory because a file is in its place.
    overwrite(folder.path, "a file");
    expect_same(cached_grip_mesh(mesh, {}, folder.path / "below"), built);
    EXPECT_EQ(bytes_of(folder.path), "a file");
}

}  // namespace
}  // namespace handhold::grip_mesh_cache_test
