#include "systems/body/layer_additives.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include <gtest/gtest.h>

#include "components/body_clip_state.hpp"
#include "systems/body/estimate_arms.hpp"
#include "systems/body/pose_arms.hpp"
#include "systems/body/propagate_spine.hpp"
#include "systems/rigs/body_clips_json.hpp"
#include "tests/systems/frame/column_scene.hpp"

namespace handhold::layer_additives_test {
namespace {

using test::k_left;
using test::k_player;
using test::k_right;

constexpr double k_dt_s = 1.0 / 90.0;

// Columns of one player's body, with clips.
struct Body {
    Column<PlayerOrigin> origin;
    Column<PlayerVelocity> velocity;
    Column<ReferenceVelocity> reference;
    Column<HeadTracking> head;
    Column<BodyMeasures> measures;
    Column<HandOwner> owner;
    Column<Grab> grab;
    Column<PalmPose> palm;
    Column<ArmMemory> arm_memory;
    Column<ArmEstimate> estimate;
    Column<ArmPose> arms;
    Column<SpineMemory> spine_memory;
    Column<PersistentId> no_ids;
    Column<Grab> no_grips;  // for the chain, which does not hang from hands here
    Column<BodyHold> no_holds;
    Column<SpinePose> spine;
    Column<BodyClipState> state;
    BodyClips clips;
    AdditiveTuning tuning;
    double t_s = 0.0;

    Body() {
        origin.add(k_player);
        velocity.add(k_player);
        reference.add(k_player);
        head.add(k_player);
        head.at(k_player).pose_ps.position = Vec3(0.0, 1.62, 0.0);
        measures.add(k_player);
        arm_memory.add(k_player);
        estimate.add(k_player);
        arms.add(k_player);
        spine_memory.add(k_player);
        spine.add(k_player);
        state.add(k_player);
        owner.add(k_left, {k_player, HandSide::left});
        owner.add(k_right, {k_player, HandSide::right});
        palm.add(k_left).pose_ws.position = Vec3(-0.25, 1.2, -0.3);
        palm.add(k_right).pose_ws.position = Vec3(0.25, 1.2, -0.3);
        grab.add(k_left);
        grab.add(k_right);
    }
    void step(double dt_s = k_dt_s) {
        t_s += dt_s;
        estimate_arms({.dt_s = dt_s,
                       .origin = origin,
                       .head = head,
                       .measures = measures,
                       .owner = owner,
                       .palm = palm,
                       .memory = arm_memory,
                       .estimate = estimate},
                      {});
        layer_clavicles({.clips = clips, .measures = measures, .estimate = estimate}, tuning, {});
        pose_arms({.origin = origin,
                   .measures = measures,
                   .owner = owner,
                   .palm = palm,
                   .estimate = estimate,
                   .arms = arms});
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
                         .owner = owner,
                         .grab = no_grips,
                         .body_hold = no_holds,
                         .memory = spine_memory,
                         .pose = spine},
                        {});
        layer_additives({.dt_s = dt_s,
                         .clips = clips,
                         .head = head,
                         .origin = origin,
                         .velocity = velocity,
                         .reference = reference,
                         .owner = owner,
                         .grab = grab,
                         .estimate = estimate,
                         .memory = spine_memory,
                         .state = state,
                         .pose = spine},
                        tuning);
    }
    void hold(bool holds) { grab.at(k_left).kind = holds ? GripKind::surface : GripKind::none; }
    const SpinePose& pose() const { return spine.at(k_player); }
    const ArmPose& arm_pose() const { return arms.at(k_player); }
};

ClipTurns with_turn(std::size_t bone, const Vec3& turn) {
    ClipTurns turns = no_turns();
    turns[bone] = turn;
    return turns;
}
BodyClip& clip(Body& body, BodyClipName name) {
    return body.clips.clips[static_cast<std::size_t>(name)];
}

void expect_same_bits(const Pose& a, const Pose& b) {
    EXPECT_EQ(a.position, b.position);
    EXPECT_EQ(a.rotation.coeffs(), b.rotation.coeffs());
}
void expect_same_body(const Body& a, const Body& b) {
    expect_same_bits(a.pose().pelvis_ws, b.pose().pelvis_ws);
    for (std::size_t i = 0; i < k_spine_links; ++i) {
        expect_same_bits(a.pose().spine_ws[i], b.pose().spine_ws[i]);
    }
    for (std::size_t side = 0; side < k_hand_count; ++side) {
        expect_same_bits(a.pose().legs[side].shin_ws, b.pose().legs[side].shin_ws);
        expect_same_bits(a.pose().legs[side].foot_ws, b.pose().legs[side].foot_ws);
        expect_same_bits(a.arm_pose().arms[side].upper_ws, b.arm_pose().arms[side].upper_ws);
        expect_same_bits(a.arm_pose().arms[side].forearm_ws, b.arm_pose().arms[side].forearm_ws);
    }
}

// Direction of the shin in the thigh's frame: +Z for a bent knee.
Vec3 knee_down(const SpinePose::Leg& leg) {
    return leg.thigh_ws.rotation.conjugate() * (leg.shin_ws.rotation * -Vec3::UnitY());
}

// All layers at once, with large turns.
void fill(Body& body) {
    ClipTurns all;
    all.fill(Vec3(0.3, 0.1, -0.2));
    clip(body, BodyClipName::idle).keys = {{0.0, no_turns()}, {1.0, all}, {2.0, no_turns()}};
    clip(body, BodyClipName::push_off).keys = {{0.0, no_turns()}, {0.3, all}, {1.0, no_turns()}};
    clip(body, BodyClipName::look_yaw).keys = {{-1.0, no_turns()}, {1.0, all}};
    clip(body, BodyClipName::look_pitch).keys = {{-1.0, all}, {1.0, no_turns()}};
    clip(body, BodyClipName::clavicle).keys = {{-1.5, no_turns()}, {1.5, all}};
}

TEST(LayerAdditives, ZeroWeightsChangeNothing) {
    Body none;
    Body off;
    fill(off);
    off.tuning = {0.0, 0.0, 1.5, 0.0, 0.0};
    for (int i = 0; i < 300; ++i) {
        for (Body* body : {&none, &off}) {
            body->velocity.at(k_player).linear_mps = Vec3(std::sin(0.05 * i), 0.0, 1.0);
            body->hold(i % 60 < 30);
            body->step();
        }
        expect_same_body(none, off);
    }
}

TEST(LayerAdditives, HandJointEqualsThePalmExactlyAndBonesKeepTheirLengths) {
    test::Random random(3);
    Body body;
    Body plain;
    fill(body);
    for (int i = 0; i < 300; ++i) {
        body.head.at(k_player).pose_ps = {Vec3(0.0, 1.62, 0.0),
                                          rotation_about(Vec3(0.6, 0.8, 0.0), std::sin(0.05 * i))};
        for (const Entity hand : {k_left, k_right}) {
            body.palm.at(hand).pose_ws = random.pose(1.5);
        }
        body.hold(i % 40 < 20);
        body.velocity.at(k_player).linear_mps = Vec3(std::sin(0.1 * i), 0.0, std::cos(0.07 * i));
        plain.head = body.head;
        plain.palm = body.palm;
        plain.velocity = body.velocity;
        plain.step();
        body.step();
        for (std::size_t side = 0; side < k_hand_count; ++side) {
            const ArmPose::Arm& arm = body.arm_pose().arms[side];
            expect_same_bits(arm.hand_ws, body.palm.elements()[side].pose_ws);
            ASSERT_TRUE(is_valid(arm.upper_ws) && is_valid(arm.forearm_ws));
            const double upper_m = (arm.forearm_ws.position - arm.upper_ws.position).norm();
            EXPECT_NEAR(upper_m, body.estimate.at(k_player).arms[side].stretch * 0.30, 1e-9);
            const SpinePose::Leg& leg = body.pose().legs[side];
            const double scale = body.measures.at(k_player).eye_height_m / k_scale_eye_m;
            EXPECT_NEAR((leg.shin_ws.position - leg.thigh_ws.position).norm(), 0.40 * scale, 1e-9);
            EXPECT_NEAR((leg.foot_ws.position - leg.shin_ws.position).norm(), 0.39 * scale, 1e-9);
            // Interpolation between two ticks tilts a shin slightly sideways.
            const Vec3 plain_down = knee_down(plain.pose().legs[side]);
            EXPECT_GT(knee_down(leg).z(),
                      std::min(0.0, plain_down.z()) - 3e-3);  // never beyond straight
        }
    }
}

TEST(LayerAdditives, IdleLoops) {
    Body body;
    clip(body, BodyClipName::idle).keys = {
        {0.0, no_turns()}, {1.0, with_turn(0, Vec3(0.2, 0.0, 0.0))}, {2.0, no_turns()}};
    body.step(1.0);  // the chain is stationary: only the clip moves
    const Quat chest = body.pose().chest_ws.rotation;
    const auto bent = [&] {
        return rotation_to_vector(chest.conjugate() * body.pose().spine_ws[0].rotation);
    };
    EXPECT_NEAR(bent().x(), 0.2, 1e-9);
    body.step(0.5);
    EXPECT_NEAR(bent().x(), 0.1, 1e-9);  // eased: half the turn at half the time
    body.step(0.5);
    EXPECT_NEAR(bent().x(), 0.0, 1e-9);
    body.step(1.0);
    EXPECT_NEAR(bent().x(), 0.2, 1e-9);
}

TEST(LayerAdditives, PushOffPlaysOnceWhenTheLastHandLetsGoWeightedBySpeed) {
    for (const double speed_mps : {0.1, 3.0}) {
        Body body;
        clip(body, BodyClipName::push_off).keys = {
            {0.0, no_turns()}, {0.5, with_turn(1, Vec3(0.3, 0.0, 0.0))}, {1.0, no_turns()}};
        body.velocity.at(k_player).linear_mps = Vec3(0.0, 0.0, speed_mps);
        body.hold(true);
        body.step();
        body.hold(false);
        body.step();
        const BodyClipState& state = body.state.at(k_player);
        EXPECT_EQ(state.push_off_s, 0.0);
        EXPECT_EQ(state.push_off_weight, speed_mps > 1.5 ? 1.0 : 0.0);
        for (int i = 0; i < 200; ++i) {
            body.step();
        }
        EXPECT_EQ(state.push_off_s, 1.0);  // stays at its end
    }
}

TEST(LayerAdditives, ReleasingOneOfTwoHandsIsNoPushOff) {
    Body body;
    fill(body);
    body.velocity.at(k_player).linear_mps = Vec3(0.0, 0.0, 3.0);
    body.hold(true);
    body.grab.at(k_right).kind = GripKind::surface;
    body.step();
    body.hold(false);
    body.step();
    EXPECT_EQ(body.state.at(k_player).push_off_weight, 0.0);
    body.grab.at(k_right).kind = GripKind::none;
    body.step();
    EXPECT_EQ(body.state.at(k_player).push_off_weight, 1.0);
}

// Hand over hand, fast and slow: no push-off interrupts another one.
TEST(LayerAdditives, ConsecutivePushOffsStayContinuous) {
    for (const double second_mps : {0.1, 0.3, 3.0}) {
        Body body;
        Body bare;
        clip(body, BodyClipName::push_off).keys = {
            {0.0, no_turns()},
            {0.4, with_turn(k_clip_legs, Vec3(-0.4, 0.0, 0.0))},
            {1.2, no_turns()}};
        Quat added = Quat::Identity();
        double most_rad = 0.0;
        for (int i = 0; i < 240; ++i) {
            for (Body* const played : {&body, &bare}) {
                played->hold(i < 60 || (i > 80 && i < 100));
                played->velocity.at(k_player).linear_mps =
                    Vec3(0.0, 0.0, i < 99 ? 3.0 : second_mps);
                played->step();
            }
            const Quat now = bare.pose().legs[0].thigh_ws.rotation.conjugate() *
                             body.pose().legs[0].thigh_ws.rotation;
            most_rad = std::max(most_rad, now.angularDistance(added));
            added = now;
        }
        EXPECT_GT(most_rad, 0.005) << second_mps;
        EXPECT_LT(most_rad, 0.03) << second_mps;
    }
}

TEST(LayerAdditives, ThrowingAFreeBodyIsNoPushOff) {
    Body body;
    fill(body);
    body.velocity.at(k_player).linear_mps = Vec3(0.0, 0.0, 3.0);
    body.grab.at(k_left).kind = GripKind::held;
    body.step();
    body.hold(false);
    body.step();
    EXPECT_EQ(body.state.at(k_player).push_off_weight, 0.0);
}

TEST(LayerAdditives, LookClipFollowsTheHeadRelativeToTheChest) {
    Body body;
    clip(body, BodyClipName::look_yaw).keys = {
        {-1.0, no_turns()}, {0.0, no_turns()}, {1.0, with_turn(0, Vec3(0.0, 0.0, 0.1))}};
    const auto leant = [&](double yaw_rad) {
        body.head.at(k_player).pose_ps.rotation = rotation_about(Vec3::UnitY(), yaw_rad);
        body.arm_memory.at(k_player).known = true;
        body.estimate.at(k_player).facing_ps = -Vec3::UnitZ();
        body.spine.at(k_player) = {};
        layer_additives({.dt_s = k_dt_s,
                         .clips = body.clips,
                         .head = body.head,
                         .origin = body.origin,
                         .velocity = body.velocity,
                         .reference = body.reference,
                         .owner = body.owner,
                         .grab = body.grab,
                         .estimate = body.estimate,
                         .memory = body.spine_memory,
                         .state = body.state,
                         .pose = body.spine},
                        body.tuning);
        return rotation_to_vector(body.pose().spine_ws[0].rotation).z();
    };
    EXPECT_NEAR(leant(0.5), 0.05, 1e-12);  // left
    EXPECT_NEAR(leant(-0.5), 0.0, 1e-12);
    EXPECT_NEAR(leant(2.0), 0.1, 1e-12);
    // Continuous straight behind, where left becomes right.
    EXPECT_NEAR(leant(k_pi - 1e-3), leant(-k_pi + 1e-3), 1e-5);
}

TEST(LayerAdditives, ClavicleClipFollowsAngleAndDistanceAndIsMirrored) {
    Body body;
    clip(body, BodyClipName::clavicle).keys = {
        {-1.5, no_turns()},
        {0.0, no_turns()},
        {1.5, with_turn(k_clip_clavicle, Vec3(0.0, 0.0, 0.2))}};
    body.clips.reach = {{0.5, 0.0}, {1.0, 1.0}};
    const auto lift = [&](double height, double reach) {
        Body plain;
        for (Body* one : {&body, &plain}) {
            for (const HandSide side : {HandSide::left, HandSide::right}) {
                const double out = side == HandSide::left ? -1.0 : 1.0;
                one->palm.elements()[index_of(side)].pose_ws.position =
                    Vec3(0.19 * out, 1.38 + height, -reach);
            }
            one->arm_memory.at(k_player).known = false;
            one->step();
        }
        std::array<Vec3, k_hand_count> moved;
        for (std::size_t side = 0; side < k_hand_count; ++side) {
            moved[side] = body.arm_pose().arms[side].upper_ws.position -
                          plain.arm_pose().arms[side].upper_ws.position;
        }
        EXPECT_LT((test::mirrored(moved[0]) - moved[1]).norm(), 1e-9);
        return moved[1].y();
    };
    EXPECT_EQ(lift(-0.3, 0.3), 0.0);   // below: none
    EXPECT_GT(lift(0.5, 0.1), 0.005);  // up and far
    EXPECT_LT(lift(0.2, 0.05), 1e-3);  // up and near
}

TEST(LayerAdditives, BodyClipStateIsTheCompleteState) {
    Body body;
    fill(body);
    body.hold(true);
    for (int i = 0; i < 50; ++i) {
        body.step();
    }
    body.hold(false);
    body.velocity.at(k_player).linear_mps = Vec3(0.0, 1.0, 2.0);
    body.step();
    Body again = body;  // copies the columns
    for (int i = 0; i < 50; ++i) {
        body.step();
        again.step();
        expect_same_body(body, again);
    }
}

TEST(BodyClips, FileIsReadAndErrorsNameTheirPlace) {
    const Result<BodyClips> good = parse_body_clips(
        R"({"idle": {"keys": [{"at": 0}, {"at": 2, "spine_1": [90, 0, 0]}, {"at": 3}]},
            "clavicle": {"keys": [{"at": 90, "clavicle": [0, 0, 9]}],
                         "reach": [{"distance": 1, "weight": 0.5}]}})",
        "a.json");
    ASSERT_TRUE(good.ok());
    EXPECT_NEAR(good.value().at(BodyClipName::idle).keys[1].turns[1].x(), k_half_pi, 1e-12);
    EXPECT_NEAR(good.value().at(BodyClipName::clavicle).keys[0].at, k_half_pi, 1e-12);
    EXPECT_EQ(reach_weight(good.value(), 7.0), 0.5);
    for (const char* bad :
         {R"({"walk": {"keys": [{"at": 0}]}})", R"({"idle": {"keys": []}})",
          R"({"idle": {"keys": [{"at": 1}]}})", R"({"idle": {"keys": [{"at": 0}, {"at": 0}]}})",
          R"({"idle": {"keys": [{"at": 0, "tail": [0, 0, 0]}]}})",
          R"({"idle": {"keys": [{"at": 0}, {"at": 2, "spine_1": [9, 0, 0]}]}})",
          R"({"idle": {"keys": [{"at": 0, "spine_0": [0, 0, 91]}]}})",
          R"({"look_yaw": {"keys": [{"at": 0}], "reach": []}})"}) {
        EXPECT_FALSE(parse_body_clips(bad, "a.json").ok()) << bad;
    }
}

}  // namespace
}  // namespace handhold::layer_additives_test
