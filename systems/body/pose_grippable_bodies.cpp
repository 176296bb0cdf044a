#include "systems/body/pose_grippable_bodies.hpp"

#include <algorithm>
#include <array>

#include "components/scaled_tuning.hpp"
#include "engine/core/check.hpp"
#include "engine/core/parallel.hpp"
#include "systems/body/shared/memoryless_body.hpp"
#include "systems/body/shared/rest_hand.hpp"

namespace handhold {
namespace {

const Pose& head_ps(const PoseGrippableBodiesIo& io, Entity player) {
    const HeadTracking& head = io.head.at(player);
    return is_null(io.asking) ? head.start_ps : head.pose_ps;
}

void add_body(const PoseGrippableBodiesIo& io, Entity player) {
    if (!io.bodies.contains(player)) {
        io.bodies.add(player);
    }
}

GrippableBody grippable_body(const PoseGrippableBodiesIo& io, Entity player,
                             TuningOfPlayers& tunings) {
    TrackedBody body{
        head_ps(io, player), {}, io.measures.at(player), io.head.at(player).shift_m.y()};
    const auto& hands = io.players[io.origin.find_index(player)].hands;
    std::array<ArmGoal, k_hand_count> goals{};
    for (std::size_t side = 0; side < k_hand_count; ++side) {
        if (hands[side] == io.owner.size()) {
            continue;
        }
        const Entity hand = io.owner.owners()[hands[side]];
        const HandTracking& tracking = io.hand.at(hand);
        body.hands_ps[side] = is_null(io.asking) ? tracking.start_ps : tracking.pose_ps;
        goals[side] = arm_goal(io.grab.at(hand), tracking);
    }
    const PlayerOrigin& origin = io.origin.at(player);
    return memoryless_body(origin, body, goals, tunings.of(origin).arm);
}

// True if the hand may begin to grip in this frame.
bool may_close(const PoseGrippableBodiesIo& io, Entity hand) {
    return hand == io.asking || io.hand.at(hand).edge == GrabEdge::onset || io.pull.contains(hand);
}

// Writes io.players. A player's hands close together, because one hand may join the other on a body
// that needs both.
void see_players(const PoseGrippableBodiesIo& io) {
    const std::size_t none = io.owner.size();
    io.players.clear();
    for (const Entity player : io.origin.owners()) {
        io.players.push_back(
            {.hands = {none, none},
             .closes = false,
             .head_ws = transform_point(io.origin.at(player).pose_ws, head_ps(io, player).position),
             .body_reach_m = k_grippable_eyes * io.measures.at(player).eye_height_m,
             .is_tracked = io.head.at(player).state != TrackingState::never});
    }
    for (std::size_t index = 0; index < io.owner.size(); ++index) {
        const HandOwner& owner = io.owner.elements()[index];
        const std::size_t player_index = io.origin.find_index(owner.player);
        HH_CHECK(player_index < io.players.size(), "the hand's player has no origin", index);
        GrippablePlayer& player = io.players[player_index];
        player.hands[index_of(owner.side)] = index;
        player.closes = player.closes || may_close(io, io.owner.owners()[index]);
    }
}

// Adds the bodies of other players of which the hand may find a part in this frame. Errs on the
// side of more. Nobody knows where a player is whose head was never tracked.
void add_bodies_in_reach(const PoseGrippableBodiesIo& io, std::size_t index,
                         const HandTuning& tuning) {
    const HandTracking& hand = io.hand.at(io.owner.owners()[index]);
    const Entity own = io.owner.elements()[index].player;
    const Pose& origin_ws = io.origin.at(own).pose_ws;
    const std::array points_ws = {transform_point(origin_ws, hand.start_ps.position),
                                  transform_point(origin_ws, hand.edge_ps.position),
                                  transform_point(origin_ws, hand.pose_ps.position)};
    const double hand_reach_m =
        tuning.palm_center_m.norm() + tuning.ray_back_m + tuning.ray_length_m + tuning.reach_m;
    for (std::size_t other = 0; other < io.origin.size(); ++other) {
        const GrippablePlayer& seen = io.players[other];
        const double reach_m = hand_reach_m + seen.body_reach_m;
        const bool is_near =
            seen.is_tracked && std::ranges::any_of(points_ws, [&](const Vec3& point) {
                return (point - seen.head_ws).squaredNorm() <= reach_m * reach_m;
            });
        const Entity player = io.origin.owners()[other];
        if (is_near && player != own) {
            add_body(io, player);
        }
    }
}

}  // namespace

void pose_grippable_bodies(const PoseGrippableBodiesIo& io, const Tuning& tuning) {
    io.bodies.clear();
    if (io.origin.size() < 2) {
        return;
    }
    TuningOfPlayers tunings(tuning);
    see_players(io);
    for (const Entity hand : io.body_hold.owners()) {
        const Grab& grab = io.grab.at(hand);
        if (grab.kind == GripKind::player && io.origin.contains(grab.body)) {
            add_body(io, grab.body);
        }
    }
    for (std::size_t index = 0; index < io.owner.size(); ++index) {
        const Entity own = io.owner.elements()[index].player;
        if (io.players[io.origin.find_index(own)].closes) {
            add_bodies_in_reach(io, index, tunings.of(io.origin.at(own)).hand);
        }
    }
    constexpr std::size_t k_players_per_slice = 4;
    const auto pose = [&](std::size_t /*slice*/, std::size_t first, std::size_t last) {
        TuningOfPlayers own_tunings(tuning);
        for (std::size_t index = first; index < last; ++index) {
            const Entity player = io.bodies.owners()[index];
            io.bodies.elements()[index] = grippable_body(io, player, own_tunings);
        }
    };
    parallel_slices(io.bodies.size(), k_players_per_slice, pose);
}

}  // namespace handhold
