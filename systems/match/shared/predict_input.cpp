#include "systems/match/shared/predict_input.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace handhold {
namespace {

constexpr std::size_t k_samples = 9;
// Weights of the samples by their ages: 0.4 to the power of the age. Chosen with k_lag_ticks on
// half of the recorded sessions of ../shared/data/vr_input; the other half prefers the same.
constexpr std::array<double, k_samples> k_weights = {
    1.0, 0.4, 0.16, 0.064, 0.0256, 0.01024, 0.004096, 0.0016384, 0.00065536};
// A hand that moves 9 m/s in ticks of 1/90 s. Faster than that, a pose jumped.
constexpr double k_jump_m = 0.1;
constexpr double k_jump_rad = 0.5;
// Speeds of guesses, in m and rad a tick: 4 m/s and 18 rad/s at 90 Hz.
constexpr double k_most_m = 0.045;
constexpr double k_most_rad = 0.2;

// A device's last real poses, the newest first, with their ages in ticks.
struct Track {
    std::array<Pose, k_samples> poses;
    std::array<double, k_samples> ages{};
    std::size_t count = 0;

    void add(const Pose& pose, double age) {
        poses[count] = pose;
        ages[count] = age;
        ++count;
    }
};

bool is_jump_between(const Pose& a, const Pose& b, double ticks) {
    return (a.position - b.position).norm() > k_jump_m * ticks ||
           rotation_to_vector((a.rotation * b.rotation.conjugate()).normalized()).norm() >
               k_jump_rad * ticks;
}

// Least-squares slope, a tick, of values relative to the newest pose.
template <typename Value>
Vec3 slope_of(const Track& track, const Value& value) {
    double sum_of_weights = 0.0;
    double mean_age = 0.0;
    Vec3 mean = Vec3::Zero();
    for (std::size_t i = 0; i < track.count; ++i) {
        const double weight = k_weights[static_cast<std::size_t>(track.ages[i])];
        sum_of_weights += weight;
        mean_age += weight * track.ages[i];
        mean += weight * value(i);
    }
    mean_age /= sum_of_weights;
    mean /= sum_of_weights;
    double spread = 0.0;
    Vec3 sum = Vec3::Zero();
    for (std::size_t i = 0; i < track.count; ++i) {
        const double weight = k_weights[static_cast<std::size_t>(track.ages[i])];
        const double age = mean_age - track.ages[i];
        spread += weight * age * age;
        sum += weight * age * (value(i) - mean);
    }
    return spread > 0.0 ? Vec3(sum / spread) : Vec3(Vec3::Zero());
}

Vec3 bounded(const Vec3& v, double most) {
    const double length = v.norm();
    return length > most ? Vec3(v * (most / length)) : v;
}

DeviceTrend trend_of_track(const Track& track) {
    DeviceTrend trend;
    trend.last = track.poses[0];
    if (track.count < 2) {
        return trend;
    }
    const auto moved = [&](std::size_t i) {
        return Vec3(track.poses[i].position - trend.last.position);
    };
    const auto turned = [&](std::size_t i) {
        return rotation_to_vector(
            (track.poses[i].rotation * trend.last.rotation.conjugate()).normalized());
    };
    trend.step_m = bounded(slope_of(track, moved), k_most_m);
    trend.turn_rad = bounded(slope_of(track, turned), k_most_rad);
    return trend;
}

PackedPose continued(const DeviceTrend& trend, const PackedPose& newest, double ticks) {
    const double travel = ticks / (1.0 + ticks / k_lag_ticks);
    Pose guess = trend.last;
    guess.position += travel * trend.step_m;
    const double angle_rad = travel * trend.turn_rad.norm();
    if (angle_rad > 0.0) {
        guess.rotation =
            (rotation_about(trend.turn_rad.normalized(), angle_rad) * guess.rotation).normalized();
    }
    return is_packable(guess) ? pack(guess) : newest;
}

// The real poses of one device in the last k_samples ticks, since it jumped.
template <typename PoseOf>
Track track_of(const InputHistory& history, const PoseOf& pose_of) {
    Track track;
    const MatchTick newest = history.last_real();
    for (MatchTick age = 0; age < k_samples && age < newest; ++age) {
        const MatchTick tick = newest - age;
        if (history.kind_at(tick) != InputKind::real) {
            continue;
        }
        const PackedPose* const packed = pose_of(history.at(tick));
        if (packed == nullptr) {
            break;  // not tracked
        }
        const Pose pose = unpack(*packed);
        const auto since = static_cast<double>(age);
        if (track.count > 0 && is_jump_between(track.poses[track.count - 1], pose,
                                               since - track.ages[track.count - 1])) {
            break;
        }
        track.add(pose, since);
    }
    return track;
}

}  // namespace

InputTrend trend_of(const InputHistory& history) {
    InputTrend trend;
    trend.newest = history.last_real();
    if (trend.newest == 0) {
        return trend;
    }
    trend.input = history.at(trend.newest);
    trend.input.snap_turns = 0;
    if (trend.input.is_head_tracked) {
        trend.devices[0] = trend_of_track(track_of(history, [](const MatchInput& input) {
            return input.is_head_tracked ? &input.head : nullptr;
        }));
    }
    for (std::size_t side = 0; side < k_hand_count; ++side) {
        MatchHand& hand = trend.input.hands[side];
        hand.edge_at = 0;
        hand.edge_pose = {};
        if (hand.is_tracked) {
            trend.devices[1 + side] =
                trend_of_track(track_of(history, [side](const MatchInput& input) {
                    return input.hands[side].is_tracked ? &input.hands[side].pose : nullptr;
                }));
        }
    }
    return trend;
}

MatchInput predict_input(const InputTrend& trend, MatchTick tick) {
    if (trend.newest == 0 || tick - trend.newest > k_away_after_ticks) {
        return {};
    }
    MatchInput guess = trend.input;
    const auto ticks = static_cast<double>(tick - trend.newest);
    if (guess.is_head_tracked) {
        guess.head = continued(trend.devices[0], guess.head, ticks);
    }
    for (std::size_t side = 0; side < k_hand_count; ++side) {
        MatchHand& hand = guess.hands[side];
        if (hand.is_tracked) {
            hand.pose = continued(trend.devices[1 + side], hand.pose, ticks);
        }
    }
    return guess;
}

}  // namespace handhold
