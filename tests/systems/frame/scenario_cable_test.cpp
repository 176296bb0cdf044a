// Chains of bodies on joints through the whole frame (talk row 7).
#include <algorithm>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "tests/systems/physics/joint_errors.hpp"

namespace handhold::scenario_cable_test {
namespace {

using test::error_of;

// A rope of links along x from the world's origin, the last one in the hand.
struct Cable {
    Scenario scene;
    std::vector<Entity> links;
    std::vector<Entity> joints;
    double worst_m = 0.0;
    double length_m = 0.0;

    explicit Cable(int count) {
        for (int i = 0; i < count; ++i) {
            const Vec3 center(0.05 + 0.1 * i, 0.0, 0.0);
            const std::string name = "link" + std::to_string(i);
            links.push_back(scene.add_crate(name, 1.0, center, Vec3(0.05, 0.02, 0.02)));
            Joint joint;
            joint.kind = JointKind::ball;
            joint.a = i == 0 ? k_no_entity : links[links.size() - 2];
            joint.b = links.back();
            const Pose frame{Vec3(0.1 * i, 0.0, 0.0), Quat::Identity()};
            joints.push_back(
                add_joint(scene.world, {name + "_joint", joint_at(scene.world, joint, frame)}));
        }
        length_m = 0.1 * count;
    }
    void run(double seconds) {
        scene.run(seconds, [this] {
            for (const Entity joint : joints) {
                worst_m = std::max(worst_m, error_of(scene, joint).m);
            }
        });
    }
};

TEST(Cable, HeldEndMovesEveryLinkAndThePlayerByNothing) {
    Cable c(40);
    const Vec3 handle(c.length_m - 0.05, 0.035, 0.0);
    c.scene.script.hands[1] = [&](double t_s) {
        const double away = 0.8 * ease(t_s, 0.3, 1.5);
        const Vec3 sway = 0.2 * std::sin(3.0 * t_s) * ease(t_s, 0.3, 1.0) * Vec3::UnitZ();
        return Pose{hand_for_palm(c.scene, handle - away * Vec3::UnitX() + sway), Quat::Identity()};
    };
    c.scene.script.grabs[1] = [](double t_s) { return t_s > 0.1; };
    c.scene.script.head = [&](double) {
        return Pose{handle + Vec3(0.0, 0.6, 1.0), Quat::Identity()};
    };
    c.scene.add_player_here();
    const Vec3 origin = c.scene.origin();
    c.run(2.5);
    ASSERT_EQ(c.scene.grab(HandSide::right).kind, GripKind::held);
    EXPECT_LE(c.worst_m, 1e-6);
    EXPECT_EQ(c.scene.origin(), origin);
}

TEST(Cable, PulledTautStopsThePlayer) {
    Cable c(12);
    const Vec3 handle(c.length_m - 0.05, 0.035, 0.0);
    c.scene.script.hands[1] = [&](double) {
        return Pose{hand_for_palm(c.scene, handle), Quat::Identity()};
    };
    c.scene.script.grabs[1] = [](double t_s) { return t_s > 0.1; };
    c.scene.script.head = [&](double) {
        return Pose{handle + Vec3(0.0, 0.6, 1.0), Quat::Identity()};
    };
    c.scene.add_player_here(Vec3::Zero(), Vec3(0.5, 0.0, 0.0));
    c.run(2.0);
    EXPECT_LE(c.worst_m, 1e-6);
    // He was already nearly as far as the rope allows: the hand cannot be farther from its end than
    // the rope is long, up to the little that a link may tilt.
    EXPECT_LE(c.scene.origin().x(), 0.1);
    EXPECT_LE(c.scene.velocity().x(), 1e-3);
}

TEST(Joints, HoldBodiesWithoutColliderThatPassThroughEachOther) {
    Scenario scene;
    const RigidBody link{BodyKind::free, 1.0, Vec3(0.01, 0.01, 0.01)};
    const Entity first = scene.add("first", link, k_no_shape, {Vec3(0.1, 0.0, 0.0), {1, 0, 0, 0}});
    const Entity second = scene.add("second", link, k_no_shape, {Vec3(0.3, 0.0, 0.0), {1, 0, 0, 0}},
                                    {Vec3(0.0, 2.0, 0.0), Vec3::Zero()});
    Joint root;
    root.b = first;
    Joint middle;
    middle.a = first;
    middle.b = second;
    const Pose between{Vec3(0.2, 0.0, 0.0), Quat::Identity()};
    const Entity joints[] = {
        add_joint(scene.world, {"root", joint_at(scene.world, root, Pose{})}),
        add_joint(scene.world, {"middle", joint_at(scene.world, middle, between)})};
    scene.add_player_here(Vec3(0.0, 50.0, 0.0));
    test::JointErrors worst;
    scene.run(2.0, [&] {
        for (const Entity joint : joints) {
            worst.take(error_of(scene, joint));
        }
        EXPECT_EQ(scene.stats.contacts, 0U);
    });
    EXPECT_LE(worst.m, 1e-6);
    EXPECT_GT((scene.body(second).position - Vec3(0.3, 0.0, 0.0)).norm(), 0.05) << "it swings";
}

}  // namespace
}  // namespace handhold::scenario_cable_test
