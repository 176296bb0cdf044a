#pragma once

#include "systems/host/host_world.hpp"

// Shared by the step functions of the C interface: the work before and after the stages of a step.
namespace handhold {

// A kind of whole step.
struct HostStep {
    void (*run)(World&, FrameCaches&, const Tuning&, const FrameInput&, StageStats&);
    // False: the clock stands. Samples of later steps are dropped, and only grips that ended since
    // the last step make events.
    bool advances = true;
    bool shows_hands = true;  // runs the shown stages
    bool moves_bodies = true;
};
// Checks the inputs and runs the step.
hh_result step_with(hh_world* world, double dt_s, const hh_player_input* inputs, std::size_t count,
                    const HostStep& step);
// Runs a step's stages with inputs that are good, and finds its events.
void run_step(hh_world& host, const FrameInput& input, const HostStep& step);
// Throws HH_ERROR_STATE while the world is in a match, whose calls step it.
void require_no_match(const hh_world& host);
// The assets of the world's shapes, for its snapshots.
const SnapshotAssets& assets_of(hh_world& host);
// Makes the spheres of players' heads that a restored world needs.
MissingHeads missing_heads(hh_world& host);
// Call after the world's state was replaced by a snapshot's.
void finish_restore(hh_world& host);
// Call after a step's stages. Counts the invalid answers of the host's surface queries and the
// samples too far ahead or too old, and recycles shapes that were removed before the step.
void finish_step(hh_world& host);

}  // namespace handhold
