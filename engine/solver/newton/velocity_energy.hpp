// Solver, newton: contacts add no energy to what drives and motors do.

#pragma once

#include <functional>

#include "engine/solver/newton/island_system.hpp"

namespace handhold {

// Newton's restitution adds energy if some contacts of a body bounce and others do not, and if
// friction turns a bounce. The rows' work is b^T lambda + 1/2 lambda^T J W J^T lambda, where b
// holds the rows' velocities before the solve, relative to what drives and motors ask for. If it is
// positive, the result is the largest step from the solution without restitution (0) towards the
// one with it (e) whose work is not:
//   lambda = lambda_0 + s (lambda_e - lambda_0),   work(s) = w_0 + g s + h s^2 <= 0
// Both solutions satisfy lambda_n >= 0, v_n >= 0 and Coulomb's cone, hence so does what lies
// between. If even lambda_0 does positive work, because it was not solved exactly, it is scaled
// down: then drives and contacts are met in part.
//
// `scratch` holds the final solution with restitution: whatever improved it afterwards could add
// energy again. `solve` solves scratch.rows again after restitution was removed from them.
void limit_energy(const IslandView& island, const std::function<void()>& solve,
                  SolveScratch& scratch);

}  // namespace handhold
