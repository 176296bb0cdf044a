#include "systems/match/drawn_poses.hpp"

#include <algorithm>

namespace handhold {
namespace {

bool jumps(const Pose& before_ws, const Pose& now_ws) {
    return (now_ws.position - before_ws.position).norm() > DrawnPoses::k_most_m ||
           rotation_to_vector(before_ws.rotation.conjugate() * now_ws.rotation).norm() >
               DrawnPoses::k_most_rad;
}

void note_player(const World& world, Entity player, const PlayerPoints& offset, DrawnPlayer& out) {
    const PlayerOrigin* const origin = world.player_origin.find(player);
    const RenderPose* const stepped = world.render_pose.find(player);
    if (origin == nullptr || stepped == nullptr) {
        out = {};
        return;
    }
    out.origin_ws = origin->pose_ws;
    out.origin_ws.position += offset.head;
    out.head_ws = stepped->head_ws;
    out.head_ws.position += offset.head;
    for (std::size_t side = 0; side < k_hand_count; ++side) {
        const RenderPose::Hand& hand = stepped->hands[side];
        out.hands[side] = {hand.shown_ws, inverse(hand.tracked_ws) * hand.shown_ws,
                           hand.grip != GripKind::none};
        out.hands[side].shown_ws.position += offset.hands[side];
    }
}

}  // namespace

void DrawnPoses::note(const MatchWorld& match, const PointsOfAll& offsets) {
    const World& world = match.world;
    ++notes_;
    Tick& now = ticks_[(notes_ - 1) % 2];
    Tick& last_shown = ticks_[notes_ % 2];
    now.tick = world.clock.frame;
    now.owners.assign(world.body_pose.owners().begin(), world.body_pose.owners().end());
    now.bodies_ws.clear();
    for (const BodyPose& body : world.body_pose.elements()) {
        now.bodies_ws.push_back(body.pose_ws);
    }
    moved_.clear();
    for (std::size_t slot = 0; slot < match.player_count; ++slot) {
        const Entity player = find_by_id(world, match.players[slot]);
        note_player(world, player, offsets[slot], now.players[slot]);
        const bool has_jumped =
            jumps(last_shown.players[slot].origin_ws, now.players[slot].origin_ws);
        for (std::size_t i = 0; i < world.grab.size(); ++i) {
            const Grab& grab = world.grab.elements()[i];
            const HandOwner& owner = world.hand_owner.at(world.grab.owners()[i]);
            const std::size_t body = grab.kind == GripKind::held && owner.player == player
                                         ? world.body_pose.find_index(grab.body)
                                         : now.bodies_ws.size();
            // All hands that hold a body have the same offset.
            if (body < now.bodies_ws.size() && std::ranges::find(moved_, body) == moved_.end()) {
                moved_.push_back(body);
                now.bodies_ws[body].position += offsets[slot].hands[index_of(owner.side)];
                if (has_jumped && is_there(last_shown, body, grab.body)) {
                    last_shown.bodies_ws[body] = now.bodies_ws[body];
                }
            }
        }
    }
}

double DrawnPoses::share_at(double before_ticks) const {
    const auto between = static_cast<double>(last().tick) - static_cast<double>(before().tick);
    return between > 0.0 ? std::clamp(1.0 - before_ticks / between, 0.0, 1.0) : 1.0;
}

DrawnPlayer DrawnPoses::player(std::size_t slot, double before_ticks) const {
    const DrawnPlayer& from = before().players[slot];
    DrawnPlayer out = last().players[slot];
    if (jumps(from.origin_ws, out.origin_ws)) {
        return out;
    }
    const double share = share_at(before_ticks);
    out.origin_ws = interpolate(from.origin_ws, out.origin_ws, share);
    out.head_ws = interpolate(from.head_ws, out.head_ws, share);
    for (std::size_t side = 0; side < k_hand_count; ++side) {
        out.hands[side].shown_ws =
            interpolate(from.hands[side].shown_ws, out.hands[side].shown_ws, share);
    }
    return out;
}

Pose DrawnPoses::body(const World& world, Entity body, const Pose& now_ws,
                      double before_ticks) const {
    const std::size_t index = world.body_pose.find_index(body);
    if (!is_there(last(), index, body)) {
        return now_ws;
    }
    const Pose& to_ws = last().bodies_ws[index];
    if (!is_there(before(), index, body) ||
        (to_ws.position - before().bodies_ws[index].position).norm() > k_most_m) {
        return to_ws;
    }
    return interpolate(before().bodies_ws[index], to_ws, share_at(before_ticks));
}

}  // namespace handhold
