#include "systems/match/shown_offsets.hpp"

namespace handhold {
namespace {

// A critically damped offset x from rest is x0 (1 + w t) exp(-w t): a twentieth at w t = 4.74.
constexpr double k_rate_per_s = 4.74 / ShownOffsets::k_shown_correction_s;

// One step of x'' = -2 w x' - w^2 x in closed form, no longer than k_most_mps allows. A truncated
// series replaces exp(-w t).
void settle(double dt_s, Vec3& offset, Vec3& rate) {
    const double x = k_rate_per_s * dt_s;
    const double decay = 1.0 / (1.0 + x + x * x / 2.0 + x * x * x / 6.0);
    const Vec3 push = rate + k_rate_per_s * offset;
    const Vec3 step = decay * (offset + dt_s * push) - offset;
    const double most_m = ShownOffsets::k_most_mps * dt_s;
    const double length_m = step.norm();
    const double share = length_m > most_m ? most_m / length_m : 1.0;
    offset += share * step;
    rate = share < 1.0 ? Vec3(step * (share / dt_s)) : Vec3(decay * (rate - x * push));
}

void add_correction(const Vec3& before, const Vec3& after, Vec3& offset) {
    offset += before - after;
    if (offset.norm() > ShownOffsets::k_most_m) {
        offset = Vec3::Zero();
    }
}

}  // namespace

void note_points(const MatchWorld& match, PointsOfAll& out) {
    const World& world = match.world;
    out = {};
    for (std::size_t slot = 0; slot < match.player_count; ++slot) {
        const Entity player = find_by_id(world, match.players[slot]);
        if (const PlayerOrigin* const origin = world.player_origin.find(player)) {
            const Vec3& head_ps = world.head_tracking.at(player).pose_ps.position;
            out[slot].head = transform_point(origin->pose_ws, head_ps);
        }
        for (std::size_t i = 0; i < world.hand_owner.size(); ++i) {
            const HandOwner& owner = world.hand_owner.elements()[i];
            if (owner.player != player) {
                continue;
            }
            const Entity hand = world.hand_owner.owners()[i];
            const Grab& grab = world.grab.at(hand);
            const BodyPose* const held =
                grab.kind != GripKind::none ? world.body_pose.find(grab.body) : nullptr;
            out[slot].hands[index_of(owner.side)] =
                held != nullptr ? transform_point(held->pose_ws, grab.anchor_bs.position)
                                : transform_point(world.player_origin.at(player).pose_ws,
                                                  world.hand_tracking.at(hand).pose_ps.position);
        }
    }
}

// A correction that turns a body moves the points where hands hold it by different amounts.
void ShownOffsets::share_held_offsets(const MatchWorld& match) {
    const World& world = match.world;
    const auto find_slot = [&](Entity player) {
        std::size_t slot = 0;
        while (slot < match.player_count && find_by_id(world, match.players[slot]) != player) {
            ++slot;
        }
        return slot;
    };
    for (std::size_t hand = 0; hand < world.grab.size(); ++hand) {
        const Grab& grab = world.grab.elements()[hand];
        if (grab.kind != GripKind::held) {
            continue;
        }
        std::size_t first = 0;
        while (world.grab.elements()[first].kind != GripKind::held ||
               world.grab.elements()[first].body != grab.body) {
            ++first;
        }
        if (first == hand) {
            continue;
        }
        const HandOwner& owner = world.hand_owner.at(world.grab.owners()[hand]);
        const HandOwner& leader = world.hand_owner.at(world.grab.owners()[first]);
        const std::size_t slot = find_slot(owner.player);
        const std::size_t leading = find_slot(leader.player);
        if (slot < match.player_count && leading < match.player_count) {
            for (PointsOfAll* const points : {&offsets_, &rates_}) {
                (*points)[slot].hands[index_of(owner.side)] =
                    (*points)[leading].hands[index_of(leader.side)];
            }
        }
    }
}

void ShownOffsets::end_correction(const MatchWorld& match) {
    note_points(match, after_);
    for (std::size_t slot = 0; slot < match.player_count; ++slot) {
        add_correction(before_[slot].head, after_[slot].head, offsets_[slot].head);
        for (std::size_t side = 0; side < k_hand_count; ++side) {
            add_correction(before_[slot].hands[side], after_[slot].hands[side],
                           offsets_[slot].hands[side]);
        }
    }
    share_held_offsets(match);
}

void ShownOffsets::advance(double dt_s) {
    for (std::size_t slot = 0; slot < offsets_.size(); ++slot) {
        settle(dt_s, offsets_[slot].head, rates_[slot].head);
        for (std::size_t side = 0; side < k_hand_count; ++side) {
            settle(dt_s, offsets_[slot].hands[side], rates_[slot].hands[side]);
        }
    }
}

}  // namespace handhold
