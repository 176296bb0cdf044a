#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <span>
#include <utility>
#include <vector>

#include "tests/random.hpp"

namespace handhold::match_test {

// The seed of a test's networks and players. HANDHOLD_MATCH_SEED=N in the environment varies all of
// them, to run the tests over other networks.
inline std::uint64_t seed_of(std::uint64_t test) {
    const char* const text = std::getenv("HANDHOLD_MATCH_SEED");
    const std::uint64_t varied = text != nullptr ? std::strtoull(text, nullptr, 10) : 0;
    return test + 1000 * varied;
}

// Of packets on their way, in one direction.
struct NetworkTraits {
    double delay_s = 0.05;
    double jitter_s = 0.02;  // uniform, on top of the delay: packets overtake each other
    double loss = 0.0;
    double duplication = 0.0;
    double burst_loss = 0.0;  // share of packets that begin a burst of k_burst lost ones
};

// A seeded network in memory. Nothing depends on real time.
class SimulatedNetwork {
  public:
    SimulatedNetwork(const NetworkTraits& traits, std::uint64_t seed)
        : traits_(traits), random_(seed) {}

    void send(std::size_t from, std::size_t to, std::span<const std::byte> bytes, double now_s) {
        ++sent_;
        if (in_burst_ == 0 && random_.between(0.0, 1.0) < traits_.burst_loss) {
            in_burst_ = k_burst;
        }
        if (in_burst_ > 0) {
            --in_burst_;
            ++lost_;
            return;
        }
        if (random_.between(0.0, 1.0) < traits_.loss) {
            ++lost_;
            return;
        }
        const bool is_doubled = random_.between(0.0, 1.0) < traits_.duplication;
        doubled_ += is_doubled ? 1 : 0;
        for (int copy = 0; copy < (is_doubled ? 2 : 1); ++copy) {
            const double arrives_s =
                now_s + traits_.delay_s + random_.between(0.0, traits_.jitter_s);
            waiting_.push_back({arrives_s, from, to, {bytes.begin(), bytes.end()}, sent_});
        }
    }
    // Calls take(from, to, bytes) for all packets that are due, in the order of their arrival.
    template <typename Take>
    void deliver(double now_s, const Take& take) {
        for (;;) {
            std::size_t first = waiting_.size();
            for (std::size_t i = 0; i < waiting_.size(); ++i) {
                if (waiting_[i].arrives_s <= now_s &&
                    (first == waiting_.size() ||
                     waiting_[i].arrives_s < waiting_[first].arrives_s)) {
                    first = i;
                }
            }
            if (first == waiting_.size()) {
                return;
            }
            for (const Packet& other : waiting_) {
                overtaken_ += other.number < waiting_[first].number &&
                                      other.from == waiting_[first].from &&
                                      other.to == waiting_[first].to
                                  ? 1
                                  : 0;
            }
            const Packet packet = std::move(waiting_[first]);
            waiting_.erase(waiting_.begin() + static_cast<std::ptrdiff_t>(first));
            take(packet.from, packet.to, packet.bytes);
        }
    }
    void set_traits(const NetworkTraits& traits) { traits_ = traits; }

    int sent() const { return sent_; }
    int lost() const { return lost_; }
    int doubled() const { return doubled_; }
    int overtaken() const { return overtaken_; }

  private:
    static constexpr int k_burst = 8;

    struct Packet {
        double arrives_s = 0.0;
        std::size_t from = 0;
        std::size_t to = 0;
        std::vector<std::byte> bytes;
        int number = 0;
    };
    NetworkTraits traits_;
    test::Random random_;
    std::vector<Packet> waiting_;
    int in_burst_ = 0;
    int sent_ = 0;
    int lost_ = 0;
    int doubled_ = 0;
    int overtaken_ = 0;
};

}  // namespace handhold::match_test
