#pragma once

#include "components/stats.hpp"
#include "components/tuning.hpp"
#include "systems/grab/shared/grab_search.hpp"

namespace handhold {

using UpdateGrabsIo = GrabSearch;  // systems/grab/shared/grab_search.hpp

// A hand that closes grips, in this order:
//  - an authored grip whose snap zone it is in (talk row 10): the one of the highest priority, of
//    equal ones the one that moves the palm least. Grips that another hand occupies, or that an
//    obstacle blocks, do not count;
//  - the first surface on the palm ray (talk rows 2, 3), or one in reach of a higher
//    GrabRule::priority;
//  - the nearest surface within HandTuning::reach_m of the palm, from any angle. Other players'
//    heads, and their bodies as the last frame showed them, count as surfaces.
// The hand must get there without crossing a wall: palm or surface must be visible from where the
// palm was last outside of walls (HandSight), or from the head, or a hand's width beside those
// lines. A palm pushed through a surface grips that surface.
//
// A hand lets go if it opens, if its error exceeds HandTuning::max_stretch_m, if its body is gone,
// or if a tracking error took the palm farther than max_stretch_m from its surface. Of a player's
// two stretched hands only the worse one lets go, of two alike the one that gripped later.
// A closed hand that pulls a body (pull_bodies) grips it as soon as the body is at the palm.
//
// Bodies whose GrabRule, or whose layers by the player's GrabLayers, refuse the hand are skipped. A
// two-handed body is gripped when the second hand closes on it. A host's orders (GrabOrder) take
// precedence over closing hands and ignore the rules. But one hand alone never holds a two-handed
// body.
void update_grabs(const UpdateGrabsIo& io, const Tuning& tuning, StageStats& stats);

}  // namespace handhold
