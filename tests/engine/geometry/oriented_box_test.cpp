#include "engine/geometry/oriented_box.hpp"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "tests/random.hpp"

namespace handhold::oriented_box_test {
namespace {

using test::Random;

// Stores boxes rounded outwards, as the tree does.
void put_rounded(const Vec3& low, const Vec3& high, std::size_t lane, Boxes4& boxes) {
    constexpr float k_infinity = std::numeric_limits<float>::infinity();
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const auto at = static_cast<Eigen::Index>(axis);
        boxes.low[axis][lane] = std::nextafter(static_cast<float>(low[at]), -k_infinity);
        boxes.high[axis][lane] = std::nextafter(static_cast<float>(high[at]), k_infinity);
    }
}

// A corner of the aligned box lies on a face of the oriented one and the rest lies outside. The
// smallest rounding in the wrong direction would reject it. Boxes 4 cm farther away are rejected.
TEST(OrientedBoxTest, TouchingBoxesAreNeverRejected) {
    Random random(1508);
    int apart = 0;
    constexpr int k_boxes = 20000;
    for (int i = 0; i < k_boxes; ++i) {
        const Mat3 turn = random.rotation().toRotationMatrix();
        const Vec3 touch = random.vector(10.0);
        const int face = i % 3;
        OrientedBox box;
        box.half_extents = random.vector(0.1).cwiseAbs();
        for (int axis = 0; axis < 3; ++axis) {
            const double off = axis == face ? -1.0 : random.between(-1.0, 1.0);
            box.axis[static_cast<std::size_t>(axis)] = turn.row(axis).transpose();
            box.centre[axis] = turn.row(axis).dot(touch) + off * box.half_extents[axis];
        }
        const Vec3 outwards = turn.row(face).transpose();
        const Vec3 size = random.vector(0.1).cwiseAbs();
        const Vec3 low = touch - (outwards.array() < 0.0).select(size, Vec3::Zero());
        const Vec3 high = low + size;
        const double reach_m = std::max(low.cwiseAbs().maxCoeff(), high.cwiseAbs().maxCoeff());
        const OrientedBoxTest test(box, reach_m + 0.1);
        const Vec3 away = 0.04 * outwards;
        Boxes4 boxes;
        const auto touching = static_cast<std::size_t>(i % 4);
        for (std::size_t lane = 0; lane < 4; ++lane) {
            const Vec3 off = lane == touching ? Vec3(Vec3::Zero()) : away;
            put_rounded(low + off, high + off, lane, boxes);
        }
        const Int4 is_met = test.may_meet(boxes);
        ASSERT_NE(is_met[touching], 0) << i;
        for (std::size_t lane = 0; lane < 4; ++lane) {
            apart += is_met[lane] == 0 ? 1 : 0;
        }
    }
    EXPECT_EQ(apart, 3 * k_boxes);
}

}  // namespace
}  // namespace handhold::oriented_box_test
