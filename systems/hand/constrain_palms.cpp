#include "systems/hand/constrain_palms.hpp"

namespace handhold {
namespace {

// `held`: the held wrist relative to the tracked one.
void hold(const Pose& held, PalmOffset& offset) {
    offset.held_m = held.position;
    offset.held_turn_rad = rotation_to_vector(held.rotation);
}

}  // namespace

void constrain_palms(const ConstrainPalmsIo& io) {
    for (const HandSurroundings& hand : io.hands) {
        const GripSurface& surface = io.surface.at(hand.hand);
        PalmOffset& offset = io.offset.at(hand.hand);
        if (hand.authored != nullptr) {
            hold(inverse(hand.wrist_bs) * hand.authored_wrist_bs(), offset);
        } else if (surface.triangle != GripSurface::k_none) {
            hold(inverse(hand.wrist_bs) * surface.fitted_wrist_bs, offset);
        } else {
            hold({}, offset);
        }
    }
}

}  // namespace handhold
