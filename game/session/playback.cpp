#include "game/session/playback.hpp"

#include <algorithm>

namespace handhold {

Playback::Playback(const Recording& recording) {
    const double first_s = recording.samples.empty() ? 0.0 : recording.samples.front().t_s;
    samples_.reserve(recording.samples.size());
    for (const RecordedSample& recorded : recording.samples) {
        TrackingSample sample;
        sample.t_s = recorded.t_s - first_s;
        sample.head_ps = recorded.head;
        sample.is_head_inferred = recorded.is_head_inferred;
        for (std::size_t side = 0; side < k_hand_count; ++side) {
            sample.controllers[side].controller_ps = recorded.hands[side].controller;
            sample.controllers[side].grab = (recorded.hands[side].buttons & k_grab_buttons) != 0;
            sample.controllers[side].squeeze = recorded.hands[side].squeeze;
            sample.controllers[side].trigger = recorded.hands[side].trigger;
            sample.controllers[side].is_inferred = recorded.hands[side].is_inferred;
            sample.controllers[side].curls = recorded.hands[side].curls;
        }
        samples_.push_back(sample);
        calibrates_.push_back(std::ranges::all_of(
            recorded.hands, [](const auto& hand) { return (hand.buttons & k_button_menu) != 0; }));
    }
    duration_s_ = samples_.empty() ? 0.0 : samples_.back().t_s;
}

std::span<const TrackingSample> Playback::window(double frame_end_s) {
    const std::size_t begin = next_;
    while (next_ < samples_.size() && samples_[next_].t_s <= frame_end_s) {
        ++next_;
    }
    // A sample lies exactly at the frame's end, as in a session that was recorded frame by
    // frame. In this frame that session did not know the next sample yet: a hand that is found
    // again there was still lost here.
    const bool ends_with_frame = next_ > begin && samples_[next_ - 1].t_s == frame_end_s;
    const std::size_t end = next_ < samples_.size() && !ends_with_frame ? next_ + 1 : next_;
    return std::span(samples_).subspan(begin, end - begin);
}

PlayerCommands Playback::commands() const {
    PlayerCommands commands;
    commands.calibrate = next_ > 0 && calibrates_[next_ - 1];
    return commands;
}

}  // namespace handhold
