#pragma once

#include "components/frame_graph.hpp"
#include "components/stats.hpp"
#include "components/tuning.hpp"
#include "engine/collision/collision_world.hpp"

namespace handhold {

struct SolvePhasesIo {
    CollisionWorld& collision;  // in/out: proxies follow the phases
    FrameGraph& frame;          // in/out: poses of the graph's bodies
};

// Stages 6 to 8: the player as designer's physics sees him (talk rows 4, 7). Each phase is a Newton
// solve of every island:
//
// - reach: hands and joints, the world as the hands want it. A player who holds on to something
// fixed
//   is moved; one who holds a light object is not, he is infinitely heavy.
// - forward: contacts too, the player infinitely heavy. What is free gives way to what is not. Only
//   islands with a free object.
// - backward: true masses, contacts hard. Where forward left something violated, and the island
//   touches something fixed or another player, the player is pushed. Held objects begin where the
//   hand wants them: pushed back by exactly the violation, whatever their mass (decision 5).
// - contradiction: what contacts still overlap is taken apart without the hands.
//
// After each phase colliders are swept from their last valid pose to the solved one; new contacts
// join and the phase repeats. An island that no contact violates never reaches the second phase:
// the origin of a player who waves a rock is bitwise unchanged.
void solve_phases(const SolvePhasesIo& io, const Tuning& tuning, StageStats& stats);

}  // namespace handhold
