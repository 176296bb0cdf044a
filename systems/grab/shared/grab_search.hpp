#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "components/authored_grip.hpp"
#include "components/body.hpp"
#include "components/frame_graph.hpp"
#include "components/grab.hpp"
#include "components/player.hpp"
#include "components/stats.hpp"
#include "components/tracking.hpp"
#include "components/tuning.hpp"
#include "engine/collision/surface_query.hpp"
#include "engine/ecs/column.hpp"
#include "systems/grab/shared/body_parts.hpp"
#include "systems/grab/shared/grab_rules.hpp"

// Finds what a closing hand grips, and which hands are in sight (HandSight).
namespace handhold {

struct ClosingHand;

// Inputs of the functions below and of update_grabs (UpdateGrabsIo). The functions below write only
// `sight`.
struct GrabSearch {
    double start_s;                               // in: start of the frame, s
    double dt_s;                                  // in: s
    SurfaceQuery surfaces;                        // in: at the start of the frame
    const Column<PersistentId>& persistent_id;    // in
    const Column<HandOwner>& owner;               // in
    const Column<HandTracking>& hand;             // in: edges
    const Column<PlayerOrigin>& origin;           // in: at the start of the frame
    const Column<HeadTracking>& head;             // in: play space, as in place_colliders
    const Column<RigidBody>& body;                // in
    const Column<BodyPose>& body_pose;            // in: at the start of the frame
    const JointGroups& joint_groups;              // in
    const Column<AuthoredGrips>& authored_grips;  // in
    GrabRules rules;                              // in
    // in: at the start of the frame; of players who are not in it, only the heads can be gripped
    const Column<GrippableBody>& grippable;
    const Column<BodyMeasures>& measures;        // in: has every player of `grippable`
    const Column<HandPull>& pull;                // in: from the last frame
    const Column<ReferenceVelocity>& reference;  // in: from the last frame
    Column<HandSight>& sight;                    // in/out
    // in/out; update_grabs also takes new anchors (anchor_bs, two_handed, slip_hs, error_m)
    Column<Grab>& grab;
    Column<AuthoredHold>& authored_hold;  // in/out: hands in an authored grip
    Column<HeadIgnores>& head_ignores;    // in/out: held bodies are added
    Column<BodyHold>& body_hold;          // in/out: hands that grip a part of a player
    Column<GrabOrder>& order;             // in/out: carried out and removed
    std::vector<ClosingHand>& closing;    // scratch of update_grabs

    GrippableBodies bodies() const {
        return {.bodies = grippable,
                .measures = measures,
                .persistent_id = persistent_id,
                .origin = origin,
                .head = head};
    }
};

// Greatest distance from the palm, times the player's scale, of a surface that is preferred because
// fingers can go round it.
inline constexpr double k_round_reach_m = 0.03;

// A point on a body, or on another player, that a hand grips.
struct GrabTarget {
    Entity body;
    Vec3 point_ws;
    Vec3 normal_ws;                     // unit, out of the solid
    std::optional<AuthoredHold> hold;   // none: not an authored grip
    std::optional<BodyPart> part = {};  // part of another player; none: a body, or a head
};

// What a closing hand grips, or why it grips nothing.
struct GrabSearchResult {
    std::optional<GrabTarget> target;
    Fallback refusal = Fallback::grab_no_surface;  // reason if there is no target
    Entity refused_by = k_no_entity;               // the body that refused the hand, if any
};

// A hand that closes, or a closed one that may grip the body it pulls, and the surface it finds.
// Scratch memory of update_grabs.
struct ClosingHand {
    std::size_t index = 0;  // index into GrabSearch::grab
    Pose hand_ps;
    double since_s = 0.0;
    Entity only = k_no_entity;  // the pulled body; null: any body may be gripped
    GrabSearchResult surface = {};
};

// Finds what a hand at `hand_ws` grips if it closes: the target of find_snap_target, else that of
// find_surface_target. Ignores bodies that refuse the hand by their
// GrabRule or by its player's GrabLayers. `only`: considers only authored grips of this body; null:
// of all bodies. `tuning`: of the hand's player (TuningOfPlayers). Counts authored grips that are
// occupied or blocked.
GrabSearchResult find_grab_target(const GrabSearch& io, Entity hand, const Pose& hand_ws,
                                  Entity only, const Tuning& tuning, StageStats& stats);
// An authored grip in reach.
std::optional<GrabTarget> find_snap_target(const GrabSearch& io, Entity hand, const Pose& hand_ws,
                                           Entity only, const Tuning& tuning, StageStats& stats);
// The surface at the palm. Only reads, on any thread if io.surfaces.any_thread().
GrabSearchResult find_surface_target(const GrabSearch& io, Entity hand, const Pose& hand_ws,
                                     const Tuning& tuning);

}  // namespace handhold
