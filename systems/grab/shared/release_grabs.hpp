#pragma once

#include <cstddef>

#include "components/scaled_tuning.hpp"
#include "components/stats.hpp"
#include "components/tuning.hpp"
#include "systems/grab/shared/grab_search.hpp"

// Ends grips before anything has moved in the frame, for update_grabs. The hand and the reason are
// noted in StageStats.
namespace handhold {

// Play space of the hand at that index of `grab`.
inline const PlayerOrigin& origin_of(const GrabSearch& io, std::size_t index) {
    return io.origin.at(io.owner.at(io.grab.owners()[index]).player);
}

// Ends the grip at once. If the hand binds the other one (binds), the other hand takes a new
// anchor where it is, before anything has moved, so that its own error does not move the player.
void release_grab(const GrabSearch& io, std::size_t index, Fallback reason, StageStats& stats);

// Ends grips on bodies and players that were removed.
void release_destroyed_bodies(const GrabSearch& io, StageStats& stats);
// Ends grips whose error exceeds HandTuning::max_stretch_m times the player's scale. Evaluates
// hands that grip alone first. A hand whose partner lets go in this pass is left until the next
// frame.
void release_overstretched_grabs(const GrabSearch& io, const HandTuning& tuning, StageStats& stats);
// After a tracking error the hand may be anywhere. A held free body comes back into it
// (anchor_grabs). Any other grip ends if the palm is farther than max_stretch_m, times the player's
// scale, from the surface.
void release_grabs_out_of_reach(const GrabSearch& io, TuningOfPlayers& tunings, StageStats& stats);
// Ends grips on two-handed bodies (GrabRule::two_hands) if one of the hands has left or leaves now.
void release_half_held_bodies(const GrabSearch& io, StageStats& stats);

}  // namespace handhold
