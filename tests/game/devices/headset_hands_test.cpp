// A headset without one: what readings of poses, buttons and fingers become for the game.
#include "game/devices/headset_hands.hpp"

#include <array>
#include <cmath>
#include <string>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "engine/core/text_file.hpp"
#include "game/devices/controller_profile.hpp"
#include "game/view/controller_figures.hpp"
#include "systems/input/read_tracking.hpp"
#include "tests/places.hpp"
#include "tests/random.hpp"

namespace handhold::headset_hands_test {
namespace {

constexpr double k_near_m = 1e-12;

HandReading hold(const Pose& grip) {
    HandReading hand;
    hand.grip_ps = grip;
    return hand;
}

// The wrist that a controller's sample stands for.
Pose hand_of(const TrackingSample& sample, HandSide side, const HandTuning& tuning) {
    return sample.controllers[index_of(side)].controller_ps *
           default_controller_to_hand(side, tuning);
}

// OpenXR: a palm's origin is the palm's centre, on its skin; a controller's grip lies in the middle
// of its handle, +X into the right palm and out of the left one, -Z to the thumb.
TEST(HeadsetHands, PalmLiesOnPalmsOriginAndOnTheHandleAroundAGrip) {
    const HandTuning tuning;
    const HandleGrip handle;
    for (const HandSide side : {HandSide::left, HandSide::right}) {
        const double outward = side == HandSide::right ? 1.0 : -1.0;
        Vec3 palm = tuning.palm_center_m;
        palm.x() *= outward;
        EXPECT_LT(transform_point(hand_in_palm(side, tuning), palm).norm(), k_near_m);
        const Vec3 on_skin(outward * handle.radius_m, 0.0, handle.along_m);
        EXPECT_LT((transform_point(hand_in_grip(side, tuning), palm) - on_skin).norm(), k_near_m);
    }
}

// The thumb is on the left of a right hand seen from its back.
TEST(HeadsetHands, BackOfHandFacesAwayFromTheHandleAndThumbLiesUpIt) {
    const HandTuning tuning;
    const HandleGrip handle;
    const Quat right = hand_in_grip(HandSide::right, tuning).rotation;
    const Quat left = hand_in_grip(HandSide::left, tuning).rotation;
    EXPECT_LT((right * Vec3::UnitY() - Vec3::UnitX()).norm(), k_near_m);
    EXPECT_LT((left * Vec3::UnitY() + Vec3::UnitX()).norm(), k_near_m);
    EXPECT_NEAR((right * -Vec3::UnitX()).dot(-Vec3::UnitZ()), std::cos(handle.slant_rad), k_near_m);
    EXPECT_NEAR((left * Vec3::UnitX()).dot(-Vec3::UnitZ()), std::cos(handle.slant_rad), k_near_m);
    EXPECT_NEAR((right * -Vec3::UnitZ()).dot(-Vec3::UnitZ()), std::sin(handle.slant_rad), k_near_m);
}

// What one feels and what one sees: the wand's handle lies along the grip's axis, turned like it.
TEST(HeadsetHands, WandsHandleIsDrawnWhereTheRealHandleIs) {
    const HandTuning tuning;
    const Pose grip_ps{Vec3(0.2, 1.3, -0.4), rotation_about(Vec3(0.6, 0.0, 0.8), 1.2)};
    const ControllerModels wand = builtin_controllers(tuning);
    for (const HandSide side : {HandSide::left, HandSide::right}) {
        HeadsetReading reading;
        reading.hands[index_of(side)] = hold(grip_ps);
        HeadsetMemory memory;
        const Pose hand_ps = hand_of(read_headset(reading, 0.0, tuning, memory), side, tuning);
        const Pose wand_ps = hand_ps * controller_in_hand(wand.sides[index_of(side)].fit);
        const Pose seen = inverse(grip_ps) * wand_ps;
        EXPECT_LT(std::hypot(seen.position.x(), seen.position.y()), 1e-9);
        EXPECT_LT(std::abs(seen.position.z()), 0.04);  // along it: nobody feels how long it is
        EXPECT_LT(rotation_to_vector(seen.rotation).norm(), 1e-9);
    }
}

TEST(HeadsetHands, HandsAreEachOthersMirrorImages) {
    const HandTuning tuning;
    const Pose right = hand_in_grip(HandSide::right, tuning);
    const Pose left = hand_in_grip(HandSide::left, tuning);
    EXPECT_NEAR(left.position.x(), -right.position.x(), k_near_m);
    EXPECT_NEAR(left.position.y(), right.position.y(), k_near_m);
    EXPECT_NEAR(left.position.z(), right.position.z(), k_near_m);
    const Vec3 right_fingers = right.rotation * -Vec3::UnitZ();
    const Vec3 left_fingers = left.rotation * -Vec3::UnitZ();
    EXPECT_LT(
        (left_fingers - Vec3(-right_fingers.x(), right_fingers.y(), right_fingers.z())).norm(),
        k_near_m);
}

TEST(HeadsetHands, WithAProfilesJointTheGripIsTheControllerAndCountsBeforeAPalm) {
    const HandTuning tuning;
    const Pose grip{Vec3(0.2, 1.3, -0.4), rotation_about(Vec3::UnitY(), 0.3)};
    const std::array<Pose, k_hand_count> joints = {
        Pose{Vec3(0.01, -0.02, 0.09), rotation_about(Vec3::UnitX(), -0.5)},
        Pose{Vec3(-0.01, -0.02, 0.09), rotation_about(Vec3::UnitX(), -0.5)}};
    for (std::size_t i = 0; i < k_hand_count; ++i) {
        HeadsetReading reading;
        reading.hands[i].grip_ps = grip;
        reading.hands[i].palm_ps = Pose{};
        HeadsetMemory memory;
        const Pose sample =
            read_headset(reading, 0.0, tuning, memory, &joints).controllers[i].controller_ps;
        EXPECT_LT((sample.position - grip.position).norm(), k_near_m);
        EXPECT_LT(sample.rotation.angularDistance(grip.rotation), 1e-7);
    }
}

TEST(HeadsetHands, GripPalmAndWristOfOneHandGiveOneHand) {
    const HandTuning tuning;
    const Pose wrist{Vec3(0.2, 1.3, -0.4),
                     (rotation_about(Vec3::UnitY(), 0.3) * rotation_about(Vec3::UnitX(), 0.7))};
    for (const HandSide side : {HandSide::left, HandSide::right}) {
        HeadsetReading by_grip;
        HeadsetReading by_palm;
        HeadsetReading by_wrist;
        by_grip.hands[index_of(side)].grip_ps = wrist * inverse(hand_in_grip(side, tuning));
        by_palm.hands[index_of(side)].palm_ps = wrist * inverse(hand_in_palm(side, tuning));
        by_wrist.hands[index_of(side)].wrist_ps = wrist;
        for (const HeadsetReading& reading : {by_grip, by_palm, by_wrist}) {
            HeadsetMemory memory;
            const Pose hand = hand_of(read_headset(reading, 0.0, tuning, memory), side, tuning);
            EXPECT_LT((hand.position - wrist.position).norm(), k_near_m);
            EXPECT_NEAR(std::abs(hand.rotation.dot(wrist.rotation)), 1.0, k_near_m);
        }
    }
}

TEST(HeadsetHands, HandClosesAboveOneThresholdAndOpensBelowAnother) {
    const HandTuning tuning;
    HeadsetMemory memory;
    HeadsetReading reading;
    reading.hands[1] = hold({});
    const auto grabs = [&](double squeeze, double trigger) {
        reading.hands[1].squeeze = squeeze;
        reading.hands[1].trigger = trigger;
        return read_headset(reading, 0.0, tuning, memory).controllers[1].grab;
    };
    EXPECT_FALSE(grabs(0.5, 0.0));
    EXPECT_TRUE(grabs(0.6, 0.0));
    EXPECT_TRUE(grabs(0.4, 0.0));
    EXPECT_TRUE(grabs(0.0, 0.4));  // the trigger keeps the grip when the squeeze ends
    EXPECT_FALSE(grabs(0.3, 0.3));
    EXPECT_FALSE(grabs(0.5, 0.5));
    EXPECT_TRUE(grabs(0.0, 1.0));
}

TEST(HeadsetHands, HandOutOfSightIsNotTrackedAndKeepsItsButton) {
    const HandTuning tuning;
    HeadsetMemory memory;
    HeadsetReading reading;
    reading.head_ps = Pose{};
    reading.hands[0] = hold({});
    reading.hands[0].squeeze = 1.0;
    ASSERT_TRUE(read_headset(reading, 0.0, tuning, memory).controllers[0].grab);
    reading.hands[0] = {};
    const TrackingSample lost = read_headset(reading, 0.1, tuning, memory);
    EXPECT_TRUE(lost.controllers[0].grab);
    EXPECT_FALSE(is_valid(lost.controllers[0].controller_ps));
    EXPECT_TRUE(is_valid(lost.head_ps));
    EXPECT_FALSE(is_valid(read_headset({}, 0.2, tuning, memory).head_ps));
}

TEST(HeadsetHands, CurledFingersCloseAHandThatHoldsNoController) {
    const HandTuning tuning;
    HeadsetMemory memory;
    HeadsetReading reading;
    reading.hands[0].wrist_ps = Pose{};
    reading.hands[0].curl = 0.9;
    EXPECT_TRUE(read_headset(reading, 0.0, tuning, memory).controllers[0].grab);
    HeadsetMemory other;
    reading.hands[0].grip_ps = Pose{};  // fingers lie about a controller all the time
    EXPECT_FALSE(read_headset(reading, 0.0, tuning, other).controllers[0].grab);
}

TEST(HeadsetHands, CurlIsNoneForStraightHalfForSquareAndFullForFolded) {
    const Vec3 wrist(0.0, 0.0, 0.0);
    const Vec3 knuckle(0.0, 0.0, -0.09);
    EXPECT_NEAR(finger_curl(wrist, knuckle, {0.0, 0.0, -0.18}), 0.0, k_near_m);
    EXPECT_NEAR(finger_curl(wrist, knuckle, {0.0, -0.05, -0.09}), 0.5, k_near_m);
    EXPECT_NEAR(finger_curl(wrist, knuckle, {0.0, 0.0, -0.03}), 1.0, k_near_m);
    EXPECT_TRUE(std::isnan(finger_curl(wrist, wrist, knuckle)));  // no hand
}

// Joints that are not seen are zeros at some runtimes, anywhere in the room.
TEST(HeadsetHands, JointsAtTheRoomsOriginAreNoFinger) {
    test::Random random(3);
    for (int i = 0; i < 300; ++i) {
        const Vec3 wrist = Vec3(0.0, 1.3, 0.0) + random.arm(0.1, 0.6);
        const Vec3 knuckle = wrist + random.arm(0.07, 0.11);
        EXPECT_TRUE(std::isnan(finger_curl(wrist, knuckle, Vec3::Zero())));
        HeadsetReading reading;
        reading.hands[1].wrist_ps = Pose{wrist, random.rotation()};
        reading.hands[1].curl = finger_curl(wrist, knuckle, Vec3::Zero());
        HeadsetMemory memory;
        memory.grabs[1] = i % 2 == 0;
        memory.curls[1] = memory.grabs[1] ? 0.9 : 0.1;
        EXPECT_EQ(read_headset(reading, 0.0, {}, memory).controllers[1].grab, i % 2 == 0);
    }
}

// headset_cases.json, which the web page's test plays too (game/web/test/devices.test.mjs).
HandReading reading_of(const nlohmann::json& given, HandSide side) {
    const Pose at{Vec3(side == HandSide::left ? -0.2 : 0.2, 1.3, -0.4), Quat::Identity()};
    HandReading hand;
    const bool is_seen = given.value("seen", true);
    const bool has_controller = given.contains("controller");
    if (has_controller && is_seen) {
        (given.value("guess", false) ? hand.guesses.grip_ps : hand.grip_ps) = at;
    }
    hand.squeeze = given.value("squeeze", 0.0);
    hand.trigger = given.value("trigger", 0.0);
    for (const char* name : {"stick", "touchpad"}) {
        if (given.contains(name)) {
            hand.stick = {given[name][0], given[name][1]};
        }
    }
    hand.brake = given.value("brake", false);
    hand.calibrate = given.value("calibrate", false);
    if (given.contains("fingers") && (is_seen || has_controller)) {
        hand.wrist_ps = at;
        double sum = 0.0;
        int known = 0;
        for (const nlohmann::json& curl : given["fingers"]) {
            sum += curl.is_null() ? 0.0 : curl.get<double>();
            known += curl.is_null() ? 0 : 1;
        }
        hand.curl = known > 0 ? sum / known : std::nan("");
    }
    return hand;
}

TEST(HeadsetHands, ReadsDevicesAsThePageDoes) {
    const auto text = read_file(source_dir() / "tests/game/devices/headset_cases.json");
    ASSERT_TRUE(text.ok());
    const nlohmann::json table = nlohmann::json::parse(text.value());
    EXPECT_GE(table.size(), 10U);
    constexpr std::array<const char*, k_hand_count> k_sides = {"left", "right"};
    for (const nlohmann::json& play : table) {
        SCOPED_TRACE(play["name"].get<std::string>());
        HeadsetMemory memory;
        for (const nlohmann::json& step : play["steps"]) {
            SCOPED_TRACE(step.dump());
            HeadsetReading reading;
            reading.head_ps = Pose{Vec3(0.0, 1.6, 0.0), Quat::Identity()};
            if (step.value("focus", true)) {  // without it Headset::read finds no hands
                for (const HandSide side : {HandSide::left, HandSide::right}) {
                    const char* const name = k_sides[index_of(side)];
                    if (step.contains(name)) {
                        reading.hands[index_of(side)] = reading_of(step[name], side);
                    }
                }
            }
            const TrackingSample sample = read_headset(reading, 0.0, {}, memory);
            const PlayerCommands commands = read_headset_commands(reading, TurnKind::snap, memory);
            const nlohmann::json& wanted = step["expect"];
            for (std::size_t i = 0; i < k_hand_count; ++i) {
                const nlohmann::json expected = wanted.value(k_sides[i], nlohmann::json::object());
                const ControllerSample& hand = sample.controllers[i];
                const bool is_tracked = is_valid(hand.controller_ps) && !hand.is_inferred;
                EXPECT_EQ(hand.is_inferred, expected.value("inferred", hand.is_inferred));
                EXPECT_EQ(is_tracked, expected.value("tracked", is_tracked));
                EXPECT_EQ(hand.grab, expected.value("grab", hand.grab));
                EXPECT_EQ(hand.squeeze, expected.value("squeeze", hand.squeeze));
                EXPECT_EQ(hand.trigger, expected.value("trigger", hand.trigger));
            }
            EXPECT_EQ(commands.snap_turns, wanted.value("snap_turns", commands.snap_turns));
            EXPECT_EQ(commands.brake, wanted.value("brake", commands.brake));
            EXPECT_EQ(commands.calibrate, wanted.value("calibrate", commands.calibrate));
            if (wanted.contains("thrust")) {
                const Vec3 thrust(wanted["thrust"][0], wanted["thrust"][1], wanted["thrust"][2]);
                EXPECT_LT((commands.thrust_ps - thrust).norm(), 1e-9);
            }
        }
    }
}

TEST(HeadsetCommands, OnePushOfTheStickIsOneSnapTurn) {
    HeadsetMemory memory;
    HeadsetReading reading;
    int turns = 0;
    for (const double push : {0.0, 0.5, 0.9, 1.0, 0.8, 0.3, 0.9, 0.0, 0.9}) {
        reading.hands[1].stick = {push, 0.0};
        turns += read_headset_commands(reading, TurnKind::snap, memory).snap_turns;
    }
    EXPECT_EQ(turns, -2);  // to the right; 0.3 is no rest
    reading.hands[1].stick = {-1.0, 0.0};
    EXPECT_GT(read_headset_commands(reading, TurnKind::smooth, memory).smooth_turn, 0.99);
}

TEST(HeadsetCommands, SticksAtRestAskForNothing) {
    HeadsetMemory memory;
    HeadsetReading reading;
    reading.head_ps = Pose{};
    reading.hands[0].stick = {0.1, -0.15};
    reading.hands[1].stick = {0.15, 0.1};
    const PlayerCommands commands = read_headset_commands(reading, TurnKind::smooth, memory);
    EXPECT_EQ(commands.smooth_turn, 0.0);
    EXPECT_EQ(commands.thrust_ps, Vec3(Vec3::Zero()));
    EXPECT_EQ(commands.brake, 0.0);
    EXPECT_FALSE(commands.calibrate);
}

TEST(HeadsetCommands, LeftStickPushesWhereTheHeadLooks) {
    HeadsetMemory memory;
    HeadsetReading reading;
    reading.head_ps = Pose{Vec3::Zero(), rotation_about(Vec3::UnitY(), k_half_pi)};  // to the left
    reading.hands[0].stick = {0.0, 1.0};
    const PlayerCommands commands = read_headset_commands(reading, TurnKind::snap, memory);
    EXPECT_LT((commands.thrust_ps + Vec3::UnitX()).norm(), k_near_m);
}

TEST(HeadsetCommands, OnlyBothButtonsTogetherCalibrate) {
    HeadsetMemory memory;
    HeadsetReading reading;
    reading.hands[0].calibrate = true;
    EXPECT_FALSE(read_headset_commands(reading, TurnKind::snap, memory).calibrate);
    reading.hands[1].calibrate = true;
    EXPECT_TRUE(read_headset_commands(reading, TurnKind::snap, memory).calibrate);
}

}  // namespace
}  // namespace handhold::headset_hands_test
