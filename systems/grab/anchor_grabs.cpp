#include "systems/grab/anchor_grabs.hpp"

#include <algorithm>
#include <optional>

#include "components/hand_indices.hpp"
#include "components/scaled_tuning.hpp"
#include "systems/rigs/authored_hand.hpp"

namespace handhold {
namespace {

Pose anchor_bs(const Pose& body_ws, const Pose& origin_ws, const Pose& hand_ps) {
    return inverse(body_ws) * (origin_ws * hand_ps);
}
void take_anchor(const Pose& body_ws, const Pose& origin_ws, const Pose& hand_ps, Grab& grab) {
    grab.anchor_bs = anchor_bs(body_ws, origin_ws, hand_ps);
}

// Takes a new anchor because of a tracking error: the hand's displacement is kept in slip_hs.
void slip_to(const Pose& anchor_bs, Grab& grab) {
    grab.slip_hs = inverse(anchor_bs) * (grab.anchor_bs * grab.slip_hs);
    grab.anchor_bs = anchor_bs;
}

// The hand's anchor at the start of the frame, when all poses are known exactly. For a resumed
// hand, its present pose is used.
Pose anchor_at_start_bs(const AnchorGrabsIo& io, Entity player, const HandTracking& hand,
                        const Grab& grab) {
    const GrabInstant start{io, 0.0};
    return anchor_bs(start.gripped_ws(grab), start.origin_ws(player),
                     hand.resumed ? hand.pose_ps : hand.start_ps);
}
void take_anchor_at_start(const AnchorGrabsIo& io, Entity player, const HandTracking& hand,
                          Grab& grab) {
    grab.anchor_bs = anchor_at_start_bs(io, player, hand, grab);
}

// If two hands drove a body together and one of them has left, for any reason, the one that stays
// takes a new anchor.
void end_broken_two_hand_grips(const AnchorGrabsIo& io, StageStats& stats) {
    for (std::size_t index = 0; index < io.grab.size(); ++index) {
        const HandPair pair = pair_of(io, index);
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

// Decides whether the two hands drive the body together. While they are too close, the second hand
// has no effect. Once they move apart, the line between them is taken as it is at that time, so
// that nothing jumps.
void pair_hands(const AnchorGrabsIo& io, const HandPair& first, StageStats& stats) {
    constexpr double k_begin_two_handed_m = 0.05;
    constexpr double k_end_two_handed_m = 0.04;
    const double scale = io.origin.at(first.player).scale;
    const bool together = first.grab.two_handed;
    if (!together && first.other_hand->edge != GrabEdge::onset) {
        take_anchor_at_start(io, first.player, *first.other_hand, *first.other);
    }
    const bool are_two_handed =
        line_length_m(first) >= scale * (together ? k_end_two_handed_m : k_begin_two_handed_m);
    if (together && !are_two_handed) {
        take_anchor_at_start(io, first.player, first.hand, first.grab);
        take_anchor_at_start(io, first.player, *first.other_hand, *first.other);
    }
    if (!are_two_handed) {
        stats.count(Fallback::hands_too_close);
    }
    first.grab.two_handed = are_two_handed;
    first.other->two_handed = are_two_handed;
}

void set_target_pose(const AnchorGrabsIo& io, const Pose& target_ps, const HandTracking& hand,
                     Grab& grab) {
    const double dt_s = io.end_s - io.start_s;
    grab.target_ps = target_ps;
    grab.target_velocity_ps_mps = (target_ps.position - hand.start_ps.position) / dt_s;
    grab.target_spin_ps_radps =
        rotation_to_vector(target_ps.rotation * hand.start_ps.rotation.conjugate()) / dt_s;
}

void set_target(const AnchorGrabsIo& io, const HandTracking& hand, Grab& grab) {
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
    set_target_pose(io, hand.pose_ps, hand, grab);
}

// Returns the new anchor of the hand that stays when the other of two hands that grip together
// (share_hold) lets go: the staying hand's pose relative to the body it holds, at the instant of
// release. Uses the poses that both hands together gave to the player and to a held free body.
Pose staying_anchor_bs(const AnchorGrabsIo& io, const HandPair& leaving, bool leaving_is_first,
                       const PhaseTuning& tuning) {
    const Grab& staying = *leaving.other;
    const HandTracking& staying_hand = *leaving.other_hand;
    const GrabInstant now{io, fraction_of(io, leaving.hand.edge_t_s)};
    Pose origin_ws = now.origin_ws(leaving.player);
    Pose body_ws = now.gripped_ws(staying);
    if (staying.kind == GripKind::surface) {
        const auto held_origin = [&](const Grab& grab, const Vec3& hand_ps) -> Vec3 {
            return transform_point(now.body_ws(grab.body), grab.anchor_bs.position) -
                   origin_ws.rotation * hand_ps;
        };
        const Vec3 from_staying = held_origin(staying, now.hand_ps(staying_hand).position);
        const Vec3 from_leaving = held_origin(leaving.grab, leaving.hand.edge_ps.position);
        origin_ws.position = 0.5 * (from_staying + from_leaving);
    } else if (staying.jointed && drives_whole_frame(staying, staying_hand) &&
               drives_whole_frame(leaving.grab, leaving.hand)) {
        body_ws = hand_driven_body_ws(now, staying.body, tuning);
        const Pose by_staying =
            origin_from_jointed_grab(now, leaving.player, body_ws, staying, staying_hand);
        const Pose by_leaving =
            origin_from_jointed_grab(now, leaving.player, body_ws, leaving.grab, leaving.hand);
        origin_ws.position = 0.5 * (by_staying.position + by_leaving.position);
    } else if (share_free_body(leaving.grab, staying)) {
        body_ws = held_body_ws(now, leaving_is_first ? leaving : swapped(leaving));
    }
    if (staying_hand.resumed && share_free_body(leaving.grab, staying)) {
        return anchor_at_start_bs(io, leaving.player, staying_hand, staying);
    }
    return anchor_bs(body_ws, origin_ws, now.hand_ps(staying_hand));
}

bool leaves_shared_grip(const HandPair& pair) {
    return pair.grab.phase == GrabPhase::releasing && pair.other != nullptr &&
           pair.other->phase == GrabPhase::holding && share_hold(pair.grab, *pair.other);
}

// If one of two hands that grip together (share_hold) lets go, it leaves now, and the other takes a
// new anchor. All anchors are found before any hand leaves, because hands of several players may
// drive one body.
void leave_shared_grips(const AnchorGrabsIo& io, const PhaseTuning& tuning, StageStats& stats) {
    for (std::size_t index = 0; index < io.grab.size(); ++index) {
        const HandPair pair = pair_of(io, index);
        if (leaves_shared_grip(pair)) {
            const std::size_t other = find_other_hand(io.owner, io.grab, index);
            // Stored in the leaving hand until all anchors are found; that hand no longer needs its
            // own.
            pair.grab.anchor_bs =
                staying_anchor_bs(io, pair, is_first_hand(io.owner, io.grab, index, other), tuning);
        }
    }
    for (std::size_t index = 0; index < io.grab.size(); ++index) {
        const HandPair pair = pair_of(io, index);
        if (leaves_shared_grip(pair)) {
            pair.other->anchor_bs = pair.grab.anchor_bs;
            pair.other->two_handed = false;
            pair.grab = {};
            stats.count(Fallback::two_hand_grip_ended);
        }
    }
}

// Ends grips of hands that opened while they were not tracked: their present pose says nothing
// about the release.
void drop_lost_grabs(const AnchorGrabsIo& io, StageStats& stats) {
    for (std::size_t index = 0; index < io.grab.size(); ++index) {
        const HandPair pair = pair_of(io, index);
        if (pair.grab.phase != GrabPhase::releasing || !pair.hand.resumed) {
            continue;
        }
        if (pair.other != nullptr && binds(pair.grab, *pair.other)) {
            take_anchor_at_start(io, pair.player, *pair.other_hand, *pair.other);
        }
        pair.grab = {};
        stats.count(Fallback::grip_lost);
    }
}

// If two hands on different bodies contradict each other and one of them lets go, both take a new
// anchor: the staying hand keeps what it holds as it is now, and the leaving hand still acts until
// its release in this frame.
void settle_contradictions(const AnchorGrabsIo& io, StageStats& stats) {
    for (std::size_t index = 0; index < io.grab.size(); ++index) {
        const HandPair pair = pair_of(io, index);
        if (pair.grab.phase == GrabPhase::releasing && pair.other != nullptr &&
            pair.other->phase == GrabPhase::holding && !share_hold(pair.grab, *pair.other) &&
            binds(pair.grab, *pair.other)) {
            take_anchor_at_start(io, pair.player, *pair.other_hand, *pair.other);
            take_anchor_at_start(io, pair.player, pair.hand, pair.grab);
            stats.count(Fallback::grip_reanchored);
        }
    }
}

// Moves a free body into the hand that holds it:
//  - into its authored grip, at the rate at which shown palms move. The grip is authored relative
//    to the controller, so a gun points where the controller points;
//  - else back to where the hand first held it, if tracking errors moved the hand.
// A body in two hands gets its pose from both: then only the displacement by tracking errors is
// undone.
void move_into_hand(const AnchorGrabsIo& io, Entity entity, const Tuning& tuning,
                    const HandPair& pair) {
    Grab& grab = pair.grab;
    if (grab.kind != GripKind::held || grab.jointed || grab.phase != GrabPhase::holding) {
        return;
    }
    const double held_s = io.end_s - std::clamp(grab.since_s, io.start_s, io.end_s);
    const double m_per_rad = tuning.palm.tilt_cost_m_per_rad;
    const AuthoredHold* const hold = io.authored_hold.find(entity);
    const bool is_shared = pair.other != nullptr && share_free_body(grab, *pair.other);
    if (hold != nullptr && hold->body == grab.body && !is_shared) {
        grab.anchor_bs = step_towards(grab.anchor_bs, hold->hand.wrist_bs,
                                      tuning.palm.rate_mps * held_s, m_per_rad);
        grab.slip_hs = {};
    } else if (has_slipped(grab)) {
        const Pose first_bs = grab.anchor_bs * grab.slip_hs;
        grab.slip_hs =
            step_towards(grab.slip_hs, {}, tuning.hand.return_speed_mps * held_s, m_per_rad);
        grab.anchor_bs = first_bs * inverse(grab.slip_hs);
    }
}

// The hand of another player that drives the free body which `joining` grips or releases. None if
// there is no such hand. Also none if hands of several players hold the body: its motion then
// depends on their masses, which only the solver knows.
std::optional<HandPair> leader_of(const AnchorGrabsIo& io, const HandPair& joining) {
    std::optional<HandPair> leader;
    for (std::size_t index = 0; index < io.grab.size(); ++index) {
        const HandPair pair = pair_of(io, index);
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
            is_first_hand(io.owner, io.grab, index, find_other_hand(io.owner, io.grab, index))) {
            leader.emplace(pair);
        }
    }
    return leader;
}

// A body that another player still holds is not thrown: from the instant of release to the end of
// the frame, the leaving hand moves with the body. Returns false if nobody else holds the body.
bool follow_leader(const AnchorGrabsIo& io, const HandPair& leaving) {
    const std::optional<HandPair> leader = leader_of(io, leaving);
    if (!leader || leader->grab.phase == GrabPhase::releasing) {
        return false;
    }
    const GrabInstant edge{io, fraction_of(io, leaving.hand.edge_t_s)};
    const GrabInstant end{io, 1.0};
    const Pose hand_ws = edge.hand_driven_origin_ws(leaving.player) * leaving.hand.edge_ps;
    const Pose motion_ws = held_body_ws(end, *leader) * inverse(held_body_ws(edge, *leader));
    set_target_pose(io, inverse(end.hand_driven_origin_ws(leaving.player)) * (motion_ws * hand_ws),
                    leaving.hand, leaving.grab);
    return true;
}

void anchor_new_grab(const AnchorGrabsIo& io, const HandPair& pair, const PhaseTuning& tuning) {
    // The hand closed before this frame: it grips a pulled body, obeys a host's order, or joins a
    // grip of both hands.
    if (pair.hand.edge != GrabEdge::onset) {
        take_anchor_at_start(io, pair.player, pair.hand, pair.grab);
        pair.grab.phase = GrabPhase::holding;
        return;
    }
    const GrabInstant now{io, fraction_of(io, pair.hand.edge_t_s)};
    // Two hands that close at the same instant both use predicted poses for their anchors: neither
    // hand drives the other's.
    const bool at_once = pair.other != nullptr && pair.other_hand->edge == GrabEdge::onset &&
                         pair.other_hand->edge_t_s == pair.hand.edge_t_s;
    const Grab* const leading = at_once ? nullptr : pair.other;
    const bool joins = leading != nullptr && leading->phase != GrabPhase::fresh &&
                       share_free_body(pair.grab, *leading);
    Pose body_ws = now.gripped_ws(pair.grab);
    if (pair.grab.jointed) {
        body_ws = hand_driven_body_ws(now, pair.grab.body, tuning);
    } else if (joins) {
        body_ws = held_body_ws(now, swapped(pair));
    } else if (const std::optional<HandPair> leader = leader_of(io, pair)) {
        body_ws = held_body_ws(now, *leader);
    }
    take_anchor(body_ws, origin_at(now, pair.player, leading, pair.other_hand, tuning),
                pair.hand.edge_ps, pair.grab);
    pair.grab.phase = GrabPhase::holding;
}

// Index of the new grip whose hand closed first in this frame (edge_t_s), or the column's size if
// no grip is new. The hand that closes first drives the body. Later hands join it, whatever their
// order in the column.
std::size_t earliest_new_grab(const AnchorGrabsIo& io) {
    std::size_t earliest = io.grab.size();
    double edge_t_s = 0.0;
    for (std::size_t index = 0; index < io.grab.size(); ++index) {
        const HandTracking& hand = io.hand.at(io.grab.owners()[index]);
        if (io.grab.elements()[index].phase == GrabPhase::fresh &&
            (earliest == io.grab.size() || hand.edge_t_s < edge_t_s)) {
            earliest = index;
            edge_t_s = hand.edge_t_s;
        }
    }
    return earliest;
}

// The hand may be anywhere after a tracking error: it takes a new anchor, and so does the other
// hand if the two drove a body together.
void reanchor_resumed_grab(const AnchorGrabsIo& io, const HandPair& pair, const PhaseTuning& tuning,
                           StageStats& stats) {
    const GrabInstant now{io, 0.0};
    if (pair.grab.two_handed) {
        take_anchor_at_start(io, pair.player, *pair.other_hand, *pair.other);
        pair.grab.two_handed = false;
        pair.other->two_handed = false;
    }
    slip_to(anchor_bs(now.gripped_ws(pair.grab),
                      origin_at(now, pair.player, pair.other, pair.other_hand, tuning),
                      pair.hand.pose_ps),
            pair.grab);
    stats.count(Fallback::grip_reanchored);
}

void reanchor_resumed_grabs(const AnchorGrabsIo& io, const PhaseTuning& tuning, StageStats& stats) {
    for (std::size_t index = 0; index < io.grab.size(); ++index) {
        const HandPair pair = pair_of(io, index);
        if (pair.grab.phase == GrabPhase::holding && pair.hand.resumed &&
            pair.hand.edge != GrabEdge::onset) {
            reanchor_resumed_grab(io, pair, tuning, stats);
        }
    }
}

void set_targets(const AnchorGrabsIo& io) {
    for (std::size_t index = 0; index < io.grab.size(); ++index) {
        const HandPair pair = pair_of(io, index);
        if (pair.grab.kind != GripKind::none &&
            (pair.grab.phase != GrabPhase::releasing || !follow_leader(io, pair))) {
            set_target(io, pair.hand, pair.grab);
        }
    }
}

// A hand moves what it grips, and its player, at most at max_speed_mps times the player's scale:
// the grip slips by the excess.
void limit_hand_speeds(const AnchorGrabsIo& io, double max_speed_mps, StageStats& stats) {
    for (std::size_t index = 0; index < io.grab.size(); ++index) {
        const HandPair pair = pair_of(io, index);
        const double max_m =
            io.origin.at(pair.player).scale * max_speed_mps * (io.end_s - io.start_s);
        Grab& grab = pair.grab;
        const bool closes = pair.hand.edge == GrabEdge::onset;
        const Vec3 travel_ps =
            grab.target_ps.position - (closes ? pair.hand.edge_ps : pair.hand.start_ps).position;
        if (grab.kind == GripKind::none || travel_ps.norm() <= max_m) {
            continue;
        }
        const Vec3 rest_ps = travel_ps * (1.0 - max_m / travel_ps.norm());
        const GrabInstant end{io, 1.0};
        const Vec3 rest_bs = end.gripped_ws(grab).rotation.conjugate() *
                             (end.origin_ws(pair.player).rotation * rest_ps);
        slip_to({grab.anchor_bs.position + rest_bs, grab.anchor_bs.rotation}, grab);
        stats.count(Fallback::grip_speed_limited);
    }
}

}  // namespace

void anchor_grabs(const AnchorGrabsIo& io, const Tuning& tuning, StageStats& stats) {
    TuningOfPlayers tunings(tuning);
    end_broken_two_hand_grips(io, stats);
    // Anchors new grips before it handles releases.
    for (std::size_t index = earliest_new_grab(io); index < io.grab.size();
         index = earliest_new_grab(io)) {
        anchor_new_grab(io, pair_of(io, index), tuning.phases);
    }
    drop_lost_grabs(io, stats);
    leave_shared_grips(io, tuning.phases, stats);
    settle_contradictions(io, stats);
    reanchor_resumed_grabs(io, tuning.phases, stats);
    set_targets(io);
    limit_hand_speeds(io, tuning.tracking.max_hand_speed_mps, stats);
    for (std::size_t index = 0; index < io.grab.size(); ++index) {
        const HandPair pair = pair_of(io, index);
        move_into_hand(io, io.grab.owners()[index], tunings.of(io.origin.at(pair.player)), pair);
    }
    end_broken_two_hand_grips(io, stats);
    for (std::size_t index = 0; index < io.grab.size(); ++index) {
        const HandPair pair = pair_of(io, index);
        if (pair.other != nullptr && share_free_body(pair.grab, *pair.other) &&
            is_first_hand(io.owner, io.grab, index, find_other_hand(io.owner, io.grab, index))) {
            pair_hands(io, pair, stats);
        }
    }
}

}  // namespace handhold
