// A headset without one: what readings of poses, buttons and fingers become for the game.
#include "game/devices/headset_hands.hpp"

#include <array>
#include <cmath>
#include <numbers>
#include <string>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "engine/core/text_file.hpp"
#include "game/devices/controller_profile.hpp"
#include "game/view/controller_figures.hpp"
#include "tests/places.hpp"
#include "tests/random.hpp"

namespace handhold::headset_hands_test {
namespace {

constexpr double k_near_m = 1e-12;

HandReading hold(const hh::Pose& grip) {
    HandReading hand;
    hand.grip_ps = grip;
    return hand;
}

// The wrist that a controller's sample stands for.
hh::Pose hand_of(const hh::Sample& sample, hh::Side side, const HandShape& shape) {
    return sample.hands[side] * shape.in_controller[side];
}

// OpenXR: a palm's origin is the palm's centre, on its skin; a controller's grip lies in the middle
// of its handle, +X into the right palm and out of the left one, -Z to the thumb.
TEST(HeadsetHands, PalmLiesOnPalmsOriginAndOnTheHandleAroundAGrip) {
    const HandShape shape = hand_shape(hh::World());
    const HandleGrip handle;
    for (const hh::Side side : {HH_LEFT, HH_RIGHT}) {
        const double outward = side == HH_RIGHT ? 1.0 : -1.0;
        hh::Vec3 palm = shape.palm_center_m;
        palm.x *= outward;
        EXPECT_LT(hh::length(hh::transform_point(hand_in_palm(side, shape.palm_center_m), palm)),
                  k_near_m);
        const hh::Vec3 on_skin{outward * handle.radius_m, 0.0, handle.along_m};
        EXPECT_LT(hh::length(hh::transform_point(hand_in_grip(side, shape.palm_center_m), palm) -
                             on_skin),
                  k_near_m);
    }
}

// The thumb is on the left of a right hand seen from its back.
TEST(HeadsetHands, BackOfHandFacesAwayFromTheHandleAndThumbLiesUpIt) {
    const HandShape shape = hand_shape(hh::World());
    const HandleGrip handle;
    const hh::Quat right = hand_in_grip(HH_RIGHT, shape.palm_center_m).rotation;
    const hh::Quat left = hand_in_grip(HH_LEFT, shape.palm_center_m).rotation;
    EXPECT_LT(hh::length(right * hh::k_y - hh::k_x), k_near_m);
    EXPECT_LT(hh::length(left * hh::k_y + hh::k_x), k_near_m);
    EXPECT_NEAR(hh::dot(right * -hh::k_x, -hh::k_z), std::cos(handle.slant_rad), k_near_m);
    EXPECT_NEAR(hh::dot(left * hh::k_x, -hh::k_z), std::cos(handle.slant_rad), k_near_m);
    EXPECT_NEAR(hh::dot(right * -hh::k_z, -hh::k_z), std::sin(handle.slant_rad), k_near_m);
}

// What one feels and what one sees: the wand's handle lies along the grip's axis, turned like it.
TEST(HeadsetHands, WandsHandleIsDrawnWhereTheRealHandleIs) {
    const HandShape shape = hand_shape(hh::World());
    const hh::Pose grip_ps{hh::Vec3{0.2, 1.3, -0.4},
                           hh::rotation_about(hh::Vec3{0.6, 0.0, 0.8}, 1.2)};
    const ControllerModels wand = builtin_controllers(shape);
    for (const hh::Side side : {HH_LEFT, HH_RIGHT}) {
        HeadsetReading reading;
        reading.hands[side] = hold(grip_ps);
        HeadsetMemory memory;
        const hh::Pose hand_ps = hand_of(read_headset(reading, 0.0, shape, memory), side, shape);
        const hh::Pose wand_ps = hand_ps * controller_in_hand(wand.sides[side].fit);
        const hh::Pose seen = hh::inverse(grip_ps) * wand_ps;
        EXPECT_LT(std::hypot(seen.position.x, seen.position.y), 1e-9);
        // Offset along the handle: players cannot feel it.
        EXPECT_LT(std::abs(seen.position.z), 0.04);
        EXPECT_LT(hh::length(hh::rotation_to_vector(seen.rotation)), 1e-9);
    }
}

TEST(HeadsetHands, HandsAreEachOthersMirrorImages) {
    const HandShape shape = hand_shape(hh::World());
    const hh::Pose right = hand_in_grip(HH_RIGHT, shape.palm_center_m);
    const hh::Pose left = hand_in_grip(HH_LEFT, shape.palm_center_m);
    EXPECT_NEAR(left.position.x, -right.position.x, k_near_m);
    EXPECT_NEAR(left.position.y, right.position.y, k_near_m);
    EXPECT_NEAR(left.position.z, right.position.z, k_near_m);
    const hh::Vec3 right_fingers = right.rotation * -hh::k_z;
    const hh::Vec3 left_fingers = left.rotation * -hh::k_z;
    EXPECT_LT(
        hh::length(left_fingers - hh::Vec3{-right_fingers.x, right_fingers.y, right_fingers.z}),
        k_near_m);
}

TEST(HeadsetHands, WithAProfilesJointTheGripIsTheControllerAndCountsBeforeAPalm) {
    const HandShape shape = hand_shape(hh::World());
    const hh::Pose grip{hh::Vec3{0.2, 1.3, -0.4}, hh::rotation_about(hh::k_y, 0.3)};
    const std::array<hh::Pose, 2> joints = {
        hh::Pose{hh::Vec3{0.01, -0.02, 0.09}, hh::rotation_about(hh::k_x, -0.5)},
        hh::Pose{hh::Vec3{-0.01, -0.02, 0.09}, hh::rotation_about(hh::k_x, -0.5)}};
    for (std::size_t i = 0; i < 2; ++i) {
        HeadsetReading reading;
        reading.hands[i].grip_ps = grip;
        reading.hands[i].palm_ps = hh::k_origin;
        HeadsetMemory memory;
        const hh::Pose sample = read_headset(reading, 0.0, shape, memory, &joints).hands[i];
        EXPECT_LT(hh::length(sample.position - grip.position), k_near_m);
        EXPECT_LT(
            hh::length(hh::rotation_to_vector(hh::conjugate(grip.rotation) * sample.rotation)),
            1e-7);
    }
}

TEST(HeadsetHands, GripPalmAndWristOfOneHandGiveOneHand) {
    const HandShape shape = hand_shape(hh::World());
    const hh::Pose wrist{hh::Vec3{0.2, 1.3, -0.4},
                         (hh::rotation_about(hh::k_y, 0.3) * hh::rotation_about(hh::k_x, 0.7))};
    for (const hh::Side side : {HH_LEFT, HH_RIGHT}) {
        HeadsetReading by_grip;
        HeadsetReading by_palm;
        HeadsetReading by_wrist;
        by_grip.hands[side].grip_ps = wrist * hh::inverse(hand_in_grip(side, shape.palm_center_m));
        by_palm.hands[side].palm_ps = wrist * hh::inverse(hand_in_palm(side, shape.palm_center_m));
        by_wrist.hands[side].wrist_ps = wrist;
        for (const HeadsetReading& reading : {by_grip, by_palm, by_wrist}) {
            HeadsetMemory memory;
            const hh::Pose hand = hand_of(read_headset(reading, 0.0, shape, memory), side, shape);
            EXPECT_LT(hh::length(hand.position - wrist.position), k_near_m);
            EXPECT_NEAR((hh::conjugate(hand.rotation) * wrist.rotation).w *
                            (hh::conjugate(hand.rotation) * wrist.rotation).w,
                        1.0, k_near_m);
        }
    }
}

TEST(HeadsetHands, HandClosesAboveOneThresholdAndOpensBelowAnother) {
    const HandShape shape = hand_shape(hh::World());
    HeadsetMemory memory;
    HeadsetReading reading;
    reading.hands[1] = hold(hh::k_origin);
    const auto grabs = [&](double squeeze, double trigger) {
        reading.hands[1].squeeze = squeeze;
        reading.hands[1].trigger = trigger;
        return read_headset(reading, 0.0, shape, memory).grab[1];
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
    const HandShape shape = hand_shape(hh::World());
    HeadsetMemory memory;
    HeadsetReading reading;
    reading.head_ps = hh::k_origin;
    reading.hands[0] = hold(hh::k_origin);
    reading.hands[0].squeeze = 1.0;
    ASSERT_TRUE(read_headset(reading, 0.0, shape, memory).grab[0]);
    reading.hands[0] = {};
    const hh::Sample lost = read_headset(reading, 0.1, shape, memory);
    EXPECT_TRUE(lost.grab[0]);
    EXPECT_FALSE(lost.hand_tracked[0]);
    EXPECT_TRUE(lost.head_tracked);
    EXPECT_FALSE(read_headset({}, 0.2, shape, memory).head_tracked);
}

TEST(HeadsetHands, CurledFingersCloseAHandThatHoldsNoController) {
    const HandShape shape = hand_shape(hh::World());
    HeadsetMemory memory;
    HeadsetReading reading;
    reading.hands[0].wrist_ps = hh::k_origin;
    reading.hands[0].curl = 0.9;
    EXPECT_TRUE(read_headset(reading, 0.0, shape, memory).grab[0]);
    HeadsetMemory other;
    reading.hands[0].grip_ps = hh::k_origin;  // fingers lie about a controller all the time
    EXPECT_FALSE(read_headset(reading, 0.0, shape, other).grab[0]);
}

TEST(HeadsetHands, CurlIsNoneForStraightHalfForSquareAndFullForFolded) {
    const hh::Vec3 wrist{0.0, 0.0, 0.0};
    const hh::Vec3 knuckle{0.0, 0.0, -0.09};
    EXPECT_NEAR(finger_curl(wrist, knuckle, {0.0, 0.0, -0.18}), 0.0, k_near_m);
    EXPECT_NEAR(finger_curl(wrist, knuckle, {0.0, -0.05, -0.09}), 0.5, k_near_m);
    EXPECT_NEAR(finger_curl(wrist, knuckle, {0.0, 0.0, -0.03}), 1.0, k_near_m);
    EXPECT_TRUE(std::isnan(finger_curl(wrist, wrist, knuckle)));  // no hand
}

// Joints that are not seen are zeros at some runtimes, anywhere in the room.
TEST(HeadsetHands, JointsAtTheRoomsOriginAreNoFinger) {
    const HandShape shape = hand_shape(hh::World());
    test::Random random(3);
    const auto arm = [&](double low, double high) {
        const Vec3 v = random.arm(low, high);
        return hh::Vec3{v.x(), v.y(), v.z()};
    };
    for (int i = 0; i < 300; ++i) {
        const hh::Vec3 wrist = hh::Vec3{0.0, 1.3, 0.0} + arm(0.1, 0.6);
        const hh::Vec3 knuckle = wrist + arm(0.07, 0.11);
        EXPECT_TRUE(std::isnan(finger_curl(wrist, knuckle, {})));
        HeadsetReading reading;
        const double turn = random.between(-3.0, 3.0);
        reading.hands[1].wrist_ps = {wrist, hh::rotation_about(hh::k_x, turn)};
        reading.hands[1].curl = finger_curl(wrist, knuckle, {});
        HeadsetMemory memory;
        memory.grabs[1] = i % 2 == 0;
        memory.curls[1] = memory.grabs[1] ? 0.9 : 0.1;
        EXPECT_EQ(read_headset(reading, 0.0, shape, memory).grab[1], i % 2 == 0 ? 1 : 0);
    }
}

// headset_cases.json, which the web page's test plays too (game/web/test/devices.test.mjs).
HandReading reading_of(const nlohmann::json& given, hh::Side side) {
    const hh::Pose at{{side == HH_LEFT ? -0.2 : 0.2, 1.3, -0.4}, hh::k_origin.rotation};
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
    const HandShape shape = hand_shape(hh::World());
    constexpr std::array<const char*, 2> k_sides = {"left", "right"};
    for (const nlohmann::json& play : table) {
        SCOPED_TRACE(play["name"].get<std::string>());
        HeadsetMemory memory;
        for (const nlohmann::json& step : play["steps"]) {
            SCOPED_TRACE(step.dump());
            HeadsetReading reading;
            reading.head_ps = {{0.0, 1.6, 0.0}, hh::k_origin.rotation};
            if (step.value("focus", true)) {  // without it Headset::read finds no hands
                for (const hh::Side side : {HH_LEFT, HH_RIGHT}) {
                    const char* const name = k_sides[side];
                    if (step.contains(name)) {
                        reading.hands[side] = reading_of(step[name], side);
                    }
                }
            }
            const hh::Sample sample = read_headset(reading, 0.0, shape, memory);
            const hh_commands commands = read_headset_commands(reading, TurnKind::snap, memory);
            const nlohmann::json& wanted = step["expect"];
            const auto expect = [](const nlohmann::json& expected, const char* key, auto found) {
                if (expected.contains(key)) {
                    EXPECT_EQ(found, static_cast<decltype(found)>(expected[key])) << key;
                }
            };
            for (std::size_t i = 0; i < k_sides.size(); ++i) {
                const nlohmann::json expected = wanted.value(k_sides[i], nlohmann::json::object());
                expect(expected, "tracked", sample.hand_tracked[i] != 0);
                expect(expected, "inferred", sample.hand_inferred[i] != 0);
                expect(expected, "grab", sample.grab[i] != 0);
                expect(expected, "squeeze", sample.squeeze[i]);
                expect(expected, "trigger", sample.trigger[i]);
            }
            expect(wanted, "snap_turns", commands.snap_turns);
            expect(wanted, "brake", commands.brake);
            expect(wanted, "calibrate", commands.calibrate != 0);
            if (wanted.contains("thrust")) {
                const hh::Vec3 thrust{wanted["thrust"][0], wanted["thrust"][1],
                                      wanted["thrust"][2]};
                EXPECT_LT(hh::length(commands.thrust - thrust), 1e-9);
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
    reading.head_ps = hh::k_origin;
    reading.hands[0].stick = {0.1, -0.15};
    reading.hands[1].stick = {0.15, 0.1};
    const hh_commands commands = read_headset_commands(reading, TurnKind::smooth, memory);
    EXPECT_EQ(commands.smooth_turn, 0.0);
    EXPECT_TRUE(commands.thrust == hh::Vec3{});
    EXPECT_EQ(commands.brake, 0.0);
    EXPECT_FALSE(commands.calibrate);
}

TEST(HeadsetCommands, LeftStickPushesWhereTheHeadLooks) {
    HeadsetMemory memory;
    HeadsetReading reading;
    reading.head_ps =
        hh::Pose{hh::Vec3{}, hh::rotation_about(hh::k_y, 0.5 * std::numbers::pi)};  // to the left
    reading.hands[0].stick = {0.0, 1.0};
    const hh_commands commands = read_headset_commands(reading, TurnKind::snap, memory);
    EXPECT_LT(hh::length(commands.thrust + hh::k_x), k_near_m);
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
