// Players whom nobody measured: of any size and scale, standing or seated.
#include "systems/body/estimate_sizes.hpp"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "tests/random.hpp"
#include "tests/systems/frame/column_scene.hpp"

namespace handhold::estimate_sizes_test {
namespace {

using test::k_left;
using test::k_player;
using test::k_right;
using test::Random;

constexpr std::array<Entity, k_hand_count> k_hands = {k_left, k_right};

// A person in metres of the world over the player's scale.
struct Person {
    double eyes_m = 1.6;      // standing
    double arm_m = 0.57;      // shoulder to wrist
    double seat = 1.0;        // eye height while playing / standing
    double floor_m = 0.0;     // height of the tracked floor
    double stretched = 0.97;  // longest reach / arm length

    static Person of(Random& random, double seat) {
        Person person;
        person.eyes_m = random.between(1.0, 1.9);
        person.arm_m = 0.356 * person.eyes_m * random.between(0.94, 1.06);
        person.seat = seat;
        person.floor_m = random.between(-0.5, 0.5);
        return person;
    }
};

struct Play {
    Column<PlayerOrigin> origin;
    Column<HeadTracking> head;
    Column<HandOwner> owner;
    Column<HandTracking> hand;
    Column<Calibration> calibration;
    Column<SizeEstimate> size;
    Column<BodyMeasures> measures;
    double scale;

    explicit Play(double scale_) : scale(scale_) {
        origin.add(k_player, {{}, scale});
        head.add(k_player);
        calibration.add(k_player);
        size.add(k_player);
        measures.add(k_player, scaled(BodyMeasures{}, scale));
        for (const HandSide side : {HandSide::left, HandSide::right}) {
            owner.add(k_hands[index_of(side)], {k_player, side});
            hand.add(k_hands[index_of(side)]);
        }
    }

    // Sways and crouches now and then; hands reach ahead, aside, up and hang, with bent arms and
    // straight ones.
    void step(const Person& person, double t_s, double dt_s) {
        const double crouch = std::max(0.0, std::sin(0.31 * t_s) - 0.5) * 0.6;
        const Vec3 eyes(0.3 * std::sin(0.2 * t_s),
                        person.floor_m + person.seat * person.eyes_m * (1.0 - 0.5 * crouch), 0.0);
        HeadTracking& now = head.at(k_player);
        now.state = TrackingState::tracked;
        now.shift_m = Vec3(0.0, scale * person.floor_m, 0.0);
        now.pose_ps.position = scale * eyes;
        for (std::size_t side = 0; side < k_hand_count; ++side) {
            const double aside = side == 0 ? -1.0 : 1.0;
            const Vec3 shoulder = eyes + person.eyes_m * Vec3(0.118 * aside, -0.135, 0.04);
            const double rate = 0.7 + 0.2 * static_cast<double>(side);
            const double way = 1.2 * std::sin(rate * t_s);  // -: hangs, +: overhead
            const double out = 0.6 + 0.5 * std::sin(0.43 * t_s + aside);
            const Vec3 along = Vec3(0.5 * aside * out, way - 0.2, -0.8).normalized();
            const double bent = 0.5 + 0.5 * std::sin(0.9 * rate * t_s + 2.0 * aside);
            HandTracking& of_hand = hand.at(k_hands[side]);
            of_hand.state = TrackingState::tracked;
            of_hand.pose_ps.position =
                scale * (shoulder + person.arm_m * (0.5 + (person.stretched - 0.5) * bent) * along);
        }
        estimate_sizes({.dt_s = dt_s,
                        .origin = origin,
                        .head = head,
                        .owner = owner,
                        .hand = hand,
                        .calibration = calibration,
                        .size = size,
                        .measures = measures});
    }
    BodyMeasures now() const { return scaled(measures.at(k_player), 1.0 / scale); }
};

double arm_of(const BodyMeasures& measures) { return measures.upper_arm_m + measures.forearm_m; }

// Oracle: the person's true measures. After 20 s, at any frame rate and scale, and no frame changes
// a measure by a millimetre of the player's metres.
RC_GTEST_PROP(EstimateSizes, StandingAndSeatedPlayersGetTheirSizeWhilePlaying, ()) {
    Random random(*rc::gen::arbitrary<std::uint64_t>());
    const bool sits = random.between(0.0, 1.0) < 0.4;
    const Person person = Person::of(random, sits ? random.between(0.6, 0.76) : 1.0);
    const double scale = std::pow(10.0, random.between(-1.0, 1.3));
    const double hz = random.between(45.0, 144.0);
    Play play(scale);
    BodyMeasures before = play.now();
    for (int frame = 1; frame <= static_cast<int>(20.0 * hz); ++frame) {
        play.step(person, frame / hz, 1.0 / hz);
        const BodyMeasures now = play.now();
        constexpr double k_visible_m = 1e-3;
        RC_ASSERT(std::abs(now.eye_height_m - before.eye_height_m) < k_visible_m);
        RC_ASSERT(std::abs(arm_of(now) - arm_of(before)) < k_visible_m);
        RC_ASSERT(std::abs(now.shoulder_width_m - before.shoulder_width_m) < k_visible_m);
        before = now;
    }
    RC_ASSERT(are_measures(play.measures.at(k_player), scale));
    RC_TAG(sits);
    const double eyes_share = before.eye_height_m / person.eyes_m;
    const double arm_share = arm_of(before) / person.arm_m;
    RC_LOG() << "eyes " << eyes_share << ", arm " << arm_share << ", scale " << scale << "\n";
    RC_ASSERT(arm_share > 0.9);
    RC_ASSERT(arm_share < 1.1);
    RC_ASSERT(eyes_share > (sits ? 0.85 : 0.95));
    RC_ASSERT(eyes_share < (sits ? 1.15 : 1.1));
}

// Measured by a T-pose, or by the host.
TEST(EstimateSizes, PlayersWhoWereMeasuredKeepTheirMeasures) {
    for (const bool by_pose : {true, false}) {
        Play play(1.0);
        if (by_pose) {
            play.calibration.at(k_player).done = true;
        } else {
            play.size.at(k_player).is_measured = true;
        }
        for (int frame = 1; frame <= 900; ++frame) {
            play.step({.eyes_m = 1.2, .arm_m = 0.4}, frame / 90.0, 1.0 / 90.0);
            play.calibration.at(k_player).done = false;  // the button is released
        }
        EXPECT_EQ(play.now().eye_height_m, BodyMeasures{}.eye_height_m);
        EXPECT_EQ(play.now().forearm_m, BodyMeasures{}.forearm_m);
    }
}

// Lost, inferred and never tracked devices say nothing about the size.
TEST(EstimateSizes, OnlyTrackedDevicesCount) {
    const auto estimate = [](Play& play) {
        for (int frame = 0; frame < 90; ++frame) {
            estimate_sizes({.dt_s = 1.0 / 90.0,
                            .origin = play.origin,
                            .head = play.head,
                            .owner = play.owner,
                            .hand = play.hand,
                            .calibration = play.calibration,
                            .size = play.size,
                            .measures = play.measures});
        }
    };
    for (const TrackingState state :
         {TrackingState::never, TrackingState::lost, TrackingState::inferred}) {
        Play hands(1.0);
        hands.step({}, 0.0, 1.0 / 90.0);
        const SizeEstimate before = hands.size.at(k_player);
        for (const Entity hand : k_hands) {
            hands.hand.at(hand).state = state;
        }
        estimate(hands);
        EXPECT_NE(hands.size.at(k_player).eyes.time_s, before.eyes.time_s);
        EXPECT_EQ(hands.size.at(k_player).reach.time_s, before.reach.time_s);

        Play head(1.0);
        head.step({}, 0.0, 1.0 / 90.0);
        HeadTracking& tracked = head.head.at(k_player);
        tracked.is_inferred = state == TrackingState::inferred;
        tracked.state = tracked.is_inferred ? TrackingState::tracked : state;
        estimate(head);
        EXPECT_EQ(head.size.at(k_player).eyes.time_s, before.eyes.time_s);
        EXPECT_EQ(head.size.at(k_player).reach.time_s, before.reach.time_s);
    }
}

// Another person takes the headset. What was seen counts half whenever 240 s were seen, so the size
// follows after about 15 minutes.
TEST(EstimateSizes, AnotherPlayerIsNoticed) {
    Play play(1.0);
    const double hz = 30.0;
    for (int frame = 1; frame <= static_cast<int>(300.0 * hz); ++frame) {
        play.step({.eyes_m = 1.75}, frame / hz, 1.0 / hz);
    }
    EXPECT_NEAR(play.now().eye_height_m, 1.75, 0.05);
    for (int frame = 1; frame <= static_cast<int>(1500.0 * hz); ++frame) {
        play.step({.eyes_m = 1.2, .arm_m = 0.43}, frame / hz, 1.0 / hz);
    }
    EXPECT_NEAR(play.now().eye_height_m, 1.2, 0.1);
}

}  // namespace
}  // namespace handhold::estimate_sizes_test
