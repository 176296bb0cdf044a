#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <random>
#include <span>
#include <utility>
#include <vector>

namespace handhold::lab {

// Of packets on their way, in one direction.
struct NetworkTraits {
    double delay_s = 0.05;
    double jitter_s = 0.02;  // uniform, on top of the delay: packets overtake each other
    double loss = 0.0;
    double duplication = 0.0;
    double burst_loss = 0.0;      // share of packets that begin a burst of k_burst lost ones
    double bytes_per_s = 0.0;     // rate of each sender to each receiver; 0: any
    double overhead_bytes = 0.0;  // headers of each packet; they count against bytes_per_s
};

// A seeded network in memory. Nothing depends on real time.
class SimulatedNetwork {
  public:
    static constexpr int k_burst = 8;
    // A rate-limited connection drops what it could not send within so long.
    static constexpr double k_longest_queue_s = 0.2;

    SimulatedNetwork(const NetworkTraits& traits, std::uint64_t seed)
        : traits_(traits), random_(seed) {}

    void send(std::size_t from, std::size_t to, std::span<const std::byte> bytes, double now_s) {
        ++sent_;
        if (in_burst_ == 0 && draw(1.0) < traits_.burst_loss) {
            in_burst_ = k_burst;
        }
        if (in_burst_ > 0) {
            --in_burst_;
            ++lost_;
            return;
        }
        if (draw(1.0) < traits_.loss) {
            ++lost_;
            return;
        }
        const double sent_s = leaves_at(from, to, bytes.size(), now_s);
        if (sent_s > now_s + k_longest_queue_s) {
            ++lost_;
            return;
        }
        const bool is_doubled = draw(1.0) < traits_.duplication;
        doubled_ += is_doubled ? 1 : 0;
        for (int copy = 0; copy < (is_doubled ? 2 : 1); ++copy) {
            const double arrives_s = sent_s + traits_.delay_s + draw(traits_.jitter_s);
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
            take(packet.from, packet.to, std::span<const std::byte>(packet.bytes));
        }
    }
    void set_traits(const NetworkTraits& traits) { traits_ = traits; }

    int sent() const { return sent_; }
    int lost() const { return lost_; }
    int doubled() const { return doubled_; }
    int overtaken() const { return overtaken_; }

  private:
    struct Packet {
        double arrives_s = 0.0;
        std::size_t from = 0;
        std::size_t to = 0;
        std::vector<std::byte> bytes;
        int number = 0;
    };
    struct Queue {
        std::size_t from = 0;
        std::size_t to = 0;
        double free_s = 0.0;  // when everything before is sent
    };

    // Uniform in [0, most); the standard distributions differ between libraries.
    double draw(double most) { return most * static_cast<double>(random_() >> 11) * 0x1p-53; }
    double leaves_at(std::size_t from, std::size_t to, std::size_t bytes, double now_s) {
        if (traits_.bytes_per_s <= 0.0) {
            return now_s;
        }
        auto queue = std::ranges::find_if(
            queues_, [&](const Queue& one) { return one.from == from && one.to == to; });
        if (queue == queues_.end()) {
            queue = queues_.insert(queue, {from, to, now_s});
        }
        const double size = static_cast<double>(bytes) + traits_.overhead_bytes;
        const double sent_s = std::max(queue->free_s, now_s) + size / traits_.bytes_per_s;
        if (sent_s <= now_s + k_longest_queue_s) {
            queue->free_s = sent_s;
        }
        return sent_s;
    }

    NetworkTraits traits_;
    std::mt19937_64 random_;
    std::vector<Packet> waiting_;
    std::vector<Queue> queues_;
    int in_burst_ = 0;
    int sent_ = 0;
    int lost_ = 0;
    int doubled_ = 0;
    int overtaken_ = 0;
};

}  // namespace handhold::lab
