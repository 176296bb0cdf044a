#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "tests/systems/body/body_columns.hpp"

namespace handhold::across_test {
namespace {

using test::mirrored;
using test::Random;

constexpr double k_radius_m = 0.05;  // of a neck, for an eye height of 1.6 m

struct Tracked {
    Pose head_ps;
    Pose left_ps;
    Pose right_ps;
    BodyMeasures measures;
};
Tracked mirrored(const Tracked& body) {
    return {mirrored(body.head_ps), mirrored(body.right_ps), mirrored(body.left_ps), body.measures};
}

Tracked random_body(Random& random) {
    BodyMeasures measures;
    const double scale = random.between(0.8, 1.2);
    measures.eye_height_m *= scale;
    measures.shoulder_width_m *= scale * random.between(0.9, 1.1);
    measures.upper_arm_m *= scale * random.between(0.9, 1.1);
    measures.forearm_m *= scale * random.between(0.9, 1.1);
    return {{Vec3(0.0, measures.eye_height_m, 0.0), Quat::Identity()}, {}, {}, measures};
}

// Hands beside the head at one height, as on a rail along -Z to the left of the player, who looks a
// little towards it. `overtakes_m`: how far the left hand is ahead of the right one.
Tracked on_a_rail(Random& random, double overtakes_m) {
    Tracked body = random_body(random);
    const double arm_m = body.measures.upper_arm_m + body.measures.forearm_m;
    const double middle_m = random.between(-0.06, 0.06) * arm_m;
    const double height_m = random.between(-0.06, 0.06) * arm_m;
    body.head_ps.rotation = rotation_about(Vec3::UnitY(), random.between(0.55, 0.75));
    const auto hand = [&](double back_m) {
        return Pose{body.head_ps.position + Vec3(-0.8 * arm_m, height_m, back_m),
                    rotation_about(Vec3::UnitZ(), 0.5)};
    };
    body.left_ps = hand(middle_m - 0.5 * overtakes_m);
    body.right_ps = hand(middle_m + 0.5 * overtakes_m);
    return body;
}

struct Posed {
    ArmEstimate estimate;
    ArmPose pose;
};
Posed pose_of(const Tracked& body) {
    test::BodyColumns columns;
    columns.add_player();
    columns.measures.at(test::k_player) = body.measures;
    columns.place(body.head_ps, body.left_ps, body.right_ps);
    columns.estimate_arms(1.0 / 90.0);
    columns.pose_arms();
    return {columns.estimate.at(test::k_player), columns.arm_pose.at(test::k_player)};
}

// Distance between two segments, by points along both: an upper bound within 2 mm.
double distance_m(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
    double least = 1e9;
    for (int i = 0; i <= 100; ++i) {
        const Vec3 point = a + 0.01 * i * (b - a);
        const Vec3 along = d - c;
        const double share = std::clamp(along.dot(point - c) / along.squaredNorm(), 0.0, 1.0);
        least = std::min(least, (c + share * along - point).norm());
    }
    return least;
}

// Least distance of both arms from the line between the base of the neck and the eyes.
double clearance_m(const Tracked& body, const Posed& posed) {
    const Vec3& base = posed.pose.chest_ws.position;
    double least = 1e9;
    for (const ArmPose::Arm& arm : posed.pose.arms) {
        const Vec3& shoulder = arm.upper_ws.position;
        const Vec3& elbow = arm.forearm_ws.position;
        least = std::min({least, distance_m(shoulder, elbow, base, body.head_ps.position),
                          distance_m(elbow, arm.hand_ws.position, base, body.head_ps.position)});
    }
    return least;
}

TEST(ReachAcross, HandsThatOvertakeOnARailKeepTheArmsOutOfTheNeck) {
    Random random(31);
    for (int i = 0; i < 2000; ++i) {
        const Tracked left = on_a_rail(random, random.between(0.0, 0.4));
        const double scale = left.measures.eye_height_m / 1.6;
        for (const Tracked& body : {left, mirrored(left)}) {
            EXPECT_GT(clearance_m(body, pose_of(body)), k_radius_m * scale)
                << (left.right_ps.position - left.left_ps.position).norm();
        }
    }
}

TEST(ReachAcross, MirroredPlayerIsMirrored) {
    Random random(37);
    for (int i = 0; i < 500; ++i) {
        const Tracked body = on_a_rail(random, random.between(-0.5, 0.5));
        const Posed a = pose_of(body);
        const Posed b = pose_of(mirrored(body));
        EXPECT_EQ(mirrored(a.estimate.facing_ps), b.estimate.facing_ps);
        EXPECT_EQ(mirrored(a.pose.arms[1].forearm_ws.position), b.pose.arms[0].forearm_ws.position);
    }
}

}  // namespace
}  // namespace handhold::across_test
