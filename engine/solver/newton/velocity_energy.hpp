// Solver, newton: restitution never adds energy.

#pragma once

#include <functional>

#include "engine/solver/newton/island_system.hpp"

namespace handhold {

// Newton's restitution adds energy if some contacts of a body bounce and others do not, and if
// friction turns a bounce. Then the result is the largest step from the solution without
// restitution (0) towards the one with it (e) whose work is not positive:
//   lambda = lambda_0 + s (lambda_e - lambda_0),   work(s) = w_0 + g s + h s^2 <= 0
// Both solutions satisfy lambda_n >= 0, v_n >= 0 and Coulomb's cone, hence so does what lies
// between. `scratch` holds the solution with restitution;
// `solve` solves scratch.rows again after restitution was removed from them. Returns false if
// nothing had to be done. `refine` improves the last solution, since nobody does so afterwards.
bool limit_energy(const IslandView& island, const std::function<void()>& solve,
                  const std::function<void()>& refine, SolveScratch& scratch);

}  // namespace handhold
