#include "systems/grab/update_grabs.hpp"

#include <algorithm>
#include <optional>

#include "components/hand_indices.hpp"
#include "components/play_space.hpp"
#include "components/scaled_tuning.hpp"
#include "engine/core/parallel.hpp"
#include "systems/grab/shared/grab_sight.hpp"
#include "systems/grab/shared/grip_kind.hpp"
#include "systems/grab/shared/release_grabs.hpp"

namespace handhold {
namespace {

GripKind grip_kind(const UpdateGrabsIo& io, Entity gripped, const PhaseTuning& tuning) {
    const RigidBody* const body = io.body.find(gripped);
    if (body == nullptr) {
        return GripKind::player;
    }
    return grip_kind_of(*body, tuning.heavy_body_kg);
}

void ignore_for_head(HeadIgnores& ignores, Entity body, StageStats& stats) {
    if (std::find(ignores.bodies.begin(), ignores.bodies.end(), body) != ignores.bodies.end()) {
        return;
    }
    auto* place = std::find(ignores.bodies.begin(), ignores.bodies.end(), k_no_entity);
    if (place == ignores.bodies.end()) {
        stats.count(Fallback::head_ignores_full);
        place = &ignores.bodies[ignores.next];
        ignores.next = (ignores.next + 1) % HeadIgnores::k_capacity;
    }
    *place = body;
}

// True if a pulled body can be gripped: it touches the palm, or has passed it by a frame's travel.
// If it were gripped at HandTuning::reach_m already, it would stay that far away.
bool is_at_palm(const GrabTarget& target, const PalmRay& ray, double scale) {
    constexpr double k_touches_m = 0.02;
    const Vec3 offset = target.point_ws - ray.palm_ws;
    return offset.norm() <= scale * k_touches_m || offset.dot(ray.to_ws - ray.from_ws) <= 0.0;
}

// Gives the hand a BodyHold if it grips a part of a player, and removes that of an earlier grip.
const BodyHold* hold_part(const UpdateGrabsIo& io, Entity hand, const GrabTarget& target) {
    io.body_hold.remove(hand);
    if (!target.part) {
        return nullptr;
    }
    const Pose part_ps = io.bodies().part_ps(target.body, *target.part);
    return &io.body_hold.add(hand, {*target.part, part_ps, part_ps});
}

// Moves grips on players' parts along with the bodies, and removes the BodyHold of grips that
// ended.
void follow_parts(const UpdateGrabsIo& io, const HandTuning& tuning) {
    for (const Entity hand : io.grab.owners()) {
        BodyHold* const hold = io.body_hold.find(hand);
        if (hold == nullptr) {
            continue;
        }
        const Grab& grab = io.grab.at(hand);
        if (grab.kind != GripKind::player || !io.origin.contains(grab.body)) {
            io.body_hold.remove(hand);
            continue;
        }
        const double share = swings(hold->part) ? io.dt_s / (io.dt_s + tuning.swing_lag_s) : 1.0;
        hold->start_ps = hold->pose_ps;
        hold->pose_ps = follow_part(
            hold->start_ps, io.bodies().part_ps(grab.body, hold->part), grab.anchor_bs.position,
            {share, io.origin.at(grab.body).scale * tuning.part_speed_mps * io.dt_s});
    }
}

void start_grab(const UpdateGrabsIo& io, Entity hand, const GrabTarget& target, double since_s,
                Grab& grab, const Tuning& tuning, StageStats& stats) {
    ++stats.grabs_gripped;
    io.authored_hold.remove(hand);
    if (target.hold) {
        io.authored_hold.add(hand, *target.hold);
    }
    const BodyHold* const part = hold_part(io, hand, target);
    const Pose body_ws = gripped_pose_ws(io.body_pose, io.origin, io.head, target.body, part);
    grab = {};
    grab.kind = grip_kind(io, target.body, tuning.phases);
    grab.jointed =
        grab.kind == GripKind::held && io.joint_groups.is_anchored(io.body.find_index(target.body));
    grab.phase = GrabPhase::fresh;
    grab.body = target.body;
    grab.since_s = since_s;
    grab.hit_bs = inverse_transform_point(body_ws, target.point_ws);
    grab.hit_normal_bs = body_ws.rotation.conjugate() * target.normal_ws;
    if (grab.kind == GripKind::held) {
        ignore_for_head(io.head_ignores.at(io.owner.at(hand).player), grab.body, stats);
    }
}

// Tries to grip a body that needs both hands; the hand at `index` grips it at `mine`. Returns true
// if the player's other hand already holds the body, or is closed at it; in the latter case that
// hand grips the body now.
bool other_hand_joins(const UpdateGrabsIo& io, std::size_t index, const GrabTarget& mine,
                      const Tuning& tuning, StageStats& stats) {
    const std::size_t other = find_other_hand(io.owner, io.grab, index);
    if (other >= io.grab.size()) {
        return false;
    }
    const Entity entity = io.grab.owners()[other];
    const HandTracking& hand = io.hand.at(entity);
    Grab& grab = io.grab.elements()[other];
    if (grab.kind != GripKind::none || !hand.pressed || hand.state != TrackingState::tracked) {
        return grab.body == mine.body && grab.phase != GrabPhase::releasing;
    }
    const bool closes_now = hand.edge == GrabEdge::onset;
    const Pose hand_ws = io.origin.at(io.owner.at(entity).player).pose_ws *
                         (closes_now ? hand.edge_ps : hand.start_ps);
    auto target = find_grab_target(io, entity, hand_ws, k_no_entity, tuning, stats).target;
    if (!target || target->body != mine.body) {
        return false;
    }
    if (target->hold && mine.hold && target->hold->grip == mine.hold->grip) {
        target->hold.reset();  // two hands cannot use the same authored grip
    }
    const double since_s =
        closes_now ? hand.edge_t_s : io.hand.at(io.grab.owners()[index]).edge_t_s;
    start_grab(io, entity, *target, since_s, grab, tuning, stats);
    return true;
}

// True if a closing hand already grips a body for two hands, because other_hand_joins started that
// grip earlier in this frame.
bool has_joined(const UpdateGrabsIo& io, const Grab& grab, const HandTracking& hand) {
    const GrabRule* const rule = io.rules.rule_of(grab.body);
    return rule != nullptr && rule->two_hands && grab.kind != GripKind::none &&
           grab.phase == GrabPhase::fresh && grab.since_s == hand.edge_t_s;
}

// The hand if it may begin to grip in this frame.
std::optional<ClosingHand> closing_of(const UpdateGrabsIo& io, std::size_t index) {
    const Entity entity = io.grab.owners()[index];
    const HandTracking& hand = io.hand.at(entity);
    if (hand.edge == GrabEdge::onset) {
        return ClosingHand{index, hand.edge_ps, hand.edge_t_s, k_no_entity};
    }
    const HandPull* const pull = io.pull.find(entity);
    if (pull != nullptr && hand.edge == GrabEdge::none && hand.pressed &&
        hand.state == TrackingState::tracked && !hand.resumed &&
        io.grab.elements()[index].kind == GripKind::none) {
        return ClosingHand{index, hand.start_ps, pull->closed_s, pull->body};
    }
    return std::nullopt;
}

// Lists the hands that may begin to grip in io.closing, in the order of io.grab, and searches their
// surfaces. The search is the largest part of the stage and uses the grips from before any hand
// closes, so that the hands can be searched in parallel.
void search_surfaces(const UpdateGrabsIo& io, const Tuning& tuning) {
    io.closing.clear();
    for (std::size_t index = 0; index < io.grab.size(); ++index) {
        if (const auto hand = closing_of(io, index)) {
            io.closing.push_back(*hand);
        }
    }
    auto search = [&](std::size_t i) {
        TuningOfPlayers tunings(tuning);
        ClosingHand& hand = io.closing[i];
        const PlayerOrigin& origin = origin_of(io, hand.index);
        hand.surface = find_surface_target(io, io.grab.owners()[hand.index],
                                           origin.pose_ws * hand.hand_ps, tunings.of(origin));
    };
    if (io.surfaces.any_thread()) {
        parallel_for(io.closing.size(), search);
    } else {
        for (std::size_t i = 0; i < io.closing.size(); ++i) {
            search(i);
        }
    }
}

void begin_grab(const UpdateGrabsIo& io, const ClosingHand& closing, const Tuning& tuning,
                StageStats& stats) {
    const GrabSearchResult& surface = closing.surface;
    const Entity entity = io.grab.owners()[closing.index];
    const HandOwner& owner = io.owner.at(entity);
    const auto& [origin_ws, scale] = io.origin.at(owner.player);
    const Pose hand_ws = origin_ws * closing.hand_ps;
    const PalmRay ray = palm_ray(hand_ws, owner.side, tuning.hand);
    const auto snap = find_snap_target(io, entity, hand_ws, closing.only, tuning, stats);
    const auto& target = snap ? snap : surface.target;
    if (!is_null(closing.only) && (!target || target->body != closing.only ||
                                   !(target->hold || is_at_palm(*target, ray, scale)))) {
        return;  // the pulled body is not at the palm yet
    }
    io.authored_hold.remove(entity);
    if (!target) {
        stats.note(surface.refusal, entity, surface.refused_by);
        return;
    }
    const GrabRule* const rule = io.rules.rule_of(target->body);
    if (rule != nullptr && rule->two_hands &&
        !other_hand_joins(io, closing.index, *target, tuning, stats)) {
        stats.note(Fallback::grab_needs_two_hands, entity, target->body);
        return;
    }
    start_grab(io, entity, *target, closing.since_s, io.grab.elements()[closing.index], tuning,
               stats);
}

// A gripped body's kind or mass has changed so that it now moves the player, or now comes along.
// The hand takes its anchor where it is, so that nothing jumps.
void follow_changed_bodies(const UpdateGrabsIo& io, const Tuning& tuning, StageStats& stats) {
    for (std::size_t index = 0; index < io.grab.size(); ++index) {
        Grab& grab = io.grab.elements()[index];
        if (grab.phase != GrabPhase::holding || !io.body.contains(grab.body)) {
            continue;
        }
        const GripKind kind = grip_kind(io, grab.body, tuning.phases);
        if (kind == grab.kind) {
            continue;
        }
        const Entity hand = io.grab.owners()[index];
        const Entity player = io.owner.at(hand).player;
        const Pose hand_ws = io.origin.at(player).pose_ws * io.hand.at(hand).start_ps;
        grab.kind = kind;
        grab.jointed =
            kind == GripKind::held && io.joint_groups.is_anchored(io.body.find_index(grab.body));
        grab.two_handed = false;
        grab.anchor_bs = inverse(io.body_pose.at(grab.body).pose_ws) * hand_ws;
        grab.slip_hs = {};
        grab.error_m = 0.0;
        if (kind == GripKind::held) {
            ignore_for_head(io.head_ignores.at(player), grab.body, stats);
        }
    }
}

// An authored hold ends with its grip, or once a hand that may turn on its body has turned away
// from the authored pose by more than leave_angle_rad.
void update_authored_hold(const UpdateGrabsIo& io, Entity entity, const Grab& grab,
                          StageStats& stats) {
    const AuthoredHold* const hold = io.authored_hold.find(entity);
    if (hold == nullptr) {
        return;
    }
    bool stays = grab.kind != GripKind::none && grab.body == hold->body;
    const bool may_turn = grab.kind != GripKind::held || grab.jointed || grab.two_handed;
    if (stays && may_turn) {
        const Quat hand_ws = io.origin.at(io.owner.at(entity).player).pose_ws.rotation *
                             io.hand.at(entity).start_ps.rotation;
        const Quat grip_ws =
            io.body_pose.at(hold->body).pose_ws.rotation * hold->hand.wrist_bs.rotation;
        stays = rotation_to_vector((hand_ws.conjugate() * grip_ws).normalized()).norm() <=
                hold->leave_angle_rad;
        if (!stays) {
            stats.count(Fallback::authored_grip_abandoned);
        }
    }
    if (!stays) {
        io.authored_hold.remove(entity);
    }
}

void carry_out_orders(const UpdateGrabsIo& io, TuningOfPlayers& tunings, StageStats& stats) {
    while (!io.order.empty()) {
        const Entity hand = io.order.owners().front();
        const Entity body = io.order.elements().front().body;
        io.order.remove(hand);
        const std::size_t index = io.grab.find_index(hand);
        if (index >= io.grab.size()) {
            continue;  // not a hand
        }
        const bool has_body = io.body.contains(body) ||
                              (io.origin.contains(body) && body != io.owner.at(hand).player &&
                               io.head.at(body).state != TrackingState::never);
        if (io.grab.elements()[index].kind != GripKind::none) {
            release_grab(io, index, Fallback::grip_ended_by_host, stats);
            io.authored_hold.remove(hand);
        }
        if (!has_body || io.hand.at(hand).state == TrackingState::never ||
            io.hand.at(hand).edge == GrabEdge::release) {
            continue;  // a hand that opens in this frame would let go at once
        }
        const HandOwner& owner = io.owner.at(hand);
        const PlayerOrigin& origin = io.origin.at(owner.player);
        const Tuning& tuning = tunings.of(origin);
        const Pose hand_ws = origin.pose_ws * io.hand.at(hand).start_ps;
        const PalmRay ray = palm_ray(hand_ws, owner.side, tuning.hand);
        const GrabTarget target{body, ray.palm_ws, hand_ws.rotation * Vec3::UnitY(), {}};
        start_grab(io, hand, target, io.start_s, io.grab.elements()[index], tuning, stats);
    }
}

}  // namespace

void update_grabs(const UpdateGrabsIo& io, const Tuning& tuning, StageStats& stats) {
    release_destroyed_bodies(io, stats);
    follow_changed_bodies(io, tuning, stats);
    follow_parts(io, tuning.hand);
    TuningOfPlayers tunings(tuning);
    release_overstretched_grabs(io, tuning.hand, stats);
    release_grabs_out_of_reach(io, tunings, stats);
    update_sights(io, tuning);
    carry_out_orders(io, tunings, stats);
    search_surfaces(io, tuning);
    auto next = io.closing.begin();
    for (std::size_t index = 0; index < io.grab.size(); ++index) {
        Grab& grab = io.grab.elements()[index];
        const Entity entity = io.grab.owners()[index];
        const HandTracking& hand = io.hand.at(entity);
        if (grab.kind != GripKind::none && hand.edge == GrabEdge::release) {
            grab.phase = GrabPhase::releasing;
        }
        update_authored_hold(io, entity, grab, stats);
        if (next == io.closing.end() || next->index != index) {
            continue;
        }
        const ClosingHand& closing_hand = *next++;
        const bool closes_now = hand.edge == GrabEdge::onset;
        stats.grab_onsets += closes_now ? 1U : 0U;
        // A hand that joined its player's other hand in this loop grips already.
        if (closes_now ? !has_joined(io, grab, hand) : grab.kind == GripKind::none) {
            begin_grab(io, closing_hand, tunings.of(origin_of(io, index)), stats);
        }
    }
    release_half_held_bodies(io, stats);
}

}  // namespace handhold
