#include "tests/game/run/hostile_player.hpp"

#include <algorithm>
#include <limits>

namespace handhold {
namespace {

const Vec3 k_head_rest(0.0, 1.6, 0.0);
const Vec3 k_hand_rest(0.25, 1.3, -0.3);

Quat any_rotation(Random& random) {
    const Vec3 axis = from_host(random.direction());
    return rotation_about(axis, random.between(-3.0, 3.0));
}

}  // namespace

HostilePlayer::HostilePlayer(std::uint64_t seed, double far_jump_m)
    : random_(Random::of(seed)), far_jump_m_(far_jump_m) {
    head_.at.position = head_.to = k_head_rest;
    for (std::size_t side = 0; side < 2; ++side) {
        const Vec3 rest(side == 0 ? -k_hand_rest.x() : k_hand_rest.x(), k_hand_rest.y(),
                        k_hand_rest.z());
        hands_[side].at.position = hands_[side].to = rest;
    }
}

void HostilePlayer::move(Device& device, double reach_m, double dt_s) {
    const double share = std::min(1.0, 12.0 * dt_s);
    device.at.position += share * (device.to - device.at.position);
    if (random_.chance(0.05)) {
        const Vec3 about = from_host(random_.cube());
        device.to = k_head_rest + Vec3(0.0, -0.2, 0.0) + reach_m * about;
        const Quat turn = any_rotation(random_);
        device.at.rotation = device.at.rotation.slerp(0.3, turn).normalized();
    }
    if (random_.chance(0.004)) {
        const Vec3 by = from_host(random_.cube());
        device.at.position += by;  // a jump
    }
    if (random_.chance(0.0005)) {
        const Vec3 by = from_host(random_.cube());
        device.at.position += far_jump_m_ * by;
    }
    device.lost = random_.chance(0.01) != device.lost;
    device.grab = random_.chance(0.04) != device.grab;
}

double HostilePlayer::broken_number() {
    constexpr double k_infinity = std::numeric_limits<double>::infinity();
    constexpr std::array<double, 5> k_numbers = {std::numeric_limits<double>::quiet_NaN(),
                                                 k_infinity, -k_infinity, 1e300, -1e-300};
    return k_numbers[static_cast<std::size_t>(random_.unit() * k_numbers.size())];
}

Pose HostilePlayer::shown(const Device& device) {
    Pose pose = device.at;
    if (device.lost || random_.chance(0.002)) {
        pose.position[static_cast<int>(random_.unit() * 3.0)] = broken_number();
    }
    if (random_.chance(0.002)) {
        pose.rotation.coeffs() *= random_.between(-2.0, 2.0);
    }
    if (random_.chance(0.001)) {
        pose.rotation.coeffs().setConstant(broken_number());
    }
    return pose;
}

hh_player_input HostilePlayer::play(hh::Player player, double start_s, double end_s) {
    const double dt_s = end_s - start_s;
    samples_.clear();
    const auto count = static_cast<int>(random_.unit() * 4.0);
    for (int i = 0; i < count; ++i) {
        move(head_, 0.25, dt_s / count);
        for (Device& hand : hands_) {
            move(hand, 0.6, dt_s / count);
        }
        hh::Sample sample = hh::sample();
        sample.time_s = start_s + dt_s * (i + random_.between(0.0, 1.3)) / count;
        if (random_.chance(0.01)) {
            sample.time_s = random_.chance(0.5) ? broken_number() : start_s - random_.unit();
        }
        sample.head = to_host(shown(head_));
        for (std::size_t side = 0; side < 2; ++side) {
            sample.hands[side] = to_host(shown(hands_[side]));
            sample.grab[side] = hands_[side].grab != random_.chance(0.02);
        }
        samples_.push_back(sample);
    }
    hh_commands commands{};
    commands.smooth_turn = random_.chance(0.01) ? broken_number() : random_.between(-2.0, 2.0);
    commands.snap_turns = random_.chance(0.02) ? static_cast<int>(random_.between(-5.0, 6.0)) : 0;
    commands.brake = random_.chance(0.01) ? broken_number() : random_.between(-1.0, 2.0);
    commands.thrust = 2.0 * random_.cube();
    if (random_.chance(0.01)) {
        commands.thrust.y = broken_number();
    }
    hh_player_input input = hh::input(player, samples_, commands);
    input.repeats_samples = true;
    return input;
}

}  // namespace handhold
