#pragma once

#include <cstdint>

#include "tests/engine/solver/scene.hpp"

namespace handhold::test {

inline constexpr double k_half_link_m = 0.05;

// A straight chain of `links` rods on a fixed body, every other one a thousand times as heavy as
// its neighbours, and a drive of the last rod's end to `target`.
inline SolverScene uneven_chain(std::uint32_t links, RowKind joint, const Vec3& target) {
    const Vec3 end(k_half_link_m, 0.0, 0.0);
    SolverScene scene;
    scene.graph.bodies = {fixed_body(1)};
    for (std::uint32_t i = 0; i < links; ++i) {
        const double mass_kg = i % 2 == 0 ? 1.0 : 1000.0;
        const double across = mass_kg * k_half_link_m * k_half_link_m / 3.0;
        scene.graph.bodies.push_back(free_body(i + 2, mass_kg, Vec3(0.3 * across, across, across),
                                               {(2.0 * i + 1.0) * end, Quat::Identity()}));
        scene.graph.blocks.push_back(
            row_block(joint, i, i + 1, i == 0 ? Vec3(Vec3::Zero()) : end, -end));
    }
    scene.graph.bodies.push_back(translating_body(links + 2, 80.0));
    scene.body(links + 1).inverse_mass = 0.0;
    scene.graph.blocks.push_back(row_block(RowKind::drive_point, links + 1, links, target, end));
    return scene;
}

}  // namespace handhold::test
