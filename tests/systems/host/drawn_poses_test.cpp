// hh_match_drawn_player and hh_match_drawn_bodies: pictures of displays of any rate.
#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "tests/systems/host/match_table.hpp"

namespace handhold::drawn_poses_test {
namespace {

using test::k_step_s;
using test::TableMachine;

constexpr double k_ball_mps = 0.8;

// A client on its own plays for half a second, which is less than it may be ahead of the server,
// and calls `look(picture's time, tick's time)` for each picture.
template <typename Look>
void play(TableMachine& machine, double hz, const Look& look) {
    const auto pictures = static_cast<int>(0.5 * hz);
    double time_s = 0.0;
    for (int picture = 1; picture <= pictures; ++picture) {
        time_s += 1.0 / hz;
        const std::uint32_t due = *machine.match.ticks_due(1.0 / hz);
        for (std::uint32_t i = 0; i < due; ++i) {
            const double end_s = machine.scene.world.time_s() + k_step_s;
            hh::Sample sample = test::table_sample(0, end_s);
            sample.grab[HH_LEFT] = 0;
            sample.grab[HH_RIGHT] = end_s > 0.15 ? 1 : 0;
            hh_match_input input = hh::match_input({&sample, 1});
            input.is_hidden = i + 1 < due ? 1 : 0;
            ASSERT_TRUE(*machine.match.advance(input));
        }
        if (machine.scene.world.time_s() > 0.1) {
            look(time_s, machine.scene.world.time_s());
        }
    }
}

class DrawnPosesAtRate : public testing::TestWithParam<double> {
  protected:
    DrawnPosesAtRate() : machine_(HH_MATCH_CLIENT, 0) {}
    hh::World& world() { return machine_.scene.world; }

    TableMachine machine_;
};

// In every picture a ball at a constant speed has moved on by as much as time has, although the
// world's own ball stands still or moves twice as far in some of them.
TEST_P(DrawnPosesAtRate, BodiesMoveEvenly) {
    const hh::Body ball = machine_.scene.ball;
    ASSERT_TRUE(world().teleport(ball, hh::pose_at({0.3, 3.0, -3.0})));
    ASSERT_TRUE(world().set_velocity(ball, {0.0, 0.0, k_ball_mps}));
    std::vector<double> drawn_m;
    std::vector<double> stepped_m;
    play(machine_, GetParam(), [&](double picture_s, double tick_s) {
        hh_pose pose{};
        ASSERT_TRUE(machine_.match.drawn_bodies({&ball, 1}, {&pose, 1}));
        const double stepped = world().pose(ball)->position.z;
        // The picture's time, less a tick.
        EXPECT_NEAR(pose.position.z, stepped + k_ball_mps * (picture_s - k_step_s - tick_s), 1e-6);
        drawn_m.push_back(pose.position.z);
        stepped_m.push_back(stepped);
    });
    ASSERT_GT(drawn_m.size(), 20U);
    const double even_m = k_ball_mps / GetParam();
    double most_uneven_m = 0.0;
    for (std::size_t i = 1; i < drawn_m.size(); ++i) {
        EXPECT_NEAR(drawn_m[i] - drawn_m[i - 1], even_m, 1e-6) << i;
        most_uneven_m = std::max(most_uneven_m, std::abs(stepped_m[i] - stepped_m[i - 1] - even_m));
    }
    if (GetParam() != 90.0) {
        EXPECT_GT(most_uneven_m, 0.2 * even_m);  // else this run proves nothing
    }
}

TEST_P(DrawnPosesAtRate, HeadAndEmptyHandsAreWhereTheDevicesAre) {
    int empty = 0;
    int holding = 0;
    double last_tick_s = 0.0;
    std::array<hh_pose, 2> before{};  // shown wrists of the last shown tick but one, by side
    std::array<hh_pose, 2> last{};
    play(machine_, GetParam(), [&](double picture_s, double tick_s) {
        hh::Sample newest = test::table_sample(0, picture_s);
        newest.head.position.y += 0.3;  // where no tick has been
        const auto drawn = machine_.match.drawn_player(0, &newest);
        const auto without = machine_.match.drawn_player(0);
        ASSERT_TRUE(drawn);
        ASSERT_TRUE(without);
        const auto expect_at = [](const hh_pose& pose, const hh::Pose& wanted, double within_m) {
            EXPECT_LT(hh::length(pose.position - wanted.position), within_m);
        };
        expect_at(drawn->head, drawn->origin * newest.head, 1e-12);
        EXPECT_GT(hh::length(drawn->head.position - without->head.position), 0.2);
        const hh_player_pose stepped = *world().pose(machine_.scene.players[0]);
        if (tick_s != std::exchange(last_tick_s, tick_s)) {
            before = last;
            last = {stepped.hands[HH_LEFT].shown, stepped.hands[HH_RIGHT].shown};
        }
        for (const hh_side side : {HH_LEFT, HH_RIGHT}) {
            if (stepped.hands[side].grip == HH_GRIP_NONE) {
                ++empty;
                // The shown wrist is beside the tracked one where surfaces hold it off.
                const double off_m = hh::length(stepped.hands[side].shown.position -
                                                stepped.hands[side].tracked.position);
                expect_at(drawn->hands[side], drawn->origin * newest.hands[side], off_m + 1e-6);
            } else {
                ++holding;
                expect_at(drawn->hands[side], without->hands[side], 1e-12);
                // On the way from the last shown tick but one to the last.
                const hh_vec3 from = before[side].position - drawn->hands[side].position;
                const hh_vec3 to = last[side].position - drawn->hands[side].position;
                EXPECT_NEAR(hh::length(from) + hh::length(to), hh::length(to - from), 1e-6);
            }
        }
    });
    EXPECT_GT(empty, 5);
    EXPECT_GT(holding, 5);
}

TEST_P(DrawnPosesAtRate, PicturesChangeNothing) {
    TableMachine other(HH_MATCH_CLIENT, 0);
    play(machine_, GetParam(), [&](double picture_s, double /*tick_s*/) {
        const hh::Sample newest = test::table_sample(0, picture_s);
        ASSERT_TRUE(machine_.match.drawn_player(0, &newest));
        ASSERT_TRUE(machine_.match.drawn_player(1));
    });
    play(other, GetParam(), [](double, double) {});
    EXPECT_EQ(world().hash(), other.scene.world.hash());
}

INSTANTIATE_TEST_SUITE_P(Hz, DrawnPosesAtRate, testing::Values(60.0, 72.0, 90.0, 120.0, 144.0));

// A world that is too far ahead of the confirmed ticks is not stepped. Then drawn poses stay the
// same.
TEST(DrawnPoses, StandStillWhileTheWorldWaits) {
    TableMachine machine(HH_MATCH_CLIENT, 0);
    const hh::Body ball = machine.scene.ball;
    ASSERT_TRUE(machine.scene.world.teleport(ball, hh::pose_at({0.3, 3.0, -3.0})));
    ASSERT_TRUE(machine.scene.world.set_velocity(ball, {0.0, 0.0, k_ball_mps}));
    int waits = 0;
    double last_m = -10.0;
    for (int picture = 0; picture < 288; ++picture) {
        const std::uint32_t due = *machine.match.ticks_due(1.0 / 144.0);
        bool has_waited = waits > 0;
        for (std::uint32_t i = 0; i < due; ++i) {
            const hh::Sample sample =
                test::table_sample(0, machine.scene.world.time_s() + k_step_s);
            const hh_match_input input = hh::match_input({&sample, 1});
            waits += *machine.match.advance(input) ? 0 : 1;
        }
        hh_pose pose{};
        if (picture < 2 || !machine.match.drawn_bodies({&ball, 1}, {&pose, 1})) {
            continue;
        }
        ASSERT_GE(pose.position.z, last_m - 1e-12) << picture;
        ASSERT_TRUE(!has_waited || pose.position.z - last_m < 1e-12) << picture;
        last_m = pose.position.z;
    }
    EXPECT_GT(waits, 50);
}

// A body that is put elsewhere is drawn here or there.
TEST(DrawnPoses, TeleportsOfBodiesAreDrawnAtOnce) {
    TableMachine machine(HH_MATCH_CLIENT, 0);
    const hh::Body ball = machine.scene.ball;
    int there = 0;
    for (int picture = 0; picture < 40; ++picture) {
        const std::uint32_t due = *machine.match.ticks_due(1.0 / 144.0);
        if (picture == 20) {
            ASSERT_TRUE(machine.scene.world.teleport(ball, hh::pose_at({0.3, 9.0, -9.0})));
        }
        for (std::uint32_t i = 0; i < due; ++i) {
            const hh::Sample sample =
                test::table_sample(0, machine.scene.world.time_s() + k_step_s);
            ASSERT_TRUE(*machine.match.advance(hh::match_input({&sample, 1})));
        }
        hh_pose pose{};
        if (machine.match.drawn_bodies({&ball, 1}, {&pose, 1})) {
            const double up_m = pose.position.y;
            there += up_m > 8.9 ? 1 : 0;
            EXPECT_TRUE(up_m < 1.5 || up_m > 8.9) << up_m;
        }
    }
    EXPECT_GT(there, 15);
}

TEST(DrawnPoses, NewestSamplesAreForTheOwnSlot) {
    TableMachine machine(HH_MATCH_CLIENT, 0);
    const hh::Sample sample = test::table_sample(0, k_step_s);
    ASSERT_TRUE(*machine.match.advance(hh::match_input({&sample, 1})));
    EXPECT_TRUE(machine.match.drawn_player(0, &sample));
    EXPECT_EQ(machine.match.drawn_player(1, &sample).status().result(), HH_ERROR_VALUE);
}

// A tick's motion of the camera rig is drawn in between; that of a snap turn is not.
TEST(DrawnPoses, SnapTurnsAreDrawnAtOnce) {
    TableMachine machine(HH_MATCH_CLIENT, 0);
    std::vector<double> turned;
    std::vector<double> stepped = {0.0};
    const auto turn_of = [](const hh_pose& origin) {
        return 2.0 * std::atan2(origin.rotation.y, origin.rotation.w);
    };
    for (int picture = 0; picture < 24; ++picture) {
        const std::uint32_t due = *machine.match.ticks_due(1.0 / 144.0);
        for (std::uint32_t i = 0; i < due; ++i) {
            hh::Sample sample = test::table_sample(0, machine.scene.world.time_s() + k_step_s);
            sample.grab[HH_LEFT] = sample.grab[HH_RIGHT] = 0;
            hh_match_input input = hh::match_input({&sample, 1});
            input.commands.snap_turns = picture == 12 || picture == 13 ? 1 : 0;
            ASSERT_TRUE(*machine.match.advance(input));
            stepped.push_back(turn_of(machine.scene.world.pose(machine.scene.players[0])->origin));
        }
        if (picture > 4) {
            turned.push_back(turn_of(machine.match.drawn_player(0)->origin));
        }
    }
    EXPECT_GT(turned.back(), 0.3);
    for (const double one : turned) {
        EXPECT_TRUE(std::ranges::any_of(stepped, [one](double step) {
            return std::abs(step - one) < 1e-9;
        })) << one;
    }
}

TEST(DrawnPoses, AreThereAfterTheFirstShownTick) {
    TableMachine machine(HH_MATCH_CLIENT, 0);
    EXPECT_EQ(machine.match.drawn_player(0).status().result(), HH_ERROR_STATE);
    const hh::Sample sample = test::table_sample(0, k_step_s);
    hh_match_input input = hh::match_input({&sample, 1});
    input.is_hidden = 1;
    ASSERT_TRUE(*machine.match.advance(input));
    EXPECT_EQ(machine.match.drawn_player(0).status().result(), HH_ERROR_STATE);
    input.is_hidden = 0;
    ASSERT_TRUE(*machine.match.advance(input));
    ASSERT_TRUE(machine.match.drawn_player(0));
    EXPECT_EQ(machine.match.drawn_player(2).status().result(), HH_ERROR_VALUE);
    const TableMachine server(HH_MATCH_SERVER);
    EXPECT_EQ(server.match.drawn_player(0).status().result(), HH_ERROR_STATE);
}

}  // namespace
}  // namespace handhold::drawn_poses_test
