#include "systems/body/pose_grippable_bodies.hpp"

#include <algorithm>
#include <array>

#include "components/scaled_tuning.hpp"
#include "systems/body/shared/memoryless_body.hpp"
#include "systems/body/shared/rest_hand.hpp"

namespace handhold {
namespace {

const Pose& head_ps(const PoseGrippableBodiesIo& io, Entity player) {
    const HeadTracking& head = io.head.at(player);
    return is_null(io.asking) ? head.start_ps : head.pose_ps;
}

// Adds the body of a player, unless it is there already.
void add_grippable_body(const PoseGrippableBodiesIo& io, Entity player, TuningOfPlayers& tunings) {
    if (io.bodies.contains(player)) {
        return;
    }
    TrackedBody body{
        head_ps(io, player), {}, io.measures.at(player), io.head.at(player).shift_m.y()};
    std::array<ArmGoal, k_hand_count> goals{};
    for (std::size_t index = 0; index < io.owner.size(); ++index) {
        const HandOwner& owner = io.owner.elements()[index];
        if (owner.player == player) {
            const Entity hand = io.owner.owners()[index];
            const HandTracking& tracking = io.hand.at(hand);
            body.hands_ps[index_of(owner.side)] =
                is_null(io.asking) ? tracking.start_ps : tracking.pose_ps;
            goals[index_of(owner.side)] = arm_goal(io.grab.at(hand), tracking);
        }
    }
    const PlayerOrigin& origin = io.origin.at(player);
    io.bodies.add(player, memoryless_body(origin, body, goals, tunings.of(origin).arm));
}

// True if the hand may begin to grip in this frame.
bool may_close(const PoseGrippableBodiesIo& io, Entity hand) {
    return hand == io.asking || io.hand.at(hand).edge == GrabEdge::onset || io.pull.contains(hand);
}

// True if the hand or its player's other hand may close: that hand may join it on a body that needs
// both.
bool may_close_or_join(const PoseGrippableBodiesIo& io, std::size_t index) {
    const Entity player = io.owner.elements()[index].player;
    for (std::size_t other = 0; other < io.owner.size(); ++other) {
        if (io.owner.elements()[other].player == player &&
            may_close(io, io.owner.owners()[other])) {
            return true;
        }
    }
    return false;
}

// True if the hand may find a part of that player in this frame. Errs on the side of true. Nobody
// knows where a player is whose head was never tracked.
bool may_reach(const PoseGrippableBodiesIo& io, std::size_t index, Entity player,
               TuningOfPlayers& tunings) {
    if (io.head.at(player).state == TrackingState::never) {
        return false;
    }
    const HandTracking& hand = io.hand.at(io.owner.owners()[index]);
    const PlayerOrigin& own = io.origin.at(io.owner.elements()[index].player);
    const PlayerOrigin& other = io.origin.at(player);
    const HandTuning& tuning = tunings.of(own).hand;
    const double reach_m = tuning.palm_center_m.norm() + tuning.ray_back_m + tuning.ray_length_m +
                           tuning.reach_m + k_grippable_eyes * io.measures.at(player).eye_height_m;
    const Vec3 head_ws = transform_point(other.pose_ws, head_ps(io, player).position);
    const std::array poses_ps = {&hand.start_ps, &hand.edge_ps, &hand.pose_ps};
    return std::ranges::any_of(poses_ps, [&](const Pose* pose_ps) {
        return (transform_point(own.pose_ws, pose_ps->position) - head_ws).norm() <= reach_m;
    });
}

}  // namespace

void pose_grippable_bodies(const PoseGrippableBodiesIo& io, const Tuning& tuning) {
    io.bodies.clear();
    if (io.origin.size() < 2) {
        return;
    }
    TuningOfPlayers tunings(tuning);
    for (const Entity hand : io.body_hold.owners()) {
        const Grab& grab = io.grab.at(hand);
        if (grab.kind == GripKind::player && io.origin.contains(grab.body)) {
            add_grippable_body(io, grab.body, tunings);
        }
    }
    for (std::size_t index = 0; index < io.owner.size(); ++index) {
        if (!may_close_or_join(io, index)) {
            continue;
        }
        for (const Entity player : io.origin.owners()) {
            if (player != io.owner.elements()[index].player &&
                may_reach(io, index, player, tunings)) {
                add_grippable_body(io, player, tunings);
            }
        }
    }
}

}  // namespace handhold
