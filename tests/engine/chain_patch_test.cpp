#include "engine/geometry/chain_patch.hpp"

#include <algorithm>

#include <gtest/gtest.h>

#include "broken_meshes.hpp"
#include "surface_cuts.hpp"

namespace handhold::chain_patch_test {
namespace {

using test::Random;

// At full detail: what is cut by hand is the very same.
GripMesh full_mesh(const Mesh& source) {
    GripMeshSettings settings;
    settings.contact.deviation_m = 0.0;
    return build_grip_mesh(source, settings);
}

ChainReach random_reach(Random& random) {
    return {{random.vector(0.1), random.rotation()}, random.between(0.02, 0.12), 0.008};
}

// The disc that a reach's plane is, in the mesh's frame.
Disc disc_of(const ChainReach& reach, const Pose& mesh, double offset_m) {
    const Pose base = inverse(mesh) * reach.base;
    Disc disc;
    disc.x_axis = base.rotation * -Vec3::UnitZ();
    disc.y_axis = base.rotation * -Vec3::UnitY();
    disc.normal = base.rotation * -Vec3::UnitX();
    disc.center = base.position + offset_m * disc.normal;
    disc.radius_m = reach.radius_m;
    return disc;
}

bool is_same_segment(const DiscSegment& a, const DiscSegment& b) {
    constexpr double k_same_m = 1e-9;
    return ((a.a_ds - b.a_ds).norm() < k_same_m && (a.b_ds - b.b_ds).norm() < k_same_m) ||
           ((a.a_ds - b.b_ds).norm() < k_same_m && (a.b_ds - b.a_ds).norm() < k_same_m);
}

TEST(ChainPatch, CutsEveryTriangleThatAPlaneMeets) {
    Random random(1506);
    const GripMesh mesh =
        full_mesh(test::as_soup(test::make_torus(0.08, 0.03, 30, 16), 2e-3, random));
    for (int i = 0; i < 300; ++i) {
        const ChainReach reach = random_reach(random);
        const Pose pose = {random.vector(0.02), random.rotation()};
        const std::vector<PlacedMesh> placed = {{&mesh, pose}};
        const double offset_m = random.between(-reach.half_width_m, reach.half_width_m);
        ChainPatch patch;
        patch.gather(reach, placed);
        std::vector<DiscSegment> segments;
        const std::size_t of_first_mesh = patch.cut(offset_m, 2, segments);
        EXPECT_EQ(of_first_mesh, segments.size());
        std::sort(segments.begin(), segments.end(),
                  [](const auto& a, const auto& b) { return a.triangle < b.triangle; });
        const auto cut = test::cut_by_hand(mesh.contact, disc_of(reach, pose, offset_m));
        ASSERT_EQ(segments.size(), cut.size());
        for (std::size_t k = 0; k < cut.size(); ++k) {
            ASSERT_EQ(segments[k].triangle, cut[k].triangle);
            ASSERT_EQ(segments[k].plane, 2U);
            ASSERT_TRUE(is_same_segment(segments[k], cut[k]));
        }
    }
}

TEST(ChainPatch, CutsOfTheFirstMeshComeFirstAndAreCounted) {
    const GripMesh ball = full_mesh(*test::make_wavy_ball(0.06, 16, 24));
    const GripMesh box = full_mesh(*test::make_box_mesh({0.04, 0.02, 0.03}));
    const ChainReach reach = {{}, 0.1, 0.01};
    const std::vector<PlacedMesh> one = {{&ball, {}}};
    const std::vector<PlacedMesh> both = {{&ball, {}}, {&box, {}}};
    ChainPatch patch;
    std::vector<DiscSegment> of_one;
    patch.gather(reach, one);
    patch.cut(0.003, 0, of_one);
    std::vector<DiscSegment> of_both;
    patch.gather(reach, both);
    const std::size_t of_first_mesh = patch.cut(0.003, 0, of_both);
    EXPECT_EQ(of_first_mesh, of_one.size());
    ASSERT_GT(of_both.size(), of_one.size());
    for (std::size_t i = 0; i < of_one.size(); ++i) {
        EXPECT_TRUE(is_same_segment(of_both[i], of_one[i]));
    }
}

TEST(ChainPatch, AsksOnlyWhatIsInReach) {
    const GripMesh mesh = full_mesh(test::make_torus(0.08, 0.03, 90, 48));
    const std::vector<PlacedMesh> placed = {{&mesh, {}}};
    ChainPatch patch;
    patch.gather({{Vec3(0.08, 0.04, 0.0), Quat::Identity()}, 0.03, 0.008}, placed);
    EXPECT_GT(patch.size(), 0U);
    EXPECT_LT(patch.size(), mesh.contact.triangles.size() / 20);
    patch.gather({{Vec3(0.0, 0.3, 0.0), Quat::Identity()}, 0.1, 0.008}, placed);
    EXPECT_EQ(patch.size(), 0U);
}

}  // namespace
}  // namespace handhold::chain_patch_test
