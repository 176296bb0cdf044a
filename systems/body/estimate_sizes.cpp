#include "systems/body/estimate_sizes.hpp"

#include <algorithm>
#include <cmath>

#include "components/hand_indices.hpp"
#include "engine/core/parallel.hpp"
#include "systems/body/shared/body_proportions.hpp"

namespace handhold {
namespace {

// The constants below were chosen on body_train's train set.
constexpr double k_eyes_percentile = 0.95;
constexpr double k_reach_percentile = 0.99;
constexpr double k_arm_share = 0.675;    // length of an arm / that percentile of the reach
constexpr double k_shortest_arm = 0.95;  // length of an arm / the usual one for the eye height
// Shares of the usual eye height for the arms at which a player sits, and stands.
constexpr double k_sits = 0.85;
constexpr double k_stands = 0.93;
// Time that must have been seen before measures change.
constexpr double k_least_s = 1.0;
// Beyond this time all that was seen counts half, so that another player is noticed. Both hands
// count for the reach, so it forgets twice as fast.
constexpr double k_most_s = 240.0;

template <std::size_t Bins>
double sum_s(const LengthHistogram<Bins>& seen) {
    double sum = 0.0;
    for (const double time_s : seen.time_s) {
        sum += time_s;
    }
    return sum;
}

template <std::size_t Bins>
void see(double length_m, double dt_s, LengthHistogram<Bins>& seen) {
    const double bin = length_m / LengthHistogram<Bins>::k_bin_m;
    if (!(bin >= 0.0 && bin < static_cast<double>(Bins))) {
        return;  // no person has this length
    }
    seen.time_s[static_cast<std::size_t>(bin)] += dt_s;
    if (sum_s(seen) > k_most_s) {
        for (double& time_s : seen.time_s) {
            time_s *= 0.5;
        }
    }
}

// The length below which the share `percentile` of the time was spent; linear within a bin.
template <std::size_t Bins>
double length_at(const LengthHistogram<Bins>& seen, double percentile) {
    double left_s = percentile * sum_s(seen);
    for (std::size_t i = 0; i < Bins; ++i) {
        if (left_s <= seen.time_s[i] && seen.time_s[i] > 0.0) {
            return (static_cast<double>(i) + left_s / seen.time_s[i]) *
                   LengthHistogram<Bins>::k_bin_m;
        }
        left_s -= seen.time_s[i];
    }
    return static_cast<double>(Bins) * LengthHistogram<Bins>::k_bin_m;
}

bool is_seen(TrackingState state) { return state == TrackingState::tracked; }

void follow(double wanted_m, double most_m, double& measure_m) {
    measure_m += std::clamp(wanted_m - measure_m, -most_m, most_m);
}

}  // namespace

std::optional<BodyMeasures> seen_measures(const SizeEstimate& size) {
    if (sum_s(size.eyes) < k_least_s || sum_s(size.reach) < k_least_s) {
        return std::nullopt;
    }
    const double eyes_m = length_at(size.eyes, k_eyes_percentile);
    const BodyMeasures usual = measures_of_eye_height(eyes_m);
    const double arm_m = std::max(k_arm_share * length_at(size.reach, k_reach_percentile),
                                  k_shortest_arm * (usual.upper_arm_m + usual.forearm_m));
    BodyMeasures measures = measures_of({eyes_m, span_of_arm_m(arm_m)});
    const double standing_m = eye_height_of_arm_m(arm_m);
    const double stands = smooth_step(eyes_m / standing_m, k_sits, k_stands);
    measures.eye_height_m = standing_m + stands * (eyes_m - standing_m);
    for (double* const measure_m : {&measures.eye_height_m, &measures.shoulder_width_m,
                                    &measures.upper_arm_m, &measures.forearm_m}) {
        *measure_m = std::clamp(*measure_m, BodyMeasures::k_min_m, BodyMeasures::k_max_m);
    }
    return measures;
}

namespace {

// Notes the lengths that this frame shows of a player who is not measured.
void see_player(const EstimateSizesIo& io, std::size_t index) {
    SizeEstimate& size = io.size.elements()[index];
    const Entity player = io.size.owners()[index];
    const HeadTracking& head = io.head.at(player);
    if (!is_seen(head.state) || head.is_inferred) {
        return;
    }
    const double scale = io.origin.at(player).scale;
    see((head.pose_ps.position.y() - head.shift_m.y()) / scale, io.dt_s, size.eyes);
    const std::size_t none = io.owner.size();
    const std::size_t first = find_hand_index(io.owner, player, k_hand_count * index);
    const std::size_t second = first == none ? none : find_hand_index(io.owner, player, first + 1);
    for (const std::size_t hand_index : {first, second == first ? none : second}) {
        if (hand_index == none) {
            continue;
        }
        const HandTracking& hand = io.hand.at(io.owner.owners()[hand_index]);
        if (is_seen(hand.state)) {
            see((hand.pose_ps.position - head.pose_ps.position).norm() / scale, io.dt_s,
                size.reach);
        }
    }
}

void follow_seen_measures(const EstimateSizesIo& io, std::size_t index) {
    const Entity player = io.size.owners()[index];
    const auto seen = seen_measures(io.size.elements()[index]);
    if (!seen) {
        return;
    }
    const double scale = io.origin.at(player).scale;
    const double most_m = scale * std::min(k_size_mps * io.dt_s, k_size_m_per_frame);
    const BodyMeasures wanted = scaled(*seen, scale);
    BodyMeasures& measures = io.measures.at(player);
    follow(wanted.eye_height_m, most_m, measures.eye_height_m);
    follow(wanted.shoulder_width_m, most_m, measures.shoulder_width_m);
    // Both bones together change by that much.
    const double upper_share = wanted.upper_arm_m / (wanted.upper_arm_m + wanted.forearm_m);
    follow(wanted.upper_arm_m, upper_share * most_m, measures.upper_arm_m);
    follow(wanted.forearm_m, (1.0 - upper_share) * most_m, measures.forearm_m);
}

}  // namespace

void estimate_sizes(const EstimateSizesIo& io) {
    constexpr std::size_t k_players_per_slice = 32;
    parallel_each(io.size.size(), k_players_per_slice, [&io](std::size_t index) {
        SizeEstimate& size = io.size.elements()[index];
        size.is_measured = size.is_measured || io.calibration.at(io.size.owners()[index]).done;
        if (!size.is_measured) {
            see_player(io, index);
            follow_seen_measures(io, index);
        }
    });
}

}  // namespace handhold
