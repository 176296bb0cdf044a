// When a server that plays one match is ready, allocated and over.
#include "game/net/agones.hpp"

#include <gtest/gtest.h>

#include "tests/game/net/loopback_match.hpp"

namespace handhold::agones_test {
namespace {

using State = AgonesReporter::State;

TEST(FleetMatch, IsOverWhenNobodyHasComeBackInTime) {
    MatchSeats seats(2, 1);
    FleetMatch fleet(60.0);
    EXPECT_EQ(fleet.update(seats, 0.0), State::ready);
    seats.at(0).stage = SeatStage::playing;
    seats.at(0).has_played = true;
    EXPECT_EQ(fleet.update(seats, 1.0), State::allocated);
    seats.at(0).stage = SeatStage::empty;
    EXPECT_EQ(fleet.update(seats, 60.0), State::allocated);
    EXPECT_FALSE(fleet.is_over(60.0));
    seats.at(0).stage = SeatStage::joining;  // comes back
    EXPECT_EQ(fleet.update(seats, 60.5), State::allocated);
    seats.at(0).stage = SeatStage::empty;
    EXPECT_EQ(fleet.update(seats, 120.0), State::allocated);
    EXPECT_FALSE(fleet.is_over(120.0));
    EXPECT_TRUE(fleet.is_over(121.0));
}

TEST(FleetMatch, SpectatorsDoNotBeginIt) {
    MatchSeats seats(2, 1);
    FleetMatch fleet(60.0);
    seats.at(2).stage = SeatStage::playing;
    seats.at(2).has_played = true;
    EXPECT_EQ(fleet.update(seats, 1.0), State::ready);
    EXPECT_FALSE(fleet.is_over(1000.0));
}

// The state is packed so slowly that it never arrives.
TEST(FleetMatch, IsNotBegunByAPeerThatSaysHelloAndLeaves) {
    if (!has_network() || !has_packing()) {
        GTEST_SKIP() << "built without a network, or without zstd";
    }
    test::LoopbackMatch match(
        2, [](MatchServerSettings& settings) { settings.packed_bytes_per_s = 1.0; });
    FleetMatch fleet(0.0);
    test::LoopbackPeer& early = match.add_peer(1);
    EXPECT_EQ(fleet.update(match.server->seats(), 1.0), State::ready);
    ASSERT_TRUE(match.run_until(20.0, [&] { return match.server->counts().joins == 1; }));
    EXPECT_EQ(fleet.update(match.server->seats(), 2.0), State::allocated);
    EXPECT_FALSE(fleet.is_over(1000.0));
    early.peer->leave();
    ASSERT_TRUE(match.run_until(20.0, [&] { return match.server->seats().taken() == 0; }));
    EXPECT_EQ(fleet.update(match.server->seats(), 3.0), State::ready);
    EXPECT_FALSE(fleet.is_over(1000.0));
}

}  // namespace
}  // namespace handhold::agones_test
