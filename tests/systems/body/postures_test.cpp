// Bodies of players who lie down, and of players whose neck alone bends.
#include <algorithm>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "systems/body/shared/lie_down.hpp"
#include "tests/random.hpp"
#include "tests/systems/body/body_columns.hpp"

namespace handhold::postures_test {
namespace {

using test::k_player;
using test::Random;

// Head and hands at one time, for a player of average size.
struct Posture {
    Pose head;
    std::array<Pose, k_hand_count> hands;
};

// A player of `size` times the average in a room turned by `heading`.
struct Player : test::BodyColumns {
    double size;
    Pose room;

    Player(double size_, double heading_rad)
        : size(size_), room{Vec3::Zero(), rotation_about(Vec3::UnitY(), heading_rad)} {
        add_player();
        BodyMeasures& own = measures.at(k_player);
        own.eye_height_m *= size;
        own.shoulder_width_m *= size;
        own.upper_arm_m *= size;
        own.forearm_m *= size;
    }
    Pose placed(const Pose& of_average) const {
        return room * Pose{size * of_average.position, of_average.rotation};
    }
    // Back to an average player's room.
    Vec3 seen(const Vec3& place) const { return (room.rotation.conjugate() * place) / size; }

    void step(const Posture& posture, double dt_s) {
        place(placed(posture.head), placed(posture.hands[0]), placed(posture.hands[1]));
        estimate_arms(dt_s);
        pose_arms();
        propagate_spine(dt_s);
    }
    Vec3 hips() const { return seen(spine_pose.at(k_player).pelvis_ws.position); }
    Vec3 foot(HandSide side) const {
        return seen(spine_pose.at(k_player).legs[index_of(side)].foot_ws.position);
    }
    // All joints but the hands, which are where the devices say.
    std::vector<Vec3> joints() const {
        const SpinePose& spine = spine_pose.at(k_player);
        std::vector<Vec3> list = test::joints_of(spine);
        list.push_back(spine.chest_ws.position);
        for (const ArmPose::Arm& arm : arm_pose.at(k_player).arms) {
            list.push_back(arm.upper_ws.position);
            list.push_back(arm.forearm_ws.position);
        }
        for (Vec3& joint : list) {
            joint = seen(joint);
        }
        return list;
    }
};

double eased(double t) {
    const double x = std::clamp(t, 0.0, 1.0);
    return x * x * (3.0 - 2.0 * x);
}

// The trunk turns about the hips at (0, 0.12, 0) from sitting on the floor to lying.
const Vec3 k_hips(0.0, 0.12, 0.0);
Posture lying(const Vec3& axis, double share, double pillow_m) {
    const Quat turn = rotation_about(axis, 0.5 * k_pi * share);
    const auto place = [&](const Vec3& on_trunk, double lowest_m) {
        Vec3 at = k_hips + turn * on_trunk;
        at.y() = std::max(at.y(), lowest_m);
        return Pose{at, turn};
    };
    Posture posture{place(Vec3(0.0, 0.70, -0.09), 0.0),
                    {place(Vec3(-0.2, 0.35, -0.25), 0.06), place(Vec3(0.2, 0.35, -0.25), 0.06)}};
    posture.head.position.y() += share * pillow_m;
    return posture;
}

// On the back, the front and either side, at any frame rate, slowly or quickly, whatever the
// player's size and heading: the shown hips are where the real ones are, and nothing is below the
// floor once the player lies.
RC_GTEST_PROP(Postures, LyingPlayersLieOnTheFloor, ()) {
    Random random(*rc::gen::arbitrary<std::uint64_t>());
    const Vec3 axis = *rc::gen::element(Vec3(Vec3::UnitX()), Vec3(-Vec3::UnitX()),
                                        Vec3(Vec3::UnitZ()), Vec3(-Vec3::UnitZ()));
    const double size = random.between(0.7, 1.2);
    Player player(size, random.between(-3.0, 3.0));
    const double hz = random.between(30.0, 144.0);
    const double lasts_s = random.between(0.5, 3.0);
    const double pillow_m = random.between(0.0, 0.08);
    const int frames = static_cast<int>((lasts_s + 5.0) * hz);
    for (int i = 1; i <= frames; ++i) {
        const double share = eased((i / hz - 1.0) / lasts_s);
        player.step(lying(axis, share, pillow_m), 1.0 / hz);
    }
    RC_ASSERT((player.hips() - k_hips).norm() < 0.3);
    for (const Vec3& joint : player.joints()) {
        RC_ASSERT(joint.y() > -0.02);
    }
}

// A neck that bends about a point between ears and shoulders, by up to 45 degrees and in any
// direction, slowly or as a glance: hips move by at most 0.135 m and feet by 0.25 m, at any time.
RC_GTEST_PROP(Postures, NeckThatBendsLeavesHipsAndFeet, ()) {
    Random random(*rc::gen::arbitrary<std::uint64_t>());
    const double size = random.between(0.7, 1.2);
    Player player(size, random.between(-3.0, 3.0));
    const double hz = random.between(45.0, 144.0);
    const double lasts_s = random.between(0.15, 2.0);
    const double way = random.between(-k_pi, k_pi);
    const Vec3 axis(std::cos(way), 0.0, std::sin(way));
    const double angle = random.between(0.1, 0.25 * k_pi);
    const double below_m = random.between(0.06, 0.13);
    const Vec3 pivot(0.0, 1.6 - below_m, random.between(0.06, 0.1));
    const Posture upright{{Vec3(0.0, 1.6, 0.0), Quat::Identity()},
                          {Pose{Vec3(-0.2, 1.1, -0.25), Quat::Identity()},
                           Pose{Vec3(0.2, 1.1, -0.25), Quat::Identity()}}};
    for (int i = 0; i < static_cast<int>(3.0 * hz); ++i) {
        player.step(upright, 1.0 / hz);
    }
    const Vec3 hips = player.hips();
    const std::array<Vec3, k_hand_count> feet = {player.foot(HandSide::left),
                                                 player.foot(HandSide::right)};
    for (int i = 1; i <= static_cast<int>((lasts_s + 4.0) * hz); ++i) {
        Posture bent = upright;
        bent.head.rotation = rotation_about(axis, angle * eased(i / hz / lasts_s));
        bent.head.position = pivot + bent.head.rotation * (upright.head.position - pivot);
        player.step(bent, 1.0 / hz);
        RC_ASSERT((player.hips() - hips).norm() < 0.135);
        RC_ASSERT((player.foot(HandSide::left) - feet[0]).norm() < 0.25);
        RC_ASSERT((player.foot(HandSide::right) - feet[1]).norm() < 0.25);
    }
}

// Who sits, squats or stoops does not lie, wherever the head looks.
RC_GTEST_PROP(Postures, HeadsThatAreHighEnoughDoNotLie, ()) {
    Random random(*rc::gen::arbitrary<std::uint64_t>());
    const Quat look = random.rotation();
    const Mat3 axes = look.toRotationMatrix();
    RC_ASSERT(lying_share(random.between(0.72, 2.0), axes.col(1), -axes.col(2)) == 0.0);
    // A level head belongs to a trunk that is upright or leans forward, as on hands and knees.
    const Quat level = rotation_about(Vec3::UnitY(), random.between(-3.0, 3.0));
    RC_ASSERT(lying_share(random.between(0.35, 0.72), Vec3::UnitY(), level * -Vec3::UnitZ()) ==
              0.0);
}

TEST(Postures, ShareOfLyingIsContinuous) {
    Random random(5);
    for (int i = 0; i < 2000; ++i) {
        const Quat look = random.rotation();
        const Vec3 turn = 1e-4 * random.direction();
        const Quat near = (rotation_from_vector(turn) * look).normalized();
        const double eyes_m = random.between(0.0, 0.8);
        const auto share = [](double height_m, const Quat& q) {
            const Mat3 axes = q.toRotationMatrix();
            return lying_share(height_m, axes.col(1), -axes.col(2));
        };
        EXPECT_NEAR(share(eyes_m, look), share(eyes_m + 1e-4, near), 5e-3);
    }
}

}  // namespace
}  // namespace handhold::postures_test
