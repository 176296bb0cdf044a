// Solver, model: removes numbers so small that processors treat them differently.

#pragma once

#include <cmath>

#include "engine/solver/model/island_view.hpp"

namespace handhold {

// Sets coordinates and velocities of an island's bodies to 0 if they are below 1e-250 (SI units).
// Some processors flush denormals during a solve, and others cannot (flush_denormals.hpp). Without
// this, their results would differ in immeasurably small numbers.
inline void drop_negligible(const IslandView& island) {
    const auto drop = [](double& value) {
        constexpr double k_negligible = 1e-250;
        value = std::abs(value) < k_negligible ? 0.0 : value;
    };
    for (const std::uint32_t index : island.island_bodies) {
        SolverBody& body = island.bodies[index];
        if (body.role == BodyRole::fixed) {
            continue;  // fixed bodies may be shared by islands: never written
        }
        for (Eigen::Index axis = 0; axis < 3; ++axis) {
            drop(body.pose_ws.position[axis]);
            drop(body.velocity_mps[axis]);
            drop(body.spin_radps[axis]);
        }
        for (double& part : body.pose_ws.rotation.coeffs()) {
            drop(part);
        }
    }
}

}  // namespace handhold
