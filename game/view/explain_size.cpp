#include "game/view/explain_size.hpp"

#include <cmath>
#include <cstdio>
#include <numeric>

#include "systems/body/estimate_sizes.hpp"

namespace handhold {
namespace {

constexpr double k_settled_m = 0.005;

template <std::size_t Bins>
double seen_s(const LengthHistogram<Bins>& histogram) {
    return std::accumulate(histogram.time_s.begin(), histogram.time_s.end(), 0.0);
}

std::string reason_of(const World& world, Entity player, const BodyMeasures& believed) {
    const SizeEstimate& size = world.size_estimate.at(player);
    if (size.is_measured) {
        return world.calibration.at(player).done ? "Measured in a T-pose."
                                                 : "Given by the host, or measured before.";
    }
    const auto seen = seen_measures(size);
    char text[160];
    if (!seen) {
        std::snprintf(text, sizeof text,
                      "Nobody measured this player, and too little play was seen: head %.1f s, "
                      "hands %.1f hand-seconds.",
                      seen_s(size.eyes), seen_s(size.reach));
        return text;
    }
    const BodyMeasures wanted = scaled(*seen, world.player_origin.at(player).scale);
    const double arm_m = wanted.upper_arm_m + wanted.forearm_m;
    const bool is_settled =
        std::fabs(wanted.eye_height_m - believed.eye_height_m) < k_settled_m &&
        std::fabs(arm_m - believed.upper_arm_m - believed.forearm_m) < k_settled_m;
    if (is_settled) {
        std::snprintf(text, sizeof text,
                      "From play that counts: head seen for %.0f s, hands for %.0f hand-seconds.",
                      seen_s(size.eyes), seen_s(size.reach));
    } else {
        std::snprintf(text, sizeof text,
                      "From play, on the way to eyes at %.2f m and arms of %.2f m: head seen for "
                      "%.0f s, hands for %.0f hand-seconds.",
                      wanted.eye_height_m, arm_m, seen_s(size.eyes), seen_s(size.reach));
    }
    return text;
}

}  // namespace

SizeStory explain_size(const World& world, Entity player) {
    const BodyMeasures& believed = world.body_measures.at(player);
    return {believed.eye_height_m, believed.upper_arm_m + believed.forearm_m,
            believed.shoulder_width_m, reason_of(world, player, believed)};
}

}  // namespace handhold
