#pragma once

#include <cstdint>

#include "components/tracking.hpp"
#include "engine/ecs/entity.hpp"
#include "engine/math/math.hpp"

// What hands hold. Hands are entities of their own: two for each player.
namespace handhold {

struct HandOwner {
    Entity player;
    HandSide side = HandSide::left;
};

// How controller and hand sit together: hand = controller * joint. Left unset it is Tuning's,
// mirrored for the left hand. Written by whoever makes the hand (a controller profile); read by
// read_tracking.
struct ControllerToHand {
    Pose hand_in_controller;
};

// Numbers as in frames.csv.
enum class GripKind : std::uint8_t {
    none = 0,
    surface = 1,   // a point of something fixed, driven or heavy: three rows, the hand may turn
    held = 2,      // a free object: six rows, or three where it hangs on joints
    authored = 3,  // only what is shown and reported: a hand that sits in an authored grip
                   // (AuthoredHold). Its Grab is a surface's or a held object's
    player = 4,    // another player's head: three rows, and both move by their masses
};

enum class GrabPhase : std::uint8_t {
    none,
    fresh,  // begun in this frame; anchor_grabs has yet to take the anchor
    holding,
    releasing,  // let go in this frame: the constraint carries on with the release velocity to the
                // frame's end
};

// Written by update_grabs (kind, phase, body, hit), anchor_grabs (anchor, target, two_handed),
// finish_positions (error).
struct Grab {
    GripKind kind = GripKind::none;
    GrabPhase phase = GrabPhase::none;
    Entity body = k_no_entity;
    Vec3 hit_bs = Vec3::Zero();  // where the palm's ray met the surface, in the body's frame; a
                                 // player's is his head's
    Vec3 hit_normal_bs = Vec3::UnitY();  // unit, out of the solid
    Pose anchor_bs;  // the tracked hand at the instant of the grab, in the body's frame: no jump
    Pose target_ps;  // where the constraint wants the hand at the end of the frame
    Vec3 target_velocity_ps_mps = Vec3::Zero();
    Vec3 target_spin_ps_radps = Vec3::Zero();
    double since_s =
        0.0;  // when the hand closed: of two hands the one that holds longer is the first
    double error_m = 0.0;     // of the hand against its anchor, at the end of the frame
    bool two_handed = false;  // held with the player's other hand, and both lead: the first's
                              // point, the line between the hands, the twist about it
    bool jointed = false;  // held, and joints lead from it to something fixed: the hand may turn on
                           // it, as on a surface
    // How far tracking errors moved the hand against what it grips: the hand's first anchor in the
    // frame of the present one. Identity: not at all. A held body returns by it.
    Pose slip_hs;
};
inline bool has_slipped(const Grab& grab) {
    return grab.slip_hs.position != Vec3::Zero() || grab.slip_hs.rotation.vec() != Vec3::Zero();
}

// Where the palm was last known to be outside of walls: what it grips must be visible from there.
// Written by update_grabs.
struct HandSight {
    Vec3 outside_bs = Vec3::Zero();  // in `frame`
    Entity frame = k_no_entity;      // the body that the player last gripped; null: the world
    bool is_known = false;           // false: the head counts instead
    bool is_clear = true;            // no wall between outside and palm, or the head sees the palm
};

// A loose body that a closed, empty hand pulls towards itself (distance grab): only hands that do.
// Written by pull_bodies; read by update_grabs.
struct HandPull {
    Entity body = k_no_entity;
    double closed_s = 0.0;  // when the hand closed
};

}  // namespace handhold
