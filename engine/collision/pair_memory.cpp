#include "engine/collision/pair_memory.hpp"

#include <algorithm>
#include <tuple>

namespace handhold {
void PairMemory::Pass::clear() {
    colliders.clear();
    pairs.clear();
    contacts.clear();
}

void PairMemory::begin(const ContactLimits& limits) {
    std::swap(now_, last_);
    now_.clear();
    next_collider_ = 0;
    next_pair_ = 0;
    if (limits.margin_m != limits_.margin_m || limits.sweep_m != limits_.sweep_m) {
        last_.clear();
        limits_ = limits;
    }
}

void PairMemory::add(const ColliderProxy& proxy) {
    const std::vector<Seen>& before = last_.colliders;
    while (next_collider_ < before.size() && before[next_collider_].proxy.id < proxy.id) {
        ++next_collider_;
    }
    const bool same =
        next_collider_ < before.size() && same_proxy(before[next_collider_].proxy, proxy);
    now_.colliders.push_back({proxy, same ? before[next_collider_].stamp : ++changes_});
}

std::optional<std::span<const ContactPoint>> PairMemory::recall(std::size_t a, std::size_t b) {
    const Seen& seen_a = now_.colliders[a];
    const Seen& seen_b = now_.colliders[b];
    const auto wanted = std::tie(seen_a.proxy.id, seen_b.proxy.id);
    while (next_pair_ < last_.pairs.size() &&
           std::tie(last_.pairs[next_pair_].id_a, last_.pairs[next_pair_].id_b) < wanted) {
        ++next_pair_;
    }
    if (next_pair_ == last_.pairs.size()) {
        return std::nullopt;
    }
    const Pair& pair = last_.pairs[next_pair_];
    if (std::tie(pair.id_a, pair.id_b) != wanted || pair.stamp_a != seen_a.stamp ||
        pair.stamp_b != seen_b.stamp) {
        return std::nullopt;
    }
    return std::span(last_.contacts).subspan(pair.first, pair.count);
}

void PairMemory::note(std::size_t a, std::size_t b, std::span<const ContactPoint> found) {
    const Seen& seen_a = now_.colliders[a];
    const Seen& seen_b = now_.colliders[b];
    now_.pairs.push_back({seen_a.proxy.id, seen_b.proxy.id, seen_a.stamp, seen_b.stamp,
                          static_cast<std::uint32_t>(now_.contacts.size()),
                          static_cast<std::uint32_t>(found.size())});
    now_.contacts.insert(now_.contacts.end(), found.begin(), found.end());
}

}  // namespace handhold
