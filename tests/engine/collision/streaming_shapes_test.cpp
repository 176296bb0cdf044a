#include <algorithm>
#include <array>
#include <memory>
#include <optional>
#include <vector>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "engine/core/check.hpp"
#include "engine/geometry/grip_mesh_library.hpp"
#include "tests/engine/collision/scene.hpp"

namespace handhold::streaming_shapes_test {
namespace {

std::shared_ptr<const Mesh> triangle_at(double z_m) {
    auto mesh = std::make_shared<Mesh>();
    mesh->positions = {{-1.0, -1.0, z_m}, {1.0, -1.0, z_m}, {0.0, 1.0, z_m}};
    mesh->triangles = {{0, 1, 2}};
    return mesh;
}

ShapeId add_some_shape(ShapeLibrary& shapes, int kind) {
    switch (kind % 3) {
        case 0:
            return shapes.add_box({0.2, 0.3, 0.4});
        case 1:
            return shapes.add_sphere(0.3);
        default:
            return shapes.add_mesh(triangle_at(0.01 * (kind % 30)));
    }
}

bool same_contacts(const std::vector<ContactPoint>& a, const std::vector<ContactPoint>& b) {
    return std::ranges::equal(a, b, [](const ContactPoint& x, const ContactPoint& y) {
        return x.id_a == y.id_a && x.id_b == y.id_b && x.feature == y.feature &&
               x.point_a_bs == y.point_a_bs && x.point_b_bs == y.point_b_bs &&
               x.separation_m == y.separation_m;
    });
}

// A world whose library's shapes come and go gives bitwise what a new world gives.
RC_GTEST_PROP(CollisionWorld, FindsWhatFreshWorldFindsWhileShapesComeAndGo, ()) {
    ShapeLibrary shapes;
    const ShapeId ball = shapes.add_sphere(0.2);
    CollisionWorld world(shapes);
    std::vector<std::optional<ShapeId>> placed(6);
    for (int round = 0; round < 12; ++round) {
        const auto place = *rc::gen::inRange<std::size_t>(0, placed.size());
        const int kind = *rc::gen::inRange(0, 90);
        if (placed[place]) {
            shapes.remove(*placed[place]);
            placed[place].reset();
        } else {
            placed[place] = add_some_shape(shapes, kind);
        }
        std::vector<ColliderProxy> proxies = {
            test::resting(1, ball, {Vec3(0.1, 0.0, 0.15), Quat::Identity()}, true)};
        for (std::size_t i = 0; i < placed.size(); ++i) {
            if (placed[i]) {
                const Pose pose{Vec3(0.1 * static_cast<double>(i), 0.0, -0.1), Quat::Identity()};
                proxies.push_back(test::resting(i + 2, *placed[i], pose, false));
            }
        }
        CollisionWorld fresh(shapes);
        std::vector<ContactPoint> contacts;
        std::vector<ContactPoint> expected;
        world.set_proxies(proxies);
        world.find_contacts({}, contacts);
        fresh.set_proxies(proxies);
        fresh.find_contacts({}, expected);
        RC_ASSERT(same_contacts(contacts, expected));
        const auto hit = world.cast_ray({0.0, 0.0, 2.0}, {0.0, 0.0, -2.0});
        const auto expected_hit = fresh.cast_ray({0.0, 0.0, 2.0}, {0.0, 0.0, -2.0});
        RC_ASSERT(hit.has_value() == expected_hit.has_value());
        RC_ASSERT(!hit || (hit->id == expected_hit->id && hit->point_ws == expected_hit->point_ws));
        shapes.recycle_removed();
    }
}

TEST(ShapeLibrary, RemovedIdFindsNothingUntilItIsReused) {
    ShapeLibrary shapes;
    const ShapeId first = shapes.add_sphere(0.2);
    const ShapeId second = shapes.add_sphere(0.3);
    shapes.remove(first);
    EXPECT_FALSE(shapes.has(first));
    EXPECT_THROW((void)shapes.at(first), PreconditionError);
    EXPECT_THROW(shapes.remove(first), PreconditionError);
    EXPECT_NE(shapes.add_sphere(0.1), first) << "reused before a frame ran without it";
    shapes.recycle_removed();
    EXPECT_EQ(shapes.add_sphere(0.4), first);
    EXPECT_EQ(shapes.at(first).radius_m, 0.4);
    EXPECT_EQ(shapes.at(second).radius_m, 0.3);
}

TEST(GripMeshLibrary, ForgetsSurfacesThatNoShapeHas) {
    ShapeLibrary shapes;
    const std::array two = {shapes.add_box({0.1, 0.1, 0.1}), shapes.add_box({0.1, 0.1, 0.1})};
    GripMeshLibrary meshes(shapes);
    EXPECT_EQ(meshes.distinct_count(), 1U);
    for (const ShapeId id : two) {
        ASSERT_TRUE(meshes.has(id));
        meshes.remove(shapes, id);
        shapes.remove(id);
        EXPECT_FALSE(meshes.has(id));
    }
    EXPECT_EQ(meshes.distinct_count(), 0U);
    EXPECT_EQ(meshes.memory_bytes(), 0U);
}

}  // namespace
}  // namespace handhold::streaming_shapes_test
