#include "game/view/grip_fit.hpp"

#include <limits>
#include <vector>

#include "systems/hand/constrain_palms.hpp"
#include "systems/hand/fit_hands.hpp"
#include "systems/hand/search_grip.hpp"
#include "systems/hand/sweep_fingers.hpp"

namespace handhold {

FittedGrip fit_grip(const GripMesh& mesh, const HandRig& rig, const Pose& wrist_bs,
                    const Tuning& tuning, const AuthoredHand* authored) {
    constexpr double k_at_once_s = std::numeric_limits<double>::infinity();
    constexpr int k_max_frames = 40;  // enough for the fit of a hand at rest to converge
    constexpr int k_min_frames = 8;   // the fit tries other thumbs in the first frames
    EntityPool entities;
    const Entity hand = entities.create();
    const Entity body = entities.create();
    Column<HandTracking> tracking;
    Column<GripSurface> surface;
    Column<PalmOffset> offset;
    Column<PalmPose> palm;
    Column<FingerPose> fingers;
    tracking.add(hand).pressed = true;
    surface.add(hand);
    offset.add(hand);
    palm.add(hand);
    fingers.add(hand);
    const std::vector<HandSurroundings> hands = {{.hand = hand,
                                                  .body = body,
                                                  .rig = &rig,
                                                  .body_ws = {},
                                                  .wrist_bs = wrist_bs,
                                                  .meshes = {{&mesh, {}}},
                                                  .signature = 1,
                                                  .search_signature = 1,
                                                  .is_gripping = true,
                                                  .authored = authored}};
    GripSearchScratch search;
    ChainFitScratch fit;
    StageStats stats;
    search_grip({.hands = hands, .surface = surface, .scratch = search}, tuning, stats);
    constrain_palms({.hands = hands, .surface = surface, .offset = offset});
    sweep_fingers({.hands = hands,
                   .surface = surface,
                   .offset = offset,
                   .fingers = fingers,
                   .traces = {},
                   .scratch = fit},
                  tuning, stats);
    for (int frame = 0;
         frame < k_min_frames || (frame < k_max_frames && !fingers.at(hand).is_converged);
         ++frame) {
        fit_hands({.dt_s = k_at_once_s,
                   .hands = hands,
                   .hand = tracking,
                   .surface = surface,
                   .offset = offset,
                   .fingers = fingers,
                   .palm = palm},
                  tuning, stats);
    }
    FittedGrip fitted;
    fitted.wrist_bs = palm.at(hand).pose_ws;
    fitted.fingers = fingers.at(hand).shown;
    fitted.is_gripping = surface.at(hand).triangle != GripSurface::k_none;
    fitted.penetrating_fingers =
        stats.fallbacks[static_cast<std::size_t>(Fallback::authored_finger_rejected)];
    return fitted;
}

}  // namespace handhold
