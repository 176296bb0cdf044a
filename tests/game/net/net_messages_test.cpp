// Messages between servers and peers: whatever bytes arrive.
#include "game/net/net_messages.hpp"

#include <array>
#include <functional>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

namespace handhold::net_messages_test {
namespace {

using Bytes = std::vector<std::byte>;

MatchDigests digests_from(std::uint64_t first) {
    MatchDigests digests{};
    for (std::uint64_t& digest : digests) {
        digest = first;
        first = 31 * first + 7;
    }
    return digests;
}

// One message of each kind, from a number.
std::vector<Bytes> messages_from(std::uint64_t number) {
    const std::string text(number % 40, 'a');
    const Bytes payload(1 + number % 100, static_cast<std::byte>(number));
    std::vector<Bytes> all(7);
    write_message(MatchOffer{.players = static_cast<std::uint8_t>(1 + number % 16),
                             .seed = number,
                             .wants_token = number % 2 == 1,
                             .digests = digests_from(number),
                             .scene = text},
                  all[0]);
    write_message(MatchHello{.person = number, .digests = digests_from(number), .token = text},
                  all[1]);
    write_message(
        MatchRefused{static_cast<NetRefusal>(1 + number % 9), static_cast<std::uint16_t>(number)},
        all[2]);
    write_message(MatchWelcome{static_cast<std::uint8_t>(number)}, all[3]);
    write_message(StatePiece{.number = static_cast<std::uint8_t>(number),
                             .total = static_cast<std::uint32_t>(payload.size() + number % 1000),
                             .offset = static_cast<std::uint32_t>(number % 1000),
                             .bytes = payload},
                  all[4]);
    write_message(static_cast<NetBye>(1 + number % 5), all[5]);
    write_joined(static_cast<std::uint8_t>(number), all[6]);
    return all;
}

// Reads a message as every kind, and writes again what was read. Returns how many kinds it was.
template <typename Message>
void read_again(const std::optional<Message>& read, std::span<const std::byte> message,
                int& kinds) {
    if (!read) {
        return;
    }
    ++kinds;
    Bytes again;
    write_message(*read, again);
    if constexpr (requires { read->version; }) {
        if (read->version != k_net_version) {
            return;  // the rest is not known
        }
    }
    EXPECT_EQ(again, Bytes(message.begin(), message.end()));
}
int kinds_of(std::span<const std::byte> message) {
    int kinds = 0;
    read_again(read_offer(message), message, kinds);
    read_again(read_hello(message), message, kinds);
    read_again(read_refused(message), message, kinds);
    read_again(read_welcome(message), message, kinds);
    read_again(read_state_piece(message), message, kinds);
    read_again(read_bye(message), message, kinds);
    kinds += read_joined(message) ? 1 : 0;
    return kinds;
}

RC_GTEST_PROP(NetMessages, EachIsReadAsWhatItIsAndAsNothingElse, (std::uint64_t number)) {
    for (const Bytes& message : messages_from(number)) {
        RC_ASSERT(kinds_of(message) == 1);
        RC_ASSERT(kind_of(message).has_value());
    }
}

// The version of an offer or a hello is read first; of other versions nothing else is.
RC_GTEST_PROP(NetMessages, TruncatedAndLongerOnesAreRefused, (std::uint64_t number)) {
    for (const Bytes& message : messages_from(number)) {
        const bool is_piece = kind_of(message) == NetKind::state;
        for (std::size_t size = 0; size < message.size(); ++size) {
            const bool is_shorter_piece = is_piece && size > 10;
            RC_ASSERT(kinds_of(std::span(message).first(size)) == (is_shorter_piece ? 1 : 0));
        }
        Bytes longer = message;
        longer.resize(message.size() + 1 + StatePiece::k_most_bytes);
        RC_ASSERT(kinds_of(longer) == 0);
    }
}

RC_GTEST_PROP(NetMessages, ChangedOnesAreReadAsTheyAreOrRefused,
              (std::uint64_t number, std::vector<std::pair<std::uint16_t, std::uint8_t>> changes)) {
    for (Bytes message : messages_from(number)) {
        for (const auto& [at, value] : changes) {
            message[at % message.size()] ^= static_cast<std::byte>(value);
        }
        RC_ASSERT(kinds_of(message) <= 1);
    }
}

RC_GTEST_PROP(NetMessages, RandomBytesAreReadAsTheyAreOrRefused,
              (const std::vector<std::uint8_t>& bytes)) {
    Bytes message;
    for (const std::uint8_t byte : bytes) {
        message.push_back(static_cast<std::byte>(byte));
    }
    RC_ASSERT(kinds_of(message) <= 1);
    for (const unsigned kind : {1U, 2U, 3U, 4U, 6U, 16U, 17U}) {
        message.insert(message.begin(), static_cast<std::byte>(kind));
        RC_ASSERT(kinds_of(message) <= 1);
    }
}

TEST(NetMessages, TheFirstDifferingDigestIsNamed) {
    const MatchDigests own = digests_from(5);
    MatchDigests other = own;
    EXPECT_EQ(first_difference(own, other), std::nullopt);
    other[5] += 1;
    other[3] += 1;
    const auto found = first_difference(own, other);
    ASSERT_TRUE(found.has_value());
    EXPECT_EQ(refusal_text({NetRefusal::level, static_cast<std::uint16_t>(*found)}),
              "other level: \"tuning\" differs");
}

}  // namespace
}  // namespace handhold::net_messages_test
