#include "game/play/session_history.hpp"

#include <algorithm>
#include <type_traits>
#include <utility>

namespace handhold {
namespace {

std::vector<double> numbers_of(const Tuning& tuning) {
    std::vector<double> numbers;
    visit_tuning(tuning, [&numbers](const TuningInfo&, const auto& field) {
        if constexpr (std::is_same_v<std::decay_t<decltype(field)>, Vec3>) {
            numbers.insert(numbers.end(), {field.x(), field.y(), field.z()});
        } else {
            numbers.push_back(static_cast<double>(field));
        }
    });
    return numbers;
}

}  // namespace

SessionHistory::SessionHistory(const DesktopSession& session, std::size_t most_bytes)
    : assets_(*session.scene().shapes, session.scene().name), most_bytes_(most_bytes) {}

void SessionHistory::drop_oldest() {
    bytes_ -= stretches_.front().state.world.size();
    stretches_.pop_front();
}

void SessionHistory::step(DesktopSession& session, const DesktopInput& input) {
    if (stretches_.empty() || stretches_.back().inputs.size() >= k_frames_a_snapshot ||
        numbers_of(stretches_.back().tuning) != numbers_of(session.tuning())) {
        stretches_.push_back({session.save(assets_), session.tuning(), {}});
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
void SessionHistory::play_again(DesktopSession& session, const Stretch& stretch) const {
    const Tuning now = std::exchange(session.tuning(), stretch.tuning);
    session.restore(stretch.state, assets_);
    for (const DesktopInput& input : stretch.inputs) {
        session.step(input);
    }
    session.tuning() = now;
}

}  // namespace handhold
