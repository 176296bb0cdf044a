#include "tools/lab/lab_frame.hpp"

#include "systems/frame/frame_stage_timer.hpp"
#include "systems/frame/frame_stages.hpp"

namespace handhold::lab {

void step_frame_with(PositionSolver solver, World& world, FrameCaches& caches, const Tuning& tuning,
                     const FrameInput& input, StageStats& stats) {
    using namespace stages;
    const FrameContext f = begin_frame(world, caches, tuning, input, stats);
    read_input(f);
    prepare_solve(f, Contacts::searched);
    {
        const StageTimer timer(Stage::solve_phases, stats);
        solve_phases_with(solver, {.collision = f.collision(), .frame = f.graph()}, tuning, stats);
    }
    finish_positions(f);
    solve_velocities(f);
    book_momentum(f);
    record_valid_poses(f);
    finish_solve(f);
    show(f);
    advance_clock(f);
}

}  // namespace handhold::lab
