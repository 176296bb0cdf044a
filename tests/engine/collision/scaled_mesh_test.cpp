#include <filesystem>

#include <gtest/gtest.h>

#include "engine/io/gltf.hpp"
#include "tests/engine/allocation_count.hpp"
#include "tests/engine/collision/scene.hpp"

// Oracle: a mesh with its positions multiplied by the scale.
namespace handhold::collision_scaled_mesh_test {
namespace {

using test::at;
using test::Random;
using test::resting;

std::shared_ptr<const Mesh> stretched(const Mesh& mesh, const Vec3& scale) {
    auto result = std::make_shared<Mesh>(mesh);
    for (Vec3& position : result->positions) {
        position = position.cwiseProduct(scale);
    }
    if (scale.prod() < 0.0) {  // a mirror image keeps its outer side
        for (auto& [a, b, c] : result->triangles) {
            std::swap(b, c);
        }
    }
    return result;
}

TEST(ScaledMesh, AnswersLikeAMeshWithScaledPositions) {
    Random random(101);
    const auto ball = test::make_wavy_ball(1.2, 24, 40);
    int hits = 0;
    int touches = 0;
    for (const Vec3& scale :
         {Vec3(1.0, 1.0, 1.0), Vec3(2.0, 2.0, 2.0), Vec3(0.3, 1.0, 2.5), Vec3(-1.0, 1.0, 1.0),
          Vec3(1.5, -0.7, -1.0), Vec3(-0.8, -0.8, -1.2)}) {
        ShapeLibrary shapes;
        const ShapeId plain = shapes.add_mesh(ball);
        const ShapeId scaled = shapes.add_mesh(ball, scale);
        const ShapeId oracle = shapes.add_mesh(stretched(*ball, scale));
        const ShapeId box = shapes.add_box({0.1, 0.05, 0.2});
        EXPECT_EQ(bounding_radius(shapes.at(scaled)), bounding_radius(shapes.at(oracle)));
        EXPECT_EQ(shapes.at(scaled).mesh, shapes.at(plain).mesh);
        CollisionWorld world(shapes);
        for (int round = 0; round < 150; ++round) {
            const Vec3 start = (0.9 + 0.3 * (round % 3)) * random.direction().cwiseProduct(scale);
            const Vec3 aside = random.vector(2.0);
            const Pose pose = at(start, random.rotation());
            const auto answers = [&](ShapeId shape) {
                world.set_proxies({{resting(1, shape, {}, false), resting(2, box, pose, true)}});
                std::vector<ContactPoint> contacts;
                world.find_contacts({}, contacts);
                const std::vector<std::uint64_t> skip = {2};
                return std::tuple(contacts, world.cast_ray(start, aside, skip),
                                  world.closest_point(aside, 3.0, skip),
                                  world.cast_sphere(0.05, start, aside, skip));
            };
            const auto [contacts, ray, near, sphere] = answers(scaled);
            const auto [o_contacts, o_ray, o_near, o_sphere] = answers(oracle);
            // The two trees may yield triangles in different orders, so contacts on an edge may
            // differ by rounding.
            ASSERT_EQ(ray.has_value(), o_ray.has_value());
            ASSERT_EQ(near.has_value(), o_near.has_value());
            ASSERT_EQ(sphere.has_value(), o_sphere.has_value());
            hits += ray ? 1 : 0;
            ASSERT_TRUE(!ray || std::abs(ray->distance_m - o_ray->distance_m) < 1e-12);
            ASSERT_TRUE(!near || std::abs(near->distance_m - o_near->distance_m) < 1e-12);
            ASSERT_TRUE(!sphere || std::abs(sphere->distance_m - o_sphere->distance_m) < 1e-9);
            ASSERT_EQ(contacts.size(), o_contacts.size());
            touches += contacts.empty() ? 0 : 1;
            for (std::size_t i = 0; i < contacts.size(); ++i) {
                ASSERT_NEAR(contacts[i].separation_m, o_contacts[i].separation_m, 1e-9);
                ASSERT_LT((contacts[i].point_b_bs - o_contacts[i].point_b_bs).norm(), 1e-6);
            }
        }
    }
    EXPECT_GT(hits, 100);
    EXPECT_GT(touches, 100);
}

TEST(ScaledMesh, NormalsArePerpendicularToTheScaledSurface) {
    // A plane through the unit points of the axes; its normal transforms by the inverse scale.
    auto mesh = std::make_shared<Mesh>();
    mesh->positions = {Vec3::UnitX(), Vec3::UnitY(), Vec3::UnitZ()};
    mesh->triangles = {{0, 1, 2}};
    ShapeLibrary shapes;
    const Vec3 scale(2.0, 1.0, 0.5);
    const ShapeId shape = shapes.add_mesh(mesh, scale);
    CollisionWorld world(shapes);
    world.set_proxies({{resting(1, shape, {}, false)}});
    const auto hit = world.cast_ray({2.0, 1.0, 0.5}, {0.0, 0.0, 0.0});
    ASSERT_TRUE(hit.has_value());
    EXPECT_LT((hit->point_ws - scale / 3.0).norm(), 1e-12);
    EXPECT_LT((hit->normal_ws - scale.cwiseInverse().normalized()).norm(), 1e-12);
}

TEST(ScaledMesh, CopiesOfOneMeshShareItsTree) {
    const auto ball = test::make_wavy_ball(1.0, 60, 100);  // 12,000 triangles
    const auto library_allocations = [&](int copies) {
        ShapeLibrary shapes;
        for (int i = 0; i < copies; ++i) {
            shapes.add_mesh(ball, Vec3::Constant(1.0 + 0.01 * i));
        }
        const std::uint64_t before = collision_allocation_count();
        const CollisionWorld world(shapes);
        return collision_allocation_count() - before;
    };
    (void)library_allocations(1);
    EXPECT_GT(library_allocations(1), 0U);
    EXPECT_EQ(library_allocations(100), library_allocations(1));
}

}  // namespace
}  // namespace handhold::collision_scaled_mesh_test
