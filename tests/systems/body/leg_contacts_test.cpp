// Legs stay outside surfaces and slide along them.
#include <algorithm>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "engine/anim/deflect_outward.hpp"
#include "engine/collision/collision_world.hpp"
#include "tests/random.hpp"
#include "tests/systems/body/hanging_body.hpp"

namespace handhold::leg_contacts_test {
namespace {

using test::k_player;

constexpr double k_sole_m = 0.11;

// Moves at a given velocity; grips nothing.
struct Body : test::HangingBody {
    const SpinePose& step(const Vec3& velocity_mps, double dt_s) {
        origin.at(k_player).pose_ws.position += dt_s * velocity_mps;
        velocity.at(k_player).linear_mps = velocity_mps;
        return HangingBody::step(dt_s);
    }
};

void put_floor(Body& body, double top_y_m) {
    body.put_box(Vec3(5.0, 0.5, 5.0), {Vec3(0.0, top_y_m - 0.5, 0.0), Quat::Identity()});
}
double lowest_m(const SpinePose& pose) {
    double low = 1e9;
    for (const SpinePose::Leg& leg : pose.legs) {
        low = std::min({low, leg.shin_ws.position.y(), leg.foot_ws.position.y()});
    }
    return low;
}

TEST(TurnOut, IsTheSmallestRotationToThePlane) {
    test::Random random(5);
    for (int i = 0; i < 500; ++i) {
        const Vec3 towards = random.direction();
        const Vec3 normal = random.direction();
        const double least = random.between(-0.99, 0.99);
        const Vec3 turned = deflect_outward(towards, normal, least, 2.0);
        EXPECT_NEAR(turned.norm(), 1.0, 1e-12);
        if (towards.dot(normal) >= least) {
            EXPECT_EQ(turned, towards);
        } else {
            // In the plane of both, on the rim.
            EXPECT_NEAR(turned.dot(normal), least, 1e-12);
            EXPECT_NEAR(towards.cross(normal).dot(turned), 0.0, 1e-12);
        }
        EXPECT_LE(deflect_outward(towards, normal, least, 0.01).dot(normal),
                  std::max(towards.dot(normal), towards.dot(normal) + 0.01) + 1e-12);
    }
}

TEST(LegContacts, WithoutObstaclesLegsAreBitwiseUnchanged) {
    Body alone;
    Body beside;
    put_floor(beside, -3.0);
    for (int i = 0; i < 300; ++i) {
        const Vec3 velocity(std::sin(0.03 * i), 0.2 * std::cos(0.05 * i), -1.0);
        const SpinePose& a = alone.step(velocity, 1.0 / 90.0);
        const SpinePose& b = beside.step(velocity, 1.0 / 90.0);
        EXPECT_EQ(a.legs[0].foot_ws.position, b.legs[0].foot_ws.position);
        EXPECT_EQ(a.legs[1].shin_ws.rotation.coeffs(), b.legs[1].shin_ws.rotation.coeffs());
    }
}

// Descends towards a floor at 0.4 m/s until the unbent soles would be 20 cm below it, the ankles 9
// cm.
TEST(LegContacts, LegsBendBeforeAnApproachingFloor) {
    for (const double hz : {36.0, 90.0, 144.0}) {
        Body free;
        Body body;
        const double sole_m = lowest_m(body.step(Vec3::Zero(), 1.0 / hz)) - k_sole_m;
        free.step(Vec3::Zero(), 1.0 / hz);
        const double floor_m = sole_m - 0.2;
        put_floor(body, floor_m);
        double deepest_m = 0.0;
        double most_mps = 0.0;
        Vec3 foot = body.spine_pose.at(k_player).legs[0].foot_ws.position;
        for (int i = 0; i < static_cast<int>(hz * 4.0); ++i) {
            const Vec3 velocity(0.0, i < hz ? -0.4 : 0.0, 0.0);
            const SpinePose& pose = body.step(velocity, 1.0 / hz);
            free.step(velocity, 1.0 / hz);
            deepest_m = std::max(deepest_m, floor_m - lowest_m(pose));
            most_mps = std::max(most_mps, (pose.legs[0].foot_ws.position - foot).norm() * hz);
            foot = pose.legs[0].foot_ws.position;
        }
        EXPECT_LT(lowest_m(free.spine_pose.at(k_player)), floor_m - 0.08) << hz;
        EXPECT_LT(deepest_m, 0.005) << hz;
        EXPECT_LT(most_mps, 3.0) << hz;
        // At rest on it.
        const Vec3 before = body.spine_pose.at(k_player).legs[0].foot_ws.position;
        body.step(Vec3::Zero(), 1.0 / hz);
        EXPECT_LT((body.spine_pose.at(k_player).legs[0].foot_ws.position - before).norm() * hz,
                  0.05);
    }
}

// The same at 36 and at 144 frames a second.
TEST(LegContacts, LegsOnAFloorHardlyDependOnTheFrameRate) {
    const auto feet = [](int hz) {
        Body body;
        put_floor(body, lowest_m(body.step(Vec3::Zero(), 1.0 / hz)) - k_sole_m - 0.2);
        std::vector<Vec3> at_36;
        for (int i = 0; i < 4 * hz; ++i) {
            const SpinePose& pose = body.step(Vec3(0.3, i < hz ? -0.5 : 0.0, 0.0), 1.0 / hz);
            if ((i + 1) % (hz / 36) == 0) {
                at_36.push_back(pose.legs[1].foot_ws.position - pose.chest_ws.position);
            }
        }
        return at_36;
    };
    const std::vector<Vec3> slow = feet(36);
    const std::vector<Vec3> fast = feet(144);
    double apart_m = 0.0;
    for (std::size_t i = 0; i < slow.size(); ++i) {
        apart_m = std::max(apart_m, (slow[i] - fast[i]).norm());
    }
    EXPECT_LT(apart_m, 0.03);
    RecordProperty("apart_um", static_cast<int>(1e6 * apart_m));
}

// Teleported so that the floor is at knee height: the legs rise above it within a second, without a
// jump.
TEST(LegContacts, LegsRiseOutOfAFloorWithoutAJump) {
    Body body;
    body.step(Vec3::Zero(), 1.0 / 90.0);
    const double knee_m = body.spine_pose.at(k_player).legs[0].shin_ws.position.y();
    put_floor(body, knee_m - 0.05);
    Vec3 foot = body.spine_pose.at(k_player).legs[0].foot_ws.position;
    for (int i = 0; i < 180; ++i) {
        const SpinePose& pose = body.step(Vec3::Zero(), 1.0 / 90.0);
        EXPECT_LT((pose.legs[0].foot_ws.position - foot).norm(), 0.08) << i;
        foot = pose.legs[0].foot_ws.position;
    }
    // The knee's limit: 70 degrees from a thigh that points 14 degrees ahead.
    const double limit_m = 0.39 * std::cos((70.0 - 14.0) * k_pi / 180.0);
    EXPECT_GT(foot.y(), knee_m - limit_m - 0.01);  // from 0.36 below the knee
}

TEST(LegContacts, LegsIgnoreTheirOwnersHead) {
    Body alone;
    Body body;
    // a head sphere that contains the whole player.
    const ShapeId shape = body.shapes.add_sphere(3.0);
    body.collision.emplace(body.shapes);
    const std::vector<ColliderProxy> own = {{Body::k_own_id, shape, {}, {}, true}};
    body.collision->set_proxies(own);
    for (int i = 0; i < 90; ++i) {
        const Vec3 velocity(0.0, 0.0, -1.0);
        EXPECT_EQ(body.step(velocity, 1.0 / 90.0).legs[0].foot_ws.position,
                  alone.step(velocity, 1.0 / 90.0).legs[0].foot_ws.position);
    }
}

}  // namespace
}  // namespace handhold::leg_contacts_test
