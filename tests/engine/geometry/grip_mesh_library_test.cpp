#include "engine/geometry/grip_mesh_library.hpp"

#include <gtest/gtest.h>

#include "broken_meshes.hpp"
#include "engine/core/check.hpp"
#include "engine/core/parallel.hpp"

namespace handhold::grip_mesh_library_test {
namespace {

TEST(GripMeshLibraryThreaded, SharesEqualShapesForAnyThreadCount) {
    ShapeLibrary shapes;
    const auto ball = std::make_shared<const Mesh>(test::make_clean_ball(0.2, 20, 30));
    const ShapeId plain = shapes.add_mesh(ball);
    const ShapeId again = shapes.add_mesh(ball);
    const ShapeId wide = shapes.add_mesh(ball, {2.0, 1.0, 1.0});
    const ShapeId box = shapes.add_box({0.1, 0.2, 0.3});
    const ShapeId same_box = shapes.add_box({0.1, 0.2, 0.3});
    const ShapeId other_box = shapes.add_box({0.1, 0.2, 0.31});
    const GripMeshLibrary one(shapes);
    EXPECT_EQ(one.distinct_count(), 4U);
    EXPECT_EQ(&one.at(plain), &one.at(again));
    EXPECT_EQ(&one.at(box), &one.at(same_box));
    EXPECT_NE(&one.at(plain), &one.at(wide));
    EXPECT_NE(&one.at(box), &one.at(other_box));
    EXPECT_GT(one.memory_bytes(), 1000U);
    set_thread_count(4);
    const GripMeshLibrary four(shapes);
    set_thread_count(1);
    for (std::uint32_t i = 0; i < shapes.size(); ++i) {
        EXPECT_EQ(one.at({i}).search.triangles, four.at({i}).search.triangles);
        EXPECT_EQ(one.at({i}).contact.positions, four.at({i}).contact.positions);
        EXPECT_EQ(one.at({i}).contact.triangles, build_grip_mesh(shapes.at({i})).contact.triangles);
    }
}

TEST(GripMeshLibrary, HasOnlyWantedShapes) {
    ShapeLibrary shapes;
    const ShapeId box = shapes.add_box({0.1, 0.2, 0.3});
    const ShapeId ball = shapes.add_sphere(0.1);
    const std::vector<ShapeId> wanted = {ball};
    const GripMeshLibrary library(shapes, wanted);
    EXPECT_TRUE(library.has(ball));
    EXPECT_FALSE(library.has(box));
    EXPECT_FALSE(library.has(k_no_shape));
    EXPECT_THROW((void)library.at(box), PreconditionError);
    EXPECT_FALSE(GripMeshLibrary().has(box));
}

TEST(GripMeshLibrary, AddBuildsOnlyMissingMeshes) {
    ShapeLibrary shapes;
    const ShapeId box = shapes.add_box({0.1, 0.2, 0.3});
    GripMeshLibrary library(shapes);
    const ShapeId same_box = shapes.add_box({0.1, 0.2, 0.3});
    const ShapeId ball = shapes.add_sphere(0.1);
    const ShapeId unwanted = shapes.add_sphere(0.2);
    const std::vector<ShapeId> wanted = {box, same_box, ball};
    library.add(shapes, wanted);
    EXPECT_EQ(library.distinct_count(), 2U);
    EXPECT_EQ(&library.at(box), &library.at(same_box));
    EXPECT_EQ(library.at(ball).contact.triangles,
              build_grip_mesh(shapes.at(ball)).contact.triangles);
    EXPECT_FALSE(library.has(unwanted));
    library.add(shapes, wanted);
    EXPECT_EQ(library.distinct_count(), 2U);
}

}  // namespace
}  // namespace handhold::grip_mesh_library_test
