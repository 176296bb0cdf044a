// Solver, newton: the drives of a load-stepped island.
#include "engine/solver/newton/load_stepped_drives.hpp"

#include <algorithm>

namespace handhold {
namespace {

// Grows by at least half of the capacity: islands grow by one body at a time.
template <typename T>
void reserve(std::size_t size, std::vector<T>& values) {
    if (size > values.capacity()) {
        values.reserve(std::max(size, values.capacity() + values.capacity() / 2));
    }
}

}  // namespace

void reserve_poses(const IslandView& island, std::vector<Pose>& poses) {
    reserve(island.island_bodies.size(), poses);
}
void save_poses(const IslandView& island, std::vector<Pose>& poses) {
    poses.clear();
    for (const std::uint32_t index : island.island_bodies) {
        poses.push_back(island.bodies[index].pose_ws);
    }
}
void restore_poses(const IslandView& island, std::span<const Pose> poses) {
    for (std::size_t i = 0; i < poses.size(); ++i) {
        island.bodies[island.island_bodies[i]].pose_ws = poses[i];
    }
}

void LoadSteppedDrives::reserve(const IslandView& island) {
    reserve_poses(island, start_);
    const auto drives = std::ranges::count_if(
        island.island_blocks, [&](std::uint32_t index) { return is_drive(island.blocks[index]); });
    handhold::reserve(static_cast<std::size_t>(drives), drives_);
}

bool LoadSteppedDrives::take(const IslandView& island) {
    save_poses(island, start_);
    drives_.clear();
    for (const std::uint32_t index : island.island_blocks) {
        const RowBlock& block = island.blocks[index];
        if (!is_drive(block) || !takes_part(island, block)) {
            continue;
        }
        const Quat& a_ws = island.bodies[block.a].pose_ws.rotation;
        const Quat& b_ws = island.bodies[block.b].pose_ws.rotation;
        Drive drive{index, block.point_a_bs, block.rotation_a_bs};
        if (block.kind != RowKind::drive_direction) {
            drive.point_error_a_bs = a_ws.conjugate() * point_error(island.bodies, block);
        }
        if (block.kind != RowKind::drive_point) {
            drive.rotation_error_a_bs = a_ws.conjugate() * rotation_error(a_ws, b_ws, block);
        }
        drives_.push_back(drive);
    }
    return !drives_.empty();
}

void LoadSteppedDrives::withhold_load(const IslandView& island, double share) const {
    for (const Drive& drive : drives_) {
        RowBlock& block = island.blocks[drive.block];
        block.point_a_bs = drive.point_a_bs;
        block.rotation_a_bs = drive.rotation_a_bs;
        if (share > 0.0) {
            block.point_a_bs -= share * drive.point_error_a_bs;
            block.rotation_a_bs =
                rotation_from_vector(-share * drive.rotation_error_a_bs) * drive.rotation_a_bs;
        }
    }
}

}  // namespace handhold
