#include "engine/geometry/triangle_bvh.hpp"

#include <cmath>
#include <limits>
#include <set>

#include <gtest/gtest.h>

#include "data_meshes.hpp"
#include "engine/geometry/closest_point.hpp"
#include "tests/engine/allocation_count.hpp"
#include "tests/engine/collision/scene.hpp"
#include "triangle_soup.hpp"

// Oracle: brute force over all triangles.
namespace handhold::triangle_bvh_test {
namespace {

using test::corners_of;
using test::make_soup;
using test::Random;

// Möller and Trumbore 1997 in long double, independent of the tested form.
struct OracleRay {
    long double fraction = 2.0L;
    bool clear = true;  // false: an edge is so near to the ray that rounding decides
};
OracleRay oracle_ray(const Mesh& mesh, const Vec3& from, const Vec3& to) {
    using V = Eigen::Matrix<long double, 3, 1>;
    OracleRay result;
    const V start = from.cast<long double>();
    const V displacement = to.cast<long double>() - start;
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        const Corners c = corners_of(mesh, t);
        const V a = c[0].cast<long double>();
        const V ab = c[1].cast<long double>() - a;
        const V ac = c[2].cast<long double>() - a;
        const V p = displacement.cross(ac);
        const long double det = ab.dot(p);
        if (std::abs(det) < 1e-14L * ab.norm() * ac.norm() * displacement.norm()) {
            continue;  // edge-on, or a sliver: neither test has to hit it
        }
        const V s = start - a;
        const long double u = s.dot(p) / det;
        const V q = s.cross(ab);
        const long double v = displacement.dot(q) / det;
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

std::optional<TriangleHit> oracle_closest(const Mesh& mesh, const Vec3& point,
                                          double max_distance_m) {
    std::optional<TriangleHit> best;
    double best_squared = max_distance_m * max_distance_m;
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
    double max_m = 0.0;
    for (const Vec3& position : mesh.positions) {
        max_m = std::max(max_m, (position - mesh.positions[0]).norm());
    }
    return max_m;
}

void expect_rays(const Mesh& mesh, const TriangleBvh& bvh, Random& random, int rounds) {
    const double size = size_of(mesh);
    int hits = 0;
    int clear = 0;
    for (int round = 0; round < rounds; ++round) {
        const Vec3 from = mesh.positions[0] + random.vector(size);
        const auto some = static_cast<std::size_t>(
            random.between(0.0, static_cast<double>(mesh.positions.size())));
        const Vec3 through = mesh.positions[some] + random.vector(0.01 * size);
        const Vec3 to = from + random.between(0.5, 2.0) * (through - from);
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
        const double max_m = round % 3 == 0 ? std::numeric_limits<double>::infinity() : away;
        const auto hit = bvh.closest_point(point, max_m);
        const auto oracle = oracle_closest(mesh, point, max_m);
        ASSERT_EQ(hit.has_value(), oracle.has_value());
        if (hit) {  // the same closed form on the same triangles gives the same bits
            ASSERT_EQ(hit->triangle, oracle->triangle);
            ASSERT_EQ(hit->distance_m, oracle->distance_m);
            ASSERT_EQ(hit->point, oracle->point);
            // Callers who know a bound of the distance may pass it: the hit is the same.
            const double slack = random.between(0.0, 1.0) * away;
            const auto bounded = bvh.closest_point(point, hit->distance_m * (1.0 + 1e-9) + slack);
            ASSERT_TRUE(bounded.has_value());
            ASSERT_EQ(bounded->triangle, hit->triangle);
            ASSERT_EQ(bounded->point, hit->point);
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

TEST(TriangleBvh, MatchesBruteForceOnSoup) {
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

TEST(TriangleBvh, MatchesBruteForceOnRealMeshes) {
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

TEST(TriangleBvh, RaysNeverPassSharedEdgesAndCorners) {
    Random random(803);
    const auto ball = test::make_wavy_ball(1.0, 24, 40);
    const TriangleBvh bvh(ball->positions, ball->triangles);
    int rays = 0;
    for (std::size_t t = 0; t < ball->triangles.size(); ++t) {
        const Corners corners = corners_of(*ball, t);
        for (const double share : {0.0, 0.25, 0.5, random.between(0.0, 1.0)}) {
            // From inside to beyond a point of an edge, including the poles' zero-length edges.
            const Vec3 target = (1.0 - share) * corners[0] + share * corners[1];
            ASSERT_TRUE(bvh.cast_ray(random.vector(0.3), 1.5 * target).has_value());
            ++rays;
        }
    }
    EXPECT_GT(rays, 5000);
}

TEST(TriangleBvh, HitsBothSidesOfTriangle) {
    const std::vector<Vec3> positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    const std::vector<std::array<std::uint32_t, 3>> triangles = {{0, 1, 2}};
    const TriangleBvh bvh(positions, triangles);
    for (const double side : {1.0, -1.0}) {
        const auto hit = bvh.cast_ray({0.25, 0.25, side}, {0.25, 0.25, -side});
        ASSERT_TRUE(hit.has_value());
        EXPECT_EQ(hit->point, Vec3(0.25, 0.25, 0.0));
        EXPECT_EQ(hit->distance_m, 1.0);
    }
    EXPECT_FALSE(bvh.cast_ray({0.25, 0.25, 1.0}, {0.25, 0.25, 0.01}));  // ends before the triangle
    EXPECT_FALSE(bvh.cast_ray({0.6, 0.6, 1.0}, {0.6, 0.6, -1.0}));
}

TEST(TriangleBvh, NonFiniteInputFindsNothing) {
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
    EXPECT_FALSE(bvh.cast_ray({0.1, 0.1, 1.0}, {0.1, 0.1, 1.0}));  // zero length
    EXPECT_FALSE(TriangleBvh().closest_point(Vec3::Zero(), k_infinity));
    EXPECT_FALSE(TriangleBvh({}, {}).cast_ray(Vec3::Zero(), Vec3::UnitX()));
}

TEST(TriangleBvh, HandlesManyCoincidentTriangles) {
    // No plane separates the triangles: the tree must not degenerate into a list.
    Mesh mesh;
    mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    mesh.triangles.assign(5000, {0, 1, 2});
    const TriangleBvh bvh(mesh.positions, mesh.triangles);
    EXPECT_EQ(bvh.closest_point({0.2, 0.2, 1.0}, 2.0)->triangle, 0U);
    EXPECT_EQ(bvh.cast_ray({0.2, 0.2, 1.0}, {0.2, 0.2, -1.0})->triangle, 0U);
    // Each is 1.5 times as far and large as the last: every split separates one triangle.
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

TEST(TriangleBvh, RejectsIndicesOutOfRange) {
    const std::vector<Vec3> positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    const std::vector<std::array<std::uint32_t, 3>> triangles = {{0, 1, 3}};
    EXPECT_THROW(TriangleBvh(positions, triangles), PreconditionError);
}

// The sphere encloses the mesh. Oracle: each triangle's cross product.
TEST(TriangleBvh, SumsAreasThatFaceSide) {
    Random random(72);
    const Mesh mesh = make_soup(random, 400);
    const TriangleBvh bvh(mesh.positions, mesh.triangles);
    constexpr double k_max_area_m2 = 0.5;
    for (int i = 0; i < 20; ++i) {
        const Vec3 side = random.vector(1.0).normalized();
        Vec3 expected = Vec3::Zero();
        for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
            const Corners c = corners_of(mesh, t);
            const Vec3 area = (c[1] - c[0]).cross(c[2] - c[0]);
            if (area.dot(side) > 0.0) {
                expected +=
                    side.dot(area.normalized()) * std::min(1.0, k_max_area_m2 / area.norm()) * area;
            }
        }
        const Vec3 sum = bvh.areas_in_sphere(Vec3::Zero(), 10.0, side, k_max_area_m2);
        EXPECT_LT((sum - expected).norm(), 1e-4 * expected.norm()) << i;
    }
    EXPECT_EQ(bvh.areas_in_sphere(Vec3(50.0, 0.0, 0.0), 1.0, Vec3::UnitX(), 1.0), Vec3::Zero());
    const double nan = std::numeric_limits<double>::quiet_NaN();
    EXPECT_EQ(bvh.areas_in_sphere(Vec3(nan, 0.0, 0.0), 1.0, Vec3::UnitX(), 1.0), Vec3::Zero());
    EXPECT_EQ(TriangleBvh().areas_in_sphere(Vec3::Zero(), 1.0, Vec3::UnitX(), 1.0), Vec3::Zero());
}

// Triangles within the sphere must count; those beyond twice its radius must not.
TEST(TriangleBvh, SumsOnlyAreasWithinSphere) {
    Random random(73);
    const Mesh mesh = make_soup(random, 300);
    const TriangleBvh bvh(mesh.positions, mesh.triangles);
    constexpr double k_radius_m = 0.4;
    Vec3 nearer = Vec3::Zero();
    Vec3 within_twice = Vec3::Zero();
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        const Corners c = corners_of(mesh, t);
        const double distance_m = closest_on_triangle(Vec3::Zero(), c).norm();
        const Vec3 area = (c[1] - c[0]).cross(c[2] - c[0]);
        if (area.z() > 0.0 && distance_m <= k_radius_m) {
            nearer += area.normalized().z() * area;
        }
        if (area.z() > 0.0 && distance_m <= 2.0 * k_radius_m) {
            within_twice += area.normalized().z() * area;
        }
    }
    const Vec3 sum = bvh.areas_in_sphere(Vec3::Zero(), k_radius_m, Vec3::UnitZ(), 1e9);
    EXPECT_GE(sum.z(), nearer.z() * (1.0 - 1e-5));
    EXPECT_LE(sum.z(), within_twice.z() * (1.0 + 1e-5));
    EXPECT_LT(nearer.z(), 0.9 * within_twice.z());
}

// Squares of such distances overflow floats.
TEST(TriangleBvh, FindsNearestFromVeryFar) {
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
