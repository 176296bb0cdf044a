// Solver, newton: the rows of a Newton step, their errors, and the moves of a step.

#pragma once

#include <span>
#include <vector>

#include "engine/solver/newton/island_system.hpp"

namespace handhold {

bool has_unilateral_block(const IslandView& island);

// Collects all equality rows, and the contact and limit rows close enough to become active. If a
// step violates an omitted row, that row is close enough in the next step.
void collect_rows(const IslandView& island, std::vector<Row>& rows);

// Deepest overlap of the contact rows, metres.
double worst_overlap(std::span<const Row> rows);
// Largest error, metres. The rows of one vector-valued error enter with their norm, so that the
// result does not depend on the world's orientation.
double worst_error(std::span<const Row> rows);
// Largest error of the drives.
double worst_drive_error(std::span<const Row> rows);

// Adds the geometric stiffness of all point, distance and cone rows to the bodies', from the rows
// and multipliers of the last step.
void gather_stiffness(const IslandView& island, SolveScratch& scratch);

// Moves the bodies by `scale` times the gathered moves. Returns the longest move, metres; rotations
// count times k_angle_lever_m.
double apply_moves(const IslandView& island, double scale, const SolveScratch& scratch);

}  // namespace handhold
