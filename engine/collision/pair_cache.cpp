#include "engine/collision/pair_cache.hpp"

#include <tuple>

namespace handhold {

void PairCache::Pass::clear() {
    pairs.clear();
    contacts.clear();
}

void PairCache::begin(const ContactLimits& limits) {
    std::swap(current_, last_);
    current_.clear();
    next_pair_ = 0;
    if (limits.margin_m != limits_.margin_m || limits.sweep_m != limits_.sweep_m) {
        last_.clear();
        limits_ = limits;
    }
}

std::optional<PairCache::Result> PairCache::recall(const Version& a, const Version& b,
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
        return Result{std::span(last_.contacts).subspan(pair.first, pair.count), pair.clear_ws};
    }
    if (pair.clear_ws && contains(*pair.clear_ws, reach_ws)) {
        return Result{{}, pair.clear_ws};
    }
    return std::nullopt;
}

void PairCache::record(const Version& a, const Version& b, const Result& result) {
    current_.pairs.push_back({a, b, static_cast<std::uint32_t>(current_.contacts.size()),
                              static_cast<std::uint32_t>(result.contacts.size()), result.clear_ws});
    current_.contacts.insert(current_.contacts.end(), result.contacts.begin(),
                             result.contacts.end());
}

}  // namespace handhold
