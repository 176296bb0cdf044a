#include "engine/solver/triad_velocities.hpp"

#include <limits>

namespace handhold {

// The same refinements as for any rows: with the factor at hand, until the rows are met or cannot
// be.
void solve_triad_velocities(const IslandView& island, const Softness& softness,
                            TriadSystem& triads) {
    constexpr double k_speed_tolerance_mps = 1e-10;
    constexpr int k_refinements = 8;
    for (const std::uint32_t index : island.island_blocks) {
        RowBlock& block = island.blocks[index];
        block.impulse_ws_ns.setZero();
        block.couple_ws_nms.setZero();
        block.joint.lock_impulse = 0.0;
    }
    triads.evaluate(island);
    triads.factorise(softness, 1.0);
    triads.evaluate_velocities(island);
    double previous = std::numeric_limits<double>::infinity();
    for (int i = 0; i <= k_refinements; ++i) {
        triads.solve();
        triads.apply_impulses(island);
        triads.evaluate_velocities(island);
        const double worst = triads.worst_value();
        if (worst < k_speed_tolerance_mps || worst > 0.5 * previous) {
            break;
        }
        previous = worst;
    }
    triads.store_velocities(island);
}

}  // namespace handhold
