#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "engine/solver/model/island_view.hpp"

// Load stepping: hands that jumped go their way in parts, each of which Newton's method can follow.
namespace handhold {

// Poses of the island's bodies, by slot.
void save_poses(const IslandView& island, std::vector<Pose>& poses);
void reserve_poses(const IslandView& island, std::vector<Pose>& poses);
void restore_poses(const IslandView& island, std::span<const Pose> poses);

// The hands of one island, and how far they are from what they hold where the bodies start. Keeps
// its memory.
class LoadSteppedDrives {
  public:
    // As they are at the bodies' present poses. False where there are none.
    bool take(const IslandView& island);
    // Room for such an island's, so that taking them allocates nothing.
    void reserve(const IslandView& island);
    // Puts the bodies where they were then.
    void restore_start(const IslandView& island) const { restore_poses(island, start_); }

    // Has hands ask for all but `share` of that, in [0, 1]. 0: bitwise as they were taken.
    void withhold_load(const IslandView& island, double share) const;

  private:
    struct Drive {
        std::uint32_t block = 0;  // into the graph's blocks
        Vec3 point_a_bs = Vec3::Zero();
        Quat rotation_a_bs = Quat::Identity();
        Vec3 point_error_a_bs = Vec3::Zero();  // from b's point to a's, in a's frame
        Vec3 rotation_error_a_bs =
            Vec3::Zero();  // rotation vector, radians: from b's rotation to a's
    };
    std::vector<Drive> drives_;
    std::vector<Pose> start_;  // by slot
};

}  // namespace handhold
