#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace handhold {

// Steers how far a client runs ahead of the server, from what the server says about how long its
// inputs waited before their deadlines. Clocks of machines are never compared.
class TickPacer {
  public:
    // By how much inputs should come before their deadlines, at least.
    static constexpr double k_target_s = 0.016;
    // Advances that one call of ticks_due returns at most.
    static constexpr int k_most_ticks = 8;

    // What the server says: the least wait of late, and the epoch that this client had then.
    // Reports of other epochs are older than the last correction, and ignored.
    void hear(double wait_s, std::uint8_t epoch, double dt_s) {
        constexpr double k_late_s = 0.004;  // a smaller lack is made up by the rate
        if (epoch != epoch_) {
            return;
        }
        const double missing_s = k_target_s - wait_s;
        rate_ = 1.0 + std::clamp(missing_s, -0.02, 0.02);
        if (missing_s > k_late_s) {
            debt_ticks_ += std::min(missing_s / dt_s, k_most_jump);
            begin_epoch();
        }
    }
    // The world is so many ticks behind what is confirmed.
    void hear_behind(double ticks) {
        debt_ticks_ = std::min(ticks, k_most_jump);  // whatever was owed is part of it
        begin_epoch();
    }
    // Counts corrections, modulo 256. The server keeps the waits of each epoch apart. A client that
    // is behind begins one with every packet, so fewer numbers would meet again within a round
    // trip.
    std::uint8_t epoch() const { return epoch_; }
    // The number of ticks for so much time of the local clock.
    int ticks_due(double elapsed_s, double dt_s) {
        debt_ticks_ += std::clamp(elapsed_s, 0.0, 1.0) * rate_ / dt_s;
        const double whole = std::floor(debt_ticks_);
        debt_ticks_ -= whole;
        const double now = std::min(whole, static_cast<double>(k_most_ticks));
        // The rest follows in the next calls; after a long freeze most of it is dropped.
        debt_ticks_ += std::min(whole - now, k_most_jump);
        return static_cast<int>(now);
    }
    // The part of a tick, [0, 1], by which the local clock is past the ticks that were due.
    double past_ticks() const { return std::min(debt_ticks_, 1.0); }

  private:
    static constexpr double k_most_jump = 48.0;  // ticks

    void begin_epoch() {
        epoch_ = static_cast<std::uint8_t>((epoch_ + 1U) % 256U);
        rate_ = 1.0;
    }

    double rate_ = 1.0;
    double debt_ticks_ = 0.0;
    std::uint8_t epoch_ = 0;
};

}  // namespace handhold
