#include "engine/geometry/convex_hull.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <map>

#include <gtest/gtest.h>

#include "engine/io/gltf.hpp"
#include "tests/engine/collision/scene.hpp"
#include "tests/places.hpp"

// Oracle: the definition of a hull. No point is outside, every corner is an input point, and the
// surface is closed.
namespace handhold::convex_hull_test {
namespace {

using test::Random;

double outside_m(const ConvexHull& hull, const Vec3& point) {
    double max_m = -1e9;
    for (const HullFace& face : hull.faces) {
        max_m = std::max(max_m, face.normal.dot(point) - face.offset_m);
    }
    return max_m;
}

void expect_hull(const ConvexHull& hull, const std::vector<Vec3>& points) {
    const double size = 2.0 * points[0].norm() + 1.0;
    ASSERT_LE(hull.corners.size(), k_max_hull_corners);
    for (const Vec3& corner : hull.corners) {
        ASSERT_NE(std::find(points.begin(), points.end(), corner), points.end());
    }
    for (const Vec3& point : points) {
        ASSERT_LE(outside_m(hull, point), hull.omitted_m + 1e-9 * size);
    }
    std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges;
    for (const HullFace& face : hull.faces) {
        ASSERT_GE(face.loop.size(), 3U);
        Vec3 area = Vec3::Zero();
        for (std::size_t i = 0; i < face.loop.size(); ++i) {
            const std::uint32_t from = face.loop[i];
            const std::uint32_t to = face.loop[(i + 1) % face.loop.size()];
            ++edges[{from, to}];
            --edges[{to, from}];
            area += hull.corners[from].cross(hull.corners[to]);
        }
        ASSERT_GT(area.dot(face.normal), 0.0);  // counter-clockwise from outside
    }
    for (const auto& [edge, count] : edges) {
        ASSERT_EQ(count, 0) << edge.first << " to " << edge.second;
    }
    // Euler's formula for a sphere's topology.
    ASSERT_EQ(hull.corners.size() + hull.faces.size(), edges.size() / 2 + 2);
}

TEST(ConvexHull, ContainsAllPointsAndIsWatertight) {
    Random random(71);
    for (int round = 0; round < 300; ++round) {
        std::vector<Vec3> points(static_cast<std::size_t>(random.between(4.0, 60.0)));
        const Vec3 middle = random.vector(2.0);
        for (Vec3& point : points) {
            point = middle + random.vector(1.0);
        }
        const auto hull = make_convex_hull(points);
        ASSERT_TRUE(hull.has_value());
        expect_hull(*hull, points);
    }
}

TEST(ConvexHull, FilledBoxGivesEightCornersAndSixFaces) {
    Random random(72);
    for (int round = 0; round < 50; ++round) {
        const Vec3 half{random.between(0.01, 2.0), random.between(0.01, 2.0),
                        random.between(0.01, 2.0)};
        const Pose pose = random.pose(5.0);
        std::vector<Vec3> points;
        for (unsigned i = 0; i < 8; ++i) {
            const Vec3 side((i & 1U) != 0 ? 1.0 : -1.0, (i & 2U) != 0 ? 1.0 : -1.0,
                            (i & 4U) != 0 ? 1.0 : -1.0);
            points.push_back(transform_point(pose, side.cwiseProduct(half)));
        }
        const std::vector<Vec3> corners = points;
        for (int i = 0; i < 200; ++i) {  // on faces, on edges and inside
            Vec3 inside = random.vector(1.0);
            for (int k = 0; k < i % 3; ++k) {
                inside[(i + k) % 3] = inside[(i + k) % 3] < 0.0 ? -1.0 : 1.0;
            }
            points.push_back(transform_point(pose, inside.cwiseProduct(half)));
        }
        const auto hull = make_convex_hull(points);
        ASSERT_TRUE(hull.has_value());
        ASSERT_EQ(hull->faces.size(), 6U);
        ASSERT_EQ(hull->corners.size(), 8U);
        expect_hull(*hull, points);
        for (const Vec3& corner : corners) {
            ASSERT_NE(std::find(hull->corners.begin(), hull->corners.end(), corner),
                      hull->corners.end());
        }
    }
}

TEST(ConvexHull, IndependentOfPointOrder) {
    Random random(73);
    std::vector<Vec3> points(500);
    for (Vec3& point : points) {
        point = random.direction();
    }
    const auto hull = make_convex_hull(points);
    std::shuffle(points.begin(), points.end(), random.engine());
    points.push_back(points.front());
    const auto again = make_convex_hull(points);
    ASSERT_TRUE(hull && again);
    EXPECT_EQ(hull->corners, again->corners);
    ASSERT_EQ(hull->faces.size(), again->faces.size());
    for (std::size_t i = 0; i < hull->faces.size(); ++i) {
        EXPECT_EQ(hull->faces[i].loop, again->faces[i].loop);
    }
}

std::vector<std::uint64_t> bits_of(const ConvexHull& hull) {
    std::vector<std::uint64_t> bits;
    const auto add = [&bits](const Vec3& vector) {
        for (const double value : {vector.x(), vector.y(), vector.z()}) {
            bits.push_back(std::bit_cast<std::uint64_t>(value));
        }
    };
    for (const Vec3& corner : hull.corners) {
        add(corner);
    }
    for (const HullFace& face : hull.faces) {
        add(face.normal);
        bits.push_back(std::bit_cast<std::uint64_t>(face.offset_m));
        bits.insert(bits.end(), face.loop.begin(), face.loop.end());
    }
    bits.push_back(std::bit_cast<std::uint64_t>(hull.width_m));
    bits.push_back(std::bit_cast<std::uint64_t>(hull.omitted_m));
    return bits;
}

// Corners on the axes' planes, each with zeros of both signs. More than 16 points: std::sort keeps
// the order of fewer.
TEST(ConvexHull, SignsOfZerosHaveNoEffect) {
    std::vector<Vec3> points;
    for (const double zero : {0.0, -0.0}) {
        for (const double side : {-1.0, 1.0}) {
            for (const double other : {zero, side}) {
                points.emplace_back(side, other, zero);
                points.emplace_back(zero, side, other);
                points.emplace_back(other, zero, side);
            }
        }
        points.emplace_back(zero, -zero, 0.0);
    }
    ASSERT_GT(points.size(), 16U);
    std::vector<Vec3> positive = points;
    for (Vec3& point : positive) {
        point.array() += 0.0;
    }
    const auto expected = make_convex_hull(positive);
    ASSERT_TRUE(expected.has_value());
    Random random(77);
    for (int turn = 0; turn < 200; ++turn) {
        std::shuffle(points.begin(), points.end(), random.engine());
        const auto hull = make_convex_hull(points);
        ASSERT_TRUE(hull.has_value());
        ASSERT_EQ(bits_of(*hull), bits_of(*expected)) << "turn " << turn;
    }
}

TEST(ConvexHull, ReportsOmittedDistanceBeyondCornerLimit) {
    Random random(74);
    std::vector<Vec3> points(3000);
    for (Vec3& point : points) {
        point = random.direction();
    }
    const auto hull = make_convex_hull(points);
    ASSERT_TRUE(hull.has_value());
    EXPECT_EQ(hull->corners.size(), k_max_hull_corners);
    expect_hull(*hull, points);
    double max_m = 0.0;
    for (const Vec3& point : points) {
        max_m = std::max(max_m, outside_m(*hull, point));
    }
    EXPECT_NEAR(hull->omitted_m, max_m, 1e-5);
    // 64 well-spread points on a unit sphere: the caps between them have about 4 pi / 124 of its
    // area.
    EXPECT_LT(max_m, 0.1);
}

TEST(ConvexHull, RejectsPointsWithoutVolume) {
    Random random(75);
    std::vector<Vec3> points;
    EXPECT_FALSE(make_convex_hull(points));
    const Quat turn = random.rotation();
    for (int i = 0; i < 50; ++i) {
        points.push_back(turn * random.vector(1.0).cwiseProduct(Vec3(1.0, 0.0, 1.0)));
    }
    EXPECT_FALSE(make_convex_hull(points));
    points.emplace_back(std::numeric_limits<double>::infinity(), 0.0, 0.0);
    EXPECT_FALSE(make_convex_hull(points));
    EXPECT_FALSE(make_convex_hull(std::vector<Vec3>(10, Vec3::UnitX())));
}

TEST(ConvexHull, HandlesNearlyCoplanarAndCollinearPoints) {
    Random random(76);
    for (int round = 0; round < 400; ++round) {
        const double flatness = std::pow(10.0, random.between(-8.0, -2.0));
        const double noise = std::pow(10.0, random.between(-9.0, -5.0));
        const Quat turn = random.rotation();
        std::vector<Vec3> points;
        for (int i = 0; i < 80; ++i) {  // a thin grid with noise
            const Vec3 grid(i % 4, i / 4 % 4, (i / 16 % 5) * flatness);
            points.push_back(turn * Vec3(grid + random.vector(noise)));
        }
        if (const auto hull = make_convex_hull(points)) {
            for (const Vec3& point : points) {
                ASSERT_LE(outside_m(*hull, point), hull->omitted_m + 1e-8) << round;
            }
            ASSERT_LT(hull->omitted_m, 2e-5) << round;
        } else {
            ASSERT_LT(flatness, 1e-5);
        }
    }
}

TEST(ConvexHull, ContainsRealObjects) {
    const std::filesystem::path folder = data_dir() / "objects";
    if (!std::filesystem::exists(folder)) {
        GTEST_SKIP() << "no object data";
    }
    int objects = 0;
    for (const auto& entry : std::filesystem::directory_iterator(folder)) {
        if (entry.path().extension() != ".glb") {
            continue;
        }
        SCOPED_TRACE(entry.path().filename());
        const Result<GltfLevel> file = load_gltf_level(entry.path());
        ASSERT_TRUE(file.ok());
        std::vector<Vec3> points;
        for (const LevelPart& part : file.value().parts) {
            points.insert(points.end(), part.mesh.positions.begin(), part.mesh.positions.end());
        }
        const auto hull = make_convex_hull(points);
        ASSERT_TRUE(hull.has_value());
        expect_hull(*hull, points);
        double reach = 0.0;
        for (const Vec3& point : points) {
            reach = std::max(reach, (point - points[0]).norm());
        }
        EXPECT_LT(hull->omitted_m, 0.02 * reach);
        ++objects;
    }
    EXPECT_GT(objects, 10);
}

}  // namespace
}  // namespace handhold::convex_hull_test
