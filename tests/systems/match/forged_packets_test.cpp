// Players whose machines lie: packets of the right format and checksum with whatever in them.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "tests/random.hpp"
#include "tests/systems/match/match_play.hpp"

namespace handhold::match_test {
namespace {

struct SentPacket {
    std::array<std::byte, k_most_packet_bytes> bytes{};
    std::size_t size = 0;

    std::span<const std::byte> view() const { return std::span(bytes).first(size); }
};

// A modified client sends all inputs that the server takes, as fast as it takes them. Then another
// player connects and stays silent. The match keeps to the clock.
TEST(ForgedPackets, NobodyDrivesTheMatchFasterThanTheClock) {
    MatchScene scene;
    const auto server = std::make_unique<ServerSession>(scene.match(), 0.0);
    server->connect(0);
    const auto sent = std::make_unique<InputHistory>();
    sent->reset(0);
    MatchTick accepted = 0;
    double now_s = 0.0;
    const auto play = [&](double until_s, auto&& expect) {
        while (now_s < until_s) {
            now_s += 0.01;
            while (sent->final_until() < server->confirmed() + ServerSession::k_most_lead) {
                sent->finish_next(k_away_input, InputKind::real);
            }
            for (int i = 0; i < 3; ++i) {
                ClientPacket header;
                for (std::size_t slot = 0; slot < k_people; ++slot) {
                    header.known_until[slot] = server->inputs_of(slot).final_until();
                }
                StreamSource own{
                    .history = sent.get(), .base = accepted, .until = sent->final_until()};
                SentPacket packet;
                packet.size = write_client_packet(header, k_people, own, packet.bytes);
                ASSERT_EQ(server->receive(0, packet.view(), now_s), MatchRefusal::none);
                accepted = own.until;
                server->advance(now_s);
            }
            expect();
        }
    };
    const auto clock = [&] { return now_s / k_tick_s; };
    play(2.0, [&] { EXPECT_LE(static_cast<double>(server->confirmed()), clock() + 10.0); });
    EXPECT_GT(static_cast<double>(server->confirmed()), clock() + 5.0);  // it did try
    server->connect(1);
    play(4.0, [&] { EXPECT_GE(static_cast<double>(server->confirmed()), clock() - 2.0); });
    EXPECT_GT(server->counts().filled, 150U);
}

MatchInput wild_input(test::Random& random) {
    MatchInput input;
    const auto pose = [&] {
        PackedPose made;
        for (std::int32_t& axis : made.position) {
            axis = static_cast<std::int32_t>(random.between(-1.0, 1.0) * PackedPose::k_most_units);
        }
        return made;
    };
    input.is_head_tracked = random.between(0.0, 1.0) < 0.8;
    input.head = input.is_head_tracked ? pose() : PackedPose{};
    for (MatchHand& hand : input.hands) {
        hand.is_tracked = true;
        hand.pose = pose();
        hand.grab = random.between(0.0, 1.0) < 0.5;
    }
    input.thrust = {127, -127, 127};
    input.calibrate = random.between(0.0, 1.0) < 0.1;
    return normalised(input);
}

// One of four players sends forged packets beside its own: any ticks, any inputs up to kilometres
// away, wrong hashes, requests for states. The others play on as if nothing were, and the server
// writes that player a state a second at most.
TEST(ForgedPackets, ALiarCostsTheOthersNothing) {
    constexpr std::size_t k_liar = 3;
    MatchPlay match({.delay_s = 0.04, .jitter_s = 0.02}, 31);
    match.play(1.5);
    std::array<std::uint64_t, k_people> ticks{};
    for (std::size_t person = 0; person < k_people; ++person) {
        ticks[person] = match.machines[person]->session.counts().ticks;
    }
    match.machines[k_liar]->is_compared = false;
    test::Random random(seed_of(32));
    const auto forged = std::make_unique<InputHistory>();
    int taken = 0;
    int states = 0;
    std::vector<std::byte> state;
    MatchScene other;
    for (int i = 0; i < 450; ++i) {
        match.play(k_tick_s);
        const MatchTick confirmed = match.server.confirmed();
        const auto near = [&](double low, double high) {
            return static_cast<MatchTick>(
                std::max(0.0, static_cast<double>(confirmed) + random.between(low, high)));
        };
        for (int k = 0; k < 4; ++k) {
            ClientPacket header;
            header.slot = k_liar;
            header.state_epoch = static_cast<std::uint8_t>(states % 4);
            header.is_fresh = random.between(0.0, 1.0) < 0.5;
            header.wants_state = random.between(0.0, 1.0) < 0.5;
            header.hash_tick = confirmed / k_hash_every_ticks * k_hash_every_ticks;
            header.hash = static_cast<std::uint64_t>(k);
            header.lead_epoch = static_cast<std::uint8_t>(random.between(0.0, 256.0));
            for (MatchTick& known : header.known_until) {
                known = near(-400.0, 30.0);
            }
            const MatchTick base = near(-100.0, 160.0);
            forged->reset(base);
            for (int n = 0; n < 1 + 16 * k; ++n) {
                forged->finish_next(wild_input(random), InputKind::real);
            }
            StreamSource own{.history = forged.get(), .base = base, .until = forged->final_until()};
            own.is_fresh = header.is_fresh;
            SentPacket packet;
            packet.size = write_client_packet(header, k_people, own, packet.bytes);
            taken += match.server.receive(k_liar, packet.view(), match.now_s) == MatchRefusal::none
                         ? 1
                         : 0;
        }
        if (match.server.needs_state(k_liar)) {
            match.server.write_state(k_liar, SnapshotAssets(other.shapes), state);
            ++states;
        }
    }
    EXPECT_GT(taken, 300);
    EXPECT_GE(states, 3);
    EXPECT_LE(states, 7);  // in five seconds
    EXPECT_GE(match.server.confirmed(), 580U);
    for (std::size_t person = 0; person < k_people; ++person) {
        if (person != k_liar) {
            const ClientSession& session = match.machines[person]->session;
            EXPECT_NEAR(static_cast<double>(session.counts().ticks - ticks[person]), 450.0, 10.0);
            EXPECT_EQ(session.counts().waits, 0U);
            EXPECT_FALSE(session.needs_state());
        }
    }
    EXPECT_GT(match.counts.compared, 1500U);
}

// A receiver who is far behind catches up over any round trip, though each packet has room for a
// few ticks only; with losses nearly always.
TEST(SendMarksCatchUp, InThreeSecondsWhateverTheRoundTrip) {
    int lost = 0;
    int still_behind = 0;
    for (std::uint64_t seed = 0; seed < 400; ++seed) {
        test::Random random(seed_of(seed));
        const auto one_way = static_cast<int>(random.between(1.0, 12.0));  // ticks
        const auto room = static_cast<MatchTick>(random.between(5.0, 20.0));
        const double loss = random.between(0.0, 1.0) < 0.5 ? 0.0 : 0.05;
        struct Sent {
            int at;
            MatchTick base;
            MatchTick until;
        };
        std::vector<Sent> packets;
        std::vector<std::pair<int, MatchTick>> acknowledgements;
        SendMarks marks;
        constexpr MatchTick k_start = 1000;
        marks.reset(k_start);
        MatchTick known = k_start;
        MatchTick acknowledged = k_start;
        MatchTick until = k_start + 90;
        std::uint64_t packet = 0;
        for (int tick = 0; tick < 270; ++tick, ++until) {
            for (const auto& [at, value] : acknowledgements) {
                acknowledged = at <= tick ? std::max(acknowledged, value) : acknowledged;
            }
            const MatchTick base = marks.base(packet, acknowledged, until);
            const MatchTick end = std::min(until, base + room);
            marks.note(packet++, end);
            if (random.between(0.0, 1.0) < loss) {
                ++lost;
            } else {
                packets.push_back({tick + one_way, base, end});
            }
            for (const Sent& sent : packets) {
                if (sent.at == tick && sent.base <= known) {
                    known = std::max(known, sent.until);
                }
            }
            acknowledgements.emplace_back(tick + one_way, known);
        }
        const bool is_behind = known + static_cast<MatchTick>(one_way) + 64 < until;
        still_behind += is_behind ? 1 : 0;
        EXPECT_FALSE(is_behind && loss == 0.0) << "one way " << one_way << ", room " << room;
    }
    EXPECT_LE(still_behind, 10);  // of 200 with losses
    EXPECT_GT(lost, 1000);
}

}  // namespace
}  // namespace handhold::match_test
