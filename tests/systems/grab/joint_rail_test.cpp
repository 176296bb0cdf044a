// The single degree of freedom of levers and drawers. Expected values are closed forms.
#include "systems/grab/shared/joint_rail.hpp"

#include <gtest/gtest.h>

#include "tests/systems/frame/column_scene.hpp"

namespace handhold::joint_rail_test {
namespace {

constexpr Entity k_thing = test::entity(20);
constexpr Entity k_frame = test::entity(21);
constexpr Entity k_handle = test::entity(22);
constexpr Entity k_joint = test::entity(30);
constexpr Entity k_other_joint = test::entity(31);

struct Joined {
    Column<RigidBody> body;
    Column<Joint> joint;
    Column<JointState> joint_state;

    explicit Joined(BodyKind frame = BodyKind::kinematic) {
        body.add(k_thing, {BodyKind::free, 2.0, Vec3::Ones(), 0.0});
        body.add(k_frame, {frame, 5.0, Vec3::Ones(), 0.0});
        body.add(k_handle, {BodyKind::free, 0.5, Vec3::Ones(), 0.0});
    }
    Joint& add(Entity entity, JointKind kind, Entity a, Entity b) {
        joint_state.add(entity);
        Joint settings;
        settings.kind = kind;
        settings.a = a;
        settings.b = b;
        settings.frame_a_bs = {Vec3(1.0, 0.0, 0.0), rotation_between(Vec3::UnitX(), Vec3::UnitY())};
        settings.frame_b_bs = {Vec3(0.0, 0.0, 2.0), rotation_between(Vec3::UnitX(), Vec3::UnitZ())};
        return joint.add(entity, settings);
    }
    std::optional<JointRail> rail() const {
        return find_rail({.body = body, .joint = joint, .joint_state = joint_state}, k_thing,
                         PhaseTuning{});
    }
};

TEST(JointRail, IsTheHoldersEndOfTheJointWhicheverEndThatIs) {
    Joined to_world;
    to_world.add(k_joint, JointKind::hinge, k_no_entity, k_thing);
    const auto world = to_world.rail();
    ASSERT_TRUE(world);
    EXPECT_TRUE(is_null(world->holder));
    EXPECT_TRUE(world->turns);
    EXPECT_LE((world->axis_hs - Vec3::UnitY()).norm(), 1e-15);
    EXPECT_EQ(world->point_hs, Vec3(1.0, 0.0, 0.0));

    Joined to_frame;
    to_frame.add(k_joint, JointKind::slider, k_thing, k_frame);
    const auto frame = to_frame.rail();
    ASSERT_TRUE(frame);
    EXPECT_EQ(frame->holder, k_frame);
    EXPECT_FALSE(frame->turns);
    EXPECT_LE((frame->axis_hs - Vec3::UnitZ()).norm(), 1e-15);
}

TEST(JointRail, IsNoneWhereAnythingElseIsLeftFree) {
    Joined loose(BodyKind::free);
    loose.add(k_joint, JointKind::hinge, k_frame, k_thing);
    EXPECT_FALSE(loose.rail()) << "what holds it goes with the hand";
    for (const JointKind kind : {JointKind::ball, JointKind::distance, JointKind::fixed}) {
        Joined scene;
        scene.add(k_joint, kind, k_no_entity, k_thing);
        EXPECT_FALSE(scene.rail());
    }
    Joined twice;
    twice.add(k_joint, JointKind::hinge, k_no_entity, k_thing);
    twice.add(k_other_joint, JointKind::hinge, k_frame, k_thing);
    EXPECT_FALSE(twice.rail());
    EXPECT_FALSE(Joined().rail());
}

TEST(JointRail, OfADoorIsItsHingeWhateverHandleHangsOnIt) {
    Joined door;
    door.add(k_joint, JointKind::hinge, k_frame, k_thing);
    door.add(k_other_joint, JointKind::hinge, k_thing, k_handle);
    const auto rail = door.rail();
    ASSERT_TRUE(rail);
    EXPECT_EQ(rail->holder, k_frame);
}

TEST(JointRail, EndsAtTheJointsLimitsAndALatchHoldsIt) {
    for (const bool is_b : {true, false}) {
        Joined scene;
        Joint& joint = scene.add(k_joint, JointKind::hinge, is_b ? k_frame : k_thing,
                                 is_b ? k_thing : k_frame);
        joint.limited = true;
        joint.lower = -1.0;
        joint.upper = 0.5;
        JointState& state = scene.joint_state.at(k_joint);
        state.coordinate = 0.2;
        EXPECT_NEAR(scene.rail()->back, is_b ? -1.2 : -0.3, 1e-15);
        EXPECT_NEAR(scene.rail()->ahead, is_b ? 0.3 : 1.2, 1e-15);
        const Pose end = moved_along(*scene.rail(), {}, 2.0);
        EXPECT_NEAR(rotation_to_vector(end.rotation).norm(), is_b ? 0.3 : 1.2, 1e-12);
        state.latched = true;
        EXPECT_EQ(scene.rail()->back, 0.0);
        EXPECT_EQ(scene.rail()->ahead, 0.0);
    }
}

TEST(JointRail, TakesAPointAsNearToTheHandAsTheJointLetsIt) {
    Joined scene;
    scene.add(k_joint, JointKind::hinge, k_no_entity, k_thing);
    const JointRail hinge = *scene.rail();
    const Vec3 from(1.3, 0.4, 0.0);
    const Quat turn = rotation_about(Vec3::UnitY(), 0.7);
    const Vec3 on_arc = hinge.point_hs + turn * (from - hinge.point_hs);
    EXPECT_NEAR(travel_along(hinge, from, on_arc), 0.7, 1e-15);
    // Along the axle and away from it the body cannot move.
    const Vec3 beside = on_arc + Vec3(0.0, 0.3, 0.0) + 0.5 * (turn * Vec3::UnitX());
    EXPECT_NEAR(travel_along(hinge, from, beside), 0.7, 1e-15);
    EXPECT_EQ(travel_along(hinge, hinge.point_hs, on_arc), 0.0);
    const Pose moved = moved_along(hinge, {from, Quat::Identity()}, 0.7);
    EXPECT_LE((moved.position - on_arc).norm(), 1e-15);
    EXPECT_LE(test::angle_between(moved.rotation, turn), 1e-7);

    JointRail slider = hinge;
    slider.turns = false;
    EXPECT_NEAR(travel_along(slider, from, from + Vec3(3.0, -0.2, 1.0)), -0.2, 1e-15);
    const Vec3 slid = moved_along(slider, {from, turn}, -0.2).position;
    EXPECT_LE((slid - (from - Vec3(0.0, 0.2, 0.0))).norm(), 1e-15);
}

// One hand rests at the lever's end; another, near the axle, trembles across its arm. By least
// squares, the end moves by at most the tremble times the ratio of the arms.
TEST(JointRail, HandsNearTheAxleHardlyCount) {
    constexpr double k_tremble_m = 5e-4;
    constexpr double k_end_m = 0.5;
    Joined scene;
    scene.add(k_joint, JointKind::hinge, k_no_entity, k_thing);
    const JointRail hinge = *scene.rail();
    const Vec3 along = hinge.axis_hs.unitOrthogonal();
    const Vec3 across = hinge.axis_hs.cross(along);
    const Vec3 end_hs = hinge.point_hs + k_end_m * along;
    for (const double arm_m : {0.002, 0.005, 0.01, 0.05}) {
        const Vec3 near_hs = hinge.point_hs + arm_m * along;
        const double near = weight_along(hinge, near_hs);
        const double way_rad = near * travel_along(hinge, near_hs, near_hs + k_tremble_m * across) /
                               (near + weight_along(hinge, end_hs));
        EXPECT_LE(k_end_m * way_rad, k_tremble_m * arm_m / k_end_m) << arm_m;
        EXPECT_GT(way_rad, 0.0) << arm_m;
    }
    JointRail slider = hinge;
    slider.turns = false;
    EXPECT_EQ(weight_along(slider, hinge.point_hs), weight_along(slider, end_hs));
}

}  // namespace
}  // namespace handhold::joint_rail_test
