// Solver, newton: what a Newton iteration asks of the linear algebra of one step. Three classes
// provide it: RowSteps (row by row), TriadSteps (packed), SweepSteps (heaps).

#pragma once

#include <concepts>
#include <cstdint>
#include <optional>

#include "engine/solver/model/regularisation.hpp"

namespace handhold {

// The rows at the current poses.
struct StepErrors {
    double worst_m = 0.0;        // largest error
    double worst_drive_m = 0.0;  // greatest error of the drives
    double overlap_m = 0.0;      // greatest overlap of the contacts
    bool has_contact = false;
    bool keeps_factor = false;  // the factor of the last step fits these rows
};

// Hints from the iteration to a step, which may use them to cost less or to converge better.
struct StepHints {
    bool adds_stiffness = false;  // add geometric stiffness, from the multipliers of the last step
    // Bodies that the last step moved by less may be skipped; none: all take part.
    std::optional<double> min_move_m;
};

// What the solves since the island was loaded have cost, and whether the last one's active set did
// not converge.
struct StepWork {
    std::uint64_t spent = 0;
    bool is_active_set_unconverged = false;
};

// One Newton step: evaluate, solve, look at the length of the move, apply it.
//   evaluate(was_whole)    errors at the current poses; was_whole: the last step was not scaled
//                          down
//   solve(R, factor)       (J W J^T + factor * R) lambda = -C; finds the moves dx = W J^T lambda
//   longest_move()         of the last solve, metres
//   largest_rotation()     of the last solve, radians
//   apply_moves(scale)     moves the bodies; returns the longest move, metres, rotations counting
//                          times k_angle_lever_m
template <typename T>
concept NewtonStep = requires(T& step, bool was_whole, const Regularisation& r, double scale) {
    { step.evaluate(was_whole) } -> std::same_as<StepErrors>;
    { step.solve(r, scale) } -> std::same_as<StepWork>;
    { step.longest_move() } -> std::same_as<double>;
    { step.largest_rotation() } -> std::same_as<double>;
    { step.apply_moves(scale) } -> std::same_as<double>;
};

// A step that has a factor, and may use it twice.
//   prepare(hints)             before every solve but the first
//   solve_with_last_factor()   in place of `solve`, if StepErrors::keeps_factor
//   k_has_cheap_factor         a new factor costs little more than a solve
template <typename T>
concept FactorisedStep = NewtonStep<T> && requires(T& step, const StepHints& hints) {
    step.prepare(hints);
    step.solve_with_last_factor();
    { T::k_has_cheap_factor } -> std::convertible_to<bool>;
};

}  // namespace handhold
