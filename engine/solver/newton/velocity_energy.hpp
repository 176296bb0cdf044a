// Solver, newton: reduces restitution so that contacts add no energy.

#pragma once

#include <functional>

#include "engine/solver/newton/island_system.hpp"

namespace handhold {

// Newton's restitution adds energy if some contacts of a body bounce and others do not, or if
// friction changes the direction of a bounce. The rows' work is b^T lambda + 1/2 lambda^T J W J^T
// lambda, where b holds the rows' velocities before the solve, relative to the velocities that
// drives and motors require. If the work is positive, the result is the point farthest from the
// solution without restitution (lambda_0) towards the solution with restitution (lambda_e) whose
// work is not positive:
//   lambda = lambda_0 + s (lambda_e - lambda_0),   work(s) = w_0 + g s + h s^2 <= 0
// Both solutions satisfy lambda_n >= 0, v_n >= 0 and Coulomb's cone, hence so does every point
// between them. If even lambda_0 does positive work, because it was not solved exactly, it is
// scaled down; drives and contacts are then satisfied only in part.
//
// `scratch` holds the final solution with restitution, because any later refinement could add
// energy again. `solve` is called to solve scratch.rows again, after restitution was removed from
// them.
void limit_energy(const IslandView& island, const std::function<void()>& solve,
                  SolveScratch& scratch);

}  // namespace handhold
