#include "engine/geometry/chain_fit.hpp"

#include <algorithm>
#include <functional>

#include <gtest/gtest.h>

#include "broken_meshes.hpp"
#include "surface_cuts.hpp"
#include "tests/engine/allocation_count.hpp"
#include "tests/engine/geometry/penetration_oracle.hpp"
#include "tests/engine/geometry/three_link_chain.hpp"

namespace handhold::chain_fit_test {
namespace {

using test::chain_fit_settings;
using test::Random;
using test::three_link_chain;

ChainFit fit(const HingeChain& chain, std::span<const PlacedMesh> meshes,
             const ChainFitSettings& settings = chain_fit_settings()) {
    ChainFitScratch scratch;
    ChainSeed seed;
    if (!meshes.empty()) {
        const Vec3 base = inverse_transform_point(meshes[0].pose, chain.base.position);
        if (const auto near = meshes[0].mesh->search_bvh.closest_point(base, 0.2)) {
            seed = {{{near->triangle, near->point}}};
        }
    }
    return fit_chain(chain, meshes, seed, settings, scratch);
}

double chain_gap_m(const HingeChain& chain, const ChainFit& fitted,
                   std::span<const PlacedMesh> meshes) {
    double least_m = 1.0;
    const auto capsules = chain_capsules(chain, fitted.angle_rad);
    for (std::size_t i = 0; i < chain.link_count; ++i) {
        least_m = std::min(least_m, test::gap_m(capsules[i], meshes));
    }
    return least_m;
}

// A base 1 to 3 cm above the origin, where the surface faces up. Tilt and roll are random up to the
// given angles; the heading is arbitrary.
Pose over_origin(double tilt_rad, double roll_rad, Random& random) {
    const Quat tilt = rotation_about(Vec3::UnitX(), random.between(-tilt_rad, tilt_rad));
    const Quat roll = rotation_about(Vec3::UnitZ(), random.between(-roll_rad, roll_rad));
    const Quat turn = rotation_about(Vec3::UnitY(), random.between(-M_PI, M_PI));
    const double height_m = random.between(0.012, 0.03);
    const double back_m = random.between(0.0, 0.04);
    return {turn * Vec3(0.0, height_m, back_m), (turn * tilt * roll).normalized()};
}

// Simplification would break mirror symmetry.
GripMeshSettings at_full_detail() {
    GripMeshSettings settings;
    settings.contact.deviation_m = 0.0;
    return settings;
}

struct Scene {
    GripMesh mesh;
    std::vector<PlacedMesh> placed;
    explicit Scene(const Mesh& source, const Pose& pose = {})
        : mesh(build_grip_mesh(source, at_full_detail())), placed{{&mesh, pose}} {}
    Scene(const Scene&) = delete;
    Scene& operator=(const Scene&) = delete;
};

Mesh lowered(Mesh mesh, double by_m) {
    for (Vec3& position : mesh.positions) {
        position.y() -= by_m;
    }
    return mesh;
}

// A chain that is clear when open.
HingeChain clear_chain(const Scene& scene, double tilt_rad, double roll_rad, Random& random) {
    for (;;) {
        const HingeChain chain = three_link_chain(over_origin(tilt_rad, roll_rad, random));
        if (chain_gap_m(chain, ChainFit{}, scene.placed) > 2e-4) {
            return chain;
        }
    }
}

// Every fit that reports contact has a gap below 0.1 mm; every fit penetrates at most
// penetration_m.
void expect_touching(const Scene& scene, double tilt_rad, double roll_rad, double penetration_m,
                     std::uint64_t seed) {
    Random random(seed);
    int touching = 0;
    for (int i = 0; i < 150; ++i) {
        const HingeChain chain = clear_chain(scene, tilt_rad, roll_rad, random);
        const ChainFit fitted = fit(chain, scene.placed);
        const double gap = chain_gap_m(chain, fitted, scene.placed);
        EXPECT_NEAR(fitted.depth_m, std::max(0.0, -gap), 1e-7) << "case " << i;
        EXPECT_GT(gap, -penetration_m) << "case " << i;
        if (fitted.contact_link != DiscClosure::k_none &&
            (fitted.fallback == ChainFallback::none ||
             fitted.fallback == ChainFallback::all_cuts)) {
            ++touching;
            EXPECT_LT(gap, 1e-4) << "case " << i;
        }
    }
    EXPECT_GT(touching, 100);
}

TEST(FitChain, TouchesPlane) {
    const Scene scene(*test::make_floor(0.5, 25));
    expect_touching(scene, 0.2, 0.0, 1e-4, 1701);
    expect_touching(scene, 0.2, 0.35, 1e-3, 1702);
}

TEST(FitChain, WrapsBoxEdge) {
    const Scene scene(lowered(*test::make_box_mesh({0.02, 0.02, 0.15}), 0.02));
    expect_touching(scene, 0.1, 0.1, 1e-3, 1703);
}

TEST(FitChain, WrapsRail) {
    const Scene scene(lowered(test::make_tube(0.0175, 0.4, 48, 40), 0.0175));
    expect_touching(scene, 0.1, 0.1, 1e-3, 1704);
}

TEST(FitChain, SingleLinkStopsOnPlaneAtClosedFormAngle) {
    // The link's end centre stops at a height equal to its radius: sin(angle) = (h - r) / l.
    const Scene scene(*test::make_floor(0.5, 25));
    HingeChain chain = three_link_chain(Vec3(0.003, 0.02, 0.01));
    chain.link_count = 1;
    const ChainFit fitted = fit(chain, scene.placed);
    EXPECT_EQ(fitted.contact_link, 0);
    const double exact_rad = std::asin((0.02 - 0.009) / 0.045);
    EXPECT_NEAR(0.045 * fitted.angle_rad[0], 0.045 * exact_rad, 5e-5);
}

TEST(FitChain, SameInWorldMovedTenKilometresAndRotated) {
    const Scene scene(lowered(test::make_tube(0.0175, 0.4, 48, 40), 0.0175));
    Random random(1705);
    double worst_rad = 0.0;
    double worst_walked_m = 0.0;
    for (int i = 0; i < 100; ++i) {
        const HingeChain chain = clear_chain(scene, 0.2, 0.2, random);
        const Pose far = {1e4 * random.direction(), random.rotation()};
        HingeChain moved = chain;
        moved.base = far * chain.base;
        const std::vector<PlacedMesh> moved_mesh = {{&scene.mesh, far}};
        ChainFitScratch scratch;
        const ChainFit here = fit_chain(chain, scene.placed, {}, chain_fit_settings(), scratch);
        const ChainFit there = fit_chain(moved, moved_mesh, {}, chain_fit_settings(), scratch);
        EXPECT_EQ(here.contact_link, there.contact_link);
        for (std::size_t k = 0; k < 3; ++k) {
            worst_rad = std::max(worst_rad, std::abs(here.angle_rad[k] - there.angle_rad[k]));
        }
        const Vec3 tip = chain_capsules(chain, fit(chain, scene.placed).angle_rad)[2].ends[1];
        const Vec3 moved_tip = chain_capsules(chain, fit(moved, moved_mesh).angle_rad)[2].ends[1];
        worst_walked_m = std::max(worst_walked_m, (tip - moved_tip).norm());
    }
    EXPECT_LT(worst_rad, 1e-6);
    // A rounding error decides in which of two triangles at an edge the walk starts, and thereby
    // which corners the 0.25 mm simplification drops.
    EXPECT_LT(worst_walked_m, 1.5e-3);
}

TEST(FitChain, MirroredChainGetsMirroredFit) {
    Random random(1706);
    const Mesh tube = lowered(test::make_tube(0.0175, 0.4, 48, 40), 0.0175);
    Mesh mirrored = tube;
    for (Vec3& position : mirrored.positions) {
        position.x() = -position.x();
    }
    for (auto& triangle : mirrored.triangles) {
        std::swap(triangle[1], triangle[2]);
    }
    const Scene left(tube);
    const Scene right(mirrored);
    for (int i = 0; i < 100; ++i) {
        const HingeChain chain = clear_chain(left, 0.2, 0.2, random);
        HingeChain other = chain;
        const Quat& q = chain.base.rotation;
        other.base.position.x() = -chain.base.position.x();
        other.base.rotation = Quat(q.w(), q.x(), -q.y(), -q.z());
        ChainFitScratch scratch;
        const ChainFit a = fit_chain(chain, left.placed, {}, chain_fit_settings(), scratch);
        const ChainFit b = fit_chain(other, right.placed, {}, chain_fit_settings(), scratch);
        for (std::size_t k = 0; k < 3; ++k) {
            EXPECT_NEAR(a.angle_rad[k], b.angle_rad[k], 1e-6) << "case " << i;
        }
    }
}

TEST(FitChain, RestPoseIfNothingIsInReach) {
    const Scene scene(*test::make_floor(0.5, 25));
    const HingeChain chain = three_link_chain(Vec3(0.0, 0.3, 0.0));
    for (const auto meshes :
         {std::span<const PlacedMesh>(scene.placed), std::span<const PlacedMesh>()}) {
        const ChainFit fitted = fit(chain, meshes);
        EXPECT_EQ(fitted.fallback, ChainFallback::rest_pose);
        EXPECT_EQ(fitted.contact_link, DiscClosure::k_none);
        EXPECT_EQ(fitted.angle_rad, chain.rest_rad);
        EXPECT_EQ(fitted.depth_m, 0.0);
    }
}

TEST(FitChain, ChainThatPenetratesWhenOpenBendsUntilClear) {
    // A wall 6 cm ahead of the base: in the open pose the last two links are inside or beyond it.
    Mesh wall = *test::make_box_mesh({0.3, 0.3, 0.1});
    for (Vec3& position : wall.positions) {
        position.z() -= 0.16;
    }
    const Scene scene(wall);
    const HingeChain chain = three_link_chain(Pose{});
    const ChainFit fitted = fit(chain, scene.placed);
    EXPECT_EQ(fitted.fallback, ChainFallback::sample_pose);
    const double gap_m = chain_gap_m(chain, fitted, scene.placed);
    EXPECT_GT(gap_m, -8e-4);
    EXPECT_LT(gap_m, 1e-3);
    EXPECT_LE(fitted.depth_m, 8e-4);
    EXPECT_GT(fitted.angle_rad[1], 0.2);
}

// Random numbers are drawn in separate statements: compilers order function arguments differently.
HingeChain chain_beside_box(Random& random) {
    const double beside_m = random.between(0.003, 0.012);
    const double height_m = random.between(0.0, 0.02);
    const double turn_rad = random.between(-0.15, 0.15);
    return three_link_chain(
        Pose{Vec3(0.03 + beside_m, height_m, 0.0), rotation_about(Vec3::UnitY(), turn_rad)});
}

HingeChain chain_around_tube(Random& random) {
    const double x = random.between(-0.05, 0.05);
    const double y = random.between(-0.01, 0.03);
    const double z = random.between(-0.02, 0.06);
    return three_link_chain(Pose{Vec3(x, y, z), rotation_from_vector(random.vector(0.8))});
}

struct Depenetrated {
    int count = 0;
    int touching = 0;
    int away = 0;  // fits that report no contact
};

// Counts the chains that were depenetrated and checks their fits against the oracle's gaps.
Depenetrated check_depenetrated(const Scene& scene,
                                const std::function<HingeChain(Random&)>& make_chain,
                                const ChainFitSettings& settings, std::uint32_t seed) {
    constexpr double k_touches_m = 2e-3;
    constexpr double k_oracle_m = 1e-6;
    Random random(seed);
    Depenetrated result;
    for (int i = 0; i < 400; ++i) {
        const HingeChain chain = make_chain(random);
        const ChainFit fitted = fit(chain, scene.placed, settings);
        const bool is_depenetrated = fitted.fallback == ChainFallback::sample_pose ||
                                     fitted.fallback == ChainFallback::opened;
        if (!is_depenetrated || fitted.depth_m > settings.open_depth_m) {
            continue;
        }
        const double gap_m = chain_gap_m(chain, fitted, scene.placed);
        ++result.count;
        result.touching += gap_m <= k_touches_m ? 1 : 0;
        EXPECT_GE(gap_m, -settings.open_depth_m - k_oracle_m) << "case " << i;
        if (fitted.contact_link != DiscClosure::k_none) {
            EXPECT_LE(gap_m, k_touches_m) << "case " << i;
            continue;
        }
        ++result.away;
        EXPECT_GE(gap_m, -k_oracle_m) << "case " << i;
        ChainFit rest;
        rest.angle_rad = chain.rest_rad;
        if (chain_gap_m(chain, rest, scene.placed) > 0.0) {
            EXPECT_EQ(fitted.angle_rad, chain.rest_rad) << "case " << i;
        }
    }
    return result;
}

TEST(FitChain, ClearSamplePoseClosesUntilItTouches) {
    const Scene box(lowered(*test::make_box_mesh({0.03, 0.02, 0.1}), 0.03));
    const Scene tube(lowered(test::make_tube(0.0175, 0.4, 48, 40), 0.0175));
    const Depenetrated beside =
        check_depenetrated(box, chain_beside_box, chain_fit_settings(), 1721);
    const Depenetrated about =
        check_depenetrated(tube, chain_around_tube, chain_fit_settings(), 1722);
    EXPECT_GE(std::min(beside.count, about.count), 40);
    EXPECT_EQ(beside.touching, beside.count);
    EXPECT_EQ(about.touching, about.count);
}

// With search_depth_m < open_depth_m a fit that is shallow enough to count as clear is
// depenetrated. It must only be reported as a sample pose if it improved.
TEST(FitChain, SamplePosePenetratesLessThanClosedPose) {
    const Scene tube(lowered(test::make_tube(0.0175, 0.4, 48, 40), 0.0175));
    ChainFitSettings settings = chain_fit_settings();
    settings.search_depth_m = 1e-4;
    settings.open_depth_m = 2e-3;
    ChainFitSettings as_closed = settings;
    as_closed.depenetrates = false;
    Random random(1724);
    int sample_poses = 0;
    for (int i = 0; i < 1000; ++i) {
        const HingeChain chain = chain_around_tube(random);
        const ChainFit fitted = fit(chain, tube.placed, settings);
        if (fitted.fallback == ChainFallback::sample_pose) {
            ++sample_poses;
            EXPECT_LT(fitted.depth_m, fit(chain, tube.placed, as_closed).depth_m) << "case " << i;
        }
    }
    EXPECT_GE(sample_poses, 100);
}

TEST(FitChain, SecondMeshStopsChainToo) {
    const Scene floor(*test::make_floor(0.5, 25));
    const GripMesh block = build_grip_mesh(*test::make_box_mesh({0.05, 0.005, 0.02}));
    const HingeChain chain = three_link_chain(Vec3(0.0, 0.03, 0.0));
    std::vector<PlacedMesh> both = floor.placed;
    both.push_back({&block, test::at({0.0, 0.005, -0.05})});
    const ChainFit fitted = fit(chain, both);
    const double gap = chain_gap_m(chain, fitted, both);
    EXPECT_LT(gap, 1e-4);
    EXPECT_GT(gap, -1e-3);
    EXPECT_GT(chain_gap_m(chain, fit(chain, floor.placed), floor.placed), -1e-3);
    EXPECT_LT(fitted.angle_rad[0], fit(chain, floor.placed).angle_rad[0] - 0.01);
}

TEST(FitChain, AllocatesNothingOnceWarm) {
    if (!counts_allocations()) {
        GTEST_SKIP() << "sanitizers replace operator new";
    }
    const Scene scene(lowered(test::make_tube(0.0175, 0.4, 48, 40), 0.0175));
    ChainFitScratch scratch;
    std::size_t before = 0;
    for (int round = 0; round < 2; ++round) {
        Random random(1707);
        before = allocation_count();
        for (int i = 0; i < 50; ++i) {
            const HingeChain chain = three_link_chain(over_origin(0.3, 0.3, random));
            fit_chain(chain, scene.placed, {}, chain_fit_settings(), scratch);
            fit_chain(chain, scene.placed, {{{0, Vec3::Zero()}}}, chain_fit_settings(), scratch);
        }
    }
    EXPECT_EQ(allocation_count(), before);
}

}  // namespace
}  // namespace handhold::chain_fit_test
