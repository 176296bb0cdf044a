#include "systems/locomotion/settle_grabs.hpp"

#include <algorithm>
#include <optional>

#include "components/hand_rows.hpp"
#include "components/joint_rail.hpp"
#include "engine/solver/two_hands.hpp"

namespace handhold {
namespace {

// Where a hand was, on the way through its samples.
Pose hand_within_frame(const HandTracking& hand, const HandHistory& history, double start_s,
                       double end_s, double t) {
    struct Stop {
        double t = 0.0;
        const Pose* hand_ps = nullptr;
    };
    Stop before{0.0, &hand.start_ps};
    Stop after{1.0, &hand.pose_ps};
    const bool jumps = hand.resumed;  // it has no way
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

// Where things were at one instant within the frame, 0 its start, 1 its end.
struct Instant {
    const SettleGrabsIo& io;
    double t = 0.0;

    // Of a player his head's.
    Pose body_ws(Entity body) const {
        if (const BodyStart* const start = io.body_start.find(body)) {
            return interpolate(start->pose_ws, io.body_pose.at(body).pose_ws, t);
        }
        const HeadTracking& head = io.head.at(body);
        return led_origin_ws(body) * interpolate(head.start_ps, head.pose_ps, t);
    }
    Pose origin_ws(Entity player) const {
        return interpolate(io.player_start.at(player).pose_ws, io.origin.at(player).pose_ws, t);
    }
    // `hand` is a row of `io.hand`.
    Pose hand_ps(const HandTracking& hand) const {
        const HandHistory& history = io.hand_history.at(io.hand.owner_of(hand));
        return hand_within_frame(hand, history, io.start_s, io.end_s, t);
    }
    // Where a hand that holds on to something fixed would have its player.
    Vec3 held_origin_ws(Entity player, const Grab& grab, const HandTracking& hand) const {
        return transform_point(body_ws(grab.body), grab.anchor_bs.position) -
               origin_ws(player).rotation * hand_ps(hand).position;
    }
    // Whom hands have held on to something fixed since before the frame goes the mean of their
    // ways, and lacks all the while what he lacked at the frame's start; others go as predicted.
    Pose led_origin_ws(Entity player) const {
        const Instant start{io, 0.0};
        Pose led_ws = origin_ws(player);
        Vec3 way = Vec3::Zero();
        int hands = 0;
        for (std::size_t row = 0; row < io.grab.size(); ++row) {
            const Entity entity = io.grab.owners()[row];
            const Grab& grab = io.grab.rows()[row];
            const HandTracking& hand = io.hand.at(entity);
            if (io.owner.at(entity).player == player && grab.kind == GripKind::surface &&
                grab.phase == GrabPhase::holding && hand.edge != GrabEdge::onset && !hand.resumed) {
                way +=
                    held_origin_ws(player, grab, hand) - start.held_origin_ws(player, grab, hand);
                ++hands;
            }
        }
        if (hands > 0) {
            led_ws.position = io.player_start.at(player).pose_ws.position + way / hands;
        }
        return led_ws;
    }
};

double fraction_of(const SettleGrabsIo& io, double t_s) {
    return std::clamp((t_s - io.start_s) / (io.end_s - io.start_s), 0.0, 1.0);
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
    if (const std::size_t other = find_other_hand(io.owner, io.grab, row); other < io.grab.size()) {
        pair.other = &io.grab.rows()[other];
        pair.other_hand = &io.hand.at(io.grab.owners()[other]);
    }
    return pair;
}

// --- Bodies on joints --------------------------------------------------------------------------

// True where it has had what it holds since before the frame, and knows where it is.
bool leads_all_along(const Grab& grab, const HandTracking& hand) {
    return grab.phase != GrabPhase::none && grab.phase != GrabPhase::fresh &&
           hand.edge != GrabEdge::onset && !hand.resumed;
}

// Where a body on a joint is that hands lead: as far along the joint as they went, on average, each
// counted as the solver counts it, and off it by what it lacked at the frame's start. Any other
// body: as predicted.
Pose led_body_ws(const Instant& now, Entity body, const PhaseTuning& tuning) {
    const SettleGrabsIo& io = now.io;
    const std::optional<JointRail> rail =
        find_rail({io.body, io.joint, io.joint_state}, body, tuning);
    if (!rail) {
        return now.body_ws(body);
    }
    const Instant start{io, 0.0};
    const auto holder_ws = [&](const Instant& at) {
        return is_null(rail->holder) ? Pose{} : at.body_ws(rail->holder);
    };
    const Pose holder_start_ws = holder_ws(start);
    const Pose holder_now_ws = holder_ws(now);
    double way = 0.0;
    double weights = 0.0;
    for (std::size_t row = 0; row < io.grab.size(); ++row) {
        const Entity entity = io.grab.owners()[row];
        const HandTracking& hand = io.hand.at(entity);
        if (io.grab.rows()[row].body != body || !leads_all_along(io.grab.rows()[row], hand)) {
            continue;
        }
        const Entity player = io.owner.at(entity).player;
        const auto hand_hs = [&](const Instant& at, const Pose& at_holder_ws) {
            const Vec3 hand_ws =
                transform_point(at.led_origin_ws(player), at.hand_ps(hand).position);
            return inverse_transform_point(at_holder_ws, hand_ws);
        };
        const Vec3 from_hs = hand_hs(start, holder_start_ws);
        const double weight = weight_along(*rail, from_hs);
        way += weight * way_along(*rail, from_hs, hand_hs(now, holder_now_ws));
        weights += weight;
    }
    constexpr double k_least_weight = 1e-8;  // a tenth of a millimetre off the axle: leads nothing
    if (weights < k_least_weight) {
        return now.body_ws(body);
    }
    return holder_now_ws *
           moved_along(*rail, inverse(holder_start_ws) * start.body_ws(body), way / weights);
}

// The player's origin at an instant, who goes by a hand of his all that its body, on a joint,
// cannot go with it.
Pose origin_by_jointed(const Instant& now, Entity player, const Pose& body_ws, const Grab& grab,
                       const HandTracking& hand) {
    const Instant start{now.io, 0.0};
    const Vec3 body_way = transform_point(body_ws, grab.anchor_bs.position) -
                          transform_point(start.body_ws(grab.body), grab.anchor_bs.position);
    Pose origin_ws = now.led_origin_ws(player);
    const Vec3 hand_way =
        transform_point(origin_ws, now.hand_ps(hand).position) -
        transform_point(start.led_origin_ws(player), start.hand_ps(hand).position);
    origin_ws.position += body_way - hand_way;
    return origin_ws;
}

// The player's origin at an instant: from a hand that already holds on to something fixed, exact,
// or to something on a joint; else on the predicted way.
Pose origin_at(const Instant& now, Entity player, const Grab* holding,
               const HandTracking* holding_hand, const PhaseTuning& tuning) {
    Pose origin_ws = now.origin_ws(player);
    // A hand that was lost until now may have jumped: what it holds says nothing.
    if (holding == nullptr || holding->phase != GrabPhase::holding || holding_hand->resumed) {
        return origin_ws;
    }
    if (holding->kind == GripKind::surface) {
        const Vec3 anchor_ws =
            transform_point(now.body_ws(holding->body), holding->anchor_bs.position);
        origin_ws.position = anchor_ws - origin_ws.rotation * now.hand_ps(*holding_hand).position;
    } else if (holding->jointed && leads_all_along(*holding, *holding_hand)) {
        return origin_by_jointed(now, player, led_body_ws(now, holding->body, tuning), *holding,
                                 *holding_hand);
    }
    return origin_ws;
}

void take_anchor(const Pose& body_ws, const Pose& origin_ws, const Pose& hand_ps, Grab& grab) {
    grab.anchor_bs = inverse(body_ws) * (origin_ws * hand_ps);
}

// As at the frame's start, where everything is known exactly. A hand found again is where it is
// now.
void take_anchor_at_start(const SettleGrabsIo& io, Entity player, const HandTracking& hand,
                          Grab& grab) {
    const Instant start{io, 0.0};
    take_anchor(start.body_ws(grab.body), start.origin_ws(player),
                hand.resumed ? hand.pose_ps : hand.start_ps, grab);
}

// --- Free bodies in two hands
// --------------------------------------------------------------------------------------------

// Where the hands want a free body; `first` leads it, alone or with the other hand.
Pose wanted_body(const Instant& now, const HandPair& first) {
    const Pose origin_ws = now.led_origin_ws(first.player);
    const Pose hand_ps = now.hand_ps(first.hand);
    const Pose& anchor_bs = first.grab.anchor_bs;
    if (!first.grab.two_handed) {
        return origin_ws * (hand_ps * inverse(anchor_bs));
    }
    const TwoHands hands{hand_ps, now.hand_ps(*first.other_hand), anchor_bs,
                         first.other->anchor_bs};
    const Quat near = origin_ws.rotation.conjugate() * now.body_ws(first.grab.body).rotation;
    const Quat rotation = rotation_by_two_hands(hands, near);
    return origin_ws * Pose{hand_ps.position - rotation * anchor_bs.position, rotation};
}

// Where a free body that is held is at an instant: it follows its hands, not its velocity, and
// lacks all the while what it lacked at the frame's start. What began to hold it in this frame
// lacks nothing.
Pose held_body(const Instant& now, const HandPair& first) {
    const bool jumps = first.hand.resumed || (first.grab.two_handed && first.other_hand->resumed);
    if (jumps) {
        return now.body_ws(first.grab.body);
    }
    Pose wanted_ws = wanted_body(now, first);
    if (first.hand.edge == GrabEdge::onset) {
        return wanted_ws;
    }
    const Pose start_ws = now.io.body_start.at(first.grab.body).pose_ws;
    return wanted_ws * (inverse(wanted_body({now.io, 0.0}, first)) * start_ws);
}

HandPair swapped(const HandPair& pair) {
    return {*pair.other, *pair.other_hand, &pair.grab, &pair.hand, pair.player};
}

// Hands that led a body together and do not any more, for whatever reason: what stays starts
// afresh.
void end_broken_pairs(const SettleGrabsIo& io, StageStats& stats) {
    for (std::size_t row = 0; row < io.grab.size(); ++row) {
        const HandPair pair = pair_of(io, row);
        const bool whole = pair.other != nullptr && pair.other->two_handed &&
                           share_free_body(pair.grab, *pair.other);
        if (pair.grab.two_handed && !whole) {
            take_anchor_at_start(io, pair.player, pair.hand, pair.grab);
            pair.grab.two_handed = false;
            stats.count(Fallback::grip_reanchored);
        }
    }
}

double line_length_m(const HandPair& pair) {
    const Vec3 apart = pair.other->target_ps.position - pair.grab.target_ps.position;
    const Vec3 apart_bs = pair.other->anchor_bs.position - pair.grab.anchor_bs.position;
    return std::min(apart.norm(), apart_bs.norm());
}

// Says whether the two lead together. The second of hands that are too close holds on wherever it
// is; once they part, the line between them begins as it lies then. Nothing jumps either way.
void pair_hands(const SettleGrabsIo& io, const HandPair& first, StageStats& stats) {
    constexpr double k_begin_m = 0.05;
    constexpr double k_end_m = 0.04;
    const bool together = first.grab.two_handed;
    if (!together && first.other_hand->edge != GrabEdge::onset) {
        take_anchor_at_start(io, first.player, *first.other_hand, *first.other);
    }
    const bool lead_both = line_length_m(first) >= (together ? k_end_m : k_begin_m);
    if (together && !lead_both) {
        take_anchor_at_start(io, first.player, first.hand, first.grab);
        take_anchor_at_start(io, first.player, *first.other_hand, *first.other);
    }
    if (!lead_both) {
        stats.count(Fallback::hands_too_close);
    }
    first.grab.two_handed = lead_both;
    first.other->two_handed = lead_both;
}

void aim_at(const SettleGrabsIo& io, const Pose& target_ps, const HandTracking& hand, Grab& grab) {
    const double dt_s = io.end_s - io.start_s;
    grab.target_ps = target_ps;
    grab.target_velocity_ps_mps = (target_ps.position - hand.start_ps.position) / dt_s;
    grab.target_spin_ps_radps =
        rotation_to_vector(target_ps.rotation * hand.start_ps.rotation.conjugate()) / dt_s;
}

void aim(const SettleGrabsIo& io, const HandTracking& hand, Grab& grab) {
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
    aim_at(io, hand.pose_ps, hand, grab);
}

// The leaving hand drops its row now; the staying one starts afresh from where the pair had put the
// player (or the body).
void leave_shared_hold(const SettleGrabsIo& io, const HandPair& leaving, bool leaving_is_first,
                       const PhaseTuning& tuning) {
    Grab& staying = *leaving.other;
    const HandTracking& staying_hand = *leaving.other_hand;
    const Instant now{io, fraction_of(io, leaving.hand.edge_t_s)};
    Pose origin_ws = now.origin_ws(leaving.player);
    Pose body_ws = now.body_ws(staying.body);
    if (staying.kind == GripKind::surface) {
        const auto held_origin = [&](const Grab& grab, const Vec3& hand_ps) -> Vec3 {
            return transform_point(now.body_ws(grab.body), grab.anchor_bs.position) -
                   origin_ws.rotation * hand_ps;
        };
        const Vec3 from_staying = held_origin(staying, now.hand_ps(staying_hand).position);
        const Vec3 from_leaving = held_origin(leaving.grab, leaving.hand.edge_ps.position);
        origin_ws.position = 0.5 * (from_staying + from_leaving);
    } else if (staying.jointed && leads_all_along(staying, staying_hand) &&
               leads_all_along(leaving.grab, leaving.hand)) {
        body_ws = led_body_ws(now, staying.body, tuning);
        const Pose by_staying =
            origin_by_jointed(now, leaving.player, body_ws, staying, staying_hand);
        const Pose by_leaving =
            origin_by_jointed(now, leaving.player, body_ws, leaving.grab, leaving.hand);
        origin_ws.position = 0.5 * (by_staying.position + by_leaving.position);
    } else if (share_free_body(leaving.grab, staying)) {
        body_ws = held_body(now, leaving_is_first ? leaving : swapped(leaving));
    }
    if (staying_hand.resumed && share_free_body(leaving.grab, staying)) {
        take_anchor_at_start(io, leaving.player, staying_hand, staying);
    } else {
        take_anchor(body_ws, origin_ws, now.hand_ps(staying_hand), staying);
    }
    staying.two_handed = false;
    leaving.grab = {};
}

// A free thing that a hand has by an authored grip comes into the hand: it was authored against
// hand and controller, and a gun points where the controller does. As fast as shown palms move; in
// two hands it stays as they have it, for they say together how it lies.
void draw_into_hand(const SettleGrabsIo& io, Entity entity, const PalmTuning& tuning,
                    const HandPair& pair) {
    Grab& grab = pair.grab;
    const AuthoredHold* const hold = io.authored_hold.find(entity);
    const bool is_free = grab.kind == GripKind::held && !grab.jointed &&
                         !(pair.other != nullptr && share_free_body(grab, *pair.other));
    if (hold == nullptr || hold->body != grab.body || !is_free ||
        grab.phase != GrabPhase::holding) {
        return;
    }
    const double held_s = io.end_s - std::clamp(grab.since_s, io.start_s, io.end_s);
    grab.anchor_bs = step_towards(grab.anchor_bs, hold->hand.wrist_bs, tuning.rate_mps * held_s,
                                  tuning.tilt_cost_m_per_rad);
}

// Whose hand leads the free body that another player's closes on, or opens from; none where
// nobody's does, or those of several do: they share it by their masses, which only the solver
// knows.
std::optional<HandPair> leader_of(const SettleGrabsIo& io, const HandPair& joining) {
    std::optional<HandPair> leader;
    for (std::size_t row = 0; row < io.grab.size(); ++row) {
        const HandPair pair = pair_of(io, row);
        const bool at_once = joining.hand.edge == GrabEdge::onset &&
                             pair.hand.edge == GrabEdge::onset &&
                             pair.hand.edge_t_s >= joining.hand.edge_t_s;
        if (pair.player == joining.player || pair.grab.phase == GrabPhase::fresh || at_once ||
            !share_free_body(pair.grab, joining.grab)) {
            continue;
        }
        if (leader && leader->player != pair.player) {
            return std::nullopt;
        }
        const bool in_both = pair.other != nullptr && pair.other->phase != GrabPhase::fresh &&
                             share_free_body(pair.grab, *pair.other);
        if (!in_both ||
            is_first_hand(io.owner, io.grab, row, find_other_hand(io.owner, io.grab, row))) {
            leader.emplace(pair);
        }
    }
    return leader;
}

// What another player still has is not thrown: the hand that leaves it goes on as the body does,
// from its edge to the frame's end, and pulls at nobody. False where nobody else has it.
bool aim_along(const SettleGrabsIo& io, const HandPair& leaving) {
    const std::optional<HandPair> leader = leader_of(io, leaving);
    if (!leader || leader->grab.phase == GrabPhase::releasing) {
        return false;
    }
    const Instant edge{io, fraction_of(io, leaving.hand.edge_t_s)};
    const Instant end{io, 1.0};
    const Pose hand_ws = edge.led_origin_ws(leaving.player) * leaving.hand.edge_ps;
    const Pose way_ws = held_body(end, *leader) * inverse(held_body(edge, *leader));
    aim_at(io, inverse(end.led_origin_ws(leaving.player)) * (way_ws * hand_ws), leaving.hand,
           leaving.grab);
    return true;
}

void settle_fresh(const SettleGrabsIo& io, const HandPair& pair, const PhaseTuning& tuning) {
    if (pair.hand.edge != GrabEdge::onset) {  // it has pulled something near, and has it now
        take_anchor_at_start(io, pair.player, pair.hand, pair.grab);
        pair.grab.phase = GrabPhase::holding;
        return;
    }
    const Instant now{io, fraction_of(io, pair.hand.edge_t_s)};
    // Two that close at one instant take their anchors alike, on the predicted way: neither leads.
    const bool at_once = pair.other != nullptr && pair.other_hand->edge == GrabEdge::onset &&
                         pair.other_hand->edge_t_s == pair.hand.edge_t_s;
    const Grab* const leading = at_once ? nullptr : pair.other;
    const bool joins = leading != nullptr && leading->phase != GrabPhase::fresh &&
                       share_free_body(pair.grab, *leading);
    Pose body_ws = now.body_ws(pair.grab.body);
    if (pair.grab.jointed) {
        body_ws = led_body_ws(now, pair.grab.body, tuning);
    } else if (joins) {
        body_ws = held_body(now, swapped(pair));
    } else if (const std::optional<HandPair> leader = leader_of(io, pair)) {
        body_ws = held_body(now, *leader);
    }
    take_anchor(body_ws, origin_at(now, pair.player, leading, pair.other_hand, tuning),
                pair.hand.edge_ps, pair.grab);
    pair.grab.phase = GrabPhase::holding;
}

// The row of the new grip with the earliest edge, or the column's size: who holds first leads who
// joins, whichever is listed first.
std::size_t earliest_fresh(const SettleGrabsIo& io) {
    std::size_t earliest = io.grab.size();
    double edge_t_s = 0.0;
    for (std::size_t row = 0; row < io.grab.size(); ++row) {
        const HandTracking& hand = io.hand.at(io.grab.owners()[row]);
        if (io.grab.rows()[row].phase == GrabPhase::fresh &&
            (earliest == io.grab.size() || hand.edge_t_s < edge_t_s)) {
            earliest = row;
            edge_t_s = hand.edge_t_s;
        }
    }
    return earliest;
}

// The hand was lost and is somewhere now: it holds on there, and so does the one it led with.
void settle_resumed(const SettleGrabsIo& io, const HandPair& pair, const PhaseTuning& tuning,
                    StageStats& stats) {
    const Instant now{io, 0.0};
    if (pair.grab.two_handed) {
        take_anchor_at_start(io, pair.player, *pair.other_hand, *pair.other);
        pair.grab.two_handed = false;
        pair.other->two_handed = false;
    }
    take_anchor(now.body_ws(pair.grab.body),
                origin_at(now, pair.player, pair.other, pair.other_hand, tuning), pair.hand.pose_ps,
                pair.grab);
    stats.count(Fallback::grip_reanchored);
}

}  // namespace

void settle_grabs(const SettleGrabsIo& io, const Tuning& tuning, StageStats& stats) {
    end_broken_pairs(io, stats);
    // New grips before anything leaves.
    for (std::size_t row = earliest_fresh(io); row < io.grab.size(); row = earliest_fresh(io)) {
        settle_fresh(io, pair_of(io, row), tuning.phases);
    }
    for (std::size_t row = 0; row < io.grab.size(); ++row) {
        const HandPair pair = pair_of(io, row);
        Grab& grab = pair.grab;
        if (grab.kind == GripKind::none) {
            continue;
        }
        if (grab.phase == GrabPhase::releasing && pair.hand.resumed) {
            // It opened while nobody saw it: where it is now says nothing of how it let go.
            if (pair.other != nullptr && share_hold(grab, *pair.other)) {
                take_anchor_at_start(io, pair.player, *pair.other_hand, *pair.other);
            }
            grab = {};
            stats.count(Fallback::grip_lost);
            continue;
        }
        if (grab.phase == GrabPhase::releasing && pair.other != nullptr &&
            pair.other->phase == GrabPhase::holding && share_hold(grab, *pair.other)) {
            const std::size_t other = find_other_hand(io.owner, io.grab, row);
            leave_shared_hold(io, pair, is_first_hand(io.owner, io.grab, row, other),
                              tuning.phases);
            stats.count(Fallback::hand_left_two_hand_grip);
            continue;
        }
        if (grab.phase == GrabPhase::holding && pair.hand.resumed &&
            pair.hand.edge != GrabEdge::onset) {
            settle_resumed(io, pair, tuning.phases, stats);
        }
        draw_into_hand(io, io.grab.owners()[row], tuning.palm, pair);
        if (grab.phase != GrabPhase::releasing || !aim_along(io, pair)) {
            aim(io, pair.hand, grab);
        }
    }
    end_broken_pairs(io, stats);
    for (std::size_t row = 0; row < io.grab.size(); ++row) {
        const HandPair pair = pair_of(io, row);
        if (pair.other != nullptr && share_free_body(pair.grab, *pair.other) &&
            is_first_hand(io.owner, io.grab, row, find_other_hand(io.owner, io.grab, row))) {
            pair_hands(io, pair, stats);
        }
    }
}

}  // namespace handhold
