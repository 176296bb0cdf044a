#include "systems/grab/shared/grab_instant.hpp"

#include <algorithm>
#include <optional>

#include "components/hand_indices.hpp"
#include "engine/solver/model/drive_pair.hpp"
#include "systems/grab/shared/joint_rail.hpp"

namespace handhold {
namespace {

// The hand at fraction t of the frame, interpolated between its samples.
Pose hand_within_frame(const HandTracking& hand, const HandHistory& history, double start_s,
                       double end_s, double t) {
    struct Knot {
        double t = 0.0;
        const Pose* hand_ps = nullptr;
    };
    Knot before{0.0, &hand.start_ps};
    Knot after{1.0, &hand.pose_ps};
    const bool jumps = hand.resumed;  // true: the hand did not travel
    for (std::uint32_t i = 0; i < history.count && !jumps; ++i) {
        const HandHistory::Entry& entry = history.entries[i];
        const double at = (entry.t_s - start_s) / (end_s - start_s);
        if (at > before.t && at <= t && at < 1.0) {
            before = {at, &entry.hand_ps};
        } else if (at > t && at < after.t) {
            after = {at, &entry.hand_ps};
        }
    }
    return interpolate(*before.hand_ps, *after.hand_ps, (t - before.t) / (after.t - before.t));
}

// Pose that its hands ask of a free body. `first` drives it, alone or together with the other hand.
Pose target_body(const GrabInstant& now, const HandPair& first) {
    const Pose origin_ws = now.hand_driven_origin_ws(first.player);
    const Pose hand_ps = now.hand_ps(first.hand);
    const Pose& anchor_bs = first.grab.anchor_bs;
    if (!first.grab.two_handed) {
        return origin_ws * (hand_ps * inverse(anchor_bs));
    }
    const DrivePair hands{hand_ps, now.hand_ps(*first.other_hand), anchor_bs,
                          first.other->anchor_bs};
    const Quat near = origin_ws.rotation.conjugate() * now.body_ws(first.grab.body).rotation;
    const Quat rotation = rotation_from_drive_pair(hands, near);
    return origin_ws * Pose{hand_ps.position - rotation * anchor_bs.position, rotation};
}

}  // namespace

Pose GrabInstant::body_ws(Entity body) const {
    if (const BodyStart* const start = io.body_start.find(body)) {
        return interpolate(start->pose_ws, io.body_pose.at(body).pose_ws, t);
    }
    const HeadTracking& head = io.head.at(body);
    return hand_driven_origin_ws(body) * interpolate(head.start_ps, head.pose_ps, t);
}

Pose GrabInstant::gripped_ws(const Grab& grab) const {
    const BodyHold* const hold = io.body_hold.find(io.grab.owner_of(grab));
    if (hold == nullptr || grab.kind != GripKind::player) {
        return body_ws(grab.body);
    }
    return hand_driven_origin_ws(grab.body) * interpolate(hold->start_ps, hold->pose_ps, t);
}

Pose GrabInstant::origin_ws(Entity player) const {
    return interpolate(io.player_start.at(player).pose_ws, io.origin.at(player).pose_ws, t);
}

Pose GrabInstant::hand_ps(const HandTracking& hand) const {
    const HandHistory& history = io.hand_history.at(io.hand.owner_of(hand));
    return hand_within_frame(hand, history, io.start_s, io.end_s, t);
}

Vec3 GrabInstant::held_origin_ws(Entity player, const Grab& grab, const HandTracking& hand) const {
    return transform_point(body_ws(grab.body), grab.anchor_bs.position) -
           origin_ws(player).rotation * hand_ps(hand).position;
}

Pose GrabInstant::hand_driven_origin_ws(Entity player) const {
    const GrabInstant start{io, 0.0};
    Pose hand_driven_ws = origin_ws(player);
    Vec3 travel = Vec3::Zero();
    int hands = 0;
    for (std::size_t index = 0; index < io.grab.size(); ++index) {
        const Entity entity = io.grab.owners()[index];
        const Grab& grab = io.grab.elements()[index];
        const HandTracking& hand = io.hand.at(entity);
        if (io.owner.at(entity).player == player && grab.kind == GripKind::surface &&
            grab.phase == GrabPhase::holding && hand.edge != GrabEdge::onset && !hand.resumed) {
            travel += held_origin_ws(player, grab, hand) - start.held_origin_ws(player, grab, hand);
            ++hands;
        }
    }
    if (hands > 0) {
        hand_driven_ws.position = io.player_start.at(player).pose_ws.position + travel / hands;
    }
    return hand_driven_ws;
}

double fraction_of(const GrabFrame& io, double t_s) {
    return std::clamp((t_s - io.start_s) / (io.end_s - io.start_s), 0.0, 1.0);
}

HandPair pair_of(const GrabFrame& io, std::size_t index) {
    const Entity entity = io.grab.owners()[index];
    HandPair pair{io.grab.elements()[index], io.hand.at(entity), nullptr, nullptr,
                  io.owner.at(entity).player};
    if (const std::size_t other = find_other_hand(io.owner, io.grab, index);
        other < io.grab.size()) {
        pair.other = &io.grab.elements()[other];
        pair.other_hand = &io.hand.at(io.grab.owners()[other]);
    }
    return pair;
}

HandPair swapped(const HandPair& pair) {
    return {*pair.other, *pair.other_hand, &pair.grab, &pair.hand, pair.player};
}

bool drives_whole_frame(const Grab& grab, const HandTracking& hand) {
    return grab.phase != GrabPhase::none && grab.phase != GrabPhase::fresh &&
           hand.edge != GrabEdge::onset && !hand.resumed;
}

Pose hand_driven_body_ws(const GrabInstant& now, Entity body, const PhaseTuning& tuning) {
    const GrabFrame& io = now.io;
    const std::optional<JointRail> rail = find_rail(
        {.body = io.body, .joint = io.joint, .joint_state = io.joint_state}, body, tuning);
    if (!rail) {
        return now.body_ws(body);
    }
    const GrabInstant start{io, 0.0};
    const auto holder_ws = [&](const GrabInstant& at) {
        return is_null(rail->holder) ? Pose{} : at.body_ws(rail->holder);
    };
    const Pose holder_start_ws = holder_ws(start);
    const Pose holder_now_ws = holder_ws(now);
    double travel = 0.0;
    double weights = 0.0;
    for (std::size_t index = 0; index < io.grab.size(); ++index) {
        const Entity entity = io.grab.owners()[index];
        const HandTracking& hand = io.hand.at(entity);
        if (io.grab.elements()[index].body != body ||
            !drives_whole_frame(io.grab.elements()[index], hand)) {
            continue;
        }
        const Entity player = io.owner.at(entity).player;
        const auto hand_hs = [&](const GrabInstant& at, const Pose& at_holder_ws) {
            const Vec3 hand_ws =
                transform_point(at.hand_driven_origin_ws(player), at.hand_ps(hand).position);
            return inverse_transform_point(at_holder_ws, hand_ws);
        };
        const Vec3 from_hs = hand_hs(start, holder_start_ws);
        const double weight = weight_along(*rail, from_hs);
        travel += weight * travel_along(*rail, from_hs, hand_hs(now, holder_now_ws));
        weights += weight;
    }
    constexpr double k_min_weight = 1e-8;  // 0.1 mm off the axis: moves nothing
    if (weights < k_min_weight) {
        return now.body_ws(body);
    }
    return holder_now_ws *
           moved_along(*rail, inverse(holder_start_ws) * start.body_ws(body), travel / weights);
}

Pose origin_from_jointed_grab(const GrabInstant& now, Entity player, const Pose& body_ws,
                              const Grab& grab, const HandTracking& hand) {
    const GrabInstant start{now.io, 0.0};
    const Vec3 body_travel = transform_point(body_ws, grab.anchor_bs.position) -
                             transform_point(start.body_ws(grab.body), grab.anchor_bs.position);
    Pose origin_ws = now.hand_driven_origin_ws(player);
    const Vec3 hand_travel =
        transform_point(origin_ws, now.hand_ps(hand).position) -
        transform_point(start.hand_driven_origin_ws(player), start.hand_ps(hand).position);
    origin_ws.position += body_travel - hand_travel;
    return origin_ws;
}

Pose origin_at(const GrabInstant& now, Entity player, const Grab* holding,
               const HandTracking* holding_hand, const PhaseTuning& tuning) {
    Pose origin_ws = now.origin_ws(player);
    // The grip of a resumed hand is not used, because the hand may have jumped.
    if (holding == nullptr || holding->phase != GrabPhase::holding || holding_hand->resumed) {
        return origin_ws;
    }
    if (holding->kind == GripKind::surface) {
        const Vec3 anchor_ws =
            transform_point(now.body_ws(holding->body), holding->anchor_bs.position);
        origin_ws.position = anchor_ws - origin_ws.rotation * now.hand_ps(*holding_hand).position;
    } else if (holding->jointed && drives_whole_frame(*holding, *holding_hand)) {
        return origin_from_jointed_grab(
            now, player, hand_driven_body_ws(now, holding->body, tuning), *holding, *holding_hand);
    }
    return origin_ws;
}

Pose held_body_ws(const GrabInstant& now, const HandPair& first) {
    const bool jumps = first.hand.resumed || (first.grab.two_handed && first.other_hand->resumed);
    if (jumps) {
        return now.body_ws(first.grab.body);
    }
    Pose target_ws = target_body(now, first);
    if (first.hand.edge == GrabEdge::onset) {
        return target_ws;
    }
    const Pose start_ws = now.io.body_start.at(first.grab.body).pose_ws;
    return target_ws * (inverse(target_body({now.io, 0.0}, first)) * start_ws);
}

}  // namespace handhold
