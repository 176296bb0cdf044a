#pragma once

#include "engine/solver/newton/island_system.hpp"

// The one velocity solve.
namespace handhold {

struct VelocitySettings {
    double touch_m = 1e-4;               // contacts closer than this count
    double restitution_speed_mps = 0.2;  // slower impacts do not bounce
    Regularisation regularisation{};     // at first
    int friction_passes = 16;            // at most, to find who sticks and who slides
    double tolerance_mps = 1e-10;        // refined until nothing lacks more
    int refinements = 8;                 // at most
};
// What an island's friction had no answer to in one frame.
struct VelocityResult {
    bool wedged = false;  // pressed the harder the harder it was held, or gained energy by it:
                          // its contacts slip freely
    bool friction_unconverged = false;  // who sticks and who slides still changed in the last pass
    bool active_set_unconverged =
        false;  // rows were left out that may overlap: changes of the active set ran out
};
// One solve over the same rows: hands move as they are driven, joints keep, contacts
// v_n >= -e v_n(before), and what slides is held back by at most its friction. Writes velocities,
// impulses and what held locked joints.
VelocityResult solve_velocities(const IslandView& island, const VelocitySettings& settings,
                                SolveScratch& scratch);

}  // namespace handhold
