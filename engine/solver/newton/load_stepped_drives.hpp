// Solver, newton: load stepping. Drives that jumped move to their targets in steps that Newton's
// method can follow.

#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "engine/solver/model/island_view.hpp"

namespace handhold {

// Save, reserve and restore the poses of the island's bodies; by slot.
void save_poses(const IslandView& island, std::vector<Pose>& poses);
void reserve_poses(const IslandView& island, std::vector<Pose>& poses);
void restore_poses(const IslandView& island, std::span<const Pose> poses);

// The drives of one island, and their errors at the poses from which the solve starts. Keeps its
// memory.
class LoadSteppedDrives {
  public:
    // Records drives, errors and poses at the bodies' current poses. False if there are no drives.
    bool take(const IslandView& island);
    // Reserves memory for an island of this size, so that `take` does not allocate.
    void reserve(const IslandView& island);
    // Restores the recorded poses.
    void restore_start(const IslandView& island) const { restore_poses(island, start_); }

    // Offsets the drives' targets so that `share` in [0, 1] of the recorded error is not asked for.
    // 0: targets are bitwise as recorded.
    void withhold_load(const IslandView& island, double share) const;

  private:
    struct Drive {
        std::uint32_t block = 0;  // index into the graph's blocks
        Vec3 point_a_bs = Vec3::Zero();
        Quat rotation_a_bs = Quat::Identity();
        Vec3 point_error_a_bs = Vec3::Zero();  // p_a - p_b in a's frame
        // Rotation vector from b's frame to a's, in a's frame, radians.
        Vec3 rotation_error_a_bs = Vec3::Zero();
    };
    std::vector<Drive> drives_;
    std::vector<Pose> start_;  // indexed by slot
};

}  // namespace handhold
