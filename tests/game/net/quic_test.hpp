#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <utility>

#include <gtest/gtest.h>

#include "game/net/transport_kinds.hpp"
#include "tests/game/net/loopback_match.hpp"

namespace handhold::test {

// Tests that need QUIC are skipped in a build without it.
class QuicTest : public testing::Test {
  protected:
    void SetUp() override {
        if (!has_quic()) {
            GTEST_SKIP() << "built without ngtcp2";
        }
    }
};

inline LoopbackPeer& add_peer(LoopbackMatch& match, std::uint64_t number, const std::string& url) {
    match.peers.push_back(std::make_unique<LoopbackPeer>(match.scene().players.size(), number));
    match.peers.back()->connect(std::move(open_link(url).value()));
    return *match.peers.back();
}

// The attack goes on until enough ticks were compared.
inline void expect_unharmed(LoopbackMatch& match, const LoopbackPeer& other) {
    EXPECT_TRUE(match.run_until(30.0, [&] { return other.compared > 40; }));
    EXPECT_TRUE(other.plays());
    EXPECT_EQ(other.different, 0U);
    EXPECT_EQ(other.peer->states(), 1U);
}

}  // namespace handhold::test
