// Physics: who yields to whom.

#pragma once

#include <cstddef>
#include <cstdint>

#include "components/body.hpp"
#include "components/frame_graph.hpp"
#include "components/grab.hpp"
#include "components/tuning.hpp"

// The solver moves bodies by their inverse masses. A share is the factor on a body's inverse mass:
// 1 is the true mass, 0 cannot be moved. Who yields to whom is decided here and nowhere else:
//
//                      reach  forward  relax  backward  contradiction  velocities
//   fixed, kinematic   0      0        0      0         0              0
//   heavy              1      0        0      1 or H    1              V
//   free               1      1        1      1 or H    1              1
//   player on surface  1      0        0      1         C              1
//   other player       M      M        0      1         C              M, P after a push
//
// "On surface": a hand grips a fixed, kinematic or heavy body or another player, or another player
// grips this one. Why each phase has these shares:
//
// - reach: a player who climbs is moved by the grip. A light object must not move the view of the
//   player who waves it, so without such a grip the player is infinitely heavy.
//   M: momentum_share of the heaviest body that a hand holds by all its rows.
// - forward: players stay where reach put them and heavy bodies count as walls. What contacts then
//   take from the hands is exactly the violation, whatever the masses.
// - relax: only held bodies give way, because the hands press a heap that cannot.
// - backward: the violation moves the player, so everyone has the true mass. H: loose bodies of a
//   heap have share 0. Forward has cleared them, and their errors of up to k_heap_slack_m must not
//   reach the player's pose.
// - contradiction: contacts outrank hands, and no grip is left to move the player. C: 1 if the
//   player's own collider touches and the island may push, else 0.
// - velocities: momentum is exchanged with the masses that moved the positions. P: 1 if the push
//   came from something that shares momentum (set_velocity_masses), else momentum_share of the
//   island's heaviest free body, but at least least_player_share. V: 1 if the body was pushed, or
//   if a hand or joint acts in its island; if a hand there yields nothing, only if one acts on the
//   body itself. It would get momentum that no player pays for.
namespace handhold {

// The phases of the position solve, in the order of a frame. solve_phases.hpp says what each is
// for.
enum class Phase : std::uint8_t { reach, forward, relax, backward, contradiction };

// --- Assembly: facts of the frame ----------------------------------------------------------------

// A free body from PhaseTuning::heavy_body_kg up is heavy.
BodyRole role_of(const RigidBody& body, const PhaseTuning& tuning);
// Records a grip in FrameGraph::phase, for the `player` whose hand grips and for the gripped
// `body`. Both are indices into FrameGraph::phase.
void note_grip(const Grab& grab, std::size_t player, std::size_t body, const PhaseTuning& tuning,
               FrameGraph& frame);
// Marks the island as pushed: from now on its players have their true mass, in the velocity solve
// too.
void mark_pushed(const Island& island, FrameGraph& frame);

// --- What the facts say about an island ----------------------------------------------------------

bool has_hand_or_joint(const ConstraintGraph& graph, const Island& island);
bool is_pushed(const FrameGraph& frame, const Island& island);
// True if the backward phase may push a player of this island: it has two players, or an active row
// with a body that the forward phase cannot move.
bool may_push(const ConstraintGraph& graph, const Island& island);

// --- Inverse masses ------------------------------------------------------------------------------

// Write the inverse masses and inertias of the island's bodies by the table above: set_masses for a
// phase, set_velocity_masses for the velocity solve.
void set_masses(const Island& island, Phase phase, FrameGraph& frame);
void set_velocity_masses(const Island& island, const PhaseTuning& tuning, FrameGraph& frame);

// Mass of a player's body for a host's own solver, which has one phase, in kg. `player` is an index
// into FrameGraph::phase, or beyond its end if no stage has seen the player yet.
double mass_for_host_kg(const FrameGraph& frame, std::size_t player, double mass_kg);

// The share of a player who holds a body of `mass_kg`, in [0, 1]: 0 up to
// PhaseTuning::kappa_light_kg, 1 from kappa_heavy_kg on, smooth in between. It is 1 / kappa of the
// talk.
double momentum_share(double mass_kg, const PhaseTuning& tuning);
// Smallest share of a player of `mass_kg` in an island whose heaviest free body has `heaviest_kg`;
// in (0, 1]. Light bodies must not shake the player, who therefore counts as up to 1000 times as
// heavy as they are. A larger ratio of masses would make the solver's regularisation visible.
double least_player_share(double heaviest_kg, double mass_kg);

}  // namespace handhold
