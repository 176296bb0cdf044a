#include "engine/geometry/chain_patch.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "broken_meshes.hpp"
#include "engine/geometry/segment_triangle.hpp"
#include "surface_cuts.hpp"

namespace handhold::chain_patch_test {
namespace {

using test::full_mesh;
using test::Random;

ChainReach random_reach(Random& random) {
    return {{random.vector(0.1), random.rotation()}, random.between(0.02, 0.12), 0.008};
}

// The disc of a reach's plane at `offset_m`, in the mesh's frame.
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

// Long segments are clipped to near the disc. True if `found` lies on `cut` and the part of `cut`
// within the disc lies on `found`.
bool is_same_segment(const DiscSegment& found, const DiscSegment& cut, double radius_m,
                     double same_m) {
    for (const Vec2& end : {found.a_ds, found.b_ds}) {
        if (test::point_to_segment(end, cut.a_ds, cut.b_ds) > same_m) {
            return false;
        }
    }
    const Vec2 along = cut.b_ds - cut.a_ds;
    const double at = -cut.a_ds.dot(along) / std::max(along.squaredNorm(), 1e-30);
    const Vec2 nearest = cut.a_ds + std::clamp(at, 0.0, 1.0) * along;
    for (const Vec2& point : {cut.a_ds, cut.b_ds, nearest}) {
        if (point.norm() < radius_m &&
            test::point_to_segment(point, found.a_ds, found.b_ds) > same_m) {
            return false;
        }
    }
    return true;
}

// Amplification of a corner's height error along a cut edge: edge length over height difference,
// the larger of the two cut edges, at least 1.
double slant(const SurfaceGraph& graph, std::uint32_t triangle, const Disc& disc) {
    double max_slant = 1.0;
    for (std::size_t i = 0; i < 3; ++i) {
        const Vec3& a = graph.positions[graph.triangles[triangle][i]];
        const Vec3& b = graph.positions[graph.triangles[triangle][(i + 1) % 3]];
        const double height_a = disc.normal.dot(a - disc.center);
        const double height_b = disc.normal.dot(b - disc.center);
        if ((height_a >= 0.0) != (height_b >= 0.0)) {
            max_slant = std::max(max_slant, (b - a).norm() / std::abs(height_b - height_a));
        }
    }
    return max_slant;
}

// Distance from the plane to the nearest corner.
double nearest_height_m(const SurfaceGraph& graph, std::uint32_t triangle, const Disc& disc) {
    double min_m = std::numeric_limits<double>::infinity();
    for (const std::uint32_t corner : graph.triangles[triangle]) {
        const Vec3 from_center = graph.positions[corner] - disc.center;
        min_m = std::min(min_m, std::abs(disc.normal.dot(from_center)));
    }
    return min_m;
}

struct Comparison {
    int cuts = 0;
    int undecided = 0;  // a corner lies in the plane, or the cut touches the disc's edge
};

// Oracle: cuts every triangle in doubles. Float rounding acts like shifting the plane by
// `rounding_m`.
void compare_cuts(const SurfaceGraph& graph, const Disc& disc, double rounding_m,
                  std::vector<DiscSegment> segments, Comparison& comparison) {
    std::sort(segments.begin(), segments.end(),
              [](const auto& a, const auto& b) { return a.triangle < b.triangle; });
    const auto is_decided = [&](const DiscSegment& cut) {
        const double nearest_m = test::point_to_segment(Vec2::Zero(), cut.a_ds, cut.b_ds);
        return nearest_height_m(graph, cut.triangle, disc) > rounding_m &&
               std::abs(nearest_m - disc.radius_m) > slant(graph, cut.triangle, disc) * rounding_m;
    };
    const auto cuts = test::cut_by_hand(graph, disc);
    auto found = segments.begin();
    for (const DiscSegment& cut : cuts) {
        ++comparison.cuts;
        while (found != segments.end() && found->triangle < cut.triangle) {
            ASSERT_FALSE(is_decided(*found)) << "not there: " << found->triangle;
            ++found;
        }
        if (found == segments.end() || found->triangle != cut.triangle) {
            ASSERT_FALSE(is_decided(cut)) << "left out: " << cut.triangle;
            ++comparison.undecided;
            continue;
        }
        if (nearest_height_m(graph, cut.triangle, disc) > rounding_m) {
            const double same_m = slant(graph, cut.triangle, disc) * rounding_m;
            ASSERT_TRUE(is_same_segment(*found, cut, disc.radius_m, same_m)) << cut.triangle;
        }
        ++found;
    }
    for (; found != segments.end(); ++found) {
        ASSERT_FALSE(is_decided(*found)) << "not there: " << found->triangle;
    }
}

TEST(ChainPatch, CutsEveryTriangleThatPlaneCrosses) {
    constexpr double k_rounding_m = 2e-7;  // of coordinates below 0.2 m
    Random random(1506);
    const GripMesh mesh =
        full_mesh(test::as_soup(test::make_torus(0.08, 0.03, 30, 16), 2e-3, random));
    Comparison comparison;
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
        for (const DiscSegment& segment : segments) {
            ASSERT_EQ(segment.plane, 2U);
        }
        compare_cuts(mesh.contact, disc_of(reach, pose, offset_m), k_rounding_m, segments,
                     comparison);
        if (HasFatalFailure()) {
            return;
        }
    }
    EXPECT_GT(comparison.cuts, 2000);
    EXPECT_LT(comparison.undecided, comparison.cuts / 1000);
}

TEST(ChainPatch, CutsOfFirstMeshComeFirstAndAreCounted) {
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
        EXPECT_EQ(of_both[i].a_ds, of_one[i].a_ds);
        EXPECT_EQ(of_both[i].b_ds, of_one[i].b_ds);
    }
}

TEST(ChainPatch, GathersOnlyTrianglesInReach) {
    const GripMesh mesh = full_mesh(test::make_torus(0.08, 0.03, 90, 48));
    const std::vector<PlacedMesh> placed = {{&mesh, {}}};
    ChainPatch patch;
    patch.gather({{Vec3(0.08, 0.04, 0.0), Quat::Identity()}, 0.03, 0.008}, placed);
    EXPECT_GT(patch.size(), 0U);
    EXPECT_LT(patch.size(), mesh.contact.triangles.size() / 20);
    patch.gather({{Vec3(0.0, 0.3, 0.0), Quat::Identity()}, 0.1, 0.008}, placed);
    EXPECT_EQ(patch.size(), 0U);
}

TEST(ChainPatch, BoxesDoNotChangeQueriesWithinThem) {
    Random random(1507);
    const GripMesh mesh = full_mesh(test::make_torus(0.08, 0.03, 90, 48));
    const std::vector<PlacedMesh> placed = {{&mesh, {}}};
    std::size_t gathered_in_all = 0;
    std::size_t gathered_in_boxes = 0;
    for (int i = 0; i < 300; ++i) {
        ChainReach reach = random_reach(random);
        ChainPatch all;
        all.gather(reach, placed);
        const double radius_m = reach.half_width_m;
        std::array<std::array<Vec2, 2>, 2> axes;
        for (std::array<Vec2, 2>& centre : axes) {
            centre[0] = random.vector(0.5 * reach.radius_m).head<2>();
            centre[1] = centre[0] + random.vector(0.3 * reach.radius_m).head<2>();
            ReachBox& box = reach.boxes[reach.box_count++];
            box.low = centre[0].cwiseMin(centre[1]).array() - radius_m;
            box.high = centre[0].cwiseMax(centre[1]).array() + radius_m;
        }
        ChainPatch boxed;
        boxed.gather(reach, placed);
        gathered_in_all += all.size();
        gathered_in_boxes += boxed.size();
        for (std::size_t box = 0; box < axes.size(); ++box) {
            const CapsulePenetration expected = all.find_penetration(axes[box], radius_m, box);
            const CapsulePenetration found = boxed.find_penetration(axes[box], radius_m, box);
            EXPECT_EQ(found.depth_m, expected.depth_m);
            EXPECT_EQ(found.crossed_at, expected.crossed_at);
        }
    }
    EXPECT_LT(gathered_in_boxes, gathered_in_all / 2);
}

// A torus in a mesh as wide as a hall, with a floor of two huge triangles.
Mesh ring_in_a_hall(const Vec3& at, double half_m) {
    Mesh mesh = test::make_torus(0.08, 0.03, 60, 32);
    for (Vec3& position : mesh.positions) {
        position += at;
    }
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    for (const double x : {-half_m, half_m}) {
        for (const double z : {-half_m, half_m}) {
            mesh.positions.emplace_back(x, at.y() - 0.031, z);
        }
    }
    mesh.triangles.push_back({first, first + 1, first + 2});
    mesh.triangles.push_back({first + 1, first + 3, first + 2});
    return mesh;
}

// Float rejection has to be safe anywhere in the mesh. Oracle: nearest_between over all triangles.
TEST(ChainPatch, FindsDeepestFarFromMeshCentre) {
    Random random(1510);
    for (const double half_m : {0.2, 5.0, 100.0}) {
        const Vec3 at(0.9 * half_m, 0.3 * half_m, -0.8 * half_m);
        const GripMesh mesh = full_mesh(ring_in_a_hall(at, half_m));
        const std::vector<PlacedMesh> placed = {{&mesh, {}}};
        int penetrating = 0;
        for (int i = 0; i < 200; ++i) {
            ChainReach reach = random_reach(random);
            reach.base.position += at;
            ChainPatch patch;
            patch.gather(reach, placed);
            const std::array<Vec2, 2> centre = {random.vector(0.4 * reach.radius_m).head<2>(),
                                                random.vector(0.4 * reach.radius_m).head<2>()};
            const auto to_mesh = [&](const Vec2& point) {
                return transform_point(reach.base, {0.0, -point.y(), -point.x()});
            };
            double nearest_m = reach.half_width_m;
            for (const auto& [a, b, c] : mesh.contact.triangles) {
                const Corners corners = {mesh.contact.positions[a], mesh.contact.positions[b],
                                         mesh.contact.positions[c]};
                nearest_m = std::min(
                    nearest_m,
                    nearest_between({to_mesh(centre[0]), to_mesh(centre[1])}, corners).distance_m);
            }
            const CapsulePenetration found = patch.find_penetration(centre, reach.half_width_m, 0);
            ASSERT_NEAR(found.nearest_m, nearest_m, 1e-9) << half_m << ", " << i;
            penetrating += found.depth_m > 0.0 ? 1 : 0;
        }
        EXPECT_GT(penetrating, 50) << half_m;
    }
}

// Cut errors grow with the distance from the mesh's centre: 0.05 mm in a mesh of 200 m.
TEST(ChainPatch, CutsFarFromMeshCentre) {
    Random random(1511);
    for (const double half_m : {0.2, 5.0, 100.0}) {
        const Vec3 at(0.9 * half_m, 0.3 * half_m, -0.8 * half_m);
        const GripMesh mesh = full_mesh(ring_in_a_hall(at, half_m));
        const std::vector<PlacedMesh> placed = {{&mesh, {}}};
        Comparison comparison;
        for (int i = 0; i < 200; ++i) {
            ChainReach reach = random_reach(random);
            reach.base.position += at;
            const double offset_m = random.between(-reach.half_width_m, reach.half_width_m);
            ChainPatch patch;
            patch.gather(reach, placed);
            std::vector<DiscSegment> segments;
            patch.cut(offset_m, 0, segments);
            const double rounding_m = 5e-7 * (half_m + reach.radius_m);
            compare_cuts(mesh.contact, disc_of(reach, {}, offset_m), rounding_m, segments,
                         comparison);
            if (HasFatalFailure()) {
                return;
            }
        }
        EXPECT_GT(comparison.cuts, 1000) << half_m;
        EXPECT_LT(comparison.undecided, comparison.cuts / 50) << half_m;
    }
}

}  // namespace
}  // namespace handhold::chain_patch_test
