// Join states on the wire.
#include "game/net/pack_state.hpp"

#include <algorithm>

#include <gtest/gtest.h>

#include "game/net/net_messages.hpp"
#include "tests/game/net/loopback_match.hpp"
#include "tests/random.hpp"

namespace handhold::pack_state_test {
namespace {

class PackStateTest : public testing::Test {
  protected:
    void SetUp() override {
        if (!has_packing()) {
            GTEST_SKIP() << "built without zstd";
        }
    }
};

std::vector<std::byte> state_of(std::size_t size) {
    std::vector<std::byte> out(size);
    for (std::size_t i = 0; i < size; ++i) {
        out[i] = static_cast<std::byte>(i % 251 * (i / 1000 % 7));
    }
    return out;
}

TEST_F(PackStateTest, WhatWasPackedIsUnpacked) {
    for (const std::size_t size : {1U, 100U, 109'000U, 3'400'000U}) {
        const std::vector<std::byte> state = state_of(size);
        const auto unpacked = unpack_state(pack_state(state), StatePiece::k_most_total);
        ASSERT_TRUE(unpacked.has_value());
        EXPECT_TRUE(*unpacked == state);
    }
}

TEST_F(PackStateTest, PartsMakeAWholeAndNoneIsLargerThanAsked) {
    for (const std::size_t size : {1U, 64U << 10U, 200'000U}) {
        const std::vector<std::byte> state = state_of(size);
        const std::unique_ptr<StatePacker> packer = StatePacker::begin(state);
        std::size_t packed = 0;
        for (int part = 0; !packer->is_done() && part < 100; ++part) {
            const std::size_t now = packer->advance(10'000);
            EXPECT_LE(now, 10'000U);
            packed += now;
        }
        ASSERT_TRUE(packer->is_done());
        EXPECT_EQ(packed, size);
        const auto unpacked = unpack_state(packer->take(), StatePiece::k_most_total);
        ASSERT_TRUE(unpacked.has_value());
        EXPECT_TRUE(*unpacked == state);
    }
}

TEST_F(PackStateTest, DamagedAndCutStatesAreRefused) {
    const std::vector<std::byte> state = state_of(10'000);
    const std::vector<std::byte> packed = pack_state(state);
    for (std::size_t size = 0; size < packed.size(); ++size) {
        EXPECT_FALSE(unpack_state(std::span(packed).first(size), 10'000).has_value()) << size;
    }
    test::Random random(3);
    int refused = 0;
    for (int i = 0; i < 2000; ++i) {
        std::vector<std::byte> flipped = packed;
        const auto at =
            static_cast<std::size_t>(random.between(0.0, static_cast<double>(flipped.size())));
        flipped[at] ^=
            static_cast<std::byte>(1U << static_cast<unsigned>(random.between(0.0, 8.0)));
        const auto unpacked = unpack_state(flipped, 20'000);
        refused += unpacked ? 0 : 1;
        EXPECT_TRUE(!unpacked || *unpacked == state) << at;
    }
    EXPECT_GT(refused, 1980);  // one bit of the header means nothing
}

TEST_F(PackStateTest, ASmallPieceThatClaimsMuchTakesNoMemory) {
    const std::vector<std::byte> packed = pack_state(std::vector<std::byte>(40U << 20U));
    EXPECT_LT(packed.size(), 10'000U);
    EXPECT_FALSE(unpack_state(packed, StatePiece::k_most_total).has_value());
    // A frame that says eight exabytes.
    std::vector<std::byte> bomb = {std::byte{0x28}, std::byte{0xb5}, std::byte{0x2f},
                                   std::byte{0xfd}, std::byte{0xe0}};
    bomb.insert(bomb.end(), 7, std::byte{0xff});
    bomb.push_back(std::byte{0x7f});
    bomb.insert(bomb.end(), 20, std::byte{0});
    EXPECT_FALSE(unpack_state(bomb, StatePiece::k_most_total).has_value());
}

// The time that a state's inputs are kept begins when the state is made, so no state waits for
// others to be packed. The clock is the test's.
TEST_F(PackStateTest, StatesArePackedOneAfterTheOther) {
    if (!has_network()) {
        GTEST_SKIP() << "built without a network";
    }
    constexpr std::size_t k_peers = 3;
    constexpr double k_tick_s = 1.0 / 90.0;
    constexpr double k_bytes_per_s = 200e3;
    double now_s = 0.0;
    test::LoopbackMatch match(
        k_peers,
        [&](MatchServerSettings& settings) {
            settings.clock = [&now_s] { return now_s; };
            settings.packed_bytes_per_s = k_bytes_per_s;
        },
        [](ListenerSettings& settings) {  // its budget follows the wall's clock
            settings.budget.messages_per_s *= 1000.0;
            settings.budget.bytes_per_s *= 1000.0;
        });
    for (std::size_t i = 0; i < k_peers; ++i) {
        match.peers.push_back(std::make_unique<test::LoopbackPeer>(k_peers, i + 1));
        match.peers.back()->settings.clock = [&now_s] { return now_s; };
        match.peers.back()->connect(match.link());
    }
    const MatchServerCounts& counts = match.server->counts();
    const auto poll = [&match] {
        match.server->poll();
        std::ranges::for_each(match.peers, [](const auto& peer) { peer->poll(); });
    };
    for (int i = 0; i < 10'000 && counts.joins < k_peers; ++i) {
        poll();
    }
    ASSERT_EQ(counts.joins, k_peers);
    EXPECT_EQ(counts.states, 1U);
    double longest_s = 0.0;
    for (int i = 0; i < 1000 && !match.all_play(); ++i) {
        now_s += k_tick_s;
        poll();
        std::size_t packing = 0;
        for (std::size_t slot = 0; slot < k_peers; ++slot) {
            const MatchSeat& seat = match.server->seats().at(slot);
            packing += seat.packer != nullptr ? 1U : 0U;
            longest_s = std::max(longest_s, seat.packer != nullptr ? seat.waited_s : 0.0);
        }
        EXPECT_LE(packing, 1U);
    }
    EXPECT_TRUE(match.all_play());
    EXPECT_EQ(counts.states, k_peers);
    EXPECT_GT(longest_s, 0.1);
    const double state_bytes = static_cast<double>(counts.state_bytes) / k_peers;
    EXPECT_LE(longest_s, state_bytes / k_bytes_per_s + 2.0 * k_tick_s);
}

TEST_F(PackStateTest, PeersWithAndWithoutItPlayOneMatch) {
    if (!has_network()) {
        GTEST_SKIP() << "built without a network";
    }
    test::LoopbackMatch match(2);
    for (const bool unpacks : {true, false}) {
        auto peer = std::make_unique<test::LoopbackPeer>(2, unpacks ? 1 : 2);
        peer->settings.unpacks = unpacks;
        peer->connect(match.link());
        match.peers.push_back(std::move(peer));
        ASSERT_TRUE(match.run_until(20.0, [&] { return match.all_play(); }));
        const MatchServerCounts& counts = match.server->counts();
        EXPECT_EQ(counts.states, unpacks ? 1U : 2U);
        RecordProperty(unpacks ? "bytes_packed" : "bytes_of_both",
                       static_cast<int>(counts.state_bytes_packed));
        if (unpacks) {
            EXPECT_LT(counts.state_bytes_packed, counts.state_bytes * 7 / 10);
            RecordProperty("bytes_made", static_cast<int>(counts.state_bytes));
        }
    }
    match.run(2.0);
    for (const auto& peer : match.peers) {
        EXPECT_EQ(peer->different, 0U);
        EXPECT_GT(peer->compared, 30U);
    }
}

}  // namespace
}  // namespace handhold::pack_state_test
