#include "game/net/quic_stream.hpp"

#include <algorithm>

#include <gtest/gtest.h>

namespace handhold::quic_stream_test {
namespace {

std::vector<std::byte> message_of(std::size_t size) {
    std::vector<std::byte> out(size);
    for (std::size_t i = 0; i < size; ++i) {
        out[i] = static_cast<std::byte>(i * 7 + size);
    }
    return out;
}

TEST(QuicStream, MessagesArriveWholeHoweverTheStreamIsCut) {
    const std::vector<std::size_t> sizes = {1, 2, 255, 256, 257, 1000, 8202};
    for (const std::size_t cut : {1U, 2U, 3U, 17U, 1150U, 65536U}) {
        StreamWriter writer;
        StreamReader reader;
        for (const std::size_t size : sizes) {
            ASSERT_TRUE(writer.push(message_of(size)));
        }
        std::vector<std::size_t> got;
        std::uint64_t offset = 0;
        while (!writer.next().empty()) {
            const auto next = writer.next();
            const auto part = next.first(std::min<std::size_t>(cut, next.size()));
            ASSERT_TRUE(reader.read(part, 10'000, [&](std::span<const std::uint8_t> message) {
                got.push_back(message.size());
                const std::vector<std::byte> sent = message_of(message.size());
                EXPECT_TRUE(std::ranges::equal(
                    message, sent, [](std::uint8_t a, std::byte b) { return std::byte{a} == b; }));
            }));
            offset += part.size();
            writer.mark_sent(part.size());
            EXPECT_FALSE(writer.is_all_acknowledged());
            writer.acknowledge(offset);
        }
        EXPECT_EQ(got, sizes);
        EXPECT_TRUE(writer.is_all_acknowledged());
    }
}

TEST(QuicStream, WhatIsUnsentAndWhatIsInFlightAreBounded) {
    StreamWriter writer;
    const std::vector<std::byte> message = message_of(8000);
    std::size_t sent = 0;
    for (int i = 0; i < 1000; ++i) {
        (void)writer.push(message);
        EXPECT_LE(writer.unsent_bytes(), StreamWriter::k_most_unsent);
        const std::size_t size = writer.next().size();
        writer.mark_sent(size);
        sent += size;
    }
    EXPECT_GE(sent, StreamWriter::k_most_in_flight);
    EXPECT_LE(sent, StreamWriter::k_most_in_flight + message.size() + 2);
    EXPECT_TRUE(writer.next().empty());
    EXPECT_FALSE(writer.push(message_of(60'000)));
    writer.acknowledge(sent);
    EXPECT_FALSE(writer.next().empty());
}

TEST(QuicStream, SizesThatNoMessageHasAreRefused) {
    const auto ignore = [](std::span<const std::uint8_t>) {};
    EXPECT_FALSE(StreamReader().read(std::vector<std::uint8_t>{0, 0}, 100, ignore));
    EXPECT_FALSE(StreamReader().read(std::vector<std::uint8_t>{101, 0, 1}, 100, ignore));
    EXPECT_FALSE(StreamReader().read(std::vector<std::uint8_t>{0xff, 0xff}, 100, ignore));
    EXPECT_TRUE(StreamReader().read(std::vector<std::uint8_t>{100, 0, 1}, 100, ignore));
}

}  // namespace
}  // namespace handhold::quic_stream_test
