#include "game/net/peer_hands.hpp"

#include <algorithm>

namespace handhold {
namespace {

// Adds the samples after `until_s`, which moves on to the last one.
void add_new(std::span<const hh::Sample> samples, double shift_s, double& until_s,
             PeerInput& input) {
    for (const hh::Sample& sample : samples) {
        if (sample.time_s > until_s) {
            until_s = sample.time_s;
            input.samples.push_back(sample);
            input.samples.back().time_s += shift_s;
        }
    }
}

}  // namespace

void ClimberHands::operator()(double end_s, PeerInput& input) {
    constexpr double k_jump_s = 1.0;
    Scene& scene = scene_.get();
    if (crowd_ == nullptr || end_s > given_until_s_ + k_jump_s ||
        end_s < given_until_s_ - k_jump_s) {
        crowd_ = std::make_shared<Crowd>(scene.host, std::span(&player_, 1), seed_);
        given_until_s_ = scene.host.time_s();
    }
    hh_player_input driven = hh::input(player_, {});
    crowd_->drive(sight_of(scene), end_s, {&driven, 1});
    input.commands = driven.commands;
    add_new({driven.samples, driven.sample_count}, 0.0, given_until_s_, input);
}

void RecordedHands::operator()(double end_s, PeerInput& input) {
    if (!begin_s_) {
        begin_s_ = end_s;
    }
    // The world's clock may go back when a state arrives.
    asked_until_s_ = std::max(asked_until_s_, end_s - *begin_s_);
    add_new(playback_->window(asked_until_s_), *begin_s_, given_until_s_, input);
    input.commands = playback_->commands();
}

}  // namespace handhold
