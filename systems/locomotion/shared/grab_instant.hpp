#pragma once

#include "components/authored_grip.hpp"
#include "components/body.hpp"
#include "components/grab.hpp"
#include "components/joint.hpp"
#include "components/player.hpp"
#include "components/tracking.hpp"
#include "components/tuning.hpp"
#include "engine/ecs/column.hpp"

// Where hands, players and what they hold were at an instant within the frame, as hands led them:
// what anchor_grabs takes anchors from. All poses are in the world, but for the hands' in their
// players' play spaces (_ps).
namespace handhold {

// The inputs of anchor_grabs (AnchorGrabsIo). The functions here read them; anchor_grabs
// alone writes, and only `grab`.
struct GrabFrame {
    double start_s = 0.0;  // in: the frame
    double end_s = 0.0;
    const Column<HandOwner>& owner;             // in
    const Column<HandTracking>& hand;           // in
    const Column<HandHistory>& hand_history;    // in: the hands' ways within the frame
    const Column<PlayerStart>& player_start;    // in
    const Column<PlayerOrigin>& origin;         // in: predicted
    const Column<HeadTracking>& head;           // in
    const Column<BodyStart>& body_start;        // in
    const Column<BodyPose>& body_pose;          // in: predicted
    const Column<AuthoredHold>& authored_hold;  // in
    const Column<RigidBody>& body;              // in
    const Column<Joint>& joint;                 // in
    const Column<JointState>& joint_state;      // in: at the frame's start
    Column<Grab>& grab;                         // in/out: anchor, target, phase, two_handed
};

// Poses at one instant within the frame, 0 its start, 1 its end.
struct GrabInstant {
    const GrabFrame& io;
    double t = 0.0;

    // As predicted; of a player his head's.
    Pose body_ws(Entity body) const;
    Pose origin_ws(Entity player) const;
    // `hand` is a row of `io.hand`.
    Pose hand_ps(const HandTracking& hand) const;
    // Where a hand that holds on to something fixed would have its player.
    Vec3 held_origin_ws(Entity player, const Grab& grab, const HandTracking& hand) const;
    // Whom hands have held on to something fixed since before the frame goes the mean of their
    // ways, and lacks all the while what he lacked at the frame's start; others go as predicted.
    Pose hand_driven_origin_ws(Entity player) const;
};

// 0 to 1, of a time within the frame.
double fraction_of(const GrabFrame& io, double t_s);

// A grip, its hand and the same player's other ones; the other grip is null where there is no other
// hand.
struct HandPair {
    Grab& grab;
    const HandTracking& hand;
    Grab* other = nullptr;
    const HandTracking* other_hand = nullptr;
    Entity player;
};
HandPair pair_of(const GrabFrame& io, std::size_t row);
HandPair swapped(const HandPair& pair);

// True where it has had what it holds since before the frame, and knows where it is.
bool drives_whole_frame(const Grab& grab, const HandTracking& hand);

// Where a body on a joint is that hands lead: as far along the joint as they went, on average, each
// counted as the solver counts it, and off it by what it lacked at the frame's start. Any other
// body: as predicted.
Pose hand_driven_body_ws(const GrabInstant& now, Entity body, const PhaseTuning& tuning);

// Where a free body that is held is: it follows its hands, not its velocity, and lacks all the
// while what it lacked at the frame's start. What began to hold it in this frame lacks nothing.
// `first` leads it, alone or with the other hand.
Pose held_body_ws(const GrabInstant& now, const HandPair& first);

// The player's origin, who goes by a hand of his all that its body, on a joint, cannot go with it.
Pose origin_from_jointed_grab(const GrabInstant& now, Entity player, const Pose& body_ws,
                              const Grab& grab, const HandTracking& hand);
// The player's origin: from a hand that already holds on to something fixed, exact, or to something
// on a joint; else, and where `holding` is null, on the predicted way.
Pose origin_at(const GrabInstant& now, Entity player, const Grab* holding,
               const HandTracking* holding_hand, const PhaseTuning& tuning);

}  // namespace handhold
