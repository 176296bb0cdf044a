#include "game/session/playback.hpp"

#include <algorithm>

#include <handhold/math.hpp>

namespace handhold {

Playback::Playback(const Recording& recording) {
    const double first_s = recording.samples.empty() ? 0.0 : recording.samples.front().t_s;
    samples_.reserve(recording.samples.size());
    for (const RecordedSample& recorded : recording.samples) {
        hh::Sample sample = hh::sample();
        sample.time_s = recorded.t_s - first_s;
        sample.head = recorded.head;
        sample.head_tracked = hh::is_valid(recorded.head);
        sample.head_inferred = sample.head_tracked && recorded.is_head_inferred;
        for (std::size_t side = 0; side < 2; ++side) {
            const RecordedHand& hand = recorded.hands[side];
            sample.hands[side] = hand.controller;
            sample.hand_tracked[side] = hh::is_valid(hand.controller);
            sample.grab[side] = (hand.buttons & k_grab_buttons) != 0;
            sample.squeeze[side] = hand.squeeze;
            sample.trigger[side] = hand.trigger;
            sample.hand_inferred[side] = sample.hand_tracked[side] && hand.is_inferred;
            sample.curls[side] = hand.curls;
        }
        samples_.push_back(sample);
        calibrates_.push_back(std::ranges::all_of(
            recorded.hands, [](const auto& hand) { return (hand.buttons & k_button_menu) != 0; }));
    }
    duration_s_ = samples_.empty() ? 0.0 : samples_.back().time_s;
}

std::span<const hh::Sample> Playback::window(double frame_end_s) {
    const std::size_t begin = next_;
    while (next_ < samples_.size() && samples_[next_].time_s <= frame_end_s) {
        ++next_;
    }
    // A sample lies exactly at the frame's end, as in a session that was recorded frame by
    // frame. In this frame that session did not know the next sample yet: a hand that is found
    // again there was still lost here.
    const bool ends_with_frame = next_ > begin && samples_[next_ - 1].time_s == frame_end_s;
    const std::size_t end = next_ < samples_.size() && !ends_with_frame ? next_ + 1 : next_;
    return std::span(samples_).subspan(begin, end - begin);
}

hh_commands Playback::commands() const {
    hh_commands commands{};
    commands.calibrate = next_ > 0 && calibrates_[next_ - 1];
    return commands;
}

}  // namespace handhold
