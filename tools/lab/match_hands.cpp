#include "tools/lab/match_hands.hpp"

#include <algorithm>
#include <cmath>

#include "components/tuning.hpp"
#include "engine/math/math.hpp"
#include "game/session/playback.hpp"
#include "systems/host/host_samples.hpp"

namespace handhold::lab {
namespace {

constexpr double k_device_s = 1.0 / 97.0;
constexpr double k_return_step_s = 1.0 / 90.0;
constexpr double k_above_m = 0.005;  // a resting palm is so far from what it will grip

// Tremor of hands: about 9 Hz, another one for each axis of each device.
Vec3 hand_tremor(std::size_t player, std::size_t side, double t_s) {
    constexpr double k_size_m = 0.0003;
    Vec3 out;
    for (int axis = 0; axis < 3; ++axis) {
        const double number = 7.0 * static_cast<double>(player) + 3.0 * static_cast<double>(side) +
                              static_cast<double>(axis);
        out[axis] = k_size_m * std::sin((50.0 + 3.7 * std::fmod(1.7 * number, 4.0)) * t_s + number);
    }
    return out;
}

Vec3 palm_of(std::size_t side) {
    const Vec3 right = Tuning{}.hand.palm_center_m;
    return {side == 0 ? -right.x() : right.x(), right.y(), right.z()};
}

// 0 before `from_s`, 1 after `to_s`, without jumps of velocity.
double ease(double t, double from_s, double to_s) {
    const double share = std::clamp((t - from_s) / (to_s - from_s), 0.0, 1.0);
    return share * share * (3.0 - 2.0 * share);
}
// From 0 to 1 and back.
double bump(double t, double from_s, double to_s) {
    const double middle_s = 0.5 * (from_s + to_s);
    return ease(t, from_s, middle_s) - ease(t, middle_s, to_s);
}

void crawl(std::size_t player, double t, TrackingSample& sample) {
    const auto number = static_cast<double>(player);
    sample.head_ps = {Vec3(0.02 * std::sin(t + number), 0.7, 0.0), Quat::Identity()};
    for (std::size_t side = 0; side < k_hand_count; ++side) {
        const double out = side == 0 ? -1.0 : 1.0;
        const Vec3 rest = Vec3(0.25 * out, 0.055, -0.3) - palm_of(side);
        const Vec3 wave(std::sin(2.0 * t + number), 0.0, out * std::sin(3.0 * t));
        const double phase = t + 0.35 * static_cast<double>(side) + 0.1 * number;
        sample.controllers[side].controller_ps = {rest + 0.1 * wave, Quat::Identity()};
        sample.controllers[side].grab = std::fmod(phase, 0.9) > 0.3;
    }
}

// Where the pair's body ends on this player's side, along z, from the player.
double end_of(std::size_t player) { return player % 2 == 0 ? -0.6 : 0.6; }

Vec3 rest_on_body(std::size_t player) {
    return Vec3(0.0, k_pair_height_m + k_pair_half_m + k_above_m, end_of(player)) - palm_of(1);
}
Vec3 left_rest(std::size_t player) { return {-0.45, 1.25, -0.25 * end_of(player)}; }

void pull_bar(std::size_t player, double t, TrackingSample& sample) {
    const auto number = static_cast<double>(player);
    sample.head_ps = {Vec3(0.03 * std::sin(1.3 * t + number), 1.6, -0.1 * end_of(player)),
                      rotation_about(Vec3::UnitY(), 0.2 * std::sin(0.9 * t))};
    const double on = std::clamp((t - 0.8) / 0.4, 0.0, 1.0);
    const Vec3 pull =
        0.12 * on *
        Vec3(std::sin(3.0 * t + number), 0.4 * std::sin(2.0 * t), std::sin(4.0 * t + number));
    sample.controllers[1].controller_ps = {rest_on_body(player) + pull, Quat::Identity()};
    sample.controllers[1].grab = t > 0.3;
    sample.controllers[0].controller_ps = {
        left_rest(player) + Vec3(0.0, 0.04 * std::sin(2.2 * t), 0.0), Quat::Identity()};
}

// The board turns about a hinge along z. The second player is late, so that both pull.
void swing_door(std::size_t player, double t, TrackingSample& sample) {
    const double late = player % 2 == 0 ? 0.0 : 0.15;
    const double angle_rad = 0.5 * ease(t, 0.8, 1.6) * std::sin(1.7 * t - late);
    const double rest_m = k_pair_half_m + k_above_m;
    const Vec3 from_rest(
        k_board_half_m * (std::cos(angle_rad) - 1.0) - rest_m * std::sin(angle_rad),
        k_board_half_m * std::sin(angle_rad) + rest_m * (std::cos(angle_rad) - 1.0), 0.0);
    sample.controllers[1].controller_ps = {rest_on_body(player) + from_rest, Quat::Identity()};
    sample.controllers[1].grab = t > 0.3;
}

// In rounds of four seconds: the first holds the tool and moves it, both hold it, the second does.
void hand_over(std::size_t player, double t, TrackingSample& sample) {
    constexpr double k_round_s = 4.0;
    const bool is_first = player % 2 == 0;
    const double phase = std::fmod(t + (is_first ? 0.0 : 0.5 * k_round_s), k_round_s);
    const double swing_m = 0.15 * bump(phase, 0.4, 1.5);
    sample.controllers[1].controller_ps = {rest_on_body(player) + Vec3(swing_m, 0.5 * swing_m, 0.0),
                                           Quat::Identity()};
    sample.controllers[1].grab = t > 0.3 && (phase < 2.3 || phase > 3.7);
}

// Both stretch their left arms forward and lay the right palm on the back of the other's left
// hand.
void hold_each_other(std::size_t player, double t, TrackingSample& sample) {
    constexpr double k_round_s = 6.0;
    constexpr double k_begin_s = 4.0;
    const Vec3 left(-0.25, 1.25, -0.5);
    sample.controllers[0].controller_ps.position +=
        ease(t, 3.0, 3.8) * (left - sample.controllers[0].controller_ps.position);
    // The other's left hand, and the palm 6 cm on its back towards the fingers.
    const Vec3 other(0.25, 1.25, -2.0 * k_face_to_face_m - left.z());
    const Vec3 rest = other + Vec3(0.0, 0.034, 0.06) - palm_of(1);
    const double phase = std::fmod(t - k_begin_s, k_round_s);
    const bool grips = t > k_begin_s && phase < 5.0;
    const double pull_m = grips ? 0.08 * bump(phase, 0.5, 4.9) : 0.0;
    const double turn = 2.5 * phase + static_cast<double>(player);
    const Vec3 out = pull_m * Vec3(std::sin(turn), 0.3 * std::sin(1.7 * turn), std::cos(turn));
    const Vec3 wait = (1.0 - ease(t, 3.0, 3.8)) * Vec3(0.15, -0.3, 0.15);
    sample.controllers[1].controller_ps = {rest + wait + out, Quat::Identity()};
    sample.controllers[1].grab = grips;
}

// The left hand holds a ball and throws it up and out.
void throw_ball(std::size_t player, double t, TrackingSample& sample) {
    constexpr double k_swing_s = 0.3;
    constexpr double k_accel_mps2 = 9.0;
    constexpr double k_stop_s = 0.2;
    const double let_go_s = 2.3 + 0.1 * static_cast<double>(player % 4);
    const double swing_s = std::clamp(t - let_go_s + k_swing_s, 0.0, k_swing_s);
    const double stop_s = std::clamp(t - let_go_s, 0.0, k_stop_s);
    const double speed_mps = k_accel_mps2 * k_swing_s;
    const double out_m = 0.5 * k_accel_mps2 * swing_s * swing_s + speed_mps * stop_s -
                         0.5 * speed_mps / k_stop_s * stop_s * stop_s;
    const double back = 1.0 - ease(t, let_go_s + k_stop_s, let_go_s + 1.0);
    sample.controllers[0].controller_ps = {
        left_rest(player) + back * out_m * Vec3(-0.5, std::sqrt(0.75), 0.0), Quat::Identity()};
    sample.controllers[0].grab = t > 0.2 && t < let_go_s;
}

void together(PairTask task, std::size_t player, double t, TrackingSample& sample) {
    pull_bar(player, t, sample);
    throw_ball(player, t, sample);
    if (task == PairTask::swing_door) {
        swing_door(player, t, sample);
    } else if (task == PairTask::hand_over) {
        hand_over(player, t, sample);
    } else if (task == PairTask::hold_each_other) {
        sample.head_ps.position.z() = 0.0;
        hold_each_other(player, t, sample);
    }
}

std::vector<TrackingSample> samples_of(const Recording& recording) {
    Playback playback(recording);
    std::vector<TrackingSample> out;
    const std::span<const hh::Sample> samples = playback.window(playback.duration_s());
    for (std::size_t i = 0; i < samples.size(); ++i) {
        out.push_back(exact_sample(samples.data(), i));
    }
    return out;
}

bool is_tracked(const Pose& pose) { return pose.position.allFinite(); }

}  // namespace

std::vector<std::string_view> match_scene_names() {
    return {"crawl", "bars", "together", "recorded"};
}

PairTask task_of_pair(const MatchSetting& setting, std::size_t pair) {
    return setting.scene == "together"
               ? static_cast<PairTask>((pair + setting.first_pair) % k_pair_tasks)
               : PairTask::pull_bar;
}

Vec3 ball_ps(std::size_t player) {
    return left_rest(player) + palm_of(0) - Vec3(0.0, k_ball_radius_m + k_above_m, 0.0);
}

std::vector<Vec3> grip_rocks_ps(const Recording& recording) {
    constexpr double k_apart_m = 0.25;
    constexpr std::size_t k_most_rocks = 8;
    const std::vector<TrackingSample> samples = samples_of(recording);
    std::vector<Vec3> out;
    for (std::size_t i = 1; i < samples.size() && out.size() < k_most_rocks; ++i) {
        for (std::size_t side = 0; side < k_hand_count; ++side) {
            const ControllerSample& hand = samples[i].controllers[side];
            if (!hand.grab || samples[i - 1].controllers[side].grab ||
                !is_tracked(hand.controller_ps) || !is_tracked(samples[i].head_ps)) {
                continue;
            }
            const Vec3 below = palm_of(side) - Vec3(0.0, k_grip_rock_m + k_above_m, 0.0);
            const Vec3 place = transform_point(hand.controller_ps, below);
            const bool is_free = std::ranges::all_of(
                out, [&](const Vec3& other) { return (other - place).norm() > k_apart_m; });
            if (is_free && (samples[i].head_ps.position - place).norm() > k_apart_m) {
                out.push_back(place);
            }
        }
    }
    return out;
}

MatchHands::MatchHands(const MatchSetting& setting, std::size_t player)
    : scene_(setting.scene), task_(task_of_pair(setting, player / 2)), player_(player) {
    if (scene_ == "recorded") {
        recorded_ = samples_of(setting.recordings[player % setting.recordings.size()]);
    }
}

TrackingSample MatchHands::next() {
    if (scene_ == "recorded") {
        return next_recorded();
    }
    TrackingSample sample;
    sample.t_s = k_device_s * static_cast<double>(count_++);
    if (scene_ == "crawl") {
        crawl(player_, sample.t_s, sample);
    } else if (scene_ == "bars") {
        pull_bar(player_, sample.t_s, sample);
    } else {
        together(task_, player_, sample.t_s, sample);
    }
    for (std::size_t side = 0; side < k_hand_count; ++side) {
        sample.controllers[side].controller_ps.position += hand_tremor(player_, side, sample.t_s);
    }
    return sample;
}

TrackingSample MatchHands::next_recorded() {
    const TrackingSample& first = recorded_.front();
    const TrackingSample& last = recorded_.back();
    TrackingSample sample;
    if (count_ < recorded_.size()) {
        sample = recorded_[count_];
    } else {
        const double since_s = k_return_step_s * static_cast<double>(count_ - recorded_.size() + 1);
        const double share = ease(since_s, 0.0, k_return_s);
        sample = first;
        sample.t_s = last.t_s + since_s;
        const auto between = [share](const Pose& from, const Pose& to) {
            return is_tracked(from) && is_tracked(to) ? interpolate(from, to, share) : to;
        };
        sample.head_ps = between(last.head_ps, first.head_ps);
        for (std::size_t side = 0; side < k_hand_count; ++side) {
            sample.controllers[side].controller_ps = between(last.controllers[side].controller_ps,
                                                             first.controllers[side].controller_ps);
            sample.controllers[side].grab = false;
        }
    }
    sample.t_s += round_s_;
    ++count_;
    if (sample.t_s >= round_s_ + last.t_s + k_return_s - 0.5 * k_return_step_s) {
        round_s_ += last.t_s + k_return_s + k_return_step_s;
        count_ = 0;
    }
    return sample;
}

}  // namespace handhold::lab
