// Source: dynamic follow-the-leader, Mueller, Kim and Chentanez 2012 ("Fast simulation of
// inextensible hair and fur"). Works from the top down. The correction that restores a link's
// length is added to the velocity of the link's lower joint; a share of it (SpineTuning::hand_back)
// is subtracted from the velocity of the parent's joint.
#include "systems/body/propagate_spine.hpp"

#include <algorithm>
#include <cmath>

#include "engine/anim/deflect_outward.hpp"
#include "engine/anim/joint_range.hpp"
#include "engine/anim/quadratic_path.hpp"
#include "engine/core/parallel.hpp"
#include "engine/math/scalar_rotation.hpp"
#include "systems/body/shared/fold_body.hpp"
#include "systems/body/shared/pose_spine.hpp"
#include "systems/body/shared/spine_chain.hpp"

namespace handhold {
namespace {

constexpr double k_longest_s = 0.5;

// Angle of a link at rest, measured like the angle that its joint limit bounds.
double rest_angle(const SpineLink& link) {
    return link.kind == SpineLinkKind::shin ? arc_tangent2(link.rest.z(), -link.rest.y()) : 0.0;
}

JointRange range_of(SpineLinkKind kind, const SpineTuning& tuning) {
    const double share = k_spine_tick_s / (k_spine_tick_s + tuning.limit_lag_s);
    switch (kind) {
        case SpineLinkKind::spine:
            return {0.0, tuning.spine_limit_rad, share};
        case SpineLinkKind::thigh:
            return {0.0, tuning.hip_limit_rad, share};
        case SpineLinkKind::shin:
            break;
    }
    return {0.0, tuning.knee_limit_rad, share};
}

Quat between(const Quat& a, const Quat& b, double share) {
    const double sign = a.dot(b) < 0.0 ? -1.0 : 1.0;
    const double of_b = sign * share;
    const double of_a = 1.0 - share;
    return unit_quat(of_a * a.w() + of_b * b.w(), of_a * a.x() + of_b * b.x(),
                     of_a * a.y() + of_b * b.y(), of_a * a.z() + of_b * b.z());
}

void rest_at(const Quat& chest, double scale, double t_s, SpineMemory& memory) {
    SpineChain chain{frame_at(chest), {}};
    memory.velocity_mps.fill(Vec3::Zero());
    memory.twist_rad.fill(0.0);
    memory.moved_m = Vec3::Zero();
    memory.since_tick_s = std::fmod(t_s, k_spine_tick_s);
    memory.tick_chest_ps = chest;
    memory.contacts = {};
    for (std::size_t i = 0; i < k_body_links; ++i) {
        const SpineLink& link = spine_links()[i];
        const SpineFrame& above = frame_above_link(chain, link);
        memory.offset_m[i] = link_base(above, memory.offset_m, link, scale) +
                             above.axes * ((scale * link.length_m) * link.rest);
        memory.angle_rad[i] = rest_angle(link);
        chain.links[i] = frame_at(link_frame(above.rotation, link.rest, 0.0));
    }
    memory.before_m = memory.offset_m;
}

// Passes a turn of the chest down the spine: each link first keeps its heading, then follows the
// link above with a lag.
void pass_twist(const Quat& from, const Quat& to, const SpineTuning& tuning, SpineMemory& memory) {
    const Quat turn = from.conjugate() * to;
    double passed = 2.0 * arc_tangent2(turn.w() < 0.0 ? -turn.y() : turn.y(), std::abs(turn.w()));
    const double share = k_spine_tick_s / (k_spine_tick_s + tuning.twist_lag_s);
    for (double& twist : memory.twist_rad) {
        const double wanted = twist - passed;
        const double now =
            std::clamp((1.0 - share) * wanted, -tuning.twist_limit_rad, tuning.twist_limit_rad);
        passed = now - wanted;  // this link's turn in the world, which the next link follows
        twist = now;
    }
}

// Values of a tick that do not depend on the player.
struct TickShares {
    double back;                      // share of the return to rest per tick
    double drag;                      // factor on velocities per tick
    std::array<JointRange, 3> range;  // by SpineLinkKind
};
TickShares tick_shares(const SpineTuning& tuning) {
    return {std::min(1.0, tuning.return_per_s * k_spine_tick_s),
            1.0 / (1.0 + tuning.drag_per_s * k_spine_tick_s),
            {range_of(SpineLinkKind::spine, tuning), range_of(SpineLinkKind::thigh, tuning),
             range_of(SpineLinkKind::shin, tuning)}};
}

// Applies drag, then the speed limit.
void slow_down(double drag, double speed_max_mps, BodyLinkVectors& velocity_mps) {
    for (Vec3& velocity : velocity_mps) {
        velocity *= drag;
        const double speed2 = velocity.squaredNorm();
        if (speed2 > speed_max_mps * speed_max_mps) {
            velocity *= speed_max_mps / std::sqrt(speed2);
        }
    }
}

// Returns the contact of the leg to which a link belongs; null for the spine and for a leg without
// contact.
const LegContact* contact_of(const SpineMemory& memory, std::size_t i) {
    const LegContact* const contact =
        i < k_spine_links ? nullptr : &memory.contacts[(i - k_spine_links) / 2];
    return contact != nullptr && contact->touches ? contact : nullptr;
}

// Turns a link's direction, in its parent's frame, until the link's lower end is outside the
// surface. The speed of the lower end is limited, so that a leg that starts inside a wall moves out
// without a jump.
Vec3 before_surface(const Vec3& towards, const Vec3& base_m, const SpineLink& link, double scale,
                    const SpineFrame& above, const LegContact& contact) {
    constexpr double k_out_mps = 3.0;
    const double length_m = scale * link.length_m;
    const double place_m = link.kind == SpineLinkKind::shin ? contact.ankle_m : contact.surface_m;
    const double least_m = place_m - contact.normal_ps.dot(base_m);
    return deflect_outward(towards, above.axes.transpose() * contact.normal_ps, least_m / length_m,
                           k_out_mps * k_spine_tick_s / length_m);
}

// Returns the part of a velocity correction that would move a joint away from the surface faster
// than the joint already does.
Vec3 rebound_mps(const Vec3& normal, const Vec3& velocity_mps, const Vec3& correction_mps) {
    const double before = normal.dot(velocity_mps);
    const double after = before + normal.dot(correction_mps);
    return std::max(0.0, after - std::max(0.0, before)) * normal;
}

struct Ticked {
    Quat chest;
    Vec3 moved_m;  // chest displacement since the last tick
    Vec3 ahead_m;  // chest displacement from this tick to the frame's end
};

void tick(const Ticked& now, double scale, const SpineTuning& tuning, SpineMemory& memory) {
    const Quat& chest = now.chest;
    pass_twist(memory.tick_chest_ps, chest, tuning, memory);
    memory.tick_chest_ps = chest;
    memory.before_m = memory.offset_m;
    SpineChain chain{frame_at(chest), {}};
    const TickShares shares = tick_shares(tuning);
    constexpr double k_ticks_per_s = 1.0 / k_spine_tick_s;
    for (std::size_t i = 0; i < k_body_links; ++i) {
        const SpineLink& link = spine_links()[i];
        const SpineFrame& above = frame_above_link(chain, link);
        const Vec3 base = link_base(above, memory.offset_m, link, scale);
        const Vec3 predicted =
            memory.offset_m[i] + k_spine_tick_s * memory.velocity_mps[i] - now.moved_m;
        Vec3 towards = above.axes.transpose() * (predicted - base);
        const double distance = towards.norm();
        towards = distance > 1e-6 ? Vec3(towards * (1.0 / distance)) : link.rest;
        const Vec3 blend = (1.0 - shares.back) * towards + shares.back * link.rest;
        Vec3 returned = blend * (1.0 / blend.norm());
        const LegContact* const contact = contact_of(memory, i);
        if (contact != nullptr) {
            returned = before_surface(returned, base - now.ahead_m, link, scale, above, *contact);
        }
        const JointRange& range = shares.range[static_cast<std::size_t>(link.kind)];
        const Vec3 allowed = link.kind == SpineLinkKind::shin
                                 ? clamp_to_hinge(returned, range, memory.angle_rad[i])
                                 : clamp_to_cone(returned, link.rest, range, memory.angle_rad[i]);
        memory.offset_m[i] = base + above.axes * ((scale * link.length_m) * allowed);
        // The correction includes the return to rest, so the velocity overshoots the rest pose.
        // Subtracting a share from the parent's velocity (hand_back) damps this.
        Vec3 correction_mps = (memory.offset_m[i] - predicted) * k_ticks_per_s;
        if (contact != nullptr) {
            correction_mps -=
                rebound_mps(contact->normal_ps, memory.velocity_mps[i], correction_mps);
        }
        memory.velocity_mps[i] += correction_mps;
        if (link.parent != k_chest_link) {
            // The pelvis has two thighs; each contributes half.
            const double share = link.kind == SpineLinkKind::thigh ? 0.5 : 1.0;
            memory.velocity_mps[link.parent] -= (share * tuning.hand_back) * correction_mps;
        }
        if (link.kind != SpineLinkKind::shin) {  // shins have no child link
            chain.links[i] =
                frame_at(link_frame(above.rotation, allowed, link_twist_rad(memory, i)));
        }
    }
    slow_down(shares.drag, tuning.speed_max_mps, memory.velocity_mps);
}

struct Motion {
    double dt_s;
    double t_s;  // world clock at the frame's end
    Pose chest_ps;
    Vec3 moved_m;  // chest displacement in this frame relative to the reference, play-space axes
};

void play(const Motion& motion, double scale, const SpineTuning& tuning, SpineMemory& memory) {
    const double span_s = std::min(motion.dt_s, k_longest_s);
    const QuadraticPath path(motion.moved_m, span_s, memory.rate_mps, memory.rate_span_s);
    const Quat from = memory.chest_ps.rotation;
    double played_s = 0.0;
    while (memory.since_tick_s + (span_s - played_s) >= k_spine_tick_s) {
        const double until_s = played_s + (k_spine_tick_s - memory.since_tick_s);
        const Vec3 moved_m = memory.moved_m + (path.at(until_s) - path.at(played_s));
        played_s = until_s;
        const Quat chest = between(from, motion.chest_ps.rotation, played_s / span_s);
        tick({chest, moved_m, path.at(span_s) - path.at(until_s)}, scale, tuning, memory);
        memory.moved_m = Vec3::Zero();
        memory.since_tick_s = 0.0;
    }
    memory.since_tick_s = span_s < motion.dt_s
                              ? std::fmod(motion.t_s, k_spine_tick_s)
                              : std::max(0.0, memory.since_tick_s + (span_s - played_s));
    memory.moved_m += path.at(span_s) - path.at(played_s);
    memory.rate_mps = path.rate_mps();
    memory.rate_span_s = span_s;
}

// True if this leg queries surfaces in this frame: 15 times per second of the world clock, with a
// phase that differs between players and legs.
bool queries_now(const PropagateSpineIo& io, std::uint64_t player, std::size_t side) {
    constexpr double k_queries_per_s = 15.0;
    constexpr std::uint64_t k_phases = 8;
    const double phase = static_cast<double>(player % k_phases) / static_cast<double>(k_phases) +
                         0.5 * static_cast<double>(side);
    return std::floor(io.t_s * k_queries_per_s + phase) !=
           std::floor((io.t_s - io.dt_s) * k_queries_per_s + phase);
}

// Finds the first surface on the line from the head to the sole, with the leg as at the last tick.
// The ray starts in the head because the head is outside all solids; the hips may be inside one.
LegContact find_surface_below(const PropagateSpineIo& io, Entity player, const Pose& chest_ps,
                              const Vec3& ankle_m, double scale) {
    constexpr double k_ahead_m = 0.2;  // margin for motion until the next query
    const double sole_m = 0.11 * scale;
    const Pose& origin_ws = io.origin.at(player).pose_ws;
    // A point well inside the head's collider. The eyes are near its surface, which may touch other
    // surfaces.
    const Vec3 in_head_m(0.0, 0.0, 0.08);
    const Vec3 head_ps = transform_point(io.head->at(player).pose_ps, in_head_m);
    const Vec3 path = chest_ps.position + ankle_m - head_ps;
    const double length = path.norm();
    if (!(length > sole_m)) {
        return {};
    }
    const Vec3 along = path * (1.0 / length);
    const std::array<std::uint64_t, 1> skip = {io.persistent_id->at(player).value};
    const auto hit = io.surfaces.cast_ray(
        transform_point(origin_ws, head_ps),
        transform_point(origin_ws, head_ps + (length + sole_m + k_ahead_m) * along), skip);
    if (!hit) {
        return {};
    }
    const Vec3 normal_ps = origin_ws.rotation.conjugate() * hit->normal_ws;
    const double surface_m =
        normal_ps.dot(inverse_transform_point(origin_ws, hit->point_ws) - chest_ps.position);
    return {true, normal_ps, surface_m, surface_m - sole_m * normal_ps.dot(along)};
}

// True if the contact coincides with the tracked floor. A folded leg stays above that floor anyway.
bool is_tracked_floor(const LegContact& contact, const TrackedFloor& floor) {
    constexpr double k_level_cosine = 0.9;
    constexpr double k_near_m = 0.15;
    return contact.touches && contact.normal_ps.y() > k_level_cosine &&
           std::abs(contact.surface_m / contact.normal_ps.y() + floor.chest_m) < k_near_m;
}

void touch_surfaces(const PropagateSpineIo& io, Entity player, const Motion& motion,
                    const TrackedFloor& floor, SpineMemory& memory) {
    if (!io.surfaces) {
        return;
    }
    const double scale = floor.scale;
    const double pelvis_m =
        // Height of the pelvis before folding.
        (floor.chest_m + memory.offset_m[k_spine_links - 1].y()) / scale;
    const std::uint64_t id = io.persistent_id->at(player).value;
    for (std::size_t side = 0; side < k_hand_count; ++side) {
        LegContact& contact = memory.contacts[side];
        if (queries_now(io, id, side)) {
            const Vec3& ankle_m = memory.offset_m[k_spine_links + 2 * side + 1];
            contact = find_surface_below(io, player, motion.chest_ps, ankle_m, scale);
            contact.touches =
                contact.touches && !(legs_fold(pelvis_m) && is_tracked_floor(contact, floor));
        } else {
            const double nearer_m = contact.normal_ps.dot(motion.moved_m);
            contact.surface_m -= nearer_m;
            contact.ankle_m -= nearer_m;
        }
    }
}

void propagate_player(const PropagateSpineIo& io, std::size_t row, const SpineTuning& tuning) {
    const Entity player = io.pose.owners()[row];
    SpineMemory& memory = io.memory.at(player);
    const Pose& origin_ws = io.origin.at(player).pose_ws;
    const double scale = io.measures.at(player).eye_height_m / k_scale_eye_m;
    const Pose& chest_ps = io.estimate.at(player).chest_ps;
    const double floor_m = io.head == nullptr ? 0.0 : io.head->at(player).shift_m.y();
    const TrackedFloor floor{chest_ps.position.y() - floor_m, scale};
    const Vec3& reference_ws = io.reference.at(player).linear_mps;
    const Vec3 own_m = chest_ps.position - memory.chest_ps.position;
    const Quat to_ps = origin_ws.rotation.conjugate();
    const Vec3 relative = to_ps * (io.velocity.at(player).linear_mps - reference_ws);
    if (!memory.known || is_jump(own_m.norm(), io.dt_s)) {
        rest_at(chest_ps.rotation, scale, io.t_s, memory);
        memory.known = true;
        memory.rate_mps = relative;
        memory.rate_span_s = io.dt_s;
    } else {
        // Velocities are relative to the reference velocity. When it changes, they are shifted
        // so that the absolute velocities stay the same.
        const Vec3 shift = to_ps * (memory.reference_ws_mps - reference_ws);
        for (Vec3& velocity : memory.velocity_mps) {
            velocity += shift;
        }
        memory.rate_mps += shift;
        const Motion motion{io.dt_s, io.t_s, chest_ps, own_m + io.dt_s * relative};
        touch_surfaces(io, player, motion, floor, memory);
        play(motion, scale, tuning, memory);
    }
    memory.reference_ws_mps = reference_ws;
    memory.chest_ps = chest_ps;
    pose_spine(origin_ws * chest_ps, memory, chest_ps, floor, io.pose.at(player));
}

}  // namespace

void propagate_spine(const PropagateSpineIo& io, const SpineTuning& tuning) {
    constexpr std::size_t k_players_per_slice = 4;
    const auto propagate = [&](std::size_t /*slice*/, std::size_t first, std::size_t last) {
        for (std::size_t row = first; row < last; ++row) {
            propagate_player(io, row, tuning);
        }
    };
    if (io.surfaces.any_thread()) {
        parallel_slices(io.pose.size(), k_players_per_slice, propagate);
    } else {
        propagate(0, 0, io.pose.size());
    }
}

}  // namespace handhold
