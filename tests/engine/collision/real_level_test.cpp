#include <algorithm>
#include <filesystem>
#include <optional>

#include <gtest/gtest.h>

#include "engine/io/gltf.hpp"
#include "tests/engine/collision/oracle.hpp"
#include "tests/places.hpp"

// Contacts with the meshes of a real level, against brute force over its triangles.
namespace handhold::collision_real_level_test {
namespace {

using test::at;
using test::Random;
using test::resting;

// The parts of a real level, each its own static collider.
struct Level {
    ShapeLibrary shapes;
    std::vector<ColliderProxy> parts;
    std::vector<std::shared_ptr<const Mesh>> meshes;
};

std::optional<Level> load_level() {
    const std::filesystem::path path = data_dir() / "level" / "station.glb";
    if (!std::filesystem::exists(path)) {
        return std::nullopt;
    }
    const Result<GltfLevel> file = load_gltf_level(path);
    EXPECT_TRUE(file.ok());
    Level level;
    for (const LevelPart& part : file.value().parts) {
        level.meshes.push_back(std::make_shared<Mesh>(part.mesh));
        level.parts.push_back(
            resting(level.parts.size() + 1, level.shapes.add_mesh(level.meshes.back()), {}, false));
    }
    return level;
}

// A random point on the segment between two vertices of a part.
Vec3 place_in(const Mesh& mesh, Random& random) {
    const auto vertex = [&] {
        return mesh.positions[static_cast<std::size_t>(
            random.between(0.0, static_cast<double>(mesh.positions.size())))];
    };
    const Vec3 a = vertex();
    const Vec3 b = vertex();
    return a + random.between(0.0, 1.0) * (b - a);
}

// Visits the non-degenerate triangles whose boxes are within reach_m of a point.
template <typename Visit>
void visit_near(const Level& level, const Vec3& point, double reach_m, const Visit& visit) {
    for (const auto& mesh : level.meshes) {
        for (const auto& t : mesh->triangles) {
            const Corners corners{mesh->positions[t[0]], mesh->positions[t[1]],
                                  mesh->positions[t[2]]};
            const Vec3 low = corners[0].cwiseMin(corners[1]).cwiseMin(corners[2]);
            const Vec3 high = corners[0].cwiseMax(corners[1]).cwiseMax(corners[2]);
            if ((point.cwiseMax(low).cwiseMin(high) - point).norm() < reach_m &&
                !area_vector(corners).isZero(0.0)) {
                visit(corners);
            }
        }
    }
}

// Oracle: distance of the centre to every triangle, in closed form.
TEST(RealLevelContacts, SphereInARealLevelIsAsDeepAsItsNearestTriangle) {
    auto level = load_level();
    if (!level) {
        GTEST_SKIP() << "no level data";
    }
    const double radius = 0.13;
    const ShapeId sphere = level->shapes.add_sphere(radius);
    CollisionWorld world(level->shapes);
    std::vector<ColliderProxy> proxies = level->parts;
    proxies.push_back(resting(1000, sphere, {}, true));
    std::vector<ContactPoint> contacts;
    Random random(22);
    int touching = 0;
    for (int round = 0; round < 300; ++round) {
        const Vec3 centre = place_in(
            *level->meshes[static_cast<std::size_t>(round) % level->meshes.size()], random);
        proxies.back() = resting(1000, sphere, at(centre, random.rotation()), true);
        world.set_proxies(proxies);
        world.find_contacts({}, contacts);
        double nearest = 1e9;
        visit_near(*level, centre, 0.2, [&](const Corners& corners) {
            nearest = std::min(nearest, (closest_on_triangle(centre, corners) - centre).norm());
        });
        const double expected = nearest - radius;
        ASSERT_EQ(contacts.empty(), expected >= 0.02) << "at " << centre.transpose();
        if (!contacts.empty()) {
            ++touching;
            ASSERT_NEAR(test::deepest(contacts), expected, 1e-9) << "at " << centre.transpose();
        }
    }
    EXPECT_GT(touching, 100);
}

// Oracle: the exact distance of the box to every triangle near it.
TEST(RealLevelContacts, BoxInARealLevelIsAsNearAsItsNearestTriangle) {
    auto level = load_level();
    if (!level) {
        GTEST_SKIP() << "no level data";
    }
    const ShapeId box = level->shapes.add_box({0.15, 0.1, 0.12});
    CollisionWorld world(level->shapes);
    std::vector<ColliderProxy> proxies = level->parts;
    proxies.push_back(resting(1000, box, {}, true));
    const auto distance = [&](const Pose& pose) {
        const test::Core core = test::make_core(level->shapes.at(box), pose);
        test::Gap nearest;
        visit_near(*level, pose.position, 0.6, [&](const Corners& corners) {
            const test::Gap gap = test::gap_to_triangle(core, corners);
            nearest = gap.distance_m < nearest.distance_m ? gap : nearest;
        });
        return nearest;
    };
    std::vector<ContactPoint> contacts;
    Random random(23);
    int near = 0;
    for (int round = 0; round < 200; ++round) {
        const auto& mesh = *level->meshes[static_cast<std::size_t>(round) % level->meshes.size()];
        Pose pose{place_in(mesh, random), random.rotation()};
        // Moved towards the nearest surface until it is a few millimetres away.
        test::Gap nearest = distance(pose);
        for (int step = 0; step < 4 && nearest.distance_m > 0.015 && nearest.distance_m < 1.0;
             ++step) {
            pose.position -= (nearest.distance_m - random.between(0.001, 0.015)) * nearest.normal;
            nearest = distance(pose);
        }
        proxies.back() = resting(1000, box, pose, true);
        world.set_proxies(proxies);
        world.find_contacts({}, contacts);
        if (nearest.distance_m > 1e-6) {
            ASSERT_EQ(contacts.empty(), nearest.distance_m >= 0.02);
            near += contacts.empty() ? 0 : 1;
            ASSERT_TRUE(contacts.empty() ||
                        std::abs(test::deepest(contacts) - nearest.distance_m) < 1e-6);
        } else {
            ASSERT_FALSE(contacts.empty());
        }
    }
    EXPECT_GT(near, 30);
}

}  // namespace
}  // namespace handhold::collision_real_level_test
