// Pairs of boxes are measured in closed form. Oracle: the same boxes as hulls, which Bullet's GJK
// and EPA measure, and optimality certificates (distance_test.cpp).
#include <cmath>

#include <gtest/gtest.h>

#include "tests/engine/collision/oracle.hpp"

namespace handhold::collision_box_pair_test {
namespace {

using test::Random;
using test::resting;

std::vector<Vec3> corners_of_box(const Vec3& half) { return test::make_box_mesh(half)->positions; }

struct BoxPair {
    Vec3 half_a = Vec3::Constant(0.1);
    Vec3 half_b = Vec3::Constant(0.1);
    Pose pose_a;
    Pose pose_b;
};

// The two boxes' cores, and their contacts as boxes and as hulls.
struct Measured {
    test::Core a;
    test::Core b;
    std::vector<ContactPoint> as_boxes;
    std::vector<ContactPoint> as_hulls;
};

Measured measure(const BoxPair& pair, double margin_m = 10.0) {
    ShapeLibrary shapes;
    const ShapeId box_a = shapes.add_box(pair.half_a);
    const ShapeId box_b = shapes.add_box(pair.half_b);
    const ShapeId hull_a = shapes.add_hull(corners_of_box(pair.half_a));
    const ShapeId hull_b = shapes.add_hull(corners_of_box(pair.half_b));
    const auto contacts = [&](ShapeId a, ShapeId b) {
        return test::contacts_of(
            shapes, {resting(1, b, pair.pose_b, false), resting(2, a, pair.pose_a, true)},
            {margin_m, 0.005});
    };
    return {test::make_core(shapes.at(box_a), pair.pose_a),
            test::make_core(shapes.at(box_b), pair.pose_b), contacts(box_a, box_b),
            contacts(hull_a, hull_b)};
}

ContactPoint deepest_of(const std::vector<ContactPoint>& contacts) {
    return *std::ranges::min_element(contacts, {}, &ContactPoint::separation_m);
}

// The contact's points are on the surfaces, its separation is the gap along its normal, and no
// separation is smaller than GJK's or EPA's.
void expect_certified(const BoxPair& pair, const Measured& measured, int round) {
    const ContactPoint box = deepest_of(measured.as_boxes);
    const ContactPoint hull = deepest_of(measured.as_hulls);
    ASSERT_NEAR(box.separation_m, hull.separation_m, 2e-8) << round;
    const Vec3 normal_ws = pair.pose_b.rotation * box.normal_b_bs;
    ASSERT_NEAR(normal_ws.norm(), 1.0, 1e-12) << round;
    ASSERT_NEAR(gap_along(measured.a, measured.b, normal_ws), box.separation_m, 3e-9) << round;
    const Vec3 point_a_ws = transform_point(pair.pose_a, box.point_a_bs);
    const Vec3 point_b_ws = transform_point(pair.pose_b, box.point_b_bs);
    ASSERT_NEAR(normal_ws.dot(point_a_ws - point_b_ws), box.separation_m, 3e-9) << round;
    const auto beyond_m = [](const Vec3& point_bs, const Vec3& half_m) {
        return (point_bs.cwiseAbs() - half_m).maxCoeff();
    };
    ASSERT_LT(beyond_m(box.point_a_bs, pair.half_a), 3e-9) << round;
    ASSERT_LT(beyond_m(box.point_b_bs, pair.half_b), 3e-9) << round;
}

bool have_same_normal(const Measured& measured) {
    return (deepest_of(measured.as_boxes).normal_b_bs - deepest_of(measured.as_hulls).normal_b_bs)
               .norm() < 1e-7;
}

// Both lists of contacts reach equally far in every direction. (A point between two others may be
// in one list alone: it is redundant.)
void expect_same_outline(const Measured& measured, Random& random, int round) {
    const auto reach_m = [](const std::vector<ContactPoint>& contacts, const Vec3& direction) {
        double farthest = -1e9;
        for (const ContactPoint& contact : contacts) {
            farthest = std::max(farthest, direction.dot(contact.point_b_bs));
        }
        return farthest;
    };
    for (int i = 0; i < 32; ++i) {
        const Vec3 direction = random.direction();
        ASSERT_NEAR(reach_m(measured.as_boxes, direction), reach_m(measured.as_hulls, direction),
                    1e-5)
            << round;
    }
}

TEST(BoxPairs, AgreeWithGjkAndEpaInRandomPoses) {
    Random random(301);
    int apart = 0;
    int overlapping = 0;
    int same_normal = 0;
    constexpr int k_rounds = 6000;
    for (int round = 0; round < k_rounds; ++round) {
        BoxPair pair;
        for (int i = 0; i < 3; ++i) {
            pair.half_a[i] = std::pow(10.0, random.between(-2.0, 0.0));
            pair.half_b[i] = std::pow(10.0, random.between(-2.0, 0.0));
        }
        pair.pose_a = random.pose(round % 2 == 0 ? 1.0 : 0.3);
        pair.pose_b = {random.vector(0.2), random.rotation()};
        const Measured measured = measure(pair);
        ASSERT_NO_FATAL_FAILURE(expect_certified(pair, measured, round));
        (deepest_of(measured.as_boxes).separation_m > 0.0 ? apart : overlapping) += 1;
        if (have_same_normal(measured)) {
            ++same_normal;
            ASSERT_NO_FATAL_FAILURE(expect_same_outline(measured, random, round));
        }
    }
    EXPECT_GT(apart, 1500);
    EXPECT_GT(overlapping, 1500);
    EXPECT_GT(same_normal, k_rounds * 99 / 100);  // the others have two shortest exits
}

// A gap that the closest features leave is found whatever they are. The boxes are moved apart along
// the normal of two corners, of two edges, or of a face of the second and a corner of the first.
TEST(BoxPairs, GapIsThatOfTheClosestFeatures) {
    Random random(302);
    for (int round = 0; round < 4000; ++round) {
        BoxPair pair;
        pair.half_a = Vec3::Constant(0.05) + random.vector(0.02);
        pair.half_b = Vec3::Constant(0.05) + random.vector(0.02);
        pair.pose_b = {random.vector(1.0), random.rotation()};
        const Quat turn = random.rotation();
        pair.pose_a = {pair.pose_b.position, pair.pose_b.rotation * turn};
        Vec3 normal_bs = random.direction();
        const Vec3 axis_bs = Vec3::Unit(round / 3 % 3);
        if (round % 3 == 1) {
            normal_bs = axis_bs.cross(turn * Vec3::Unit(round / 9 % 3)).normalized();
        } else if (round % 3 == 2) {
            normal_bs = random.between(0.0, 1.0) < 0.5 ? Vec3(-axis_bs) : axis_bs;
        }
        const Vec3 normal_ws = pair.pose_b.rotation * normal_bs;
        const auto corner_along = [](const Vec3& half, const Vec3& direction) {
            const auto is_zero = direction.array().abs() < 1e-9;  // the middle of a face or an edge
            return Vec3(is_zero.select(0.0, direction.array().sign() * half.array()));
        };
        const Vec3 corner_b = transform_point(pair.pose_b, corner_along(pair.half_b, normal_bs));
        const Vec3 corner_a =
            pair.pose_a.rotation *
            corner_along(pair.half_a, pair.pose_a.rotation.conjugate() * Vec3(-normal_ws));
        const double gap_m = random.between(1e-4, 0.02);
        pair.pose_a.position = corner_b + gap_m * normal_ws - corner_a;
        const Measured measured = measure(pair, 0.05);
        ASSERT_FALSE(measured.as_boxes.empty()) << round;
        ASSERT_NEAR(deepest_of(measured.as_boxes).separation_m, gap_m, 1e-9) << round;
        ASSERT_LT(
            (pair.pose_b.rotation * deepest_of(measured.as_boxes).normal_b_bs - normal_ws).norm(),
            1e-7)
            << round;
    }
}

// Parallel faces, turned about their normal and shifted: none of their corners need lie within the
// other face.
TEST(BoxPairs, ParallelFacesHaveTheirGap) {
    Random random(303);
    for (int round = 0; round < 4000; ++round) {
        BoxPair pair;
        for (int i = 0; i < 3; ++i) {
            pair.half_a[i] = random.between(0.02, 0.3);
            pair.half_b[i] = random.between(0.02, 0.3);
        }
        const double gap_m = random.between(-0.01, 0.02);
        const double height_m = pair.half_a.y() + pair.half_b.y() + gap_m;
        const double turn_rad =
            round % 3 == 0 ? k_half_pi * (round / 3 % 4) : random.between(-3.0, 3.0);
        pair.pose_b = {random.vector(1.0), random.rotation()};
        const double shift_m = 0.5 * std::min(pair.half_a.minCoeff(), pair.half_b.minCoeff());
        const Vec3 offset_bs(random.between(-shift_m, shift_m), height_m, 0.0);
        pair.pose_a = pair.pose_b * Pose{offset_bs, rotation_about(Vec3::UnitY(), turn_rad)};
        const Measured measured = measure(pair, 0.05);
        ASSERT_NO_FATAL_FAILURE(expect_certified(pair, measured, round));
        ASSERT_NEAR(deepest_of(measured.as_boxes).separation_m, gap_m, 2e-9) << round;
        ASSERT_GE(measured.as_boxes.size(), 4U) << round;
        ASSERT_LE(measured.as_boxes.size(), 8U) << round;
    }
}

// A long plate lies across a beam with a nanometre of overlap and turns about the beam. Its ends
// move far, the part over the beam by less than the grazing tolerance (0.5 mm). Nothing stops it:
// an impact would leave contacts beside the beam, under the plate's ends.
TEST(BoxPairs, PlateThatTurnsOnABeamIsStoppedByNoPointBesideIt) {
    Random random(305);
    for (int round = 0; round < 2000; ++round) {
        BoxPair pair;
        pair.half_a = {random.between(1.0, 2.0), 0.05, 0.3};
        pair.half_b = {random.between(0.03, 0.06), 0.1, 2.5};
        pair.pose_b = {random.vector(1.0), random.rotation()};
        // `under` of the plate lies on `top` of the beam.
        const double end_m = 0.9 * pair.half_a.x();
        const Vec3 under(random.between(-end_m, end_m), -pair.half_a.y(), 0.0);
        const Vec3 top(0.0, pair.half_b.y() - 1e-9, random.between(-1.0, 1.0));
        const double yaw_rad = round % 3 == 0 ? 0.0 : random.between(-0.5, 0.5);
        const Quat yaw = rotation_about(Vec3::UnitY(), yaw_rad);
        const Pose from_bs{top - yaw * under, yaw};
        const double turn_rad = (round % 2 == 0 ? 4e-4 : -4e-4) / pair.half_b.x();
        const Quat turn = rotation_about(Vec3::UnitZ(), turn_rad);
        const Pose to_bs{top - turn * (yaw * under), turn * yaw};
        ShapeLibrary shapes;
        const ShapeId plate = shapes.add_box(pair.half_a);
        const ShapeId beam = shapes.add_box(pair.half_b);
        const std::vector<ContactPoint> contacts = test::contacts_of(
            shapes, {resting(1, beam, pair.pose_b, false),
                     {2, plate, pair.pose_b * from_bs, pair.pose_b * to_bs, true}});
        ASSERT_FALSE(contacts.empty()) << round;
        for (const ContactPoint& contact : contacts) {
            ASSERT_LT((contact.point_b_bs.cwiseAbs() - pair.half_b).maxCoeff(), 1e-6) << round;
            ASSERT_GT(contact.separation_m, -5e-4) << round;
        }
    }
}

// Nearly parallel edges and faces: the axes across edges lose their direction.
TEST(BoxPairs, NearlyAlignedBoxesAgree) {
    Random random(304);
    for (int round = 0; round < 4000; ++round) {
        BoxPair pair;
        pair.half_a = Vec3::Constant(0.1) + random.vector(0.05);
        pair.half_b = Vec3::Constant(0.1) + random.vector(0.05);
        const double tilt_rad = std::pow(10.0, random.between(-17.0, -2.0));
        pair.pose_b = {random.vector(1.0), random.rotation()};
        const Vec3 axis = random.direction();
        pair.pose_a = pair.pose_b * Pose{random.vector(0.25), rotation_about(axis, tilt_rad)};
        ASSERT_NO_FATAL_FAILURE(expect_certified(pair, measure(pair), round));
    }
}

}  // namespace
}  // namespace handhold::collision_box_pair_test
