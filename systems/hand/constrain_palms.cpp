#include "systems/hand/constrain_palms.hpp"

namespace handhold {
namespace {

void hold_at(const HandSurroundings& hand, const Pose& wrist_bs, PalmOffset& offset) {
    const Pose held = inverse(hand.wrist_bs) * wrist_bs;
    offset.held_m = held.position;
    offset.held_turn_rad = rotation_to_vector(held.rotation);
}

}  // namespace

void constrain_palms(const ConstrainPalmsIo& io) {
    for (const HandSurroundings& hand : io.hands) {
        const GripSurface& surface = io.surface.at(hand.hand);
        PalmOffset& offset = io.offset.at(hand.hand);
        if (hand.authored != nullptr) {
            hold_at(hand, hand.authored_wrist_bs(), offset);
        } else if (surface.triangle != GripSurface::k_none) {
            hold_at(hand, surface.fitted_wrist_bs, offset);
        } else {
            offset.held_m = Vec3::Zero();
            offset.held_turn_rad = Vec3::Zero();
        }
    }
}

}  // namespace handhold
