#include <array>
#include <cstddef>
#include <memory>
#include <span>
#include <vector>

#include <gtest/gtest.h>

#include "systems/match/match_messages.hpp"
#include "tests/random.hpp"

namespace handhold::server_packet_test {
namespace {

using test::Random;

constexpr std::size_t k_slots = 5;
constexpr MatchTick k_newest = 40;

MatchInput random_input(Random& random) {
    MatchInput input;
    input.is_head_tracked = true;
    input.head = pack({random.vector(2.0), Quat::Identity()});
    input.hands[1].is_tracked = true;
    input.hands[1].pose = pack({random.vector(2.0), rotation_about(random.direction(), 1.0)});
    input.hands[1].grab = random.between(0.0, 1.0) < 0.5;
    return input;
}

// Streams that begin after a gap are left out; all others are read as they were written.
TEST(ServerPacket, HolesInSomeStreamsLeaveTheOthers) {
    Random random(9301);
    auto packet = std::make_unique<ServerPacket>();
    int holes = 0;
    int whole = 0;
    for (int i = 0; i < 400; ++i) {
        std::vector<InputHistory> server(k_slots);
        std::vector<InputHistory> client(k_slots);
        std::array<StreamSource, k_slots> streams;
        std::array<bool, k_slots> has_hole{};
        for (std::size_t slot = 0; slot < k_slots; ++slot) {
            const auto known = static_cast<MatchTick>(random.between(30.0, 40.0));
            for (MatchTick tick = 1; tick <= k_newest; ++tick) {
                const MatchInput input = normalised(random_input(random));
                server[slot].finish_next(input, InputKind::real);
                if (tick <= known) {
                    client[slot].finish_next(input, InputKind::real);
                }
            }
            const auto base = static_cast<MatchTick>(random.between(33.0, 40.0));
            streams[slot] = {.history = &server[slot],
                             .base = base,
                             .until = k_newest,
                             .is_receivers_own = slot == 0};
            has_hole[slot] = base > known;
        }
        ServerHeader header;
        header.confirmed_until = k_newest;
        std::array<std::byte, k_most_packet_bytes> bytes{};
        const std::size_t size = write_server_packet(header, k_slots, streams, bytes);
        ASSERT_EQ(
            read_server_packet(std::span(bytes).first(size), k_slots, {client, 0, 0}, *packet),
            MatchRefusal::none);
        std::uint32_t gaps = 0;
        for (std::size_t slot = 0; slot < k_slots; ++slot) {
            const StreamPart& part = packet->streams[slot];
            gaps += has_hole[slot] ? 1U : 0U;
            EXPECT_EQ(part.count, has_hole[slot] ? 0 : streams[slot].until - streams[slot].base);
            for (std::size_t k = 0; slot > 0 && k < part.count; ++k) {
                ASSERT_EQ(part.entries[k].input, server[slot].at(part.base + k + 1));
                ++whole;
            }
        }
        EXPECT_EQ(packet->gaps, gaps);
        holes += static_cast<int>(gaps);
    }
    EXPECT_GT(holes, 300);
    EXPECT_GT(whole, 2000);
}

}  // namespace
}  // namespace handhold::server_packet_test
