#pragma once

#include <cstdint>
#include <vector>

#include "engine/math/math.hpp"

namespace handhold {

// Recentrings that a headset's runtime announces. Readings are corrected to the space that the
// session began in, so that the game never notices one.
class PlaySpaceChanges {
  public:
    // From `time_ns` on, readings are given in a space whose origin lies at `new_in_old` in the
    // space before. Ignored if the pose is not valid.
    void add(std::int64_t time_ns, const Pose& new_in_old);
    // The space of readings for that time, in the first one: first = space_at(time) * reading.
    Pose space_at(std::int64_t time_ns) const;

  private:
    struct Change {
        std::int64_t time_ns = 0;
        Pose space;  // play space from then on, in the frame of the first
    };
    std::vector<Change> changes_;  // changes in the order of their times
};

}  // namespace handhold
