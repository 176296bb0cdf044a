#include "game/devices/play_space_changes.hpp"

#include <handhold/math.hpp>

namespace handhold {

void PlaySpaceChanges::add(std::int64_t time_ns, const hh::Pose& new_in_old) {
    if (!hh::is_valid(new_in_old)) {
        return;
    }
    // A change that is announced late, for a time before the last change, takes effect at the time
    // of the last change.
    const std::int64_t last_ns = changes_.empty() ? time_ns : changes_.back().time_ns;
    const hh::Pose last = changes_.empty() ? hh::k_origin : changes_.back().space;
    changes_.push_back({time_ns > last_ns ? time_ns : last_ns, last * new_in_old});
}

hh::Pose PlaySpaceChanges::space_at(std::int64_t time_ns) const {
    hh::Pose space = hh::k_origin;
    for (const Change& change : changes_) {
        if (change.time_ns <= time_ns) {
            space = change.space;
        }
    }
    return space;
}

}  // namespace handhold
