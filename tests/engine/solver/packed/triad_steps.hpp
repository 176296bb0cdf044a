#pragma once

#include <limits>

#include <gtest/gtest.h>

#include "engine/solver/packed/triad_system.hpp"

namespace handhold::test {

// Two position steps and one velocity step by TriadSystem alone. Contacts must be touching (none
// may be ignored).
inline void solve_a_step(TriadSystem& system, const IslandView& island) {
    ASSERT_TRUE(system.load(island, std::numeric_limits<double>::infinity()));
    for (int step = 0; step < 2; ++step) {
        system.evaluate(island);
        if (step > 0) {
            system.gather_stiffness();
        }
        system.factorise({}, 1.0);
        system.solve();
        system.apply_moves(0.9);
    }
    system.store_poses(island);
    system.evaluate_velocities(island);
    system.solve();
    system.apply_impulses();
    system.store_velocities(island);
}

}  // namespace handhold::test
