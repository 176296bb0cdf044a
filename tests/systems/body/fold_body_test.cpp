// Crouching: the body folds above the tracked floor.
#include "systems/body/shared/fold_body.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "systems/body/propagate_spine.hpp"
#include "tests/random.hpp"
#include "tests/systems/frame/column_scene.hpp"

namespace handhold::fold_body_test {
namespace {

using test::k_player;
using test::Random;

// A player whose eyes are at some height above the tracked floor, which lies at `floor_m`.
struct Body {
    Column<PlayerOrigin> origin;
    Column<PlayerVelocity> velocity;
    Column<ReferenceVelocity> reference;
    Column<BodyMeasures> measures;
    Column<HeadTracking> head;
    Column<ArmEstimate> estimate;
    Column<SpineMemory> memory;
    Column<PersistentId> no_ids;
    Column<HandOwner> no_hands;
    Column<Grab> no_grips;
    Column<BodyHold> no_holds;
    Column<SpinePose> pose;
    double floor_m = 0.0;
    double t_s = 0.0;
    Quat chest = Quat::Identity();

    explicit Body(double eye_height_m = BodyMeasures{}.eye_height_m) {
        origin.add(k_player);
        velocity.add(k_player);
        reference.add(k_player);
        measures.add(k_player).eye_height_m = eye_height_m;
        head.add(k_player);
        estimate.add(k_player);
        memory.add(k_player);
        pose.add(k_player);
    }
    double scale() const { return measures.at(k_player).eye_height_m / k_scale_eye_m; }
    // As estimate_arms places the chest of an upright head.
    const SpinePose& step(double eyes_m, double dt_s = 1.0 / 90.0,
                          const Vec3& velocity_mps = Vec3::Zero()) {
        constexpr double k_eyes_to_chest_m = 0.221;
        head.at(k_player).shift_m.y() = floor_m;
        estimate.at(k_player).chest_ps = {
            Vec3(0.0, floor_m + eyes_m - k_eyes_to_chest_m * scale(), 0.0), chest};
        velocity.at(k_player).linear_mps = velocity_mps;
        t_s += dt_s;
        propagate_spine({.dt_s = dt_s,
                         .t_s = t_s,
                         .surfaces = {},
                         .persistent_id = no_ids,
                         .origin = origin,
                         .velocity = velocity,
                         .reference = reference,
                         .head = head,
                         .measures = measures,
                         .estimate = estimate,
                         .owner = no_hands,
                         .grab = no_grips,
                         .body_hold = no_holds,
                         .memory = memory,
                         .pose = pose},
                        {});
        return pose.at(k_player);
    }
    const SpinePose& settle(double eyes_m) {
        for (int i = 0; i < 200; ++i) {
            step(eyes_m);
        }
        return pose.at(k_player);
    }
};

std::vector<Vec3> joints_of(const SpinePose& pose) {
    std::vector<Vec3> joints = {pose.pelvis_ws.position};
    for (const Pose& link : pose.spine_ws) {
        joints.push_back(link.position);
    }
    for (const SpinePose::Leg& leg : pose.legs) {
        joints.insert(joints.end(),
                      {leg.thigh_ws.position, leg.shin_ws.position, leg.foot_ws.position});
    }
    return joints;
}

void expect_bones(const SpinePose& pose, double scale) {
    for (const SpinePose::Leg& leg : pose.legs) {
        const Vec3 shin = leg.foot_ws.position - leg.shin_ws.position;
        EXPECT_NEAR((leg.shin_ws.position - leg.thigh_ws.position).norm(), k_thigh_m * scale, 1e-9);
        EXPECT_NEAR(shin.norm(), k_shin_m * scale, 1e-9);
        const Vec3 in_thigh = leg.thigh_ws.rotation.conjugate() * shin.normalized();
        EXPECT_GT(in_thigh.z(), -0.03);  // knees bend backwards only
    }
}

TEST(FoldBody, CrouchedPelvisKneesAndAnklesStayAboveTheFloor) {
    Random random(3);
    for (int player = 0; player < 40; ++player) {
        Body body(random.between(1.1, 2.1));
        body.floor_m = random.between(-1.0, 1.0);
        const double eyes_m = random.between(0.3, body.measures.at(k_player).eye_height_m);
        const Quat turned = rotation_about(Vec3::UnitY(), random.between(-3.0, 3.0));
        body.chest = turned * rotation_about(Vec3::UnitX(), random.between(-0.7, 0.3));
        const SpinePose& pose = body.settle(eyes_m);
        EXPECT_GT(pose.pelvis_ws.position.y(), body.floor_m + 0.11 * body.scale()) << eyes_m;
        for (const SpinePose::Leg& leg : pose.legs) {
            EXPECT_GT(leg.shin_ws.position.y(), body.floor_m + 0.03) << eyes_m;
            EXPECT_GT(leg.foot_ws.position.y(), body.floor_m + 0.02) << eyes_m;
        }
        expect_bones(pose, body.scale());
    }
}

// Swinging limbs of a crouched player who drifts about do not pass below the floor either.
TEST(FoldBody, MovingWhileCrouchedKeepsJointsAboveTheFloor) {
    Random random(5);
    for (int player = 0; player < 20; ++player) {
        Body body(random.between(1.3, 2.0));
        const double eyes_m = random.between(0.3, 0.8) * body.measures.at(k_player).eye_height_m;
        body.settle(eyes_m);
        for (int i = 0; i < 300; ++i) {
            const double phase = 0.05 * i + player;
            const Vec3 velocity(2.0 * std::sin(phase), std::cos(1.7 * phase),
                                3.0 * std::sin(0.6 * phase));
            const SpinePose& pose = body.step(eyes_m, 1.0 / 90.0, velocity);
            EXPECT_GT(pose.pelvis_ws.position.y(), 0.1 * body.scale());
            for (const SpinePose::Leg& leg : pose.legs) {
                EXPECT_GT(leg.shin_ws.position.y(), 0.0);
                EXPECT_GT(leg.foot_ws.position.y(), 0.0);
            }
            expect_bones(pose, body.scale());
        }
    }
}

// 1 mm of head height moves no joint by more than 8 mm against the head: nothing pops.
TEST(FoldBody, FoldingIsContinuousInTheHeadsHeight) {
    for (const double pitch : {-0.6, -0.2, 0.0, 0.3}) {
        Body body;
        body.chest = rotation_about(Vec3::UnitX(), pitch);
        std::vector<Vec3> before;
        double most_m = 0.0;
        for (double eyes_m = 1.65; eyes_m > 0.3; eyes_m -= 0.001) {
            body.memory.at(k_player).known = false;  // at rest
            const SpinePose& pose = body.step(eyes_m);
            const std::vector<Vec3> now = joints_of(pose);
            for (std::size_t i = 0; i < before.size(); ++i) {
                most_m = std::max(most_m, (now[i] - before[i]).norm());
            }
            before = now;
        }
        EXPECT_LT(most_m, 0.008) << pitch;
    }
}

TEST(FoldBody, StandingPlayersAreNotChangedByABit) {
    Body standing;
    Body nowhere_near;
    for (int i = 0; i < 100; ++i) {
        const Vec3 velocity(std::sin(0.1 * i), 0.0, -1.0);
        const std::vector<Vec3> a = joints_of(standing.step(1.62, 1.0 / 90.0, velocity));
        const std::vector<Vec3> b = joints_of(nowhere_near.step(5.0, 1.0 / 90.0, velocity));
        for (std::size_t k = 0; k < a.size(); ++k) {
            EXPECT_NEAR((a[k] - b[k] - (a[1] - b[1])).norm(), 0.0, 1e-12);
        }
    }
}

// A tilted body is a crouched one turned about the vertical.
TEST(FoldBody, FacesWhereTheChestFaces) {
    const auto knees = [](double yaw) {
        Body body;
        body.chest = rotation_about(Vec3::UnitY(), yaw);
        const SpinePose& pose = body.settle(0.7);
        const Vec3 middle = 0.5 * (pose.legs[0].shin_ws.position + pose.legs[1].shin_ws.position) -
                            pose.pelvis_ws.position;
        return rotation_about(Vec3::UnitY(), -yaw) * middle;
    };
    const Vec3 ahead = knees(0.0);
    EXPECT_LT(ahead.z(), -0.2);  // in front of the pelvis
    EXPECT_NEAR(ahead.x(), 0.0, 1e-9);
    EXPECT_NEAR((knees(2.1) - ahead).norm(), 0.0, 1e-9);
}

}  // namespace
}  // namespace handhold::fold_body_test
