#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>

#include "game/net/transport.hpp"

namespace handhold {

// Excess is forgotten after so long without any.
inline constexpr double k_calm_s = 5.0;
// Pauses of reading before a connection is cut off as flooding. A peer whose network was away for
// five seconds delivers at once what it kept meanwhile: by estimate 15 pauses.
inline constexpr int k_most_throttles = 40;

// How much more a connection may send now.
class ReceiveBudget {
  public:
    explicit ReceiveBudget(const LinkBudget& budget)
        : budget_(budget),
          messages_(budget.messages_per_s * budget.burst_s),
          bytes_(budget.bytes_per_s * budget.burst_s) {}

    // Counts what came. False: nothing more should be read until may_read.
    bool take(std::size_t messages, std::uint64_t bytes, double now_s) {
        refill(now_s);
        messages_ -= static_cast<double>(messages);
        bytes_ -= static_cast<double>(bytes);
        return messages_ > 0.0 && bytes_ > 0.0;
    }
    // True once a quarter of the burst is there again.
    bool may_read(double now_s) {
        refill(now_s);
        const double enough = 0.25 * budget_.burst_s;
        return messages_ >= enough * budget_.messages_per_s &&
               bytes_ >= enough * budget_.bytes_per_s;
    }

  private:
    void refill(double now_s) {
        const double elapsed_s = std::max(0.0, now_s - last_s_);
        last_s_ = now_s;
        messages_ = std::min(messages_ + elapsed_s * budget_.messages_per_s,
                             budget_.burst_s * budget_.messages_per_s);
        bytes_ = std::min(bytes_ + elapsed_s * budget_.bytes_per_s,
                          budget_.burst_s * budget_.bytes_per_s);
    }

    LinkBudget budget_;
    double messages_;
    double bytes_;
    double last_s_ = 0.0;
};

// Datagrams in a peer's name that are not the peer's, or copies.
struct ForgedGate {
    ReceiveBudget budget;
    bool is_open = true;  // false: over its budget

    bool may_read(double now_s) {
        is_open = is_open || budget.may_read(now_s);
        return is_open;
    }
    void take(std::size_t bytes, double now_s) { is_open = budget.take(0, bytes, now_s); }
};

}  // namespace handhold
