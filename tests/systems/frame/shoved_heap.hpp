#pragma once

#include <string>

#include "tests/systems/frame/scenario.hpp"

namespace handhold::test {

inline constexpr double k_heap_half_m = 0.1;  // half extent of its crates

// side^3 crates 5 mm apart before a wall, and a crate in the right hand that is pushed into them at
// up to 1.5 m/s.
inline void add_shoved_heap(int side, Scenario& s) {
    const Vec3 half_m = Vec3::Constant(k_heap_half_m);
    s.add_crate("held", 2.0, Vec3(0.3, 1.2 - k_heap_half_m - 0.02, -0.1), half_m);
    const double spacing_m = 2.0 * k_heap_half_m + 0.005;
    const Vec3 first(0.3 - 0.5 * (side - 1) * spacing_m, 1.2 - 0.5 * (side - 1) * spacing_m, -0.45);
    for (int i = 0; i < side * side * side; ++i) {
        const Vec3 place(i % side, i / side % side, -(i / (side * side)));
        s.add_crate("crate" + std::to_string(i), 5.0, first + spacing_m * place, half_m);
    }
    s.add_wall("wall", Vec3(3.0, 3.0, 0.1),
               Vec3(0.3, 1.2, -0.45 - side * spacing_m + k_heap_half_m - 0.2));
    s.script.grabs[1] = [](double) { return true; };
    s.script.hands[1] = [](double t_s) {
        return Pose{Vec3(0.3, 1.2, -0.02 - 0.6 * ease(t_s, 0.2, 0.6)), Quat::Identity()};
    };
    s.add_player_here();
}

}  // namespace handhold::test
