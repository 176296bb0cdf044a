// Stages of frame_stages.hpp that compute the shown hands and bodies.
#include <algorithm>

#include "systems/body/clear_arms.hpp"
#include "systems/body/estimate_arms.hpp"
#include "systems/body/layer_additives.hpp"
#include "systems/body/limit_feet.hpp"
#include "systems/body/limit_pelvis.hpp"
#include "systems/body/pose_arms.hpp"
#include "systems/body/propagate_spine.hpp"
#include "systems/body/publish_body.hpp"
#include "systems/body/publish_pose.hpp"
#include "systems/frame/frame_slices.hpp"
#include "systems/frame/frame_stage_timer.hpp"
#include "systems/frame/frame_stages.hpp"
#include "systems/hand/constrain_palms.hpp"
#include "systems/hand/fit_hands.hpp"
#include "systems/hand/gather_surroundings.hpp"
#include "systems/hand/search_grip.hpp"
#include "systems/hand/sweep_fingers.hpp"

namespace handhold::stages {

// --- Shown hands ---------------------------------------------------------------------------------

namespace {

template <typename HandStage>
void for_hand_slices(const FrameContext& f, const HandStage& stage) {
    for_slices(f, f.hands().surroundings.size(), stage);
}

std::span<const HandSurroundings> hands_of(const FrameContext& f, std::size_t first,
                                           std::size_t last) {
    return std::span(f.hands().surroundings).subspan(first, last - first);
}

// Builds the missing meshes of held parts.
void add_part_meshes(const FrameContext& f) {
    const World& w = f.w;
    f.caches.part_meshes.drop_if_many(w.body_hold.size());
    for (std::size_t index = 0; index < w.body_hold.size(); ++index) {
        const Entity hand = w.body_hold.owners()[index];
        const Grab& grab = w.grab.at(hand);
        if (grab.kind == GripKind::player && w.render_pose.contains(grab.body)) {
            f.caches.part_meshes.add(
                resized(part_capsule(w.render_pose.at(grab.body), w.body_measures.at(grab.body),
                                     w.body_hold.elements()[index].part),
                        w.player_origin.at(w.hand_owner.at(hand).player).scale));
        }
    }
}

}  // namespace

void gather_surroundings(const FrameContext& f) {
    const StageTimer timer(Stage::gather_surroundings, f.stats);
    World& w = f.w;
    if (f.caches.meshes_for_hands != nullptr) {
        add_part_meshes(f);
    }
    f.hands().surroundings.resize(w.hand_owner.size());
    f.hands().traces.assign(w.hand_owner.size(), {});
    const bool has_all_colliders = !f.caches.host_surfaces && f.caches.body_surfaces.empty();
    const GatherSurroundingsIo io{
        .meshes = {.of_shapes = f.caches.meshes_for_hands,
                   .of_bodies = f.caches.body_surfaces,
                   .of_parts = f.caches.part_meshes,
                   .resized = f.caches.resized_meshes},
        .rigs = f.caches.hand_rigs,
        .more_rigs = f.caches.more_hand_rigs,
        .rig_choice = w.hand_rig,
        .near = {.bodies = f.graph().entities,
                 .collision = has_all_colliders ? &f.collision() : nullptr,
                 .proxies = f.graph().proxies},
        .persistent_id = w.persistent_id,
        .owner = w.hand_owner,
        .hand = w.hand_tracking,
        .grab = w.grab,
        .body_hold = w.body_hold,
        .origin = w.player_origin,
        .head = w.head_tracking,
        .shown = w.render_pose,
        .measures = w.body_measures,
        .body_pose = w.body_pose,
        .collider = w.collider,
        .authored_hold = w.authored_hold,
        .surroundings = f.hands().surroundings};
    const bool are_alike = std::ranges::all_of(
        w.player_origin.elements(), [](const PlayerOrigin& origin) { return origin.scale == 1.0; });
    if (!are_alike) {  // the meshes of other scales are made on the way
        handhold::gather_surroundings(io, 0, w.hand_owner.size(), f.stats);
        return;
    }
    for_hand_slices(f, [&io](HandScratch::Slice& slice, std::size_t first, std::size_t last) {
        handhold::gather_surroundings(io, first, last, slice.stats);
    });
}

void search_grip(const FrameContext& f) {
    const StageTimer timer(Stage::search_grip, f.stats);
    for_hand_slices(f, [&f](HandScratch::Slice& slice, std::size_t first, std::size_t last) {
        handhold::search_grip({.hands = hands_of(f, first, last),
                               .surface = f.w.grip_surface,
                               .scratch = slice.search},
                              f.tuning, slice.stats);
    });
}

void constrain_palms(const FrameContext& f) {
    const StageTimer timer(Stage::constrain_palms, f.stats);
    World& w = f.w;
    for_hand_slices(f, [&](HandScratch::Slice& /*slice*/, std::size_t first, std::size_t last) {
        handhold::constrain_palms({.hands = hands_of(f, first, last),
                                   .surface = w.grip_surface,
                                   .offset = w.palm_offset});
    });
}

void sweep_fingers(const FrameContext& f) {
    const StageTimer timer(Stage::sweep_fingers, f.stats);
    World& w = f.w;
    for_hand_slices(f, [&](HandScratch::Slice& slice, std::size_t first, std::size_t last) {
        handhold::sweep_fingers({.hands = hands_of(f, first, last),
                                 .surface = w.grip_surface,
                                 .offset = w.palm_offset,
                                 .fingers = w.finger_pose,
                                 .traces = std::span(f.hands().traces).subspan(first, last - first),
                                 .scratch = slice.fit},
                                f.tuning, slice.stats);
    });
}

void fit_hands(const FrameContext& f) {
    const StageTimer timer(Stage::fit_hands, f.stats);
    World& w = f.w;
    for_hand_slices(f, [&](HandScratch::Slice& slice, std::size_t first, std::size_t last) {
        handhold::fit_hands({.dt_s = f.dt_s(),
                             .hands = hands_of(f, first, last),
                             .hand = w.hand_tracking,
                             .surface = w.grip_surface,
                             .offset = w.palm_offset,
                             .fingers = w.finger_pose,
                             .palm = w.palm_pose},
                            f.tuning, slice.stats, slice.fit_rows);
    });
}

// --- Shown body ----------------------------------------------------------------------------------

void estimate_arms(const FrameContext& f) {
    const StageTimer timer(Stage::estimate_arms, f.stats);
    World& w = f.w;
    handhold::estimate_arms({.dt_s = f.dt_s(),
                             .origin = w.player_origin,
                             .head = w.head_tracking,
                             .measures = w.body_measures,
                             .owner = w.hand_owner,
                             .hand = w.hand_tracking,
                             .grab = w.grab,
                             .palm = w.palm_pose,
                             .memory = w.arm_memory,
                             .estimate = w.arm_estimate},
                            f.tuning.arm);
}

void layer_clavicles(const FrameContext& f) {
    const StageTimer timer(Stage::layer_additives, f.stats);
    handhold::layer_clavicles(
        {.clips = f.caches.body_clips, .measures = f.w.body_measures, .estimate = f.w.arm_estimate},
        f.tuning.additive, f.tuning.arm);
}

void pose_arms(const FrameContext& f) {
    const StageTimer timer(Stage::pose_arms, f.stats);
    World& w = f.w;
    handhold::pose_arms({.origin = w.player_origin,
                         .measures = w.body_measures,
                         .owner = w.hand_owner,
                         .palm = w.palm_pose,
                         .estimate = w.arm_estimate,
                         .arms = w.arm_pose});
}

void propagate_spine(const FrameContext& f) {
    const StageTimer timer(Stage::propagate_spine, f.stats);
    World& w = f.w;
    handhold::propagate_spine({.dt_s = f.dt_s(),
                               .t_s = f.end_s(),
                               .surfaces = f.surfaces(),
                               .persistent_id = w.persistent_id,
                               .origin = w.player_origin,
                               .velocity = w.player_velocity,
                               .reference = w.reference_velocity,
                               .head = w.head_tracking,
                               .measures = w.body_measures,
                               .estimate = w.arm_estimate,
                               .owner = w.hand_owner,
                               .grab = w.grab,
                               .body_hold = w.body_hold,
                               .memory = w.spine_memory,
                               .pose = w.spine_pose},
                              f.tuning.spine);
}

void layer_additives(const FrameContext& f) {
    const StageTimer timer(Stage::layer_additives, f.stats);
    World& w = f.w;
    handhold::layer_additives({.dt_s = f.dt_s(),
                               .clips = f.caches.body_clips,
                               .head = w.head_tracking,
                               .origin = w.player_origin,
                               .velocity = w.player_velocity,
                               .reference = w.reference_velocity,
                               .owner = w.hand_owner,
                               .grab = w.grab,
                               .estimate = w.arm_estimate,
                               .memory = w.spine_memory,
                               .state = w.body_clip_state,
                               .pose = w.spine_pose},
                              f.tuning.additive);
}

void limit_pelvis(const FrameContext& f) {
    const StageTimer timer(Stage::layer_additives, f.stats);
    World& w = f.w;
    handhold::limit_pelvis({.dt_s = f.dt_s(),
                            .origin = w.player_origin,
                            .memory = w.spine_memory,
                            .pose = w.spine_pose});
}

void limit_feet(const FrameContext& f) {
    const StageTimer timer(Stage::layer_additives, f.stats);
    World& w = f.w;
    handhold::limit_feet({.dt_s = f.dt_s(),
                          .origin = w.player_origin,
                          .memory = w.spine_memory,
                          .pose = w.spine_pose});
}

void clear_arms(const FrameContext& f) {
    const StageTimer timer(Stage::pose_arms, f.stats);
    World& w = f.w;
    handhold::clear_arms({.dt_s = f.dt_s(),
                          .measures = w.body_measures,
                          .spine = w.spine_pose,
                          .memory = w.arm_memory,
                          .arms = w.arm_pose});
}

void publish_pose(const FrameContext& f) {
    const StageTimer timer(Stage::publish_pose, f.stats);
    World& w = f.w;
    handhold::publish_pose({.push_backs = f.graph().push_backs,
                            .origin = w.player_origin,
                            .head = w.head_tracking,
                            .owner = w.hand_owner,
                            .hand = w.hand_tracking,
                            .grab = w.grab,
                            .palm = w.palm_pose,
                            .fingers = w.finger_pose,
                            .authored_hold = w.authored_hold,
                            .render = w.render_pose},
                           f.tuning);
}

void publish_body(const FrameContext& f) {
    const StageTimer timer(Stage::publish_pose, f.stats);
    handhold::publish_body(
        {.arms = f.w.arm_pose, .spine = f.w.spine_pose, .render = f.w.render_pose});
}

}  // namespace handhold::stages
