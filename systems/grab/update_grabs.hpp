#pragma once

#include "components/stats.hpp"
#include "components/tuning.hpp"
#include "systems/grab/shared/grab_search.hpp"

namespace handhold {

using UpdateGrabsIo = GrabSearch;  // systems/grab/shared/grab_search.hpp

// A hand that closes grips, in this order:
//  - an authored grip in whose snap zone the hand is (talk row 10): the one of highest priority,
//    among equal ones the one that moves the palm least. Grips that another hand occupies, or that
//    an obstacle blocks, do not count;
//  - the first surface on the palm ray (talk rows 2, 3), or one in reach of a higher
//    GrabRule::priority;
//  - the nearest surface within HandTuning::reach_m of the palm, from any angle. Other players'
//    heads, and their GrippableBody, count as surfaces;
//  - in place of a surface that fingers cannot go round, one of another body that they can, or
//    another player's arm or leg, within k_round_reach_m of the palm: a rail rather than the panel
//    behind it. The hand does not snap.
// The hand must get there without crossing a wall: the palm or the surface must be visible from
// where the palm was last outside of walls (HandSight) or from the head, directly or by a detour of
// a hand's width. A palm pushed through a surface grips that surface.
//
// A hand lets go if it opens, if its error exceeds HandTuning::max_stretch_m, if its body is gone,
// or if a tracking error took the palm farther than max_stretch_m from its surface. If both of a
// player's hands exceed max_stretch_m, only the hand with the larger error lets go; with equal
// errors, the hand that gripped later.
// A closed hand that pulls a body (pull_bodies) grips it as soon as the body is at the palm.
//
// If a gripped body's kind or mass has changed so that it now moves the player, or now comes along,
// the hand takes its anchor where it is, so that nothing jumps. Grips on players' parts follow the
// parts of GrippableBody (BodyHold).
//
// Skips bodies that refuse the hand, by their GrabRule or because none of their layers is in the
// player's GrabLayers. A two-handed body is gripped when the second hand closes on it. A host's
// orders (GrabOrder) take precedence over closing hands and ignore the rules. But one hand alone
// never holds a two-handed body.
void update_grabs(const UpdateGrabsIo& io, const Tuning& tuning, StageStats& stats);

}  // namespace handhold
