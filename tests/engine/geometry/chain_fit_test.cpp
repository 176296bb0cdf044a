#include "engine/geometry/chain_fit.hpp"

#include <algorithm>
#include <functional>

#include <gtest/gtest.h>

#include "broken_meshes.hpp"
#include "surface_cuts.hpp"
#include "tests/engine/allocation_count.hpp"
#include "tests/engine/geometry/penetration_oracle.hpp"

namespace handhold::chain_fit_test {
namespace {

using test::Random;

constexpr double k_rad_per_deg = M_PI / 180.0;

// An index finger, stretched along -Z, that curls down.
HingeChain finger_at(const Pose& base) {
    HingeChain chain;
    chain.base = base;
    chain.length_m = {0.045, 0.026, 0.022};
    chain.radius_m = {0.009, 0.008, 0.007};
    chain.closed_rad = {75.0 * k_rad_per_deg, 105.0 * k_rad_per_deg, 75.0 * k_rad_per_deg};
    chain.rest_rad = {20.0 * k_rad_per_deg, 30.0 * k_rad_per_deg, 15.0 * k_rad_per_deg};
    return chain;
}

ChainFit fit(const HingeChain& chain, std::span<const PlacedMesh> meshes,
             const ChainFitSettings& settings = {}) {
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

// Knuckles 1 to 3 cm over the surface at the origin, whose outside is up; the finger tilted and
// rolled by at most so much.
Pose over_origin(double tilt_rad, double roll_rad, Random& random) {
    const Quat tilt = rotation_about(Vec3::UnitX(), random.between(-tilt_rad, tilt_rad));
    const Quat roll = rotation_about(Vec3::UnitZ(), random.between(-roll_rad, roll_rad));
    const Quat turn = rotation_about(Vec3::UnitY(), random.between(-M_PI, M_PI));
    const double height_m = random.between(0.012, 0.03);
    const double back_m = random.between(0.0, 0.04);
    return {turn * Vec3(0.0, height_m, back_m), (turn * tilt * roll).normalized()};
}

// Simplified, a mirrored mesh is not the mirror of what the mesh becomes.
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

// Stretched it touches nothing yet.
HingeChain clear_finger(const Scene& scene, double tilt_rad, double roll_rad, Random& random) {
    for (;;) {
        const HingeChain chain = finger_at(over_origin(tilt_rad, roll_rad, random));
        if (chain_gap_m(chain, ChainFit{}, scene.placed) > 2e-4) {
            return chain;
        }
    }
}

// Every fit that says it touches: not off by more than 0.1 mm, not sunk by more than penetration_m.
void expect_touching(const Scene& scene, double tilt_rad, double roll_rad, double penetration_m,
                     std::uint64_t seed) {
    Random random(seed);
    int touching = 0;
    for (int i = 0; i < 150; ++i) {
        const HingeChain chain = clear_finger(scene, tilt_rad, roll_rad, random);
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

TEST(FitChain, LaysFingersOnAPlane) {
    const Scene scene(*test::make_floor(0.5, 25));
    expect_touching(scene, 0.2, 0.0, 1e-4, 1701);
    expect_touching(scene, 0.2, 0.35, 1e-3, 1702);
}

TEST(FitChain, LaysFingersRoundABoxsEdge) {
    const Scene scene(lowered(*test::make_box_mesh({0.02, 0.02, 0.15}), 0.02));
    expect_touching(scene, 0.1, 0.1, 1e-3, 1703);
}

TEST(FitChain, LaysFingersRoundARail) {
    const Scene scene(lowered(test::make_tube(0.0175, 0.4, 48, 40), 0.0175));
    expect_touching(scene, 0.1, 0.1, 1e-3, 1704);
}

TEST(FitChain, OnAPlaneTheFirstLinkStopsWhereTrigonometrySays) {
    // Flat over the floor, one link: its end's centre comes to the height of its radius.
    const Scene scene(*test::make_floor(0.5, 25));
    HingeChain chain = finger_at({Vec3(0.003, 0.02, 0.01), Quat::Identity()});
    chain.link_count = 1;
    const ChainFit fitted = fit(chain, scene.placed);
    EXPECT_EQ(fitted.contact_link, 0);
    const double exact_rad = std::asin((0.02 - 0.009) / 0.045);
    EXPECT_NEAR(0.045 * fitted.angle_rad[0], 0.045 * exact_rad, 5e-5);
}

TEST(FitChain, IsTheSameInMovedAndTurnedWorldsTenKilometresAway) {
    const Scene scene(lowered(test::make_tube(0.0175, 0.4, 48, 40), 0.0175));
    Random random(1705);
    double worst_rad = 0.0;
    double worst_walked_m = 0.0;
    for (int i = 0; i < 100; ++i) {
        const HingeChain chain = clear_finger(scene, 0.2, 0.2, random);
        const Pose far = {1e4 * random.direction(), random.rotation()};
        HingeChain moved = chain;
        moved.base = far * chain.base;
        const std::vector<PlacedMesh> moved_mesh = {{&scene.mesh, far}};
        ChainFitScratch scratch;
        const ChainFit here = fit_chain(chain, scene.placed, {}, {}, scratch);
        const ChainFit there = fit_chain(moved, moved_mesh, {}, {}, scratch);
        EXPECT_EQ(here.contact_link, there.contact_link);
        for (std::size_t k = 0; k < 3; ++k) {
            worst_rad = std::max(worst_rad, std::abs(here.angle_rad[k] - there.angle_rad[k]));
        }
        const Vec3 tip = chain_capsules(chain, fit(chain, scene.placed).angle_rad)[2].ends[1];
        const Vec3 moved_tip = chain_capsules(chain, fit(moved, moved_mesh).angle_rad)[2].ends[1];
        worst_walked_m = std::max(worst_walked_m, (tip - moved_tip).norm());
    }
    EXPECT_LT(worst_rad, 1e-6);
    // Which of two triangles at an edge a walk begins in is decided by a rounding error, and with
    // it which corners within 0.25 mm of its line are left out.
    EXPECT_LT(worst_walked_m, 1.5e-3);
}

TEST(FitChain, OfAMirroredChainIsTheSame) {
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
        const HingeChain chain = clear_finger(left, 0.2, 0.2, random);
        HingeChain other = chain;
        const Quat& q = chain.base.rotation;
        other.base.position.x() = -chain.base.position.x();
        other.base.rotation = Quat(q.w(), q.x(), -q.y(), -q.z());
        ChainFitScratch scratch;
        const ChainFit a = fit_chain(chain, left.placed, {}, {}, scratch);
        const ChainFit b = fit_chain(other, right.placed, {}, {}, scratch);
        for (std::size_t k = 0; k < 3; ++k) {
            EXPECT_NEAR(a.angle_rad[k], b.angle_rad[k], 1e-6) << "case " << i;
        }
    }
}

TEST(FitChain, WithNothingToTouchIsRelaxed) {
    const Scene scene(*test::make_floor(0.5, 25));
    const HingeChain chain = finger_at({Vec3(0.0, 0.3, 0.0), Quat::Identity()});
    for (const auto meshes :
         {std::span<const PlacedMesh>(scene.placed), std::span<const PlacedMesh>()}) {
        const ChainFit fitted = fit(chain, meshes);
        EXPECT_EQ(fitted.fallback, ChainFallback::rest_pose);
        EXPECT_EQ(fitted.contact_link, DiscClosure::k_none);
        EXPECT_EQ(fitted.angle_rad, chain.rest_rad);
        EXPECT_EQ(fitted.depth_m, 0.0);
    }
}

TEST(FitChain, SunkWhenStraightIsBentUntilItIsClear) {
    // A wall 6 cm before the knuckles: stretched, the last two links are in it or beyond.
    Mesh wall = *test::make_box_mesh({0.3, 0.3, 0.1});
    for (Vec3& position : wall.positions) {
        position.z() -= 0.16;
    }
    const Scene scene(wall);
    const HingeChain chain = finger_at({});
    for (const bool searches : {true, false}) {
        ChainFitSettings settings;
        settings.searches = searches;
        const ChainFit fitted = fit(chain, scene.placed, settings);
        EXPECT_EQ(fitted.fallback, ChainFallback::sample_pose);
        const double gap_m = chain_gap_m(chain, fitted, scene.placed);
        EXPECT_GT(gap_m, -8e-4);
        EXPECT_LT(gap_m, 1e-3);
        EXPECT_LE(fitted.depth_m, 8e-4);
        EXPECT_GT(fitted.angle_rad[1], 0.2);
    }
}

// Drawn one by one: compilers differ in the order of arguments.
HingeChain finger_beside_a_box(Random& random) {
    const double beside_m = random.between(0.003, 0.012);
    const double height_m = random.between(0.0, 0.02);
    const double turn_rad = random.between(-0.15, 0.15);
    return finger_at(
        {Vec3(0.03 + beside_m, height_m, 0.0), rotation_about(Vec3::UnitY(), turn_rad)});
}

HingeChain finger_about_a_tube(Random& random) {
    const double x = random.between(-0.05, 0.05);
    const double y = random.between(-0.01, 0.03);
    const double z = random.between(-0.02, 0.06);
    return finger_at({Vec3(x, y, z), rotation_from_vector(random.vector(0.8))});
}

struct Mended {
    int count = 0;
    int touching = 0;
    int away = 0;  // those that say that they touch nothing
};

// Fingers that were sunk and came clear: what a fit says is held against the oracle's gaps.
Mended check_mended(const Scene& scene, const std::function<HingeChain(Random&)>& finger,
                    const ChainFitSettings& settings, std::uint32_t seed) {
    constexpr double k_touches_m = 2e-3;
    constexpr double k_oracle_m = 1e-6;
    Random random(seed);
    Mended mended;
    for (int i = 0; i < 400; ++i) {
        const HingeChain chain = finger(random);
        const ChainFit fitted = fit(chain, scene.placed, settings);
        const bool is_mended = fitted.fallback == ChainFallback::sample_pose ||
                               fitted.fallback == ChainFallback::opened;
        if (!is_mended || fitted.depth_m > settings.open_depth_m) {
            continue;
        }
        const double gap_m = chain_gap_m(chain, fitted, scene.placed);
        ++mended.count;
        mended.touching += gap_m <= k_touches_m ? 1 : 0;
        EXPECT_GE(gap_m, -settings.open_depth_m - k_oracle_m) << "case " << i;
        if (fitted.contact_link != DiscClosure::k_none) {
            EXPECT_LE(gap_m, k_touches_m) << "case " << i;
            continue;
        }
        ++mended.away;
        EXPECT_GE(gap_m, -k_oracle_m) << "case " << i;
        ChainFit relaxed;
        relaxed.angle_rad = chain.rest_rad;
        if (chain_gap_m(chain, relaxed, scene.placed) > 0.0) {
            EXPECT_EQ(fitted.angle_rad, chain.rest_rad) << "case " << i;
        }
    }
    return mended;
}

// Beside a box that it grazes, and about a tube.
TEST(FitChain, BentClearComesBackUntilItTouches) {
    const Scene box(lowered(*test::make_box_mesh({0.03, 0.02, 0.1}), 0.03));
    const Scene tube(lowered(test::make_tube(0.0175, 0.4, 48, 40), 0.0175));
    const Mended beside = check_mended(box, finger_beside_a_box, {}, 1721);
    const Mended about = check_mended(tube, finger_about_a_tube, {}, 1722);
    EXPECT_GE(std::min(beside.count, about.count), 40);
    EXPECT_EQ(beside.touching, beside.count);
    EXPECT_EQ(about.touching, about.count);
}

// As sliding_refit_settings has it (systems/hand/shared/finger_chain.hpp). The counts are floors
// below what any compiler comes to: each kind has to be there.
TEST(FitChain, BentClearInASlideTouchesOrIsAtEase) {
    const Scene box(lowered(*test::make_box_mesh({0.03, 0.02, 0.1}), 0.03));
    const Scene tube(lowered(test::make_tube(0.0175, 0.4, 48, 40), 0.0175));
    ChainFitSettings settings;
    settings.searches = false;
    settings.recloses_to_touch = false;
    const Mended beside = check_mended(box, finger_beside_a_box, settings, 1721);
    const Mended about = check_mended(tube, finger_about_a_tube, settings, 1722);
    EXPECT_GE(beside.touching, 85);
    EXPECT_GE(about.touching, 20);
    EXPECT_GE(std::min(beside.away, about.away), 20);
}

// Of those that came to touch by bending, how far they are from where they were to be near to.
double distance_to_near_rad(const Scene& scene, const ChainAngles& near_rad,
                            const ChainFitSettings& how) {
    Random random(1723);
    double off_rad = 0.0;
    for (int i = 0; i < 400; ++i) {
        const ChainFit fitted = fit(finger_about_a_tube(random), scene.placed, how);
        if (fitted.fallback == ChainFallback::sample_pose && fitted.depth_m <= how.open_depth_m) {
            for (std::size_t link = 0; link < near_rad.size(); ++link) {
                off_rad += std::abs(fitted.angle_rad[link] - near_rad[link]);
            }
        }
    }
    return off_rad;
}

TEST(FitChain, BentClearIsNearToWhereItIsToBe) {
    const Scene tube(lowered(test::make_tube(0.0175, 0.4, 48, 40), 0.0175));
    const ChainFitSettings at_ease;
    for (const double curl_rad : {0.0, 1.2}) {
        ChainFitSettings near = at_ease;
        near.near_rad.emplace().fill(curl_rad);
        EXPECT_LT(distance_to_near_rad(tube, *near.near_rad, near),
                  0.95 * distance_to_near_rad(tube, *near.near_rad, at_ease))
            << curl_rad;
    }
}

// A designer may have digits mended that are not sunk so deep as to be opened: what does not move
// is not bent.
TEST(FitChain, WhatIsMendedIsLessSunkOrSaysThatItStayed) {
    const Scene tube(lowered(test::make_tube(0.0175, 0.4, 48, 40), 0.0175));
    ChainFitSettings settings;
    settings.search_depth_m = 1e-4;
    settings.open_depth_m = 2e-3;
    ChainFitSettings as_closed = settings;
    as_closed.depenetrates = false;
    Random random(1724);
    int bent = 0;
    for (int i = 0; i < 1000; ++i) {
        const HingeChain chain = finger_about_a_tube(random);
        const ChainFit mended = fit(chain, tube.placed, settings);
        if (mended.fallback == ChainFallback::sample_pose) {
            ++bent;
            EXPECT_LT(mended.depth_m, fit(chain, tube.placed, as_closed).depth_m) << "case " << i;
        }
    }
    EXPECT_GE(bent, 100);
}

// Where no search is asked for, what is sunk before it closes is bent clear from there: hardly
// deeper than what is closed first. The bends are the same, but not what they are measured against.
TEST(FitChain, WithoutSearchesIsHardlyDeeperThanWithThem) {
    constexpr double k_hardly_m = 2e-3;
    Random random(2717);
    const Scene ball(test::make_clean_ball(0.06, 16, 24));
    int sunk = 0;
    for (int i = 0; i < 1000; ++i) {
        const Pose base{random.vector(0.12), rotation_from_vector(random.vector(M_PI))};
        const HingeChain chain = finger_at(base);
        ChainFitSettings settings;
        settings.searches = false;
        const ChainFit without = fit(chain, ball.placed, settings);
        const ChainFit with = fit(chain, ball.placed);
        sunk += with.depth_m > settings.search_depth_m ? 1 : 0;
        EXPECT_LE(without.depth_m, std::max(with.depth_m, settings.open_depth_m) + k_hardly_m) << i;
    }
    EXPECT_GT(sunk, 30);
}

TEST(FitChain, SecondMeshUnderTheFingerStopsItToo) {
    const Scene floor(*test::make_floor(0.5, 25));
    const GripMesh block = build_grip_mesh(*test::make_box_mesh({0.05, 0.005, 0.02}));
    const HingeChain chain = finger_at({Vec3(0.0, 0.03, 0.0), Quat::Identity()});
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
        GTEST_SKIP() << "the sanitizers bring operators of their own";
    }
    const Scene scene(lowered(test::make_tube(0.0175, 0.4, 48, 40), 0.0175));
    ChainFitScratch scratch;
    std::size_t before = 0;
    for (int round = 0; round < 2; ++round) {
        Random random(1707);
        before = allocation_count();
        for (int i = 0; i < 50; ++i) {
            const HingeChain chain = finger_at(over_origin(0.3, 0.3, random));
            fit_chain(chain, scene.placed, {}, {}, scratch);
            fit_chain(chain, scene.placed, {{{0, Vec3::Zero()}}}, {}, scratch);
        }
    }
    EXPECT_EQ(allocation_count(), before);
}

TEST(FindSunk, IsTheDeepestOfAllTrianglesInAnyFrame) {
    Random random(1708);
    const GripMesh ball = build_grip_mesh(*test::make_wavy_ball(0.06, 16, 24));
    const GripMesh box = build_grip_mesh(*test::make_box_mesh({0.04, 0.02, 0.03}));
    int crossed = 0;
    for (int i = 0; i < 300; ++i) {
        const Pose frame = {random.vector(3.0), random.rotation()};
        const std::vector<PlacedMesh> meshes = {
            {&ball, frame * test::at(random.vector(0.05), random.rotation())},
            {&box, frame * test::at(random.vector(0.05), random.rotation())}};
        Capsule capsule;
        capsule.ends = {transform_point(frame, random.vector(0.1)),
                        transform_point(frame, random.vector(0.1))};
        capsule.radius_m = random.between(0.004, 0.012);
        const CapsulePenetration sunk = find_penetration(capsule, meshes);
        EXPECT_NEAR(sunk.depth_m, std::max(0.0, -test::gap_m(capsule, meshes)), 1e-8) << i;
        // The first of the surfaces on the way along the middle.
        std::optional<double> first;
        for (const PlacedMesh& placed : meshes) {
            const auto hit = placed.mesh->contact_bvh.cast_ray(
                inverse_transform_point(placed.pose, capsule.ends[0]),
                inverse_transform_point(placed.pose, capsule.ends[1]));
            if (hit) {
                const double at = hit->distance_m / (capsule.ends[1] - capsule.ends[0]).norm();
                first = std::min(first.value_or(1.0), at);
            }
        }
        ASSERT_EQ(sunk.crossed_at.has_value(), first.has_value()) << i;
        if (first) {
            ++crossed;
            EXPECT_NEAR(*sunk.crossed_at, *first, 1e-9) << i;
        }
    }
    EXPECT_GT(crossed, 50);
}

}  // namespace
}  // namespace handhold::chain_fit_test
