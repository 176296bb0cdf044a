#include "systems/grab/pull_bodies.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "components/play_space.hpp"
#include "components/scaled_tuning.hpp"

namespace handhold {
namespace {

// A pull ends at this distance, as a multiple of the reach.
constexpr double k_lost_ratio = 1.5;

PalmRay ray_of(const PullBodiesIo& io, Entity hand, const Pose& hand_ps, const HandTuning& tuning) {
    const HandOwner& owner = io.owner.at(hand);
    return palm_ray(io.origin.at(owner.player).pose_ws * hand_ps, owner.side, tuning);
}

// True if any hand grips the body, or another hand pulls it.
bool is_taken(const PullBodiesIo& io, Entity hand, Entity body) {
    for (std::size_t index = 0; index < io.grab.size(); ++index) {
        const Grab& grab = io.grab.elements()[index];
        if (grab.kind != GripKind::none && grab.body == body) {
            return true;
        }
    }
    for (std::size_t index = 0; index < io.pull.size(); ++index) {
        if (io.pull.owners()[index] != hand && io.pull.elements()[index].body == body) {
            return true;
        }
    }
    return false;
}

bool is_jointed(const PullBodiesIo& io, std::size_t body_index) {
    if (io.joint_groups.is_anchored(body_index)) {
        return true;
    }
    for (std::size_t index = 0; index < io.body.size(); ++index) {
        if (index != body_index && io.joint_groups.share_group(index, body_index)) {
            return true;
        }
    }
    return false;
}

// Why this hand may not pull the body; none if it may.
std::optional<Fallback> refusal_reason(const PullBodiesIo& io, Entity hand, Entity pulled,
                                       const PullTuning& tuning) {
    const RigidBody& body = io.body.at(pulled);
    if (body.kind != BodyKind::free || is_jointed(io, io.body.find_index(pulled))) {
        return Fallback::pull_refused_fixed;
    }
    if (body.mass_kg > tuning.max_mass_kg) {
        return Fallback::pull_refused_heavy;
    }
    const GrabRule* const rule = io.rules.rule_of(pulled);
    if (!io.rules.allow(io.owner.at(hand), pulled) || (rule != nullptr && rule->two_hands)) {
        return Fallback::grab_refused_by_rule;
    }
    if (is_taken(io, hand, pulled)) {
        return Fallback::pull_refused_held;
    }
    return std::nullopt;
}

Entity body_of_id(const PullBodiesIo& io, std::uint64_t id) {
    const auto owners = io.body.owners();
    const auto found = std::ranges::find_if(
        owners, [&](Entity entity) { return io.persistent_id.at(entity).value == id; });
    return found != owners.end() ? *found : k_no_entity;
}

// The body that the palm points at. Null if there is none, or if it may not be pulled, which is
// counted.
Entity find_pullable_body(const PullBodiesIo& io, Entity hand, const Tuning& tuning,
                          StageStats& stats) {
    const PalmRay ray = ray_of(io, hand, io.hand.at(hand).edge_ps, tuning.hand);
    const Vec3 along = (ray.to_ws - ray.from_ws).normalized();
    const std::array own_head = {io.persistent_id.at(io.owner.at(hand).player).value};
    const auto hit = io.surfaces.cast_sphere(tuning.pull.radius_m, ray.palm_ws,
                                             ray.palm_ws + tuning.pull.reach_m * along, own_head);
    const Entity found = hit ? body_of_id(io, hit->id) : k_no_entity;
    if (is_null(found)) {
        return k_no_entity;
    }
    if (const auto reason = refusal_reason(io, hand, found, tuning.pull)) {
        stats.count(*reason);
        return k_no_entity;
    }
    return found;
}

// Offset from the body's nearest surface point to the palm; from its centre if it has no surface.
// The centre is not used otherwise: a hand cannot grip the middle of a ring, and the centre of a
// long pole may be far away.
Vec3 offset_to_palm(const PullBodiesIo& io, Entity pulled, const Vec3& palm_ws) {
    const auto near = io.surfaces.closest_point_on(io.persistent_id.at(pulled).value, palm_ws);
    return palm_ws - (near ? near->point_ws : io.body_pose.at(pulled).pose_ws.position);
}

// Returns false if the pull ends. Counts a fallback unless the player opened the hand.
bool can_continue(const PullBodiesIo& io, Entity hand, const HandPull& pull, const Tuning& tuning,
                  StageStats& stats) {
    const HandTracking& tracking = io.hand.at(hand);
    if (!tracking.pressed || io.grab.at(hand).kind != GripKind::none) {
        return false;
    }
    const bool is_there = io.body_pose.find(pull.body) != nullptr;
    const Vec3 palm_ws = ray_of(io, hand, tracking.start_ps, tuning.hand).palm_ws;
    const bool is_seen = tracking.state == TrackingState::tracked && !tracking.resumed;
    const bool may_go_on = is_there && is_seen &&
                           !refusal_reason(io, hand, pull.body, tuning.pull) &&
                           offset_to_palm(io, pull.body, palm_ws).norm() <=
                               k_lost_ratio * tuning.pull.reach_m + tuning.hand.reach_m;
    if (!may_go_on) {
        stats.count(Fallback::pull_lost);
    }
    return may_go_on;
}

// Applies one frame's pull: an impulse on the body, and its opposite on the player.
void apply_pull(const PullBodiesIo& io, Entity hand, Entity pulled, const Tuning& tuning) {
    const Entity player = io.owner.at(hand).player;
    const HandTracking& tracking = io.hand.at(hand);
    const Vec3 palm_ws = ray_of(io, hand, tracking.start_ps, tuning.hand).palm_ws;
    const Vec3 palm_end_ws = ray_of(io, hand, tracking.pose_ps, tuning.hand).palm_ws;
    Vec3& player_mps = io.player_velocity.at(player).linear_mps;
    Vec3& body_mps = io.body_velocity.at(pulled).linear_mps;
    const Vec3 offset = offset_to_palm(io, pulled, palm_ws);
    const double distance_m = std::max(offset.norm(), 1e-6);
    const double body_kg = io.body.at(pulled).mass_kg;
    const double player_kg = io.player.at(player).mass_kg;
    const double reduced_kg = body_kg * player_kg / (body_kg + player_kg);
    // v^2 = 2 (F/2) / m d: half of the force can stop the body within the remaining distance.
    const double stoppable_mps = std::sqrt(tuning.pull.force_n / reduced_kg * distance_m);
    const double speed_mps = std::min(tuning.pull.speed_mps, stoppable_mps);
    const Vec3 palm_mps = player_mps + (palm_end_ws - palm_ws) / io.dt_s;
    Vec3 impulse = reduced_kg * (offset * (speed_mps / distance_m) - (body_mps - palm_mps));
    const double max_ns = tuning.pull.force_n * io.dt_s;
    if (impulse.norm() > max_ns) {
        impulse *= max_ns / impulse.norm();
    }
    body_mps += impulse / body_kg;
    player_mps -= impulse / player_kg;
}

}  // namespace

void pull_bodies(const PullBodiesIo& io, const Tuning& of_all, StageStats& stats) {
    if (of_all.pull.reach_m <= 0.0) {
        io.pull.clear();
        return;
    }
    TuningOfPlayers tunings(of_all);
    for (std::size_t index = 0; index < io.grab.size(); ++index) {
        const Entity hand = io.grab.owners()[index];
        const Tuning& tuning = tunings.of(io.origin.at(io.owner.at(hand).player));
        const HandTracking& tracking = io.hand.at(hand);
        const HandPull* const pull = io.pull.find(hand);
        if (pull != nullptr &&
            (tracking.edge != GrabEdge::none || !can_continue(io, hand, *pull, tuning, stats))) {
            io.pull.remove(hand);
        }
        if (tracking.edge == GrabEdge::onset && io.grab.elements()[index].kind == GripKind::none &&
            io.sight.at(hand).is_clear) {
            const Entity loose = find_pullable_body(io, hand, tuning, stats);
            if (!is_null(loose)) {
                io.pull.add(hand, {loose, tracking.edge_t_s});
            }
        }
        if (const HandPull* const now = io.pull.find(hand)) {
            apply_pull(io, hand, now->body, tuning);
        }
    }
}

}  // namespace handhold
