// Stages of frame_stages.hpp that compute the shown hands and bodies.
#include "systems/body/estimate_arms.hpp"
#include "systems/body/layer_additives.hpp"
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
    for (std::size_t row = 0; row < w.body_hold.size(); ++row) {
        const Grab& grab = w.grab.at(w.body_hold.owners()[row]);
        if (grab.kind == GripKind::player && w.render_pose.contains(grab.body)) {
            f.caches.part_meshes.add(part_capsule(w.render_pose.at(grab.body),
                                                  w.body_measures.at(grab.body),
                                                  w.body_hold.rows()[row].part));
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
    const Column<BodySurface>* const own_surfaces =
        f.caches.body_surfaces.empty() ? nullptr : &f.caches.body_surfaces;
    const bool has_all_colliders = !f.caches.host_surfaces && own_surfaces == nullptr;
    const GatherSurroundingsIo io{
        f.caches.meshes_for_hands,
        f.caches.hand_rigs,
        f.graph().entities,
        w.persistent_id,
        w.hand_owner,
        w.hand_tracking,
        w.grab,
        w.player_origin,
        w.head_tracking,
        w.body_pose,
        w.collider,
        w.authored_hold,
        f.hands().surroundings,
        &w.hand_rig,
        f.caches.more_hand_rigs,
        own_surfaces,
        has_all_colliders ? &f.collision() : nullptr,
        f.graph().proxies,
        &w.body_hold,
        f.caches.meshes_for_hands != nullptr ? &f.caches.part_meshes : nullptr,
        &w.render_pose,
        &w.body_measures};
    for_hand_slices(f, [&io](HandScratch::Slice& slice, std::size_t first, std::size_t last) {
        handhold::gather_surroundings(io, first, last, slice.stats);
    });
}

void search_grip(const FrameContext& f) {
    const StageTimer timer(Stage::search_grip, f.stats);
    for_hand_slices(f, [&f](HandScratch::Slice& slice, std::size_t first, std::size_t last) {
        handhold::search_grip({hands_of(f, first, last), f.w.grip_surface, slice.search}, f.tuning,
                              slice.stats);
    });
}

void constrain_palms(const FrameContext& f) {
    const StageTimer timer(Stage::constrain_palms, f.stats);
    World& w = f.w;
    for_hand_slices(f, [&](HandScratch::Slice& /*slice*/, std::size_t first, std::size_t last) {
        handhold::constrain_palms({hands_of(f, first, last), w.grip_surface, w.palm_offset});
    });
}

void sweep_fingers(const FrameContext& f) {
    const StageTimer timer(Stage::sweep_fingers, f.stats);
    World& w = f.w;
    for_hand_slices(f, [&](HandScratch::Slice& slice, std::size_t first, std::size_t last) {
        handhold::sweep_fingers(
            {hands_of(f, first, last), w.grip_surface, w.palm_offset, w.finger_pose,
             std::span(f.hands().traces).subspan(first, last - first), slice.fit},
            f.tuning, slice.stats);
    });
}

void fit_hands(const FrameContext& f) {
    const StageTimer timer(Stage::fit_hands, f.stats);
    World& w = f.w;
    for_hand_slices(f, [&](HandScratch::Slice& slice, std::size_t first, std::size_t last) {
        handhold::fit_hands({f.dt_s(), hands_of(f, first, last), w.hand_tracking, w.grip_surface,
                             w.palm_offset, w.finger_pose, w.palm_pose},
                            f.tuning, slice.stats);
    });
}

// --- Shown body ----------------------------------------------------------------------------------

void estimate_arms(const FrameContext& f) {
    const StageTimer timer(Stage::estimate_arms, f.stats);
    World& w = f.w;
    handhold::estimate_arms({f.dt_s(), w.player_origin, w.head_tracking, w.body_measures,
                             w.hand_owner, w.palm_pose, w.arm_memory, w.arm_estimate},
                            f.tuning.arm);
}

void layer_clavicles(const FrameContext& f) {
    const StageTimer timer(Stage::layer_additives, f.stats);
    handhold::layer_clavicles({f.caches.body_clips, f.w.body_measures, f.w.arm_estimate},
                              f.tuning.additive, f.tuning.arm);
}

void pose_arms(const FrameContext& f) {
    const StageTimer timer(Stage::pose_arms, f.stats);
    World& w = f.w;
    handhold::pose_arms(
        {w.player_origin, w.body_measures, w.hand_owner, w.palm_pose, w.arm_estimate, w.arm_pose});
}

void propagate_spine(const FrameContext& f) {
    const StageTimer timer(Stage::propagate_spine, f.stats);
    World& w = f.w;
    handhold::propagate_spine(
        {f.dt_s(), f.end_s(), w.player_origin, w.player_velocity, w.reference_velocity,
         w.body_measures, w.arm_estimate, w.spine_memory, w.spine_pose, f.surfaces(),
         &w.head_tracking, &w.persistent_id, &w.hand_owner, &w.grab, &w.body_hold},
        f.tuning.spine);
}

void layer_additives(const FrameContext& f) {
    const StageTimer timer(Stage::layer_additives, f.stats);
    World& w = f.w;
    handhold::layer_additives({f.dt_s(), f.caches.body_clips, w.head_tracking, w.player_velocity,
                               w.reference_velocity, w.hand_owner, w.grab, w.arm_estimate,
                               w.body_clip_state, w.spine_pose, &w.spine_memory, &w.player_origin},
                              f.tuning.additive);
}

void publish_pose(const FrameContext& f) {
    const StageTimer timer(Stage::publish_pose, f.stats);
    World& w = f.w;
    handhold::publish_pose(
        {f.graph().push_backs, w.player_origin, w.head_tracking, w.hand_owner, w.hand_tracking,
         w.grab, w.palm_pose, w.finger_pose, w.authored_hold, w.render_pose},
        f.tuning);
}

void publish_body(const FrameContext& f) {
    const StageTimer timer(Stage::publish_pose, f.stats);
    handhold::publish_body({f.w.arm_pose, f.w.spine_pose, f.w.render_pose});
}

// --- Groups of stages ----------------------------------------------------------------------------

// Palms and fingers on what they hold.
void show_hands(const FrameContext& f) {
    gather_surroundings(f);
    search_grip(f);
    constrain_palms(f);
    sweep_fingers(f);
    fit_hands(f);
}

// Arms, spine and legs between head and hands.
void show_bodies(const FrameContext& f) {
    estimate_arms(f);
    layer_clavicles(f);
    pose_arms(f);
    propagate_spine(f);
    layer_additives(f);
}

void publish(const FrameContext& f) {
    publish_pose(f);
    publish_body(f);
}

}  // namespace handhold::stages
