// Source: dynamic follow-the-leader, Mueller, Kim and Chentanez 2012 ("Fast simulation of
// inextensible hair and fur"). Works from the top down. The correction that restores a link's
// length is added to the velocity of the link's lower joint; a share of it (SpineTuning::hand_back)
// is subtracted from the velocity of the parent's joint.
#include "systems/body/propagate_spine.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "engine/anim/deflect_outward.hpp"
#include "engine/anim/joint_range.hpp"
#include "engine/anim/quadratic_path.hpp"
#include "engine/core/parallel.hpp"
#include "engine/math/scalar_rotation.hpp"
#include "systems/body/shared/body_contacts.hpp"
#include "systems/body/shared/hang_body.hpp"
#include "systems/body/shared/pose_spine.hpp"
#include "systems/body/shared/rest_spine.hpp"
#include "systems/body/shared/spine_chain.hpp"

namespace handhold {
namespace {

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
    return {k_least_knee_rad, tuning.knee_limit_rad, share};
}

Quat between(const Quat& a, const Quat& b, double share) {
    const double sign = a.dot(b) < 0.0 ? -1.0 : 1.0;
    const double of_b = sign * share;
    const double of_a = 1.0 - share;
    return unit_quat(of_a * a.w() + of_b * b.w(), of_a * a.x() + of_b * b.x(),
                     of_a * a.y() + of_b * b.y(), of_a * a.z() + of_b * b.z());
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
        passed = now - wanted;  // turn of this link in the world, which the next link follows
        twist = now;
    }
}

// Values of a tick that do not depend on the player.
struct TickShares {
    double back;                      // share of the way back to rest per tick
    double drag;                      // factor on velocities per tick
    std::array<JointRange, 3> range;  // indexed by SpineLinkKind
};
TickShares tick_shares(const SpineTuning& tuning) {
    return {std::min(1.0, tuning.return_per_s * k_spine_tick_s),
            1.0 / (1.0 + tuning.drag_per_s * k_spine_tick_s),
            {range_of(SpineLinkKind::spine, tuning), range_of(SpineLinkKind::thigh, tuning),
             range_of(SpineLinkKind::shin, tuning)}};
}

// Upper limit of a joint. A surface may push it beyond the limit of its swing, up to a human range.
// Afterwards the limit follows the joint back at a limited speed.
double reached_limit(SpineLinkKind kind, double limit_rad, bool touches, double angle_rad) {
    // The index is a SpineLinkKind.
    constexpr std::array<double, 3> k_widest_rad = {0.7, 1.3, 2.4};
    constexpr double k_back_radps = 2.0;
    const double widest_rad = k_widest_rad[static_cast<std::size_t>(kind)];
    return std::max(limit_rad, touches ? widest_rad : angle_rad - k_back_radps * k_spine_tick_s);
}

// Turns a thigh into the range of a person's hip: it extends backwards by 30 degrees, and swings
// outward by 35 and inward by 15. `outward`: its sign is that of the leg's side.
Vec3 within_hip(const Vec3& towards, double outward) {
    constexpr double k_back = -0.5;
    constexpr double k_outward = -0.57;
    constexpr double k_inward = -0.26;
    const Vec3 aside = outward < 0.0 ? Vec3(-Vec3::UnitX()) : Vec3(Vec3::UnitX());
    const Vec3 ahead = deflect_outward(towards, -Vec3::UnitZ(), k_back, 2.0);
    return deflect_outward(deflect_outward(ahead, aside, k_inward, 2.0), -aside, k_outward, 2.0);
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

struct Ticked {
    Quat chest;
    double lying;         // ArmEstimate::lying
    Vec3 moved_m;         // neck's displacement since the last tick
    Vec3 ahead_m;         // neck's displacement from this tick to the frame's end
    double share;         // share of the frame that has passed, [0, 1]
    double origin_scale;  // PlayerOrigin::scale
};

void tick(const Ticked& now, double scale, const SpineTuning& tuning, SpineMemory& memory) {
    const Quat& chest = now.chest;
    pass_twist(memory.tick_chest_ps, chest, tuning, memory);
    memory.tick_chest_ps = chest;
    memory.before_m = memory.offset_m;
    BodyPull& pull = memory.pull;
    follow_pull(pull.hands_before + now.share * (pull.hands - pull.hands_before), k_spine_tick_s,
                tuning, pull);
    const TrunkLean lean = lean_at(chest, pull.now, now.lying);
    SpineChain chain{frame_at(leaning_chest(chest, lean)), {}};
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
        const Vec3& rest = i < k_spine_links ? lean.rest_above[i] : link.rest;
        const Vec3 blend = (1.0 - shares.back) * towards + shares.back * rest;
        const Vec3 returned = blend * (1.0 / blend.norm());
        const BodyContact* const contact = contact_of(memory, i);
        const Vec3 outside = contact == nullptr
                                 ? returned
                                 : before_surface({returned, base - now.ahead_m,
                                                   scale * link.length_m, now.origin_scale},
                                                  above, *contact);
        const Vec3 before =
            link.kind == SpineLinkKind::thigh ? within_hip(outside, link.base_m.x()) : outside;
        JointRange range = shares.range[static_cast<std::size_t>(link.kind)];
        range.high_rad =
            reached_limit(link.kind, range.high_rad, contact != nullptr, memory.angle_rad[i]);
        const Vec3 allowed = link.kind == SpineLinkKind::shin
                                 ? clamp_to_hinge(before, range, memory.angle_rad[i])
                                 : clamp_to_cone(before, link.rest, range, memory.angle_rad[i]);
        memory.offset_m[i] = base + above.axes * ((scale * link.length_m) * allowed);
        // The correction includes the return to rest, so the velocity overshoots the rest pose.
        // Subtracting a share from the parent's velocity (hand_back) damps this.
        Vec3 correction_mps = (memory.offset_m[i] - predicted) * k_ticks_per_s;
        if (contact != nullptr && outside != returned) {
            memory.velocity_mps[i] =
                touching_mps(contact->normal_ps, memory.velocity_mps[i], correction_mps);
        } else {
            memory.velocity_mps[i] += correction_mps;
        }
        if (link.parent != k_chest_link && outside == returned) {
            // The pelvis has two thighs; each contributes half of the correction.
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
    double lying;
    double origin_scale;  // PlayerOrigin::scale
    Pose chest_ps;
    // Displacements in this frame relative to the reference, play-space axes.
    Vec3 moved_m;        // the neck
    Vec3 chest_moved_m;  // the chest
};

void play(const Motion& motion, double scale, const SpineTuning& tuning, SpineMemory& memory) {
    const double span_s = std::min(motion.dt_s, k_longest_spine_s);
    const QuadraticPath path(motion.moved_m, span_s, memory.rate_mps, memory.rate_span_s);
    const Quat from = memory.chest_ps.rotation;
    double played_s = 0.0;
    while (memory.since_tick_s + (span_s - played_s) >= k_spine_tick_s) {
        const double until_s = played_s + (k_spine_tick_s - memory.since_tick_s);
        const Vec3 moved_m = memory.moved_m + (path.at(until_s) - path.at(played_s));
        played_s = until_s;
        const Quat chest = between(from, motion.chest_ps.rotation, played_s / span_s);
        tick({chest, motion.lying, moved_m, path.at(span_s) - path.at(until_s), played_s / span_s,
              motion.origin_scale},
             scale, tuning, memory);
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

// Searches for surfaces beside the body, if io.surfaces is set.
void touch_surfaces(const PropagateSpineIo& io, Entity player, const Motion& motion,
                    const TrackedFloor& floor, SpineMemory& memory) {
    if (!io.surfaces) {
        return;
    }
    // A point inside the head, because the eyes are near the surface of the head's collider, which
    // may touch other surfaces.
    const double origin_scale = io.origin.at(player).scale;
    const Vec3 in_head_m(0.0, 0.0, origin_scale * 0.08);
    const BodySurroundings around{io.surfaces,
                                  io.persistent_id.at(player).value,
                                  io.origin.at(player).pose_ws,
                                  transform_point(io.head.at(player).pose_ps, in_head_m),
                                  motion.chest_ps.position,
                                  free_body(motion.chest_ps.rotation, motion.lying),
                                  floor,
                                  origin_scale,
                                  io.pose.at(player)};
    find_body_contacts(around, io.t_s, io.dt_s, motion.chest_moved_m, memory);
    memory.pull.hands +=
        surface_pull(memory.contacts[k_free_body], around.free_ps,
                     motion.chest_ps.rotation * Vec3::UnitZ(), floor.scale * k_free_body_m);
}

// Whether another player's hand holds the trunk or a leg.
struct Held {
    bool now = false;
    bool before = false;  // since before this frame
};
Held held(const PropagateSpineIo& io, Entity player) {
    Held found;
    for (std::size_t index = 0; index < io.body_hold.size(); ++index) {
        const Grab& grab = io.grab.at(io.body_hold.owners()[index]);
        if (grab.kind == GripKind::player && grab.body == player &&
            swings(io.body_hold.elements()[index].part)) {
            found.now = true;
            found.before = found.before || grab.since_s < io.t_s - io.dt_s;
        }
    }
    return found;
}

// Displacement of the neck in a frame, less what a bend of the neck explains. The neck bends about
// a point that is known within k_pivot_m: while the head turns by an angle, the estimated point may
// move by that angle times k_pivot_m although the trunk rests.
Vec3 trunk_motion(const Vec3& neck_moved_m, const Quat& head_before, const Quat& head_now,
                  double scale) {
    constexpr double k_pivot_m = 0.05;
    const Quat turn = head_before.conjugate() * head_now;
    const double angle_rad = 2.0 * arc_tangent2(turn.vec().norm(), std::abs(turn.w()));
    const double length_m = neck_moved_m.norm();
    const double explained_m = scale * k_pivot_m * angle_rad;
    return length_m > explained_m ? Vec3(neck_moved_m * (1.0 - explained_m / length_m))
                                  : Vec3(Vec3::Zero());
}

void propagate_player(const PropagateSpineIo& io, std::size_t index, const SpineTuning& tuning) {
    const Entity player = io.pose.owners()[index];
    SpineMemory& memory = io.memory.at(player);
    const Pose& origin_ws = io.origin.at(player).pose_ws;
    const double scale = io.measures.at(player).eye_height_m / k_scale_eye_m;
    const Pose& chest_ps = io.estimate.at(player).chest_ps;
    const double floor_m = io.head.at(player).shift_m.y();
    const double lying = io.estimate.at(player).lying;
    const TrackedFloor floor{chest_ps.position.y() - floor_m, scale, lying};
    const Held is_held = held(io, player);
    // While the body is held, its velocities are relative to the player's velocity.
    const Vec3 reference_ws =
        is_held.now ? io.velocity.at(player).linear_mps : io.reference.at(player).linear_mps;
    // A bending neck moves the chest a little. This must not make the body swing, so the chain
    // moves with it rigidly.
    const Vec3 neck_ps = chest_ps.position - io.estimate.at(player).from_neck_m;
    const Quat& head_ps = io.head.at(player).pose_ps.rotation;
    const Vec3 neck_moved_m = neck_ps - memory.neck_ps;
    const Quat to_ps = origin_ws.rotation.conjugate();
    const Vec3 relative = to_ps * (io.velocity.at(player).linear_mps - reference_ws);
    if (!memory.known || is_jump(neck_moved_m.norm() / io.origin.at(player).scale, io.dt_s)) {
        rest_spine(chest_ps.rotation, lying, scale, io.t_s, memory);
        memory.known = true;
        memory.rate_mps = relative;
        memory.rate_span_s = io.dt_s;
    } else {
        // Velocities are relative to the reference velocity. When it changes, they are shifted
        // so that the absolute velocities stay the same. A held body follows its player's changes.
        const Vec3 shift = is_held.before ? Vec3(Vec3::Zero())
                                          : Vec3(to_ps * (memory.reference_ws_mps - reference_ws));
        for (Vec3& velocity : memory.velocity_mps) {
            velocity += shift;
        }
        memory.rate_mps += shift;
        const Vec3 travel_m = io.dt_s * relative;
        const Vec3 own_m = trunk_motion(neck_moved_m, memory.head_ps, head_ps, scale);
        const Motion motion{io.dt_s,
                            io.t_s,
                            lying,
                            io.origin.at(player).scale,
                            chest_ps,
                            own_m + travel_m,
                            chest_ps.position - memory.chest_ps.position + travel_m};
        touch_surfaces(io, player, motion, floor, memory);
        SpineTuning own = tuning;
        own.speed_max_mps *= io.origin.at(player).scale;
        play(motion, scale, own, memory);
    }
    memory.reference_ws_mps = reference_ws;
    memory.chest_ps = chest_ps;
    memory.neck_ps = neck_ps;
    memory.head_ps = head_ps;
    pose_spine(origin_ws * chest_ps, memory, chest_ps, floor, io.pose.at(player));
}

// Writes BodyPull::hands.
void take_pulls(const PropagateSpineIo& io) {
    for (SpineMemory& memory : io.memory.elements()) {
        memory.pull.hands_before = memory.pull.hands;
        memory.pull.hands = Vec3::Zero();
    }
    for (std::size_t index = 0; index < io.owner.size(); ++index) {
        const Grab* const grab = io.grab.find(io.owner.owners()[index]);
        if (grab == nullptr || !can_push_off(*grab)) {
            continue;
        }
        const HandOwner& owner = io.owner.elements()[index];
        const BodyMeasures& measures = io.measures.at(owner.player);
        const ArmEstimate& estimate = io.estimate.at(owner.player);
        const Vec3 from_chest_m =
            estimate.arms[index_of(owner.side)].hand_ps.position - estimate.chest_ps.position;
        io.memory.at(owner.player).pull.hands +=
            from_chest_m * (1.0 / (measures.upper_arm_m + measures.forearm_m));
    }
}

}  // namespace

void propagate_spine(const PropagateSpineIo& io, const SpineTuning& tuning) {
    take_pulls(io);
    constexpr std::size_t k_players_per_slice = 4;
    const auto propagate = [&](std::size_t /*slice*/, std::size_t first, std::size_t last) {
        for (std::size_t index = first; index < last; ++index) {
            propagate_player(io, index, tuning);
        }
    };
    if (io.surfaces.any_thread()) {
        parallel_slices(io.pose.size(), k_players_per_slice, propagate);
    } else {
        propagate(0, 0, io.pose.size());
    }
}

}  // namespace handhold
