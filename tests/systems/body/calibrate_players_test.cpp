#include "systems/body/calibrate_players.hpp"

#include <gtest/gtest.h>

#include "tests/systems/frame/column_scene.hpp"

namespace handhold::calibrate_players_test {
namespace {

using test::k_left;
using test::k_player;
using test::k_right;

// Columns of one player in a T-pose: eyes at 1.70 m, wrists 1.60 m apart.
struct TPosed {
    Column<PlayerCommands> commands;
    Column<PlayerOrigin> origin;
    Column<HeadTracking> head;
    Column<HandOwner> owner;
    Column<HandTracking> hand;
    Column<Calibration> calibration;
    Column<BodyMeasures> measures;

    TPosed() {
        commands.add(k_player).calibrate = true;
        origin.add(k_player);
        head.add(k_player);
        measures.add(k_player);
        calibration.add(k_player);
        owner.add(k_left, {k_player, HandSide::left});
        owner.add(k_right, {k_player, HandSide::right});
        hand.add(k_left);
        hand.add(k_right);
        stand(1.70, 1.60);
    }
    void stand(double eyes_m, double span_m) {
        const Quat turn = rotation_about(Vec3::UnitY(), 0.7);
        HeadTracking& h = head.at(k_player);
        h.state = TrackingState::tracked;
        h.pose_ps = {h.shift_m + Vec3(0.2, eyes_m, -0.1), turn};
        for (const double side : {-1.0, 1.0}) {
            HandTracking& t = hand.at(side < 0.0 ? k_left : k_right);
            t.state = TrackingState::tracked;
            t.pose_ps.position = h.pose_ps.position + turn * Vec3(side * 0.5 * span_m, -0.22, 0.03);
        }
    }
    void play(double seconds, double dt_s = 1.0 / 90.0) {
        const int frames = static_cast<int>(seconds / dt_s + 0.5);
        for (int i = 0; i < frames; ++i) {
            calibrate_players({.dt_s = dt_s,
                               .commands = commands,
                               .origin = origin,
                               .head = head,
                               .owner = owner,
                               .hand = hand,
                               .calibration = calibration,
                               .measures = measures},
                              {});
        }
    }
    const BodyMeasures& found() const { return measures.elements()[0]; }
    bool is_default() const { return found().eye_height_m == BodyMeasures{}.eye_height_m; }
};

double span_of(const BodyMeasures& m) {
    return m.shoulder_width_m + 2.0 * (m.upper_arm_m + m.forearm_m);
}

TEST(CalibratePlayers, MeasuresATPoseHeldForASecondAtAnyRate) {
    for (const double hz : {30.0, 90.0, 144.0}) {
        TPosed player;
        player.play(0.95, 1.0 / hz);
        EXPECT_TRUE(player.is_default()) << hz;
        player.play(0.1, 1.0 / hz);
        EXPECT_NEAR(player.found().eye_height_m, 1.70, 1e-9) << hz;
        EXPECT_NEAR(span_of(player.found()), 1.60, 1e-9) << hz;
    }
}

TEST(CalibratePlayers, SeatedPlayerGetsTheHeightOfTheirSpan) {
    TPosed player;
    player.stand(1.20, 1.60);
    player.play(1.1);
    EXPECT_NEAR(player.found().eye_height_m, 1.60 / 0.95, 1e-9);
    EXPECT_NEAR(span_of(player.found()), 1.60, 1e-9);
}

// Re-centring shifts the tracking; the shift is not part of the height.
TEST(CalibratePlayers, ShiftedTrackingIsMeasuredFromTheFloor) {
    TPosed player;
    player.head.at(k_player).shift_m = Vec3(1.0, -0.4, 2.0);
    player.stand(1.70, 1.60);
    player.play(1.1);
    EXPECT_NEAR(player.found().eye_height_m, 1.70, 1e-9);
}

TEST(CalibratePlayers, MovingHandsRestartTheMeasurement) {
    TPosed player;
    player.play(0.9);
    player.stand(1.70, 1.75);
    player.play(0.9);
    EXPECT_TRUE(player.is_default());
    player.play(0.2);
    EXPECT_NEAR(span_of(player.found()), 1.75, 1e-9);
}

TEST(CalibratePlayers, NothingIsMeasuredWithoutARequestOrTracking) {
    TPosed silent;
    silent.commands.at(k_player).calibrate = false;
    silent.play(3.0);
    EXPECT_TRUE(silent.is_default());
    TPosed lost;
    lost.hand.at(k_left).state = TrackingState::lost;
    lost.play(3.0);
    EXPECT_TRUE(lost.is_default());
}

TEST(CalibratePlayers, MeasuresOncePerRequest) {
    TPosed player;
    player.play(1.1);
    player.stand(1.50, 1.40);
    player.play(3.0);
    EXPECT_NEAR(player.found().eye_height_m, 1.70, 1e-9);
    player.commands.at(k_player).calibrate = false;
    player.play(0.1);
    player.commands.at(k_player).calibrate = true;
    player.play(1.1);
    EXPECT_NEAR(player.found().eye_height_m, 1.50, 1e-9);
}

// Arms at any angle from level to 55 degrees down give the same span: shoulders 0.25 spans apart
// and 0.145 spans below the eyes.
TEST(ReadTPose, MeasuresLoweredArms) {
    for (const double span_m : {1.1, 1.5, 1.8}) {
        const Vec3 head(0.0, span_m / 0.95, 0.0);
        for (int degrees = 0; degrees <= 55; degrees += 5) {
            const double angle = degrees * k_degree;
            const double x = 0.125 * span_m + 0.375 * span_m * std::cos(angle);
            const double y = head.y() - 0.145 * span_m - 0.375 * span_m * std::sin(angle);
            const auto pose = read_t_pose(head, Vec3(-x, y, 0.0), Vec3(x, y, 0.0));
            ASSERT_TRUE(pose) << span_m << " " << degrees;
            EXPECT_NEAR(pose->span_m, span_m, 1e-9) << degrees;
        }
        // Hanging arms are not accepted.
        const double x = 0.2 * span_m;
        const double y = head.y() - 0.51 * span_m;
        EXPECT_FALSE(read_t_pose(head, Vec3(-x, y, 0.0), Vec3(x, y, 0.0)));
    }
}

// Bent arms, or controllers held far apart, are not measured.
TEST(ReadTPose, RefusesImplausibleArmLengths) {
    const Vec3 head(0.0, 1.7, 0.0);
    const auto at = [&](double half_m, double below_m) {
        const Vec3 down(0.0, 1.7 - below_m, 0.0);
        return read_t_pose(head, down - half_m * Vec3::UnitX(), down + half_m * Vec3::UnitX());
    };
    EXPECT_TRUE(at(0.80, 0.22));
    EXPECT_FALSE(at(0.60, 0.22));
    EXPECT_FALSE(at(0.80, 0.80));
    EXPECT_TRUE(at(0.62, 0.66));
}

TEST(ReadTPose, RefusesOtherPoses) {
    const Vec3 head(0.0, 1.7, 0.0);
    const Vec3 left(-0.8, 1.48, 0.0);
    const Vec3 right(0.8, 1.48, 0.0);
    EXPECT_TRUE(read_t_pose(head, left, right));
    EXPECT_FALSE(read_t_pose(head, left, right + Vec3(0.0, 0.4, 0.0)));                  // aslant
    EXPECT_FALSE(read_t_pose(head, left - Vec3(0, 0.6, 0), right - Vec3(0, 0.6, 0)));    // hanging
    EXPECT_FALSE(read_t_pose(head, left + Vec3(0, 0.3, 0), right + Vec3(0, 0.3, 0)));    // raised
    EXPECT_FALSE(read_t_pose(head, left - Vec3(0, 0, 0.5), right - Vec3(0, 0, 0.5)));    // ahead
    EXPECT_FALSE(read_t_pose(head, 0.3 * left + 0.7 * head, 0.3 * right + 0.7 * head));  // near
    const Vec3 nowhere = Vec3::Constant(std::numeric_limits<double>::quiet_NaN());
    EXPECT_FALSE(read_t_pose(nowhere, left, right));
    EXPECT_FALSE(read_t_pose(head, nowhere, right));
}

TEST(MeasuresOf, EyeHeightAloneGivesABodyOfThatHeight) {
    for (const double height : {1.2, 1.62, 1.9}) {
        const BodyMeasures measures = measures_of_eye_height(height);
        EXPECT_EQ(measures.eye_height_m, height);
        EXPECT_NEAR(span_of(measures) / height, 0.95, 1e-12);
    }
}

}  // namespace
}  // namespace handhold::calibrate_players_test
