#include "systems/hand/constrain_palms.hpp"

#include "systems/hand/shared/finger_chain.hpp"
#include "systems/hand/shared/palm_fit.hpp"

namespace handhold {
namespace {

// True if search_grip already fitted the palm for this wrist.
bool has_current_fit(const HandSurroundings& hand, const GripSurface& surface) {
    return surface.has_fitted_wrist && surface.surroundings_signature == hand.signature &&
           surface.wrist_bs.position == hand.wrist_bs.position &&
           surface.wrist_bs.rotation.coeffs() == hand.wrist_bs.rotation.coeffs();
}

void hold_at(const HandSurroundings& hand, const Pose& wrist_bs, PalmOffset& offset) {
    const Pose held = inverse(hand.wrist_bs) * wrist_bs;
    offset.held_m = held.position;
    offset.held_turn_rad = rotation_to_vector(held.rotation);
}

void hold_palm(const HandSurroundings& hand, const GripSurface& surface, const Tuning& tuning,
               PalmOffset& offset) {
    if (hand.authored != nullptr) {
        hold_at(hand, hand.authored->wrist_bs, offset);
        offset.solved_signature = 0;
        return;
    }
    if (surface.triangle == GripSurface::k_none) {
        offset.held_m = Vec3::Zero();
        offset.held_turn_rad = Vec3::Zero();
        offset.solved_signature = 0;
        return;
    }
    const bool has_fit = has_current_fit(hand, surface);
    if (!has_fit && offset.solved_signature == hand.signature &&
        offset.solved_triangle == surface.triangle &&
        hand_travel_m(offset.solved_wrist_bs, hand.wrist_bs) < tuning.finger.reuse_travel_m) {
        return;
    }
    offset.solved_signature = hand.signature;
    offset.solved_wrist_bs = hand.wrist_bs;
    offset.solved_triangle = surface.triangle;
    hold_at(hand,
            has_fit ? surface.fitted_wrist_bs
                    : fit_palm(hand, surface, tuning.palm, {.last = &surface}).wrist_bs,
            offset);
}

}  // namespace

void constrain_palms(const ConstrainPalmsIo& io, const Tuning& tuning) {
    for (const HandSurroundings& hand : io.hands) {
        hold_palm(hand, io.surface.at(hand.hand), tuning, io.offset.at(hand.hand));
    }
}

}  // namespace handhold
