#include "systems/match/shared/match_input.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/math/scalar_rotation.hpp"

namespace handhold {
namespace {

constexpr double k_rotation_units = PackedPose::k_most_rotation * 1.4142135623730951;

double round_half_up(double value) { return std::floor(value + 0.5); }

// `value` in [low, high] as an integer of `steps` steps; NaN counts as 0.
template <typename Integer>
Integer packed_share(double value, double low, double steps) {
    const double bounded = value >= low ? std::min(value, 1.0) : (value < low ? low : 0.0);
    return static_cast<Integer>(round_half_up(bounded * steps));
}

Pose untracked() {
    constexpr double k_nan = std::numeric_limits<double>::quiet_NaN();
    return {Vec3::Constant(k_nan), Quat::Identity()};
}

// A device's pose at a share of the tick.
Pose pose_within(const PackedPose& before, bool was_tracked, const PackedPose& now, bool is_tracked,
                 double share) {
    if (!is_tracked) {
        return untracked();
    }
    return was_tracked && share < 1.0 ? interpolate(unpack(before), unpack(now), share)
                                      : unpack(now);
}

// All devices at `at` / 256 of the tick; 256 is its end.
TrackingSample sample_within(const MatchInput& before, const MatchInput& now, int at,
                             double start_s, double end_s) {
    constexpr int k_end = 256;
    const double share = static_cast<double>(at) / k_end;
    TrackingSample sample;
    sample.t_s = at == k_end ? end_s : start_s + share * (end_s - start_s);
    sample.head_ps =
        pose_within(before.head, before.is_head_tracked, now.head, now.is_head_tracked, share);
    sample.is_head_inferred = now.is_head_inferred;
    for (std::size_t side = 0; side < k_hand_count; ++side) {
        const MatchHand& was = before.hands[side];
        const MatchHand& is = now.hands[side];
        ControllerSample& out = sample.controllers[side];
        out.controller_ps =
            is.edge_at == at && at < k_end && is.is_tracked
                ? unpack(is.edge_pose)
                : pose_within(was.pose, was.is_tracked, is.pose, is.is_tracked, share);
        const bool is_over = at == k_end || (is.edge_at != 0 && is.edge_at <= at);
        out.grab = is_over ? is.grab : was.grab;
        out.squeeze = static_cast<double>(is.squeeze) / 255.0;
        out.trigger = static_cast<double>(is.trigger) / 255.0;
        out.is_inferred = is.is_inferred;
        for (std::size_t finger = 0; finger < k_finger_count; ++finger) {
            out.curls[finger] = is.curls[finger] == MatchHand::k_unknown_curl
                                    ? handhold::k_unknown_curl
                                    : static_cast<double>(is.curls[finger]) / 254.0;
        }
    }
    return sample;
}

}  // namespace

bool is_packable(const Pose& pose) {
    constexpr double k_most_m = PackedPose::k_most_units / PackedPose::k_units_per_m;
    return is_valid(pose) && pose.position.cwiseAbs().maxCoeff() <= k_most_m;
}

PackedPose pack(const Pose& pose) {
    PackedPose packed;
    for (int axis = 0; axis < 3; ++axis) {
        packed.position[static_cast<std::size_t>(axis)] = static_cast<std::int32_t>(
            round_half_up(pose.position[axis] * PackedPose::k_units_per_m));
    }
    const Quat rotation = pose.rotation.normalized();
    const Quat::Coefficients& parts = rotation.coeffs();
    int largest = 3;
    for (int i = 0; i < 3; ++i) {
        largest = std::abs(parts[i]) > std::abs(parts[largest]) ? i : largest;
    }
    packed.largest = static_cast<std::uint8_t>(largest);
    const double sign = parts[largest] < 0.0 ? -1.0 : 1.0;
    std::size_t next = 0;
    for (int i = 0; i < 4; ++i) {
        if (i != largest) {
            constexpr double k_most = PackedPose::k_most_rotation;
            packed.rotation[next++] = static_cast<std::int16_t>(
                std::clamp(round_half_up(sign * parts[i] * k_rotation_units), -k_most, k_most));
        }
    }
    return packed;
}

Pose unpack(const PackedPose& packed) {
    Pose pose;
    for (int axis = 0; axis < 3; ++axis) {
        pose.position[axis] =
            packed.position[static_cast<std::size_t>(axis)] / PackedPose::k_units_per_m;
    }
    std::array<double, 4> parts{};
    double sum = 0.0;
    std::size_t next = 0;
    for (std::size_t i = 0; i < parts.size(); ++i) {
        if (i != packed.largest) {
            parts[i] = packed.rotation[next++] / k_rotation_units;
            sum += parts[i] * parts[i];
        }
    }
    // Three components at their limits have a sum of 1.5: no unit quaternion. unit_quat then makes
    // one.
    parts[packed.largest] = std::sqrt(std::max(0.0, 1.0 - sum));
    pose.rotation = unit_quat(parts[3], parts[0], parts[1], parts[2]);
    return pose;
}

TickSamples unpack_samples(const MatchInput& before, const MatchInput& now, double start_s,
                           double end_s) {
    TickSamples out;
    const int left = now.hands[0].edge_at;
    const int right = now.hands[1].edge_at;
    for (const int at : {std::min(left, right), std::max(left, right)}) {
        const bool is_again = out.count > 0 && left == right;
        if (at > 0 && !is_again) {
            out.samples[out.count++] = sample_within(before, now, at, start_s, end_s);
        }
    }
    out.samples[out.count++] = sample_within(before, now, 256, start_s, end_s);
    return out;
}

PlayerCommands unpack_commands(const MatchInput& input) {
    PlayerCommands commands;
    commands.smooth_turn = input.smooth_turn / 127.0;
    commands.snap_turns = input.snap_turns;  // NOLINT(bugprone-signed-char-misuse): a number
    commands.brake = input.brake / 255.0;
    for (int axis = 0; axis < 3; ++axis) {
        commands.thrust_ps[axis] = input.thrust[static_cast<std::size_t>(axis)] / 127.0;
    }
    commands.calibrate = input.calibrate;
    return commands;
}

void TickSampler::add(const TrackingSample& sample) {
    if (!std::isfinite(sample.t_s)) {
        return;
    }
    if (count_ == k_most_waiting) {
        std::move(waiting_.begin() + 1, waiting_.end(), waiting_.begin());
        --count_;
    }
    waiting_[count_++] = sample;
}

// The button of one hand at the tick's end, and when it came to that state. `used`: the tick's
// samples.
void TickSampler::take_grab(std::size_t side, std::span<const TrackingSample> used, double start_s,
                            double end_s, MatchHand& hand) {
    const bool grab = used.empty() ? grab_[side] : used.back().controllers[side].grab;
    hand.grab = grab;
    if (grab != grab_[side]) {
        std::size_t first = used.size() - 1;  // the first of the samples that have the new state
        while (first > 0 && used[first - 1].controllers[side].grab == grab) {
            --first;
        }
        const double share = (used[first].t_s - start_s) / (end_s - start_s);
        const Pose& pose_ps = used[first].controllers[side].controller_ps;
        if (share < 1.0 && is_packable(pose_ps)) {
            hand.edge_at =
                static_cast<std::uint8_t>(std::clamp(round_half_up(256.0 * share), 1.0, 255.0));
            hand.edge_pose = pack(pose_ps);
        }
    }
    grab_[side] = grab;
}

// Head and hands at the tick's end, from the last sample that a tick used and the next one.
void TickSampler::take_poses(double end_s, MatchInput& input) const {
    const TrackingSample* const later = count_ > 0 ? waiting_.data() : nullptr;
    const bool is_known = has_last_ && (later != nullptr || end_s - last_.t_s <= k_longest_hold_s);
    const double span_s = later != nullptr ? later->t_s - last_.t_s : 0.0;
    const double share = span_s > 0.0 ? std::clamp((end_s - last_.t_s) / span_s, 0.0, 1.0) : 0.0;
    const auto take_pose = [&](const Pose& held, const Pose* next, PackedPose& out) {
        if (!is_known || !is_packable(held)) {
            return false;
        }
        out = pack(next != nullptr && is_packable(*next) ? interpolate(held, *next, share) : held);
        return true;
    };
    input.is_head_tracked =
        take_pose(last_.head_ps, later != nullptr ? &later->head_ps : nullptr, input.head);
    input.is_head_inferred = last_.is_head_inferred;
    for (std::size_t side = 0; side < k_hand_count; ++side) {
        const ControllerSample& reading = last_.controllers[side];
        MatchHand& hand = input.hands[side];
        hand.is_tracked =
            take_pose(reading.controller_ps,
                      later != nullptr ? &later->controllers[side].controller_ps : nullptr,
                      hand.pose) &&
            reading.controller_ps.position != Vec3::Zero();
        hand.is_inferred = reading.is_inferred;
        hand.squeeze = packed_share<std::uint8_t>(reading.squeeze, 0.0, 255.0);
        hand.trigger = packed_share<std::uint8_t>(reading.trigger, 0.0, 255.0);
        for (std::size_t finger = 0; finger < k_finger_count; ++finger) {
            if (reading.curls[finger] >= 0.0) {
                hand.curls[finger] = packed_share<std::uint8_t>(reading.curls[finger], 0.0, 254.0);
            }
        }
    }
}

MatchInput TickSampler::take(double start_s, double end_s, const PlayerCommands& commands,
                             std::uint32_t buttons) {
    const auto waiting = std::span(waiting_).first(count_);
    const auto used = static_cast<std::size_t>(
        std::ranges::find_if(waiting, [&](const TrackingSample& s) { return !(s.t_s <= end_s); }) -
        waiting.begin());
    MatchInput input;
    for (std::size_t side = 0; side < k_hand_count; ++side) {
        take_grab(side, waiting.first(used), start_s, end_s, input.hands[side]);
    }
    if (used > 0) {
        last_ = waiting[used - 1];
        has_last_ = true;
        std::move(waiting_.begin() + static_cast<std::ptrdiff_t>(used),
                  waiting_.begin() + static_cast<std::ptrdiff_t>(count_), waiting_.begin());
        count_ -= used;
    }
    take_poses(end_s, input);
    input.smooth_turn = packed_share<std::int8_t>(commands.smooth_turn, -1.0, 127.0);
    input.snap_turns = static_cast<std::int8_t>(std::clamp(commands.snap_turns, -127, 127));
    input.brake = packed_share<std::uint8_t>(commands.brake, 0.0, 255.0);
    for (int axis = 0; axis < 3; ++axis) {
        input.thrust[static_cast<std::size_t>(axis)] =
            packed_share<std::int8_t>(commands.thrust_ps[axis], -1.0, 127.0);
    }
    input.calibrate = commands.calibrate;
    input.buttons = buttons;
    return input;
}

}  // namespace handhold
