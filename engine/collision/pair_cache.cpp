#include "engine/collision/pair_cache.hpp"

#include <tuple>

namespace handhold {

void PairCache::Pass::clear() {
    pairs.clear();
    contacts.clear();
}

void PairCache::begin(const ContactLimits& limits) {
    std::swap(now_, last_);
    now_.clear();
    next_pair_ = 0;
    if (limits.margin_m != limits_.margin_m || limits.sweep_m != limits_.sweep_m) {
        last_.clear();
        limits_ = limits;
    }
}

std::optional<PairCache::Known> PairCache::recall(const Seen& a, const Seen& b,
                                                  const Bounds& reach_ws) {
    const auto ids_of = [](const Pair& pair) { return std::tie(pair.a.id, pair.b.id); };
    const auto wanted = std::tie(a.id, b.id);
    while (next_pair_ < last_.pairs.size() && ids_of(last_.pairs[next_pair_]) < wanted) {
        ++next_pair_;
    }
    if (next_pair_ == last_.pairs.size()) {
        return std::nullopt;
    }
    const Pair& pair = last_.pairs[next_pair_];
    if (ids_of(pair) != wanted || pair.b.stamp != b.stamp) {
        return std::nullopt;
    }
    if (pair.a.stamp == a.stamp) {
        return Known{std::span(last_.contacts).subspan(pair.first, pair.count), pair.clear_ws};
    }
    if (pair.clear_ws && holds(*pair.clear_ws, reach_ws)) {
        return Known{{}, pair.clear_ws};
    }
    return std::nullopt;
}

void PairCache::note(const Seen& a, const Seen& b, const Known& known) {
    now_.pairs.push_back({a, b, static_cast<std::uint32_t>(now_.contacts.size()),
                          static_cast<std::uint32_t>(known.contacts.size()), known.clear_ws});
    now_.contacts.insert(now_.contacts.end(), known.contacts.begin(), known.contacts.end());
}

}  // namespace handhold
