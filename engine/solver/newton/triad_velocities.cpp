// Solver, newton: velocity solve of an island in packed triads.
#include "engine/solver/newton/triad_velocities.hpp"

#include <limits>

namespace handhold {

// Iterative refinement with one factor until the rows are satisfied or cannot be (see
// refine_velocities in velocities.cpp).
void solve_triad_velocities(const IslandView& island, const VelocitySettings& settings,
                            TriadSystem& triads) {
    for (const std::uint32_t index : island.island_blocks) {
        RowBlock& block = island.blocks[index];
        block.impulse_ws_ns.setZero();
        block.angular_impulse_ws_nms.setZero();
        block.joint.lock_impulse = 0.0;
    }
    triads.evaluate_if_moved(island);
    triads.factorise(settings.regularisation, 1.0);
    triads.evaluate_velocities(island);
    double previous = std::numeric_limits<double>::infinity();
    for (int i = 0; i <= settings.refinements; ++i) {
        triads.solve();
        triads.apply_impulses();
        triads.evaluate_velocities(island);
        const double worst = triads.worst_residual();
        if (worst < settings.tolerance_mps || worst > 0.5 * previous) {
            break;
        }
        previous = worst;
    }
    triads.store_velocities(island);
}

}  // namespace handhold
