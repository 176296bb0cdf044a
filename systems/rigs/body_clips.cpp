#include "systems/rigs/body_clips.hpp"

#include <algorithm>

namespace handhold {
namespace {

// Indices of the elements before and after `at` in a list sorted by `key`, and the interpolation
// share between them.
struct Place {
    std::size_t before = 0;
    std::size_t after = 0;
    double share = 0.0;
};
template <typename Row>
Place place_of(const std::vector<Row>& rows, double at, double Row::*key) {
    const auto after =
        std::upper_bound(rows.begin(), rows.end(), at,
                         [key](double value, const Row& row) { return value < row.*key; });
    if (after == rows.begin()) {
        return {};
    }
    const std::size_t last = static_cast<std::size_t>(after - rows.begin()) - 1;
    if (after == rows.end()) {
        return {last, last, 0.0};
    }
    return {last, last + 1, (at - rows[last].*key) / ((*after).*key - rows[last].*key)};
}

}  // namespace

ClipTurns no_turns() {
    ClipTurns none;
    none.fill(Vec3::Zero());
    return none;
}

void add_turns(const BodyClip& clip, double at, double weight, ClipBlend blend, ClipTurns& turns) {
    if (clip.keys.empty() || weight == 0.0) {
        return;
    }
    const Place place = place_of(clip.keys, at, &ClipKey::at);
    const double share =
        blend == ClipBlend::eased ? smooth_step(place.share, 0.0, 1.0) : place.share;
    const ClipTurns& a = clip.keys[place.before].turns;
    const ClipTurns& b = clip.keys[place.after].turns;
    for (std::size_t i = 0; i < k_clip_bones; ++i) {
        turns[i] += (weight * (1.0 - share)) * a[i] + (weight * share) * b[i];
    }
}

double reach_weight(const BodyClips& clips, double distance) {
    if (clips.reach.empty()) {
        return 1.0;
    }
    const Place place = place_of(clips.reach, distance, &ClavicleReach::distance);
    const double a = clips.reach[place.before].weight;
    return a + place.share * (clips.reach[place.after].weight - a);
}

}  // namespace handhold
