#include "systems/locomotion/settle_grabs.hpp"

#include <algorithm>

#include "components/hand_rows.hpp"

namespace handhold {
namespace {

// Where things were at one instant within the frame, 0 its start, 1 its end.
struct Instant {
    const SettleGrabsIo& io;
    double t = 0.0;

    Pose body_ws(Entity body) const {
        return interpolate(io.body_start.at(body).pose_ws, io.body_pose.at(body).pose_ws, t);
    }
    Pose origin_ws(Entity player) const {
        return interpolate(io.player_start.at(player).pose_ws, io.origin.at(player).pose_ws, t);
    }
    Pose hand_ps(const HandTracking& hand) const {
        return interpolate(hand.start_ps, hand.pose_ps, t);
    }
};

double fraction_of(const SettleGrabsIo& io, double t_s) {
    return std::clamp((t_s - io.start_s) / (io.end_s - io.start_s), 0.0, 1.0);
}

// The row of the same player's other hand, or the column's size.
std::size_t other_hand(const SettleGrabsIo& io, std::size_t row) {
    const std::size_t own = io.owner.find_row(io.grab.owners()[row]);
    const Entity player = io.owner.rows()[own].player;
    // The left hand's row comes before the right one's.
    const std::size_t beside =
        io.owner.rows()[own].side == HandSide::left ? own + 1 : own + io.owner.size() - 1;
    std::size_t other = find_hand_row(io.owner, player, beside);
    if (other == own) {
        other = find_hand_row(io.owner, player, own + 1);
    }
    const std::size_t found =
        other == own ? Column<Grab>::k_npos : io.grab.find_row(io.owner.owners()[other]);
    return found == Column<Grab>::k_npos ? io.grab.size() : found;
}

// The player's origin at an instant: from a hand that already holds on to something fixed, exact;
// else on the predicted way.
Pose origin_at(const Instant& now, Entity player, const Grab* holding,
               const HandTracking* holding_hand) {
    Pose origin_ws = now.origin_ws(player);
    // A hand that was lost until now may have jumped: what it holds says nothing.
    if (holding != nullptr && holding->kind == GripKind::surface &&
        holding->phase == GrabPhase::holding && !holding_hand->resumed) {
        const Vec3 anchor_ws =
            transform_point(now.body_ws(holding->body), holding->anchor_bs.position);
        origin_ws.position = anchor_ws - origin_ws.rotation * now.hand_ps(*holding_hand).position;
    }
    return origin_ws;
}

void take_anchor(const Instant& now, const Pose& origin_ws, const Pose& hand_ps, Grab& grab) {
    grab.anchor_bs = inverse(now.body_ws(grab.body)) * (origin_ws * hand_ps);
}

void aim(const SettleGrabsIo& io, const HandTracking& hand, Grab& grab) {
    const double dt_s = io.end_s - io.start_s;
    if (grab.phase == GrabPhase::releasing) {
        const double rest_s = std::max(0.0, io.end_s - hand.edge_t_s);
        grab.target_velocity_ps_mps = hand.release_velocity_ps_mps;
        grab.target_spin_ps_radps = hand.release_spin_ps_radps;
        grab.target_ps.position = hand.edge_ps.position + rest_s * hand.release_velocity_ps_mps;
        grab.target_ps.rotation =
            (rotation_from_vector(rest_s * hand.release_spin_ps_radps) * hand.edge_ps.rotation)
                .normalized();
        return;
    }
    grab.target_ps = hand.pose_ps;
    grab.target_velocity_ps_mps = (hand.pose_ps.position - hand.start_ps.position) / dt_s;
    grab.target_spin_ps_radps =
        rotation_to_vector(hand.pose_ps.rotation * hand.start_ps.rotation.conjugate()) / dt_s;
}

// True where the two hands hold the player, or one body, together.
bool share_hold(const Grab& a, const Grab& b) {
    const bool both_fixed = a.kind == GripKind::surface && b.kind == GripKind::surface;
    return both_fixed || (a.kind != GripKind::none && a.kind == b.kind && a.body == b.body);
}

// The leaving hand drops its row now; the staying one starts afresh from where the pair had put the
// player (or the body).
void leave_shared_hold(const SettleGrabsIo& io, Grab& leaving, const HandTracking& leaving_hand,
                       Grab& staying, const HandTracking& staying_hand, Entity player) {
    const Instant now{io, fraction_of(io, leaving_hand.edge_t_s)};
    Pose origin_ws = now.origin_ws(player);
    if (staying.kind == GripKind::surface) {
        const auto held_origin = [&](const Grab& grab, const Vec3& hand_ps) -> Vec3 {
            return transform_point(now.body_ws(grab.body), grab.anchor_bs.position) -
                   origin_ws.rotation * hand_ps;
        };
        const Vec3 from_staying = held_origin(staying, now.hand_ps(staying_hand).position);
        const Vec3 from_leaving = held_origin(leaving, leaving_hand.edge_ps.position);
        origin_ws.position = 0.5 * (from_staying + from_leaving);
    }
    take_anchor(now, origin_ws, now.hand_ps(staying_hand), staying);
    leaving = {};
}

// A grip, its hand and the same player's other ones; the other grip is null where there is no other
// hand.
struct HandPair {
    Grab& grab;
    const HandTracking& hand;
    Grab* other = nullptr;
    const HandTracking* other_hand = nullptr;
    Entity player;
};

HandPair pair_of(const SettleGrabsIo& io, std::size_t row) {
    const Entity entity = io.grab.owners()[row];
    HandPair pair{io.grab.rows()[row], io.hand.at(entity), nullptr, nullptr,
                  io.owner.at(entity).player};
    if (const std::size_t other = other_hand(io, row); other < io.grab.size()) {
        pair.other = &io.grab.rows()[other];
        pair.other_hand = &io.hand.at(io.grab.owners()[other]);
    }
    return pair;
}

void settle_fresh(const SettleGrabsIo& io, const HandPair& pair) {
    const Instant now{io, fraction_of(io, pair.hand.edge_t_s)};
    // Two that close at one instant take their anchors alike, on the predicted way: neither leads.
    const bool at_once = pair.other != nullptr && pair.other_hand->edge == GrabEdge::onset &&
                         pair.other_hand->edge_t_s == pair.hand.edge_t_s;
    const Grab* const leading = at_once ? nullptr : pair.other;
    take_anchor(now, origin_at(now, pair.player, leading, pair.other_hand), pair.hand.edge_ps,
                pair.grab);
    pair.grab.phase = GrabPhase::holding;
}

}  // namespace

void settle_grabs(const SettleGrabsIo& io, StageStats& stats) {
    // New grips before anything leaves, the earlier edge first: which hand is listed first
    // does not matter.
    for (std::size_t row = 0; row < io.grab.size(); ++row) {
        const HandPair pair = pair_of(io, row);
        if (pair.grab.phase != GrabPhase::fresh) {
            continue;
        }
        if (pair.other != nullptr && pair.other->phase == GrabPhase::fresh &&
            pair.other_hand->edge_t_s < pair.hand.edge_t_s) {
            settle_fresh(io, {*pair.other, *pair.other_hand, &pair.grab, &pair.hand, pair.player});
        }
        settle_fresh(io, pair);
    }
    for (std::size_t row = 0; row < io.grab.size(); ++row) {
        const HandPair pair = pair_of(io, row);
        Grab& grab = pair.grab;
        if (grab.kind == GripKind::none) {
            continue;
        }
        if (grab.phase == GrabPhase::releasing && pair.hand.resumed) {
            // It opened while nobody saw it: where it is now says nothing of how it let go.
            grab = {};
            stats.count(Fallback::grip_lost);
            continue;
        }
        if (grab.phase == GrabPhase::releasing && pair.other != nullptr &&
            pair.other->phase == GrabPhase::holding && share_hold(grab, *pair.other)) {
            leave_shared_hold(io, grab, pair.hand, *pair.other, *pair.other_hand, pair.player);
            stats.count(Fallback::hand_left_two_hand_grip);
            continue;
        }
        if (grab.phase == GrabPhase::holding && pair.hand.resumed &&
            pair.hand.edge != GrabEdge::onset) {
            const Instant now{io, 0.0};
            take_anchor(now, origin_at(now, pair.player, pair.other, pair.other_hand),
                        pair.hand.pose_ps, grab);
            stats.count(Fallback::grip_reanchored);
        }
        aim(io, pair.hand, grab);
    }
}

}  // namespace handhold
