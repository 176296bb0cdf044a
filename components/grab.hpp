#pragma once

#include <cstdint>

#include "components/tracking.hpp"
#include "engine/ecs/entity.hpp"
#include "engine/math/math.hpp"

// What hands hold. Each hand is an entity; a player has two. A grab begins in update_grabs.
namespace handhold {

struct HandOwner {
    Entity player;
    HandSide side = HandSide::left;
};

// Pose of the hand in the controller's frame: hand = controller * hand_in_controller. A hand
// without this component uses HandTuning's pose, mirrored for the left hand. Written by the host
// that creates the hand (for example from a controller profile); read by read_tracking.
struct ControllerToHand {
    Pose hand_in_controller;
};

// The values are those written to frames.csv.
enum class GripKind : std::uint8_t {
    none = 0,
    // A point on a fixed, kinematic or heavy body: three constraint rows; the hand may turn.
    surface = 1,
    // A free body: six constraint rows, or three if joints connect the body to something that a
    // hand cannot move (Grab::jointed).
    held = 2,
    // The hand is in an authored grip (AuthoredHold). Used for display and reports only: the hand's
    // Grab itself has kind surface or held.
    authored = 3,
    // Another player's head, arm, trunk or leg (BodyHold): three constraint rows; both players move
    // in proportion to their inverse masses.
    player = 4,
};

enum class GrabPhase : std::uint8_t {
    none,
    fresh,  // grab began in this frame; anchor_grabs has not set the anchor yet
    holding,
    // The hand lets go in this frame. The constraint continues with the release velocity until the
    // end of the frame.
    releasing,
};

// What one hand grips. _bs is the gripped body's frame. If `body` is another player, _bs is the
// frame of the part in the hand's BodyHold, or of that player's head if the hand has no BodyHold.
//
// Written in a frame, in this order:
//  - update_grabs begins grips (kind, jointed, phase, body, since_s, hit_*), ends them and marks
//    those that end in this frame. It takes a new anchor, with error_m 0, for a hand whose partner
//    lets go of a shared hold, and for a hand whose body has changed its kind or mass; the latter
//    also resets kind, jointed, two_handed and slip_hs.
//  - anchor_grabs: anchor_bs, slip_hs, target_*, two_handed, phase.
//  - finish_positions or accept_solution: error_m, which discard_broken_results bounds.
//  - limit_velocities clears released grips.
// In frames without physics, keep_holds writes error_m instead and clears grips of removed bodies.
// Between frames, change_shape moves anchor_bs and hit_* to the new frame, and teleports end grips.
struct Grab {
    GripKind kind = GripKind::none;
    GrabPhase phase = GrabPhase::none;
    Entity body = k_no_entity;
    Vec3 hit_bs = Vec3::Zero();          // gripped point of the surface
    Vec3 hit_normal_bs = Vec3::UnitY();  // unit, out of the solid
    Pose anchor_bs;  // tracked hand at the instant of the grab, so that the hand does not jump
    Pose target_ps;  // target of the hand constraint at the end of the frame
    Vec3 target_velocity_ps_mps = Vec3::Zero();
    Vec3 target_spin_ps_radps = Vec3::Zero();
    double since_s = 0.0;  // time at which the hand closed; see is_first_hand
    double error_m = 0.0;  // distance between hand and anchor at the end of the frame
    // Both hands of the player hold the body and drive it together: its gripped point follows the
    // first hand, its direction follows the line between the hands, and its twist about that line
    // is the mean of both hands' twists.
    bool two_handed = false;
    // Joints connect the held body to something that a hand cannot move (JointGroups::anchored).
    // The hand may turn on it, as on a surface.
    bool jointed = false;
    // How far tracking errors have moved the hand on the body: the hand's original anchor in the
    // frame of anchor_bs. Identity: not at all. move_into_hand reduces it for a held free body,
    // which so returns to its place in the hand.
    Pose slip_hs;
};
// True if the player can pull on what the hand grips. False for a loose body, which would just move
// with the hand.
inline bool can_push_off(const Grab& grab) {
    return grab.kind == GripKind::surface || grab.kind == GripKind::player || grab.jointed;
}
inline bool has_slipped(const Grab& grab) {
    return grab.slip_hs.position != Vec3::Zero() || grab.slip_hs.rotation.vec() != Vec3::Zero();
}

// Where the palm was last known to be outside of walls. A hand grips only what is visible from
// there or from the head. Written by update_grabs; change_shape moves outside_bs to the body's new
// frame, and teleports reset it.
struct HandSight {
    Vec3 outside_bs = Vec3::Zero();  // point in `frame`
    Entity frame = k_no_entity;      // body that the player last gripped; null: the world
    bool is_known = false;           // false: the palm counts as outside
    // No wall stands between outside_bs and the palm, or none between the head and the palm.
    bool is_clear = true;
};

// Which hands may grip a body. A body without this component may be gripped by any hand. Written by
// the host.
struct GrabRule {
    bool left = true;
    bool right = true;
    bool two_hands = false;  // true: only both hands of one player together may grip the body
    // A closing hand grips the body of highest priority within its reach. Default 0.
    std::int32_t priority = 0;
};

// Layers of the bodies that a player's hands grip. A player without this component grips all.
// Written by the host.
struct GrabLayers {
    std::uint32_t layers = ~0U;
};

// A host's order to a hand: grip `body` (a body, or another player's head), wherever the hand is. A
// null `body` orders the hand to let go without a throw. Carried out and removed by update_grabs in
// the next frame.
struct GrabOrder {
    Entity body = k_no_entity;
};

// Distance grab: the free body that a closed, empty hand pulls towards itself. Only pulling hands
// have this component. Written by pull_bodies; read by update_grabs.
struct HandPull {
    Entity body = k_no_entity;
    double closed_s = 0.0;  // time at which the hand closed
};

}  // namespace handhold
