// Every message is parsed as hostile: refused as a whole with a counted reason, or accepted.
#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <memory>
#include <vector>

#include <gtest/gtest.h>

#include "tests/engine/allocation_count.hpp"
#include "tests/random.hpp"
#include "tests/systems/match/match_play.hpp"

namespace handhold::match_test {
namespace {

using Bytes = std::vector<std::byte>;

constexpr std::array<std::uint8_t, k_people> k_epochs{};  // epochs of states: nobody has joined

std::uint8_t sender_of(std::span<const std::byte> packet) {
    return packet.size() < 2 ? 0 : std::to_integer<std::uint8_t>(packet[1] & std::byte{15});
}

// Packets of a running match, and the inputs that they are read against.
struct Recording {
    std::vector<Bytes> packets;
    std::vector<InputHistory> server;
    std::vector<InputHistory> client;  // of person 0

    Recording() {
        MatchPlay match({.delay_s = 0.05, .jitter_s = 0.03, .loss = 0.05}, 21);
        match.play(1.5);
        match.records = true;
        match.play(0.1);
        packets = match.recorded;
        for (std::size_t slot = 0; slot < k_people; ++slot) {
            server.push_back(match.server.inputs_of(slot));
            client.push_back(match.machines[0]->session.inputs_of(slot));
        }
    }
    static bool is_clients(const Bytes& packet) {
        return (std::to_integer<unsigned>(packet[0]) & 7U) == 1;
    }
    MatchRefusal read(std::span<const std::byte> packet, bool by_server) {
        return by_server
                   ? read_client_packet(packet, k_people,
                                        {sender_of(packet), server, server, k_epochs}, *of_client_)
                   : read_server_packet(packet, k_people, {client, 0, 0}, *of_server_);
    }

  private:
    std::unique_ptr<ClientPacket> of_client_ = std::make_unique<ClientPacket>();
    std::unique_ptr<ServerPacket> of_server_ = std::make_unique<ServerPacket>();
};

void seal(Bytes& packet) {
    const std::size_t size = packet.size() - 4;
    const std::uint32_t sum = match_checksum(std::span(packet).first(size));
    for (std::size_t i = 0; i < 4; ++i) {
        packet[size + i] = static_cast<std::byte>((sum >> (8 * i)) & 0xffU);
    }
}

TEST(HostileMessages, EveryTruncationAndBitFlipIsRefused) {
    Recording recording;
    std::size_t tried = 0;
    std::size_t accepted = 0;
    for (const Bytes& packet : recording.packets) {
        const bool by_server = Recording::is_clients(packet);
        accepted += recording.read(packet, by_server) == MatchRefusal::none ? 1U : 0U;
        EXPECT_NE(recording.read(packet, !by_server), MatchRefusal::none);  // of the other kind
        for (std::size_t size = 0; size < packet.size(); ++size) {
            ASSERT_NE(recording.read(std::span(packet).first(size), by_server), MatchRefusal::none);
            ++tried;
        }
        Bytes flipped = packet;
        for (std::size_t bit = 0; bit < 8 * packet.size(); ++bit) {
            flipped[bit / 8] ^= static_cast<std::byte>(1U << (bit % 8));
            ASSERT_NE(recording.read(flipped, by_server), MatchRefusal::none) << bit;
            flipped[bit / 8] = packet[bit / 8];
            ++tried;
        }
        Bytes longer = packet;
        longer.resize(k_most_packet_bytes + 1);
        ASSERT_EQ(recording.read(longer, by_server), MatchRefusal::size);
    }
    EXPECT_GT(tried, 20000U);
    EXPECT_GT(accepted, recording.packets.size() / 3);  // the unchanged ones can be read
}

// With a right checksum, the fields themselves are hostile. Nothing grows, and what is accepted is
// within its ranges.
TEST(HostileMessages, ForgedFieldsAreRefusedOrInRange) {
    Recording recording;
    test::Random random(seed_of(3));
    std::array<std::size_t, k_match_refusals> seen{};
    const auto in_range = [](const PackedPose& pose) {
        return pose.largest < 4 &&
               std::ranges::all_of(pose.position,
                                   [](std::int32_t x) {
                                       return x <= PackedPose::k_most_units &&
                                              x >= -PackedPose::k_most_units;
                                   }) &&
               std::ranges::all_of(pose.rotation, [](std::int16_t x) {
                   return x <= PackedPose::k_most_rotation && x >= -PackedPose::k_most_rotation;
               });
    };
    auto server_packet = std::make_unique<ServerPacket>();
    auto client_packet = std::make_unique<ClientPacket>();
    Bytes forged;
    forged.reserve(2 * k_most_packet_bytes);
    std::size_t allocations = 0;
    for (int i = 0; i < 60000; ++i) {
        const auto pick = static_cast<std::size_t>(
            random.between(0.0, static_cast<double>(recording.packets.size())));
        forged = recording.packets[std::min(pick, recording.packets.size() - 1)];
        const bool by_server = Recording::is_clients(forged);
        const auto flips = static_cast<int>(random.between(1.0, 12.0));
        for (int flip = 0; flip < flips; ++flip) {
            const auto bit = static_cast<std::size_t>(
                random.between(8.0, 8.0 * static_cast<double>(forged.size() - 4)));
            forged[bit / 8] ^= static_cast<std::byte>(1U << (bit % 8));
        }
        if (i % 5 == 0) {
            forged.resize(
                static_cast<std::size_t>(random.between(7.0, static_cast<double>(forged.size()))));
        }
        seal(forged);
        const std::size_t at = allocation_count();
        const MatchRefusal refusal =
            by_server
                ? read_client_packet(
                      forged, k_people,
                      {sender_of(forged), recording.server, recording.server, k_epochs},
                      *client_packet)
                : read_server_packet(forged, k_people, {recording.client, 0, 0}, *server_packet);
        allocations += allocation_count() - at;
        ++seen[static_cast<std::size_t>(refusal)];
        if (refusal != MatchRefusal::none) {
            continue;
        }
        for (std::size_t slot = 0; slot < (by_server ? 1U : k_people); ++slot) {
            const StreamPart& part = by_server ? client_packet->own : server_packet->streams[slot];
            ASSERT_LE(part.count, StreamPart::k_most);
            for (std::size_t k = 0; k < part.count; ++k) {
                if (part.entries[k].is_sent) {
                    const MatchInput& input = part.entries[k].input;
                    ASSERT_TRUE(in_range(input.head));
                    ASSERT_TRUE(in_range(input.hands[0].pose) && in_range(input.hands[1].pose));
                    ASSERT_TRUE(is_valid(unpack(input.head)));
                }
            }
        }
    }
    EXPECT_EQ(allocations, 0U);
    EXPECT_GT(seen[static_cast<std::size_t>(MatchRefusal::none)], 100U);
    EXPECT_GT(seen[static_cast<std::size_t>(MatchRefusal::malformed)], 1000U);
    EXPECT_GT(seen[static_cast<std::size_t>(MatchRefusal::gap)] +
                  seen[static_cast<std::size_t>(MatchRefusal::window)],
              1000U);
}

// Noise, replays, packets of others and floods cost the others nothing.
TEST(HostileMessages, AttackerMovesNobodyAndIsCounted) {
    const NetworkTraits traits{.delay_s = 0.04, .jitter_s = 0.02};
    MatchPlay calm(traits, 22);
    calm.play(3.0);
    MatchPlay attacked(traits, 22);
    attacked.records = true;
    test::Random random(seed_of(4));
    for (int i = 0; i < 270; ++i) {
        attacked.play(k_tick_s);
        Bytes noise(static_cast<std::size_t>(random.between(0.0, 1400.0)));
        for (std::byte& byte : noise) {
            byte = static_cast<std::byte>(static_cast<unsigned>(random.between(0.0, 256.0)) & 255U);
        }
        EXPECT_NE(attacked.server.receive(3, noise, attacked.now_s), MatchRefusal::none);
        EXPECT_NE(attacked.machines[0]->session.receive(noise), MatchRefusal::none);
        // Replays of old packets, and packets of person 0 sent by person 3.
        constexpr std::size_t k_delivered = 400;  // so many packets ago
        const std::size_t sent = attacked.recorded.size();
        const std::size_t old = sent > k_delivered ? sent - k_delivered : sent;
        for (std::size_t k = 0; k < 4 && old + k < attacked.recorded.size(); ++k) {
            const Bytes& packet = attacked.recorded[old + k];
            if (Recording::is_clients(packet)) {
                const unsigned slot = std::to_integer<unsigned>(packet[1]) & 15U;
                attacked.server.receive((slot + 1) % k_people, packet, attacked.now_s);
                attacked.server.receive(slot, packet, attacked.now_s);
            }
        }
    }
    const RefusalCounts& refused = attacked.server.counts().refused;
    EXPECT_GT(refused[static_cast<std::size_t>(MatchRefusal::checksum)], 100U);
    EXPECT_GT(refused[static_cast<std::size_t>(MatchRefusal::size)], 10U);
    EXPECT_GT(refused[static_cast<std::size_t>(MatchRefusal::sender)], 100U);
    EXPECT_GT(attacked.machines[0]->session.counts().refused[static_cast<std::size_t>(
                  MatchRefusal::checksum)],
              100U);
    const MatchTick last = std::min(calm.server.confirmed(), attacked.server.confirmed());
    EXPECT_GT(last, 260U);
    EXPECT_EQ(attacked.server_hash(last), calm.server_hash(last));
}

TEST(HostileMessages, DamagedJoinStatesChangeNothing) {
    MatchPlay match({.delay_s = 0.03, .jitter_s = 0.01}, 23);
    match.play(1.5);
    std::vector<std::byte> state;
    MatchScene other;
    const SnapshotAssets assets(other.shapes);
    match.server.write_state(0, assets, state);
    ClientSession session(other.match(), 0);
    const std::uint64_t before = hash_simulated(other.world);
    test::Random random(seed_of(5));
    for (int i = 0; i < 300; ++i) {
        Bytes damaged = state;
        const auto at =
            static_cast<std::size_t>(random.between(0.0, static_cast<double>(state.size() - 1)));
        if (i % 3 == 0) {
            damaged.resize(at);
        } else {
            damaged[at] ^= static_cast<std::byte>(1U << (i % 8));
        }
        ASSERT_TRUE(session.join(damaged, assets).has_value()) << i;
        ASSERT_EQ(hash_simulated(other.world), before);
    }
    EXPECT_EQ(session.counts().refused[static_cast<std::size_t>(MatchRefusal::state)], 300U);
    ASSERT_FALSE(session.join(state, assets).has_value());
    EXPECT_EQ(hash_simulated(other.world), match.server_hash(match.server.confirmed()));
}

}  // namespace
}  // namespace handhold::match_test
