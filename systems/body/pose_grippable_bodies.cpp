#include "systems/body/pose_grippable_bodies.hpp"

#include <algorithm>
#include <array>

#include "components/scaled_tuning.hpp"
#include "systems/body/shared/memoryless_body.hpp"

namespace handhold {
namespace {

// Adds the body of a player, unless it is there already or the head was never tracked.
void add_grippable_body(const PoseGrippableBodiesIo& io, Entity player, const ArmTuning& tuning) {
    const HeadTracking* const head = io.head.find(player);
    if (head == nullptr || head->state == TrackingState::never || io.bodies.contains(player)) {
        return;
    }
    const bool is_between_frames = !is_null(io.asking);
    TrackedBody body{is_between_frames ? head->pose_ps : head->start_ps,
                     {},
                     io.measures.at(player),
                     head->shift_m.y()};
    for (std::size_t index = 0; index < io.owner.size(); ++index) {
        const HandOwner& owner = io.owner.elements()[index];
        if (owner.player == player) {
            const HandTracking& hand = io.hand.at(io.owner.owners()[index]);
            body.hands_ps[index_of(owner.side)] = is_between_frames ? hand.pose_ps : hand.start_ps;
        }
    }
    io.bodies.add(player, memoryless_body(io.origin.at(player), body, tuning));
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

// True if the hand may find a part of that player in this frame. Errs on the side of true.
bool may_reach(const PoseGrippableBodiesIo& io, std::size_t index, Entity player,
               TuningOfPlayers& tunings) {
    constexpr double k_body_eyes =
        2.0;  // eye heights from the head; GrippableBodies finds no farther
    const HandTracking& hand = io.hand.at(io.owner.owners()[index]);
    const PlayerOrigin& own = io.origin.at(io.owner.elements()[index].player);
    const PlayerOrigin& other = io.origin.at(player);
    const HandTuning& tuning = tunings.of(own).hand;
    const double reach_m = tuning.palm_center_m.norm() + tuning.ray_back_m + tuning.ray_length_m +
                           tuning.reach_m + k_body_eyes * io.measures.at(player).eye_height_m;
    const Vec3 head_ws = transform_point(other.pose_ws, io.head.at(player).start_ps.position);
    const std::array poses_ps = {&hand.start_ps, &hand.edge_ps, &hand.pose_ps};
    return std::ranges::any_of(poses_ps, [&](const Pose* pose_ps) {
        return (transform_point(own.pose_ws, pose_ps->position) - head_ws).norm() <= reach_m;
    });
}

}  // namespace

void pose_grippable_bodies(const PoseGrippableBodiesIo& io, const Tuning& tuning) {
    io.bodies.clear();
    for (const Entity hand : io.body_hold.owners()) {
        const Grab& grab = io.grab.at(hand);
        if (grab.kind == GripKind::player && io.origin.contains(grab.body)) {
            add_grippable_body(io, grab.body, tuning.arm);
        }
    }
    TuningOfPlayers tunings(tuning);
    for (std::size_t index = 0; index < io.owner.size(); ++index) {
        if (io.origin.size() < 2 || !may_close_or_join(io, index)) {
            continue;
        }
        for (const Entity player : io.origin.owners()) {
            if (player != io.owner.elements()[index].player &&
                may_reach(io, index, player, tunings)) {
                add_grippable_body(io, player, tuning.arm);
            }
        }
    }
}

}  // namespace handhold
