#pragma once

#include "components/arm.hpp"
#include "components/body_clip_state.hpp"
#include "components/body_tuning.hpp"
#include "components/grab.hpp"
#include "components/hand.hpp"
#include "components/player.hpp"
#include "components/spine.hpp"
#include "components/tracking.hpp"
#include "engine/ecs/column.hpp"
#include "systems/rigs/body_clips.hpp"

namespace handhold {

struct LayerClaviclesIo {
    const BodyClips& clips;                // in: the clavicle clip
    const Column<BodyMeasures>& measures;  // in
    Column<ArmEstimate>& estimate;         // in/out: shoulders, elbow directions, stretch
};

// Runs between estimate_arms and pose_arms. Turns each clavicle about the base of the neck by the
// clavicle clip, according to the hand's elevation and distance from the shoulder. The arm then
// reaches its hand from the moved shoulder; the hand keeps its pose. Without the clip, or with
// weight 0, nothing changes.
void layer_clavicles(const LayerClaviclesIo& io, const AdditiveTuning& additive,
                     const ArmTuning& arm);

struct LayerAdditivesIo {
    double dt_s;                                 // in: > 0
    const BodyClips& clips;                      // in: all but the clavicle clip
    const Column<HeadTracking>& head;            // in
    const Column<PlayerOrigin>& origin;          // in: the contacts are relative to it
    const Column<PlayerVelocity>& velocity;      // in
    const Column<ReferenceVelocity>& reference;  // in
    const Column<HandOwner>& owner;              // in
    const Column<Grab>& grab;                    // in
    const Column<ArmEstimate>& estimate;         // in: facing_ps
    const Column<SpineMemory>& memory;           // in: contacts
    Column<BodyClipState>& state;                // in/out
    Column<SpinePose>& pose;                     // in/out: all bones except the chest
};

// Rates of the factor on the clips' turns at a surface.
inline constexpr double k_outside_falls_per_s = 6.0;
inline constexpr double k_outside_rises_per_s = 1.0;

// Talk row 24. Adds the turns of the clips to spine and legs, bone by bone from the top. The clips
// are the idle motion, the push-off after the last hand has let go, and those driven by the look
// direction. Bones keep their lengths, and knees bend only backwards. The simulated chain
// (SpineMemory) is not affected. At a surface the turns are reduced by a common factor, so that no
// joint moves farther into it than it already is. The factor falls by k_outside_falls_per_s at
// most, and rises by k_outside_rises_per_s. Without clips, or with all weights 0, no pose changes.
void layer_additives(const LayerAdditivesIo& io, const AdditiveTuning& tuning);

}  // namespace handhold
