#pragma once

#include <cstdint>
#include <vector>

#include <handhold/handhold.hpp>

namespace handhold {

// Recentrings that a headset's runtime announces. Readings are corrected to the space that the
// session began in, so that the game never notices one.
class PlaySpaceChanges {
  public:
    // From `time_ns` on, the runtime gives readings in a new space, whose pose in the previous
    // space is `new_in_old`. Ignored if the pose is not valid.
    void add(std::int64_t time_ns, const hh::Pose& new_in_old);
    // Pose of the space of readings at that time, in the session's first space: first =
    // space_at(time) * reading.
    hh::Pose space_at(std::int64_t time_ns) const;

  private:
    struct Change {
        std::int64_t time_ns = 0;
        hh::Pose space = hh::k_origin;  // play space from then on, in the frame of the first
    };
    std::vector<Change> changes_;  // changes in the order of their times
};

}  // namespace handhold
