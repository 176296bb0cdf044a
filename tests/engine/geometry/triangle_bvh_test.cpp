#include "engine/geometry/triangle_bvh.hpp"

#include <cmath>
#include <limits>
#include <set>

#include <gtest/gtest.h>

#include "data_meshes.hpp"
#include "engine/collision/closest_point.hpp"
#include "tests/engine/allocation_count.hpp"
#include "tests/engine/collision/scene.hpp"

// The oracle looks at every triangle.
namespace handhold::triangle_bvh_test {
namespace {

using test::Random;

Corners corners_of(const Mesh& mesh, std::size_t t) {
    const auto& [a, b, c] = mesh.triangles[t];
    return {mesh.positions[a], mesh.positions[b], mesh.positions[c]};
}

// Triangles of sizes from a thousandth to the whole, slivers, points and lines among them.
Mesh make_soup(Random& random, std::size_t count) {
    Mesh mesh;
    for (std::size_t t = 0; t < count; ++t) {
        const double size = std::pow(10.0, random.between(-3.0, 0.0));
        const Vec3 centre = random.vector(1.0);
        const auto first = static_cast<std::uint32_t>(mesh.positions.size());
        Vec3 a = random.vector(size);
        Vec3 b = random.vector(size);
        Vec3 c = random.vector(size);
        const double kind = random.between(0.0, 1.0);
        if (kind < 0.1) {
            c = a + random.between(0.0, 1.0) * (b - a) +
                random.vector(std::pow(10.0, random.between(-13.0, -6.0)));
        } else if (kind < 0.12) {
            b = c = a;
        }
        for (const Vec3& corner : {a, b, c}) {
            mesh.positions.push_back(centre + corner);
        }
        mesh.triangles.push_back({first, first + 1, first + 2});
    }
    return mesh;
}

// Möller and Trumbore, 1997, in long double: shares nothing with the tested form. Fraction of the
// way; negative: no hit, or nearer to an edge than rounding can tell.
struct OracleRay {
    long double fraction = 2.0L;
    bool clear = true;  // no triangle's edge comes near enough to the ray for rounding to decide
};
OracleRay oracle_ray(const Mesh& mesh, const Vec3& from, const Vec3& to) {
    using V = Eigen::Matrix<long double, 3, 1>;
    OracleRay result;
    const V start = from.cast<long double>();
    const V way = to.cast<long double>() - start;
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        const Corners c = corners_of(mesh, t);
        const V a = c[0].cast<long double>();
        const V ab = c[1].cast<long double>() - a;
        const V ac = c[2].cast<long double>() - a;
        const V p = way.cross(ac);
        const long double det = ab.dot(p);
        if (std::abs(det) < 1e-14L * ab.norm() * ac.norm() * way.norm()) {
            continue;  // from the edge, or a sliver: found by neither, or by chance
        }
        const V s = start - a;
        const long double u = s.dot(p) / det;
        const V q = s.cross(ab);
        const long double v = way.dot(q) / det;
        const long double fraction = ac.dot(q) / det;
        constexpr long double k_near = 1e-7L;
        if (u < -k_near || v < -k_near || u + v > 1.0L + k_near || fraction < -k_near ||
            fraction > 1.0L + k_near) {
            continue;
        }
        if (u < k_near || v < k_near || u + v > 1.0L - k_near || fraction < k_near ||
            fraction > 1.0L - k_near) {
            result.clear = false;
        } else {
            result.fraction = std::min(result.fraction, fraction);
        }
    }
    return result;
}

std::optional<TriangleHit> oracle_closest(const Mesh& mesh, const Vec3& point, double most_m) {
    std::optional<TriangleHit> best;
    double best_squared = most_m * most_m;
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
        const Vec3 on_triangle = closest_on_triangle(point, corners_of(mesh, t));
        const double squared = (on_triangle - point).squaredNorm();
        if (best ? squared < best_squared : squared <= best_squared) {
            best = TriangleHit{t, on_triangle, std::sqrt(squared)};
            best_squared = squared;
        }
    }
    return best;
}

double size_of(const Mesh& mesh) {
    double most = 0.0;
    for (const Vec3& position : mesh.positions) {
        most = std::max(most, (position - mesh.positions[0]).norm());
    }
    return most;
}

void expect_rays(const Mesh& mesh, const TriangleBvh& bvh, Random& random, int rounds) {
    const double size = size_of(mesh);
    int hits = 0;
    int clear = 0;
    for (int round = 0; round < rounds; ++round) {
        const Vec3 from = mesh.positions[0] + random.vector(size);
        const auto some = static_cast<std::size_t>(
            random.between(0.0, static_cast<double>(mesh.positions.size())));
        const Vec3 to = from + random.between(0.5, 2.0) *
                                   (mesh.positions[some] + random.vector(0.01 * size) - from);
        const OracleRay oracle = oracle_ray(mesh, from, to);
        if (!oracle.clear) {
            continue;
        }
        ++clear;
        const auto hit = bvh.cast_ray(from, to);
        ASSERT_EQ(hit.has_value(), oracle.fraction <= 1.0L) << round;
        if (hit) {
            ++hits;
            const double expected = static_cast<double>(oracle.fraction) * (to - from).norm();
            ASSERT_NEAR(hit->distance_m, expected, 1e-9 * size) << round;
            ASSERT_LT(
                (closest_on_triangle(hit->point, corners_of(mesh, hit->triangle)) - hit->point)
                    .norm(),
                1e-9 * size);
        }
    }
    EXPECT_GT(clear, rounds / 2);
    EXPECT_GT(hits, rounds / 20);
}

void expect_nearest_and_spheres(const Mesh& mesh, const TriangleBvh& bvh, Random& random,
                                int rounds) {
    const double size = size_of(mesh);
    for (int round = 0; round < rounds; ++round) {
        const auto some = static_cast<std::size_t>(
            random.between(0.0, static_cast<double>(mesh.positions.size())));
        const double away = size * std::pow(10.0, random.between(-5.0, 0.5));
        const Vec3 point = mesh.positions[some] + random.vector(away);
        const double most = round % 3 == 0 ? std::numeric_limits<double>::infinity() : away;
        const auto hit = bvh.closest_point(point, most);
        const auto oracle = oracle_closest(mesh, point, most);
        ASSERT_EQ(hit.has_value(), oracle.has_value());
        if (hit) {  // the same closed form on the same triangles: the same bits
            ASSERT_EQ(hit->triangle, oracle->triangle);
            ASSERT_EQ(hit->distance_m, oracle->distance_m);
            ASSERT_EQ(hit->point, oracle->point);
        }
        std::set<std::uint32_t> visited;
        bvh.visit_in_sphere(point, away,
                            [&](std::uint32_t t) { ASSERT_TRUE(visited.insert(t).second); });
        for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
            const double squared =
                (closest_on_triangle(point, corners_of(mesh, t)) - point).squaredNorm();
            ASSERT_EQ(visited.count(t) == 1, squared <= away * away) << t;
        }
    }
}

TEST(TriangleBvh, AnswersAsALookAtEveryTriangleOfASoup) {
    Random random(801);
    for (const std::size_t count : {1U, 2U, 3U, 9U, 40U, 300U, 2000U}) {
        SCOPED_TRACE(count);
        const Mesh soup = make_soup(random, count);
        const TriangleBvh bvh(soup.positions, soup.triangles);
        EXPECT_EQ(bvh.triangle_count(), count);
        if (count >= 300) {  // fewer are hardly ever hit
            expect_rays(soup, bvh, random, 300);
        }
        expect_nearest_and_spheres(soup, bvh, random, 100);
    }
}

TEST(TriangleBvh, AnswersAsALookAtEveryTriangleOfRealMeshes) {
    Random random(802);
    int meshes = 0;
    for (const char* folder : {"objects", "nasty"}) {
        for (const auto& path : test::data_files(folder)) {
            SCOPED_TRACE(path);
            const Mesh mesh = test::load_whole(path);
            if (mesh.triangles.empty()) {
                continue;
            }
            const TriangleBvh bvh(mesh.positions, mesh.triangles);
            expect_rays(mesh, bvh, random, 40);
            expect_nearest_and_spheres(mesh, bvh, random, 15);
            ++meshes;
        }
    }
    if (meshes == 0) {
        GTEST_SKIP() << "no mesh data";
    }
}

TEST(TriangleBvh, LetsNoRaySlipThroughSharedEdgesAndCorners) {
    Random random(803);
    const auto ball = test::make_wavy_ball(1.0, 24, 40);
    const TriangleBvh bvh(ball->positions, ball->triangles);
    int rays = 0;
    for (std::size_t t = 0; t < ball->triangles.size(); ++t) {
        const Corners corners = corners_of(*ball, t);
        for (const double share : {0.0, 0.25, 0.5, random.between(0.0, 1.0)}) {
            // From the middle to beyond a point of an edge, the poles' points without length too.
            const Vec3 target = (1.0 - share) * corners[0] + share * corners[1];
            ASSERT_TRUE(bvh.cast_ray(random.vector(0.3), 1.5 * target).has_value());
            ++rays;
        }
    }
    EXPECT_GT(rays, 5000);
}

TEST(TriangleBvh, SeesBothSidesOfATriangle) {
    const std::vector<Vec3> positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    const std::vector<std::array<std::uint32_t, 3>> triangles = {{0, 1, 2}};
    const TriangleBvh bvh(positions, triangles);
    for (const double side : {1.0, -1.0}) {
        const auto hit = bvh.cast_ray({0.25, 0.25, side}, {0.25, 0.25, -side});
        ASSERT_TRUE(hit.has_value());
        EXPECT_EQ(hit->point, Vec3(0.25, 0.25, 0.0));
        EXPECT_EQ(hit->distance_m, 1.0);
    }
    EXPECT_FALSE(bvh.cast_ray({0.25, 0.25, 1.0}, {0.25, 0.25, 0.01}));  // ends before it
    EXPECT_FALSE(bvh.cast_ray({0.6, 0.6, 1.0}, {0.6, 0.6, -1.0}));
}

TEST(TriangleBvh, FindsNothingWhereNothingIsFinite) {
    constexpr double k_nan = std::numeric_limits<double>::quiet_NaN();
    constexpr double k_infinity = std::numeric_limits<double>::infinity();
    const std::vector<Vec3> positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {k_nan, 0, 0}};
    const std::vector<std::array<std::uint32_t, 3>> triangles = {{0, 1, 3}, {0, 1, 2}, {3, 3, 3}};
    const TriangleBvh bvh(positions, triangles);
    EXPECT_EQ(bvh.triangle_count(), 1U);
    EXPECT_EQ(bvh.closest_point({0.1, 0.1, 5.0}, k_infinity)->triangle, 1U);
    for (const double bad : {k_nan, k_infinity}) {
        EXPECT_FALSE(bvh.closest_point({bad, 0.0, 0.0}, 1.0));
        EXPECT_FALSE(bvh.cast_ray({0.1, 0.1, 1.0}, {0.1, 0.1, -bad}));
        bvh.visit_in_sphere({bad, 0.0, 0.0}, 1.0, [](std::uint32_t) { FAIL(); });
    }
    EXPECT_FALSE(bvh.closest_point({0.0, 0.0, 0.0}, k_nan));
    EXPECT_FALSE(bvh.cast_ray({0.1, 0.1, 1.0}, {0.1, 0.1, 1.0}));  // no way
    EXPECT_FALSE(TriangleBvh().closest_point(Vec3::Zero(), k_infinity));
    EXPECT_FALSE(TriangleBvh({}, {}).cast_ray(Vec3::Zero(), Vec3::UnitX()));
}

TEST(TriangleBvh, HandlesManyTrianglesInOnePlace) {
    // No plane parts them: the tree must not grow into a list.
    Mesh mesh;
    mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    mesh.triangles.assign(5000, {0, 1, 2});
    const TriangleBvh bvh(mesh.positions, mesh.triangles);
    EXPECT_EQ(bvh.closest_point({0.2, 0.2, 1.0}, 2.0)->triangle, 0U);
    EXPECT_EQ(bvh.cast_ray({0.2, 0.2, 1.0}, {0.2, 0.2, -1.0})->triangle, 0U);
    // Each ten times as far and large as the last: every split takes off one.
    Mesh row;
    for (std::uint32_t i = 0; i < 300; ++i) {
        const double size = std::pow(1.5, i % 150) * (i < 150 ? 1e-12 : -1e-12);
        row.positions.insert(row.positions.end(),
                             {{size, 0, 0}, {1.2 * size, 0, 0}, {size, 0.2 * size, 0}});
        row.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
    }
    Random random(804);
    expect_nearest_and_spheres(row, TriangleBvh(row.positions, row.triangles), random, 100);
}

TEST(TriangleBvh, QueriesDoNotAllocate) {
    Random random(805);
    const Mesh soup = make_soup(random, 500);
    const TriangleBvh bvh(soup.positions, soup.triangles);
    std::size_t found = 0;
    const std::size_t before = allocation_count();
    for (int i = 0; i < 100; ++i) {
        const Vec3 point = random.vector(1.0);
        found += bvh.closest_point(point, 1.0) ? 1U : 0U;
        found += bvh.cast_ray(point, -point) ? 1U : 0U;
        bvh.visit_in_sphere(point, 0.2, [&](std::uint32_t) { ++found; });
    }
    EXPECT_EQ(allocation_count(), before);
    EXPECT_GT(found, 100U);
}

TEST(TriangleBvh, RefusesIndicesOutOfRange) {
    const std::vector<Vec3> positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    const std::vector<std::array<std::uint32_t, 3>> triangles = {{0, 1, 3}};
    EXPECT_THROW(TriangleBvh(positions, triangles), PreconditionError);
}

// All of it is in the sphere: what counts is told by each triangle's own cross product.
TEST(TriangleBvh, SumsTheAreasThatLookTowardsASide) {
    Random random(72);
    const Mesh mesh = make_soup(random, 400);
    const TriangleBvh bvh(mesh.positions, mesh.triangles);
    constexpr double k_most_m2 = 0.5;
    for (int i = 0; i < 20; ++i) {
        const Vec3 side = random.vector(1.0);
        Vec3 expected = Vec3::Zero();
        for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
            const Corners c = corners_of(mesh, t);
            const Vec3 area = (c[1] - c[0]).cross(c[2] - c[0]);
            if (area.dot(side) > 0.0) {
                expected += std::min(1.0, k_most_m2 / area.norm()) * area;
            }
        }
        const Vec3 sum = bvh.areas_in_sphere(Vec3::Zero(), 10.0, side, k_most_m2);
        EXPECT_LT((sum - expected).norm(), 1e-4 * expected.norm()) << i;
    }
    EXPECT_EQ(bvh.areas_in_sphere(Vec3(50.0, 0.0, 0.0), 1.0, Vec3::UnitX(), 1.0), Vec3::Zero());
    const double nan = std::numeric_limits<double>::quiet_NaN();
    EXPECT_EQ(bvh.areas_in_sphere(Vec3(nan, 0.0, 0.0), 1.0, Vec3::UnitX(), 1.0), Vec3::Zero());
    EXPECT_EQ(TriangleBvh().areas_in_sphere(Vec3::Zero(), 1.0, Vec3::UnitX(), 1.0), Vec3::Zero());
}

// What is surely within the sphere counts, what is surely beyond does not.
TEST(TriangleBvh, SumsNoAreasBeyondTheSphere) {
    Random random(73);
    const Mesh mesh = make_soup(random, 300);
    const TriangleBvh bvh(mesh.positions, mesh.triangles);
    constexpr double k_radius_m = 0.4;
    Vec3 nearer = Vec3::Zero();
    Vec3 hardly_farther = Vec3::Zero();
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        const Corners c = corners_of(mesh, t);
        const double distance_m = closest_on_triangle(Vec3::Zero(), c).norm();
        const Vec3 area = (c[1] - c[0]).cross(c[2] - c[0]);
        if (area.z() > 0.0 && distance_m <= k_radius_m) {
            nearer += area;
        }
        if (area.z() > 0.0 && distance_m <= 2.0 * k_radius_m) {
            hardly_farther += area;
        }
    }
    const Vec3 sum = bvh.areas_in_sphere(Vec3::Zero(), k_radius_m, Vec3::UnitZ(), 1e9);
    EXPECT_GE(sum.z(), nearer.z() * (1.0 - 1e-5));
    EXPECT_LE(sum.z(), hardly_farther.z() * (1.0 + 1e-5));
    EXPECT_LT(nearer.z(), 0.9 * hardly_farther.z());
}

// Of all triangles of a soup, slivers, lines and points among them, four by four, from points near
// and far: neither bound is more than the distance, and the close one is hardly less.
TEST(DistanceLowerBound, IsNeverMoreThanTheDistanceAndCloselyHardlyLess) {
    Random random(806);
    const Mesh mesh = make_soup(random, 400);
    const TriangleBvh bvh(mesh.positions, mesh.triangles);
    OrientedBox everything;
    everything.half_extents = Vec3::Constant(10.0);
    constexpr double k_room = 1e-5;  // ten times what is left for rounding
    for (int i = 0; i < 200; ++i) {
        const Vec3 local = random.vector(std::pow(10.0, random.between(-2.0, 1.0)));
        const DistanceLowerBound least(local, bvh.reach_m());
        const double clearance_m = k_room * (bvh.reach_m() + local.norm());
        std::size_t seen = 0;
        bvh.visit_near_box(
            everything, [&](std::uint32_t first_slot, std::uint32_t count, const Triangles4& four) {
                const Float4 roughly = least.squared(four);
                const Float4 closely = least.squared_tight(four);
                for (std::uint32_t lane = 0; lane < count; ++lane) {
                    const Corners corners = bvh.corners_at(first_slot + lane);
                    const Vec3 point = local + bvh.origin();
                    const double distance_m = (closest_on_triangle(point, corners) - point).norm();
                    const double roughly_m = std::sqrt(static_cast<double>(roughly[lane]));
                    const double closely_m = std::sqrt(static_cast<double>(closely[lane]));
                    ASSERT_LE(roughly_m, distance_m * (1.0 + 1e-6)) << i;
                    ASSERT_LE(closely_m, distance_m * (1.0 + 1e-6)) << i;
                    ASSERT_GE(closely_m, distance_m - clearance_m) << i;
                }
                seen += count;
            });
        ASSERT_EQ(seen, mesh.triangles.size());
    }
}

// So are distances of boxes: of random ones, some of them flat, and some around the point.
TEST(DistanceLowerBound, IsNeverMoreThanTheDistanceOfABox) {
    Random random(807);
    for (int i = 0; i < 5000; ++i) {
        const double scale = std::pow(10.0, random.between(-2.0, 2.0));
        const Vec3 point = random.vector(scale);
        Boxes4 boxes;
        std::array<double, 4> distance_m = {};
        double reach_m = 0.0;
        for (std::size_t lane = 0; lane < 4; ++lane) {
            const Vec3 a = random.vector(scale);
            Vec3 b = a + random.vector(random.between(0.0, 1.0) * scale);
            b.x() = lane == 0 ? a.x() : b.x();
            Vec3 low;
            Vec3 high;
            for (std::size_t axis = 0; axis < 3; ++axis) {
                const auto at = static_cast<Eigen::Index>(axis);
                boxes.low[axis][lane] = static_cast<float>(std::min(a[at], b[at]));
                boxes.high[axis][lane] = static_cast<float>(std::max(a[at], b[at]));
                low[at] = static_cast<double>(boxes.low[axis][lane]);
                high[at] = static_cast<double>(boxes.high[axis][lane]);
                reach_m = std::max({reach_m, -low[at], high[at]});
            }
            distance_m[lane] = (low - point).cwiseMax(point - high).cwiseMax(0.0).norm();
        }
        const DistanceLowerBound least(point, reach_m);
        const Float4 squared = least.squared(boxes);
        for (std::size_t lane = 0; lane < 4; ++lane) {
            const double least_m = std::sqrt(static_cast<double>(squared[lane]));
            ASSERT_LE(least_m, distance_m[lane] * (1.0 + 1e-6)) << i;
            ASSERT_GE(least_m, distance_m[lane] - 1e-5 * (reach_m + point.norm())) << i;
        }
    }
}

// Squares of floats are infinite from there on.
TEST(TriangleBvh, FindsWhatIsNearestFromVeryFarAway) {
    const std::vector<Vec3> positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    const std::vector<std::array<std::uint32_t, 3>> triangles = {{0, 1, 2}};
    const TriangleBvh bvh(positions, triangles);
    for (const double far_m : {1e10, 2e19, 1e20, 1e30, 1e38, 1e39, 1e60, 1e150}) {
        const Vec3 point(0.0, 0.0, far_m);
        const auto hit = bvh.closest_point(point, std::numeric_limits<double>::infinity());
        EXPECT_TRUE(hit.has_value()) << far_m;
        int visits = 0;
        bvh.visit_in_sphere(point, 2.0 * far_m, [&](std::uint32_t) { ++visits; });
        EXPECT_EQ(visits, 1) << far_m;
    }
}

}  // namespace
}  // namespace handhold::triangle_bvh_test
