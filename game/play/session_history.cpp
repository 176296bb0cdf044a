#include "game/play/session_history.hpp"

#include <algorithm>
#include <stdexcept>
#include <utility>

namespace handhold {

void SessionHistory::drop_oldest() {
    bytes_ -= stretches_.front().state.world.size();
    stretches_.pop_front();
}

void SessionHistory::step(DesktopSession& session, const DesktopInput& input) {
    if (stretches_.empty() || stretches_.back().inputs.size() >= k_frames_a_snapshot ||
        stretches_.back().tuning != session.world().tuning_numbers()) {
        stretches_.push_back({session.save(), session.world().tuning_numbers(), {}});
        bytes_ += stretches_.back().state.world.size();
        while (bytes_ > most_bytes_ && stretches_.size() > 2) {
            drop_oldest();
        }
    }
    stretches_.back().inputs.push_back(input);
    session.step(input);
}

std::size_t SessionHistory::frames() const {
    std::size_t count = 0;
    for (const Stretch& stretch : stretches_) {
        count += stretch.inputs.size();
    }
    return count;
}

std::size_t SessionHistory::rewind(DesktopSession& session, std::size_t frames) {
    std::size_t left = frames;
    while (left > 0 && !stretches_.empty()) {
        Stretch& stretch = stretches_.back();
        const std::size_t back = std::min(left, stretch.inputs.size());
        left -= back;
        if (left == 0 || stretches_.size() == 1) {
            stretch.inputs.resize(stretch.inputs.size() - back);
            play_again(session, stretch);
        }
        if (left > 0 || stretch.inputs.empty()) {
            bytes_ -= stretch.state.world.size();
            stretches_.pop_back();
        }
    }
    return frames - left;
}

// Restores the stretch's first state and replays its inputs with the tuning of that time. Keeps the
// session's current tuning.
void SessionHistory::play_again(DesktopSession& session, const Stretch& stretch) {
    const std::vector<double> now = session.world().tuning_numbers();
    const auto tune = [&session](const std::vector<double>& numbers) {
        if (!session.world().set_tuning_numbers(numbers)) {
            throw std::logic_error("the tuning of a session is out of range");
        }
    };
    tune(stretch.tuning);
    session.restore(stretch.state);
    for (const DesktopInput& input : stretch.inputs) {
        session.step(input);
    }
    tune(now);
}

}  // namespace handhold
