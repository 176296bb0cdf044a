#include "engine/solver/newton/load_stepped_drives.hpp"

#include <algorithm>

namespace handhold {
namespace {

// By no less than half of what there is: islands grow by a body at a time.
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
void keep_poses(const IslandView& island, std::vector<Pose>& poses) {
    poses.clear();
    for (const std::uint32_t index : island.island_bodies) {
        poses.push_back(island.bodies[index].pose_ws);
    }
}
void put_back(const IslandView& island, std::span<const Pose> poses) {
    for (std::size_t i = 0; i < poses.size(); ++i) {
        island.bodies[island.island_bodies[i]].pose_ws = poses[i];
    }
}

void LedHands::reserve(const IslandView& island) {
    reserve_poses(island, start_);
    const auto hands = std::ranges::count_if(
        island.island_blocks, [&](std::uint32_t index) { return is_hand(island.blocks[index]); });
    handhold::reserve(static_cast<std::size_t>(hands), hands_);
}

bool LedHands::take(const IslandView& island) {
    keep_poses(island, start_);
    hands_.clear();
    for (const std::uint32_t index : island.island_blocks) {
        const RowBlock& block = island.blocks[index];
        if (!is_hand(block) || !takes_part(island, block)) {
            continue;
        }
        const Quat& a_ws = island.bodies[block.a].pose_ws.rotation;
        const Quat& b_ws = island.bodies[block.b].pose_ws.rotation;
        Hand hand{index, block.point_a_bs, block.rotation_a_bs};
        if (block.kind != RowKind::hand_direction) {
            hand.lack_a_bs = a_ws.conjugate() * point_error(island.bodies, block);
        }
        if (block.kind != RowKind::hand_point) {
            hand.turn_a_bs = a_ws.conjugate() * rotation_error(a_ws, b_ws, block);
        }
        hands_.push_back(hand);
    }
    return !hands_.empty();
}

void LedHands::hold_back(const IslandView& island, double share) const {
    for (const Hand& hand : hands_) {
        RowBlock& block = island.blocks[hand.block];
        block.point_a_bs = hand.point_a_bs;
        block.rotation_a_bs = hand.rotation_a_bs;
        if (share > 0.0) {
            block.point_a_bs -= share * hand.lack_a_bs;
            block.rotation_a_bs =
                rotation_from_vector(-share * hand.turn_a_bs) * hand.rotation_a_bs;
        }
    }
}

}  // namespace handhold
