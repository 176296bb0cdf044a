#include "game/view/snap_hint.hpp"

#include <algorithm>

#include "systems/rigs/authored_hand.hpp"

namespace handhold {
namespace {

constexpr double k_near = 2.0;  // multiple of a zone's radius and angle where the hint begins

}  // namespace

std::optional<SnapHint> find_snap_hint(const World& world, Entity hand, const HandTuning& tuning) {
    const HandOwner& owner = world.hand_owner.at(hand);
    if (world.grab.at(hand).kind != GripKind::none) {
        return std::nullopt;
    }
    Vec3 palm_hs = tuning.palm_center_m;
    palm_hs.x() *= owner.side == HandSide::right ? 1.0 : -1.0;
    const Pose& tracked_ws =
        world.render_pose.at(owner.player).hands[index_of(owner.side)].tracked_ws;
    std::optional<SnapHint> best;
    std::int32_t best_priority = 0;
    for (std::size_t index = 0; index < world.authored_grips.size(); ++index) {
        const AuthoredGrips& grips = world.authored_grips.elements()[index];
        const Pose& body_ws = world.body_pose.at(world.authored_grips.owners()[index]).pose_ws;
        for (std::size_t i = 0; i < grips.count; ++i) {
            const AuthoredGrip& grip = grips.grips[i];
            const AuthoredHand& there = grip.hands[index_of(owner.side)];
            if (!there.is_there) {
                continue;
            }
            const Pose wrist_ws = body_ws * there.wrist_bs;
            const GripSync sync = grip_sync(tracked_ws, wrist_ws, palm_hs);
            // Distance from the grip's pose; 1 at the zone's boundary.
            const double off = std::max(sync.palm_m / std::max(grip.snap_radius_m, 1e-6),
                                        sync.turn_rad / std::max(grip.snap_angle_rad, 1e-6));
            const SnapHint hint{wrist_ws, there, 1.0 - off / k_near, off <= 1.0};
            const bool is_better =
                !best || (hint.is_within != best->is_within ? hint.is_within
                          : grip.priority != best_priority  ? grip.priority > best_priority
                                                            : hint.nearness > best->nearness);
            if (off < k_near && is_better) {
                best = hint;
                best_priority = grip.priority;
            }
        }
    }
    return best;
}

}  // namespace handhold
