#include "systems/body/layer_additives.hpp"

#include <algorithm>
#include <cmath>

#include "components/body_clip_state.hpp"
#include "engine/core/parallel.hpp"
#include "engine/math/scalar_rotation.hpp"
#include "systems/body/shared/fold_body.hpp"

namespace handhold {
namespace {

constexpr std::size_t k_players_per_slice = 32;

double length_of(const BodyClip& clip) { return clip.keys.empty() ? 0.0 : clip.keys.back().at; }

// Turns a pose by a rotation vector. For a zero vector, returns the pose unchanged, bit for bit.
Pose turned(const Pose& pose, const Vec3& turn) {
    if (turn == Vec3::Zero()) {
        return pose;
    }
    return {pose.position, (pose.rotation * rotation_from_vector(turn)).normalized()};
}

// Moves a bone with its parent, whose pose changes from `above` to `above_now`.
Pose carried(const Pose& bone, const Pose& above, const Pose& above_now) {
    return above_now * (inverse(above) * bone);
}

// Returns the part of a turn that a knee allows: about its hinge, and not beyond its least or
// greatest bend.
Vec3 knee_turn(const Pose& thigh_ws, const Pose& shin_ws, const Vec3& turn) {
    const Vec3 down = thigh_ws.rotation.conjugate() * (shin_ws.rotation * -Vec3::UnitY());
    const double bent = arc_tangent2(down.z(), -down.y());
    return {std::clamp(turn.x(), std::min(0.0, bent - k_knee_max_rad),
                       std::max(0.0, bent - k_least_knee_rad)),
            0.0, 0.0};
}

void turn_leg(const ClipTurns& turns, std::size_t first, const Pose& pelvis, const Pose& pelvis_now,
              SpinePose::Leg& leg) {
    const SpinePose::Leg was = leg;
    leg.thigh_ws = turned(carried(was.thigh_ws, pelvis, pelvis_now), turns[first]);
    leg.shin_ws = turned(carried(was.shin_ws, was.thigh_ws, leg.thigh_ws),
                         knee_turn(was.thigh_ws, was.shin_ws, turns[first + 1]));
    leg.foot_ws = turned(carried(was.foot_ws, was.shin_ws, leg.shin_ws), turns[first + 2]);
}

void turn_body(const ClipTurns& turns, SpinePose& pose) {
    Pose above = pose.chest_ws;
    Pose above_now = pose.chest_ws;
    for (std::size_t i = 0; i < k_spine_links; ++i) {
        const Pose was = pose.spine_ws[i];
        pose.spine_ws[i] = turned(carried(was, above, above_now), turns[i]);
        above = was;
        above_now = pose.spine_ws[i];
    }
    const Pose pelvis = pose.pelvis_ws;
    pose.pelvis_ws = carried(pelvis, above, above_now);
    for (std::size_t side = 0; side < k_hand_count; ++side) {
        turn_leg(turns, k_clip_legs + side * k_leg_bones, pelvis, pose.pelvis_ws, pose.legs[side]);
    }
}

// World positions of the links' lower ends, indexed by link.
BodyLinkVectors ends_of(const SpinePose& pose) {
    BodyLinkVectors ends;
    for (std::size_t i = 0; i + 1 < k_spine_links; ++i) {
        ends[i] = pose.spine_ws[i + 1].position;
    }
    ends[k_spine_links - 1] = pose.pelvis_ws.position;
    for (std::size_t side = 0; side < k_hand_count; ++side) {
        ends[k_spine_links + 2 * side] = pose.legs[side].shin_ws.position;
        ends[k_spine_links + 2 * side + 1] = pose.legs[side].foot_ws.position;
    }
    return ends;
}

// Returns the largest share of a motion at which no link enters its surface, or penetrates it
// deeper than before. Exact for straight paths of the joints.
double share_outside(const BodyLinkVectors& from_ws, const BodyLinkVectors& to_ws,
                     const SpineMemory& memory, const Vec3& chest_ws, const Quat& to_world) {
    double share = 1.0;
    for (std::size_t i = 0; i < k_body_links; ++i) {
        const BodyContact& contact = memory.contacts[body_part_of(i)];
        if (!contact.touches) {
            continue;
        }
        const Vec3 normal_ws = to_world * contact.normal_ps;
        const double inward_m = normal_ws.dot(from_ws[i] - to_ws[i]);
        const double room_m =
            std::max(0.0, normal_ws.dot(from_ws[i] - chest_ws) - contact.surface_m);
        if (inward_m > room_m) {
            share = std::min(share, room_m / inward_m);
        }
    }
    return share;
}

// Adds the turns, or the share of them that keeps the body out of surfaces.
void turn_body_outside(const LayerAdditivesIo& io, Entity player, ClipTurns& turns,
                       BodyClipState& state, SpinePose& pose) {
    const SpinePose was = pose;
    turn_body(turns, pose);
    const double share =
        share_outside(ends_of(was), ends_of(pose), io.memory.at(player), was.chest_ws.position,
                      io.origin.at(player).pose_ws.rotation);
    state.outside = std::clamp(share, state.outside - k_outside_falls_per_s * io.dt_s,
                               state.outside + k_outside_rises_per_s * io.dt_s);
    if (state.outside < 1.0) {
        for (Vec3& turn : turns) {
            turn *= state.outside;
        }
        pose = was;
        turn_body(turns, pose);
    }
}

void see_hands(const LayerAdditivesIo& io) {
    for (BodyClipState& state : io.state.elements()) {
        state.was_gripping = state.gripping;
        state.gripping = false;
    }
    for (std::size_t index = 0; index < io.owner.size(); ++index) {
        if (can_push_off(io.grab.at(io.owner.owners()[index]))) {
            io.state.at(io.owner.elements()[index].player).gripping = true;
        }
    }
}

void advance(const BodyClips& clips, double dt_s, double speed_mps, const AdditiveTuning& tuning,
             BodyClipState& state) {
    const double idle_s = length_of(clips.at(BodyClipName::idle));
    state.idle_s = idle_s > 0.0 ? std::fmod(state.idle_s + dt_s, idle_s) : 0.0;
    const double push_off_s = length_of(clips.at(BodyClipName::push_off));
    state.push_off_s = std::min(state.push_off_s + dt_s, push_off_s);
    const bool is_over = state.push_off_s >= push_off_s || state.push_off_weight == 0.0;
    if (state.was_gripping && !state.gripping && is_over) {
        state.push_off_s = 0.0;
        state.push_off_weight = smooth_step(speed_mps, 0.2, tuning.push_off_speed_mps);
    }
}

void add_look(const BodyClips& clips, const Quat& head_ps, const Vec3& facing, double weight,
              ClipTurns& turns) {
    const Vec3 ahead_ps = head_ps * -Vec3::UnitZ();
    const double left = facing.z() * ahead_ps.x() - facing.x() * ahead_ps.z();
    const double ahead = facing.x() * ahead_ps.x() + facing.z() * ahead_ps.z();
    // Length of the horizontal part of the look direction: looking straight up has no yaw.
    const double level = std::sqrt(left * left + ahead * ahead);
    // Straight behind is neither left nor right, so the clip fades out towards it.
    constexpr double k_fade_from_rad = 0.75 * k_pi;
    const double yaw_rad = arc_tangent2(left, ahead);
    const double fade = 1.0 - smooth_step(std::abs(yaw_rad), k_fade_from_rad, k_pi);
    add_turns(clips.at(BodyClipName::look_yaw), yaw_rad, weight * level * fade, ClipBlend::straight,
              turns);
    add_turns(clips.at(BodyClipName::look_pitch), arc_tangent2(ahead_ps.y(), level), weight,
              ClipBlend::straight, turns);
}

void turn_clavicle(const BodyClips& clips, HandSide side, double arm_m, double reach, double weight,
                   const Pose& chest_ps, ArmEstimate::Arm& arm) {
    const Vec3 hand = chest_ps.rotation.conjugate() * (arm.hand_ps.position - arm.shoulder_ps);
    const double level = std::sqrt(hand.x() * hand.x() + hand.z() * hand.z());
    ClipTurns turns = no_turns();
    add_turns(clips.at(BodyClipName::clavicle), arc_tangent2(hand.y(), level),
              weight * reach_weight(clips, hand.norm() / arm_m), ClipBlend::straight, turns);
    Vec3 turn = turns[k_clip_clavicle];
    if (turn == Vec3::Zero()) {
        return;
    }
    if (side == HandSide::left) {
        turn = {turn.x(), -turn.y(), -turn.z()};
    }
    const Vec3 bone = (1.0 - k_clavicle_from) *
                      (chest_ps.rotation.conjugate() * (arm.shoulder_ps - chest_ps.position));
    arm.shoulder_ps += chest_ps.rotation * (rotation_from_vector(turn) * bone - bone);
    const Vec3 line = arm.hand_ps.position - arm.shoulder_ps;
    const double distance = line.norm();
    arm.stretch = std::max(1.0, distance / (reach * arm_m));
    if (distance > 1e-6) {
        const Vec3 axis = line / distance;
        const Vec3 bend = arm.bend_ps - axis * axis.dot(arm.bend_ps);
        const double length = bend.norm();
        arm.bend_ps = length > 1e-6 ? Vec3(bend / length) : any_perpendicular(axis);
    }
}

void layer_player(const LayerAdditivesIo& io, std::size_t index, const AdditiveTuning& tuning) {
    const Entity player = io.state.owners()[index];
    BodyClipState& state = io.state.elements()[index];
    const double speed_mps =
        (io.velocity.at(player).linear_mps - io.reference.at(player).linear_mps).norm() /
        io.origin.at(player).scale;
    advance(io.clips, io.dt_s, speed_mps, tuning, state);
    ClipTurns turns = no_turns();
    add_turns(io.clips.at(BodyClipName::idle), state.idle_s, tuning.idle, ClipBlend::eased, turns);
    add_turns(io.clips.at(BodyClipName::push_off), state.push_off_s,
              tuning.push_off * state.push_off_weight, ClipBlend::eased, turns);
    add_look(io.clips, io.head.at(player).pose_ps.rotation, io.estimate.at(player).facing_ps,
             tuning.look, turns);
    if (std::any_of(turns.begin(), turns.end(),
                    [](const Vec3& turn) { return turn != Vec3::Zero(); })) {
        turn_body_outside(io, player, turns, state, io.pose.at(player));
    }
}

}  // namespace

void layer_clavicles(const LayerClaviclesIo& io, const AdditiveTuning& additive,
                     const ArmTuning& arm) {
    if (additive.clavicle == 0.0 || io.clips.at(BodyClipName::clavicle).keys.empty()) {
        return;
    }
    parallel_each(io.estimate.size(), k_players_per_slice, [&](std::size_t index) {
        const BodyMeasures* const measures = io.measures.find(io.estimate.owners()[index]);
        if (measures == nullptr) {
            return;
        }
        ArmEstimate& estimate = io.estimate.elements()[index];
        for (const HandSide side : {HandSide::left, HandSide::right}) {
            turn_clavicle(io.clips, side, measures->upper_arm_m + measures->forearm_m, arm.reach,
                          additive.clavicle, estimate.chest_ps, estimate.arms[index_of(side)]);
        }
    });
}

void layer_additives(const LayerAdditivesIo& io, const AdditiveTuning& tuning) {
    see_hands(io);
    parallel_each(io.state.size(), k_players_per_slice,
                  [&](std::size_t index) { layer_player(io, index, tuning); });
}

}  // namespace handhold
