#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <span>
#include <vector>

// Messages in a stream of bytes: each has its size in two bytes, little-endian, before it.
namespace handhold {

// Messages that are sent, and kept until the other side has acknowledged them.
class StreamWriter {
  public:
    static constexpr std::size_t k_most_unsent = std::size_t{54} << 10U;
    static constexpr std::size_t k_most_in_flight = std::size_t{256} << 10U;

    // False: the message does not fit. The receiver has not read for long. Precondition: at most
    // 65535 bytes.
    bool push(std::span<const std::byte> message) {
        if (unsent_bytes() + message.size() + 2 > k_most_unsent) {
            return false;
        }
        std::vector<std::uint8_t> chunk(2 + message.size());
        chunk[0] = static_cast<std::uint8_t>(message.size() & 0xffU);
        chunk[1] = static_cast<std::uint8_t>(message.size() >> 8U);
        std::ranges::transform(message, chunk.begin() + 2,
                               [](std::byte byte) { return std::to_integer<std::uint8_t>(byte); });
        end_ += chunk.size();
        chunks_.push_back(std::move(chunk));
        return true;
    }
    // The bytes to send next; their address stays the same until they are acknowledged. Empty:
    // nothing is, or too much is in flight.
    std::span<const std::uint8_t> next() const {
        if (unsent_bytes() == 0 || sent_ - begin_ >= k_most_in_flight) {
            return {};
        }
        return std::span<const std::uint8_t>(chunks_[chunk_]).subspan(at_);
    }
    // Precondition: at most the size of next().
    void mark_sent(std::size_t bytes) {
        sent_ += bytes;
        at_ += bytes;
        if (bytes > 0 && at_ == chunks_[chunk_].size()) {
            ++chunk_;
            at_ = 0;
        }
    }
    // The other side has everything before `offset`.
    void acknowledge(std::uint64_t offset) {
        while (chunk_ > 0 && begin_ + chunks_.front().size() <= offset) {
            begin_ += chunks_.front().size();
            chunks_.pop_front();
            --chunk_;
        }
        acknowledged_ = std::max(acknowledged_, offset);
    }
    std::size_t unsent_bytes() const { return static_cast<std::size_t>(end_ - sent_); }
    bool is_all_acknowledged() const { return acknowledged_ >= end_; }
    std::uint64_t acknowledged() const { return acknowledged_; }

  private:
    std::deque<std::vector<std::uint8_t>> chunks_;
    std::size_t chunk_ = 0;    // index of the chunk that is sent next
    std::size_t at_ = 0;       // bytes of it that are sent
    std::uint64_t begin_ = 0;  // offset of the first chunk
    std::uint64_t sent_ = 0;   // offset of the first unsent byte
    std::uint64_t end_ = 0;    // offset after the last chunk
    std::uint64_t acknowledged_ = 0;
};

// Finds the messages in a stream.
class StreamReader {
  public:
    // Calls `take` with each complete message. False: one is longer than `most`, or empty.
    template <typename Take>
    bool read(std::span<const std::uint8_t> bytes, std::size_t most, Take&& take) {
        while (!bytes.empty()) {
            const std::size_t wanted = message_.size() < 2 ? 2 : 2 + size();
            const std::size_t part = std::min(wanted - message_.size(), bytes.size());
            message_.insert(message_.end(), bytes.begin(),
                            bytes.begin() + static_cast<std::ptrdiff_t>(part));
            bytes = bytes.subspan(part);
            if (message_.size() >= 2 && (size() == 0 || size() > most)) {
                return false;
            }
            if (message_.size() > 2 && message_.size() == 2 + size()) {
                take(std::span<const std::uint8_t>(message_).subspan(2));
                message_.clear();
            }
        }
        return true;
    }

  private:
    std::size_t size() const { return message_[0] + (std::size_t{message_[1]} << 8U); }

    std::vector<std::uint8_t> message_;  // incomplete message with its size
};

}  // namespace handhold
