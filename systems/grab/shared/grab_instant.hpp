#pragma once

#include "components/authored_grip.hpp"
#include "components/body.hpp"
#include "components/body_part.hpp"
#include "components/grab.hpp"
#include "components/joint.hpp"
#include "components/player.hpp"
#include "components/tracking.hpp"
#include "components/tuning.hpp"
#include "engine/ecs/column.hpp"

// Poses of hands, players and gripped bodies at an instant within the frame, as the hands move
// them. anchor_grabs takes anchors from these. All poses are in the world, except for hands', which
// are in their players' play spaces (_ps).
namespace handhold {

// Inputs of all functions below, and of anchor_grabs (AnchorGrabsIo). Only anchor_grabs writes, and
// only `grab`.
struct GrabFrame {
    double start_s;                             // in: start of the frame, s
    double end_s;                               // in: end of the frame, s
    const Column<HandOwner>& owner;             // in
    const Column<HandTracking>& hand;           // in
    const Column<HandHistory>& hand_history;    // in: samples within the frame
    const Column<PlayerStart>& player_start;    // in
    const Column<PlayerOrigin>& origin;         // in: predicted
    const Column<HeadTracking>& head;           // in
    const Column<BodyStart>& body_start;        // in
    const Column<BodyPose>& body_pose;          // in: predicted
    const Column<AuthoredHold>& authored_hold;  // in
    const Column<RigidBody>& body;              // in
    const Column<Joint>& joint;                 // in
    const Column<JointState>& joint_state;      // in: at the frame's start
    const Column<BodyHold>& body_hold;          // in: hands that grip a part of a player
    Column<Grab>& grab;                         // in/out: anchor, target, phase, two_handed
};

// Poses at one instant within the frame; t = 0 is its start, 1 its end.
struct GrabInstant {
    const GrabFrame& io;
    double t = 0.0;

    // The pose interpolated from the start of the frame to the prediction; for a player, the
    // head's.
    Pose body_ws(Entity body) const;
    // The pose of what the hand grips: body_ws, or the pose of another player's part if the hand
    // has a BodyHold. Precondition: `grab` is an element of `io.grab`.
    Pose gripped_ws(const Grab& grab) const;
    Pose origin_ws(Entity player) const;
    // `hand` is an element of `io.hand`.
    Pose hand_ps(const HandTracking& hand) const;
    // The origin position at which a hand on a fixed body would be on its anchor.
    Vec3 held_origin_ws(Entity player, const Grab& grab, const HandTracking& hand) const;
    // The origin as moved by hands that have gripped fixed bodies since before the frame: by the
    // mean of their travels. The distance of hands from their anchors stays as at the start of the
    // frame. If the player has no such hand, the origin is predicted, as in origin_ws.
    Pose hand_driven_origin_ws(Entity player) const;
};

// Fraction of the frame at the time t_s, clamped to [0, 1].
double fraction_of(const GrabFrame& io, double t_s);

// A grip and its hand, and the grip and hand on the player's other side; null if there is none.
struct HandPair {
    Grab& grab;
    const HandTracking& hand;
    Grab* other = nullptr;
    const HandTracking* other_hand = nullptr;
    Entity player;
};
HandPair pair_of(const GrabFrame& io, std::size_t index);
HandPair swapped(const HandPair& pair);

// True if the hand has gripped its body since before the frame, and is not `resumed`.
bool drives_whole_frame(const Grab& grab, const HandTracking& hand);

// Pose of a jointed body that hands move: it moves along its joint by the weighted mean of the
// hands' travels (weight_along). The distance of hands from their anchors stays as at the start of
// the frame. For any other body: the predicted pose.
Pose hand_driven_body_ws(const GrabInstant& now, Entity body, const PhaseTuning& tuning);

// Pose of a held free body: it follows its hands, not its velocity. `first` drives the body, alone
// or together with the other hand. The distance of hands from their anchors stays as at the start
// of the frame; for a grip that began in this frame it is 0. The predicted pose if one of these
// hands is `resumed`.
Pose held_body_ws(const GrabInstant& now, const HandPair& first);

// The player's origin as moved by a hand on a jointed body: the origin takes the part of the hand's
// travel that the joint does not allow.
Pose origin_from_jointed_grab(const GrabInstant& now, Entity player, const Pose& body_ws,
                              const Grab& grab, const HandTracking& hand);
// The player's origin as moved by a hand that already grips a fixed body (exact) or a jointed one.
// The predicted origin if the hand grips anything else, or if `holding` is null.
Pose origin_at(const GrabInstant& now, Entity player, const Grab* holding,
               const HandTracking* holding_hand, const PhaseTuning& tuning);

}  // namespace handhold
