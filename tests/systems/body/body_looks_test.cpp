// How bodies look beside a surface below them, and arms beside the trunk.
#include <gtest/gtest.h>

#include "systems/body/clear_arms.hpp"
#include "systems/body/shared/fold_body.hpp"
#include "tests/random.hpp"
#include "tests/systems/body/hanging_body.hpp"

namespace handhold::body_looks_test {
namespace {

using test::HangingBody;
using test::k_player;

// Surfaces 0.45 to 1.1 m below the chest, tilted by up to 14 degrees: feet do not stand beside the
// chest, knees stay bent, and legs stay apart.
TEST(BodyLooks, BodiesLieAlongASurfaceBelow) {
    test::Random random(118);
    for (int i = 0; i < 40; ++i) {
        HangingBody body;
        const double below_m = random.between(0.45, 1.1);
        const double pitch_rad = random.between(-0.25, 0.25);
        const double roll_rad = random.between(-0.25, 0.25);
        const Quat tilt = rotation_from_vector(Vec3(pitch_rad, 0.0, roll_rad));
        const Vec3 up = tilt * Vec3::UnitY();
        body.put_box(Vec3(6.0, 0.5, 6.0), {Vec3(0.0, 1.4 - below_m, 0.0) - 0.5 * up, tilt});
        // The tracked floor is far below.
        body.head.at(k_player).shift_m.y() = -5.0;
        const SpinePose& pose = body.run(4.0);
        const Vec3 chest = pose.chest_ws.position;
        const Vec3 trunk = chest - pose.pelvis_ws.position;
        for (const SpinePose::Leg& leg : pose.legs) {
            EXPECT_LT(trunk.dot(leg.foot_ws.position - chest), 0.0) << i;
            const Vec3 thigh = leg.shin_ws.position - leg.thigh_ws.position;
            const Vec3 shin = leg.foot_ws.position - leg.shin_ws.position;
            EXPECT_GT(arc_tangent2(thigh.cross(shin).norm(), thigh.dot(shin)),
                      k_least_knee_rad - 0.02)
                << i;
        }
    }
}

// The hand and the bones' lengths stay; arms that are outside stay exactly.
TEST(BodyLooks, ElbowsLeaveTheTrunk) {
    test::Random random(119);
    HangingBody body;
    const SpinePose spine = body.run(0.1);
    int inside = 0;
    for (int i = 0; i < 500; ++i) {
        body.arm_pose.at(k_player) = {};
        ArmPose& arms = body.arm_pose.at(k_player);
        for (const double side : {-1.0, 1.0}) {
            ArmPose::Arm& arm = arms.arms[side < 0.0 ? 0 : 1];
            const Vec3 shoulder = spine.chest_ws.position + Vec3(0.19 * side, 0.0, 0.0);
            arm.upper_ws.position = shoulder;
            arm.forearm_ws.position = shoulder + 0.3 * random.direction();
            // Not beyond the trunk: no turn about the arm's line keeps such a forearm outside.
            const double aside_m = side * random.between(0.05, 0.3);
            const double up_m = random.between(-0.4, 0.1);
            const double back_m = random.between(-0.4, -0.25);
            arm.hand_ws.position = shoulder + Vec3(aside_m, up_m, back_m);
        }
        const ArmPose before = arms;
        clear_arms({.measures = body.measures, .spine = body.spine_pose, .arms = body.arm_pose});
        for (std::size_t side = 0; side < k_hand_count; ++side) {
            const Vec3 was = before.arms[side].forearm_ws.position;
            const Vec3 now = arms.arms[side].forearm_ws.position;
            const Vec3 shoulder = arms.arms[side].upper_ws.position;
            const Vec3 hand = arms.arms[side].hand_ws.position;
            EXPECT_EQ(hand, before.arms[side].hand_ws.position);
            EXPECT_NEAR((now - shoulder).norm(), (was - shoulder).norm(), 1e-9);
            EXPECT_NEAR((now - hand).norm(), (was - hand).norm(), 1e-9);
            inside += now != was ? 1 : 0;
        }
    }
    EXPECT_GT(inside, 50);
}

}  // namespace
}  // namespace handhold::body_looks_test
