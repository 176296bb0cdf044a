#pragma once

#include <vector>

#include "components/body_clip_state.hpp"
#include "systems/body/clear_arms.hpp"
#include "systems/body/estimate_arms.hpp"
#include "systems/body/layer_additives.hpp"
#include "systems/body/limit_feet.hpp"
#include "systems/body/limit_pelvis.hpp"
#include "systems/body/pose_arms.hpp"
#include "systems/body/propagate_spine.hpp"
#include "tests/systems/frame/column_scene.hpp"

namespace handhold::test {

// The columns of players' bodies, and the systems that write them, in the order of a frame.
struct BodyColumns {
    Column<PlayerOrigin> origin;
    Column<PlayerVelocity> velocity;
    Column<ReferenceVelocity> reference;
    Column<PersistentId> id;  // a player needs one beside surfaces
    Column<HeadTracking> head;
    Column<BodyMeasures> measures;
    Column<HandOwner> owner;
    Column<PalmPose> palm;
    Column<HandTracking> tracking;
    Column<Grab> grab;
    Column<BodyHold> body_hold;
    Column<ArmMemory> arm_memory;
    Column<ArmEstimate> estimate;
    Column<ArmPose> arm_pose;
    Column<SpineMemory> spine_memory;
    Column<SpinePose> spine_pose;
    Column<BodyClipState> clip_state;
    BodyClips clips;
    ArmTuning arm_tuning;
    SpineTuning spine_tuning;
    AdditiveTuning additive_tuning;
    double t_s = 0.0;  // the world's clock, which propagate_spine advances

    // A player of average size with both hands, tracked and empty, in every column except `id`.
    void add_player(Entity player = k_player, Entity left = k_left, Entity right = k_right) {
        origin.add(player);
        velocity.add(player);
        reference.add(player);
        head.add(player);
        measures.add(player);
        arm_memory.add(player);
        estimate.add(player);
        arm_pose.add(player);
        spine_memory.add(player);
        spine_pose.add(player);
        clip_state.add(player);
        owner.add(left, {player, HandSide::left});
        owner.add(right, {player, HandSide::right});
        for (const Entity hand : {left, right}) {
            palm.add(hand);
            tracking.add(hand).state = TrackingState::tracked;
            grab.add(hand);
        }
    }
    // Head and shown hands of k_player.
    void place(const Pose& head_ps, const Pose& left_ws, const Pose& right_ws) {
        head.at(k_player).pose_ps = head_ps;
        palm.at(k_left).pose_ws = left_ws;
        palm.at(k_right).pose_ws = right_ws;
    }

    void estimate_arms(double dt_s) {
        handhold::estimate_arms({.dt_s = dt_s,
                                 .origin = origin,
                                 .head = head,
                                 .measures = measures,
                                 .owner = owner,
                                 .hand = tracking,
                                 .grab = grab,
                                 .palm = palm,
                                 .memory = arm_memory,
                                 .estimate = estimate},
                                arm_tuning);
    }
    void pose_arms() {
        handhold::pose_arms({.origin = origin,
                             .measures = measures,
                             .owner = owner,
                             .palm = palm,
                             .estimate = estimate,
                             .arms = arm_pose});
    }
    void propagate_spine(double dt_s, const SurfaceQuery& surfaces = {}) {
        t_s += dt_s;
        handhold::propagate_spine({.dt_s = dt_s,
                                   .t_s = t_s,
                                   .surfaces = surfaces,
                                   .persistent_id = id,
                                   .origin = origin,
                                   .velocity = velocity,
                                   .reference = reference,
                                   .head = head,
                                   .measures = measures,
                                   .estimate = estimate,
                                   .owner = owner,
                                   .grab = grab,
                                   .body_hold = body_hold,
                                   .memory = spine_memory,
                                   .pose = spine_pose},
                                  spine_tuning);
    }
    void limit_pelvis(double dt_s) {
        handhold::limit_pelvis(
            {.dt_s = dt_s, .origin = origin, .memory = spine_memory, .pose = spine_pose});
    }
    void limit_feet(double dt_s) {
        handhold::limit_feet(
            {.dt_s = dt_s, .origin = origin, .memory = spine_memory, .pose = spine_pose});
    }
    void clear_arms(double dt_s) {
        handhold::clear_arms({.dt_s = dt_s,
                              .measures = measures,
                              .spine = spine_pose,
                              .memory = arm_memory,
                              .arms = arm_pose});
    }
    // `grips`: hands whose release counts as a push-off. They may differ from `grab`, which the
    // trunk hangs from.
    void layer_additives(double dt_s, const Column<Grab>& grips) {
        handhold::layer_additives({.dt_s = dt_s,
                                   .clips = clips,
                                   .head = head,
                                   .origin = origin,
                                   .velocity = velocity,
                                   .reference = reference,
                                   .owner = owner,
                                   .grab = grips,
                                   .estimate = estimate,
                                   .memory = spine_memory,
                                   .state = clip_state,
                                   .pose = spine_pose},
                                  additive_tuning);
    }
};

// The positions of all joints below the chest: spine from the top down, pelvis, legs.
inline std::vector<Vec3> joints_of(const SpinePose& pose) {
    std::vector<Vec3> joints;
    for (const Pose& link : pose.spine_ws) {
        joints.push_back(link.position);
    }
    joints.push_back(pose.pelvis_ws.position);
    for (const SpinePose::Leg& leg : pose.legs) {
        joints.push_back(leg.thigh_ws.position);
        joints.push_back(leg.shin_ws.position);
        joints.push_back(leg.foot_ws.position);
    }
    return joints;
}

}  // namespace handhold::test
