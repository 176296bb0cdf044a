#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <span>
#include <vector>

#include "game/net/transport.hpp"

namespace handhold {

// Messages that wait for a connection to take them. Bounded, whatever the other side does.
class SendQueue {
  public:
    static constexpr std::size_t k_most_bytes = std::size_t{64} << 10U;
    static constexpr std::size_t k_most_newest = 8;

    // False: a reliable message does not fit. The receiver has not read for long.
    bool push(Delivery delivery, std::span<const std::byte> message);

    bool is_empty() const { return entries_.empty(); }
    // The oldest message. Precondition: !is_empty().
    std::span<const std::byte> front() const { return entries_.front().bytes; }
    void pop();
    std::size_t bytes() const { return bytes_; }
    // Messages that were dropped.
    std::uint64_t dropped() const { return dropped_; }

  private:
    struct Entry {
        Delivery delivery = Delivery::reliable;
        std::vector<std::byte> bytes;
    };
    void drop_oldest_newest();

    std::deque<Entry> entries_;
    std::size_t bytes_ = 0;
    std::size_t newest_ = 0;  // entries of Delivery::newest
    std::uint64_t dropped_ = 0;
};

}  // namespace handhold
