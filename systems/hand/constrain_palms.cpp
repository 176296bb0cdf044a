#include "systems/hand/constrain_palms.hpp"

#include <algorithm>
#include <cmath>

#include "systems/hand/shared/finger_chain.hpp"
#include "systems/hand/shared/palm_fit.hpp"

namespace handhold {
namespace {

// The lift is reset once the tracked wrist has moved or turned farther than this since the lift was
// set.
constexpr double k_lift_reset_m = 0.01;
constexpr double k_lift_reset_rad = 0.17;

// True if search_grip already fitted the palm for this wrist pose. That fit has no lift.
bool has_current_fit(const HandSurroundings& hand, const GripSurface& surface, double lift_m) {
    return surface.has_fitted_wrist && lift_m == 0.0 &&
           surface.surroundings_signature == hand.signature &&
           surface.wrist_bs.position == hand.wrist_bs.position &&
           surface.wrist_bs.rotation.coeffs() == hand.wrist_bs.rotation.coeffs();
}

void set_target(const HandSurroundings& hand, const GripSurface& surface, const Tuning& tuning,
                PalmOffset& offset) {
    if (hand.authored != nullptr) {
        const Pose target = inverse(hand.wrist_bs) * hand.authored->wrist_bs;
        offset.target_m = target.position;
        offset.target_turn_rad = rotation_to_vector(target.rotation);
        offset.lift_m = 0.0;
        offset.solved_signature = 0;
        return;
    }
    if (surface.triangle == GripSurface::k_none) {
        offset.target_m = Vec3::Zero();
        offset.target_turn_rad = Vec3::Zero();
        offset.lift_m = 0.0;
        offset.solved_signature = 0;
        return;
    }
    const Pose moved = inverse(offset.lift_wrist_bs) * hand.wrist_bs;
    if (moved.position.norm() > k_lift_reset_m ||
        rotation_to_vector(moved.rotation).norm() > k_lift_reset_rad) {
        offset.lift_m = 0.0;
    }
    const bool has_fit = has_current_fit(hand, surface, offset.lift_m);
    if (!has_fit && offset.solved_signature == hand.signature &&
        offset.solved_lift_m == offset.lift_m && offset.solved_triangle == surface.triangle &&
        hand_travel_m(offset.solved_wrist_bs, hand.wrist_bs) < tuning.finger.reuse_travel_m) {
        return;
    }
    offset.solved_signature = hand.signature;
    offset.solved_wrist_bs = hand.wrist_bs;
    offset.solved_lift_m = offset.lift_m;
    offset.solved_triangle = surface.triangle;
    const Pose fitted_wrist_bs =
        has_fit ? surface.fitted_wrist_bs
                : fit_palm(hand, surface, offset.lift_m, tuning.palm, {.last = &surface}).wrist_bs;
    const Pose target = inverse(hand.wrist_bs) * fitted_wrist_bs;
    offset.target_m = target.position;
    offset.target_turn_rad = rotation_to_vector(target.rotation);
}

// Moves the shown offset towards its target by at most rate_mps * dt_s. Translation and rotation
// advance by the same share of what remains. A radian of rotation counts as tilt_cost_m_per_rad
// metres.
void follow_target(double dt_s, const PalmTuning& tuning, PalmOffset& offset) {
    const Vec3 remaining_m = offset.target_m - offset.shown_m;
    const Vec3 turn_rad = offset.target_turn_rad - offset.shown_turn_rad;
    const double distance_m = remaining_m.norm() + tuning.tilt_cost_m_per_rad * turn_rad.norm();
    const double step_m = tuning.rate_mps * dt_s;
    if (distance_m <= step_m) {
        offset.shown_m = offset.target_m;
        offset.shown_turn_rad = offset.target_turn_rad;
    } else {
        offset.shown_m += step_m / distance_m * remaining_m;
        offset.shown_turn_rad += step_m / distance_m * turn_rad;
    }
}

}  // namespace

void constrain_palms(const ConstrainPalmsIo& io, const Tuning& tuning) {
    for (const HandSurroundings& hand : io.hands) {
        PalmOffset& offset = io.offset.at(hand.hand);
        set_target(hand, io.surface.at(hand.hand), tuning, offset);
        follow_target(io.dt_s, tuning.palm, offset);
        const bool is_tracked = offset.shown_m.isZero() && offset.shown_turn_rad.isZero();
        const Pose wrist_ws = hand.body_ws * hand.wrist_bs;
        io.palm.at(hand.hand).pose_ws =
            is_tracked
                ? wrist_ws
                : wrist_ws * Pose{offset.shown_m, rotation_from_vector(offset.shown_turn_rad)};
    }
}

}  // namespace handhold
