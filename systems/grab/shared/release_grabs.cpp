#include "systems/grab/shared/release_grabs.hpp"

#include <cmath>
#include <optional>

#include "components/hand_indices.hpp"
#include "components/play_space.hpp"

namespace handhold {
namespace {

// True if the gripped body or player still exists.
bool is_there(const GrabSearch& io, const Grab& grab) {
    return grab.kind == GripKind::player ? io.origin.contains(grab.body)
                                         : io.body.contains(grab.body);
}

// Index of the player's other hand, if that grips something too.
std::optional<std::size_t> partner_of(const GrabSearch& io, std::size_t index) {
    const std::size_t other = find_other_hand(io.owner, io.grab, index);
    return other < io.grab.size() && io.grab.elements()[other].kind != GripKind::none
               ? std::optional(other)
               : std::nullopt;
}

// Pose of the gripped body, head or part at the start of the frame.
Pose gripped_start_ws(const GrabSearch& io, Entity gripped, const BodyHold* hold) {
    const BodyPose* const body = io.body_pose.find(gripped);
    return body != nullptr ? body->pose_ws
                           : io.origin.at(gripped).pose_ws *
                                 (hold != nullptr ? hold->start_ps : io.head.at(gripped).start_ps);
}

// True if this hand lets go when both of a player's hands are overstretched: the one with the
// larger error; with equal errors the one that closed later; if both closed at once, the left one.
// The other hand may then reach its anchor.
bool yields_to_partner(const GrabSearch& io, std::size_t index, std::size_t partner) {
    const Grab& grab = io.grab.elements()[index];
    const Grab& other = io.grab.elements()[partner];
    constexpr double k_equal_m = 1e-6;
    const double difference = grab.error_m - other.error_m;
    if (std::abs(difference) > k_equal_m) {
        return difference > 0.0;
    }
    return grab.since_s != other.since_s
               ? grab.since_s > other.since_s
               : io.owner.at(io.grab.owners()[index]).side == HandSide::left;
}

// True if the palm is farther than `reach_m` from the gripped surface; on a player's part, from the
// surface point that was gripped.
bool is_out_of_reach(const GrabSearch& io, Entity hand, const Vec3& palm_ws, double reach_m) {
    const Grab& grab = io.grab.at(hand);
    if (const BodyHold* const hold = io.body_hold.find(hand)) {
        const Pose part_ws = gripped_start_ws(io, grab.body, hold);
        return (transform_point(part_ws, grab.hit_bs) - palm_ws).norm() > reach_m;
    }
    const auto nearest =
        io.surfaces.closest_point_on(io.persistent_id.at(grab.body).value, palm_ws);
    return nearest && (nearest->point_ws - palm_ws).norm() > reach_m && nearest->distance_m > 0.0;
}

}  // namespace

void release_grab(const GrabSearch& io, std::size_t index, Fallback reason, StageStats& stats) {
    Grab& grab = io.grab.elements()[index];
    stats.note(reason, io.grab.owners()[index], grab.body);
    if (const std::optional<std::size_t> partner = partner_of(io, index)) {
        Grab& staying = io.grab.elements()[*partner];
        const Entity hand = io.grab.owners()[*partner];
        // anchor_grabs does the same for two hands on one free body.
        if (binds(grab, staying) && !share_free_body(grab, staying) && is_there(io, staying)) {
            const Pose hand_ws =
                io.origin.at(io.owner.at(hand).player).pose_ws * io.hand.at(hand).start_ps;
            staying.anchor_bs =
                inverse(gripped_start_ws(io, staying.body, io.body_hold.find(hand))) * hand_ws;
            staying.error_m = 0.0;
            stats.count(Fallback::grip_reanchored);
        }
    }
    grab = {};
}

void release_destroyed_bodies(const GrabSearch& io, StageStats& stats) {
    for (std::size_t index = 0; index < io.grab.size(); ++index) {
        const Grab& grab = io.grab.elements()[index];
        if (grab.kind != GripKind::none && !is_there(io, grab)) {
            release_grab(io, index, Fallback::grip_body_gone, stats);
        }
    }
}

void release_overstretched_grabs(const GrabSearch& io, const HandTuning& tuning,
                                 StageStats& stats) {
    for (const bool alone : {true, false}) {
        for (std::size_t index = 0; index < io.grab.size(); ++index) {
            const Grab& grab = io.grab.elements()[index];
            const double max_stretch_m = origin_of(io, index).scale * tuning.max_stretch_m;
            if (grab.kind == GripKind::none || grab.error_m <= max_stretch_m) {
                continue;
            }
            const std::optional<std::size_t> partner = partner_of(io, index);
            if (alone != partner.has_value() && (alone || yields_to_partner(io, index, *partner))) {
                release_grab(io, index, Fallback::grip_stretched, stats);
            }
        }
    }
}

void release_grabs_out_of_reach(const GrabSearch& io, TuningOfPlayers& tunings, StageStats& stats) {
    for (std::size_t index = 0; index < io.grab.size(); ++index) {
        const Grab& grab = io.grab.elements()[index];
        const Entity entity = io.grab.owners()[index];
        const HandTracking& hand = io.hand.at(entity);
        const bool returns = grab.kind == GripKind::held && !grab.jointed;
        if (grab.kind == GripKind::none || returns || !(hand.resumed || has_slipped(grab))) {
            continue;
        }
        const HandOwner& owner = io.owner.at(entity);
        const PlayerOrigin& origin = io.origin.at(owner.player);
        const HandTuning& tuning = tunings.of(origin).hand;
        const Vec3 palm_ws = palm_ray(origin.pose_ws * hand.start_ps, owner.side, tuning).palm_ws;
        if (is_out_of_reach(io, entity, palm_ws, tuning.max_stretch_m)) {
            release_grab(io, index, Fallback::grip_out_of_reach, stats);
        }
    }
}

void release_half_held_bodies(const GrabSearch& io, StageStats& stats) {
    for (std::size_t index = 0; index < io.grab.size(); ++index) {
        const Grab& grab = io.grab.elements()[index];
        const GrabRule* const rule = io.rules.rule_of(grab.body);
        if (grab.kind == GripKind::none || grab.phase == GrabPhase::releasing || rule == nullptr ||
            !rule->two_hands) {
            continue;
        }
        const std::optional<std::size_t> partner = partner_of(io, index);
        const bool is_whole = partner && io.grab.elements()[*partner].body == grab.body &&
                              io.grab.elements()[*partner].phase != GrabPhase::releasing;
        if (!is_whole) {
            release_grab(io, index, Fallback::grip_needs_two_hands, stats);
        }
    }
}

}  // namespace handhold
