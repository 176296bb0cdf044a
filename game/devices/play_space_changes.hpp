#pragma once

#include <cstdint>
#include <vector>

#include <handhold/handhold.hpp>

namespace handhold {

// Recentrings of the play space, which a headset's runtime announces. Readings are corrected to the
// space in which the session began, so that the game never notices a recentring.
class PlaySpaceChanges {
  public:
    // From `time_ns` on, the runtime gives readings in a new space, whose pose in the previous
    // space is `new_in_old`. Ignored if the pose is not valid.
    void add(std::int64_t time_ns, const hh::Pose& new_in_old);
    // Pose of the play space at that time, in the session's first play space. A reading is
    // converted to the first play space by space_at(time_ns) * reading.
    hh::Pose space_at(std::int64_t time_ns) const;

  private:
    struct Change {
        std::int64_t time_ns = 0;
        // Play space from time_ns on, in the frame of the session's first play space.
        hh::Pose space = hh::k_origin;
    };
    std::vector<Change> changes_;  // changes in the order of their times
};

}  // namespace handhold
