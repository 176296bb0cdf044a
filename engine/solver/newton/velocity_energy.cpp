// Solver, newton: restitution never adds energy. The equations are in the header.
#include "engine/solver/newton/velocity_energy.hpp"

#include <algorithm>
#include <cmath>

namespace handhold {
namespace {

// Kinetic energy of the gathered moves if they were velocities, J.
double kinetic_energy(const IslandView& island, const SolveScratch& scratch) {
    double energy = 0.0;
    for (const std::uint32_t index : island.island_bodies) {
        const SolverBody& body = island.bodies[index];
        if (!(body.inverse_mass > 0.0)) {
            continue;
        }
        energy += 0.5 * scratch.moves_m[body.slot].squaredNorm() / body.inverse_mass;
        if (body.inverse_inertia_bs.squaredNorm() > 0.0) {
            const Vec3 turn_bs =
                body.pose_ws.rotation.conjugate() * scratch.rotations_rad[body.slot];
            energy += 0.5 * turn_bs.dot(turn_bs.cwiseQuotient(body.inverse_inertia_bs));
        }
    }
    return energy;
}

// Linear part of the work function, J: the rows' velocities before, relative to what drives and
// motors ask for, times the multipliers. Restitution is not part of it.
double linear_work(const SolveScratch& scratch) {
    double work = 0.0;
    for (std::size_t i = 0; i < scratch.rows.size(); ++i) {
        const bool is_contact_row = scratch.rows[i].group == RowGroup::contact;
        const double restitution_mps = is_contact_row ? scratch.approach_mps[i] : 0.0;
        work += scratch.lambda[i] * (scratch.rows[i].residual - restitution_mps);
    }
    return work;
}

void scale_moves(double factor, SolveScratch& scratch) {
    for (double& lambda : scratch.lambda) {
        lambda *= factor;
    }
    for (std::size_t slot = 0; slot < scratch.moves_m.size(); ++slot) {
        scratch.moves_m[slot] *= factor;
        scratch.rotations_rad[slot] *= factor;
    }
}

void add_bouncing_moves(double factor, SolveScratch& scratch) {
    for (std::size_t i = 0; i < scratch.lambda.size(); ++i) {
        scratch.lambda[i] += factor * scratch.bouncing_lambda[i];
    }
    for (std::size_t slot = 0; slot < scratch.moves_m.size(); ++slot) {
        scratch.moves_m[slot] += factor * scratch.bouncing_moves_m[slot];
        scratch.rotations_rad[slot] += factor * scratch.bouncing_rotations_rad[slot];
    }
}

void clear_restitution(SolveScratch& scratch) {
    for (std::size_t i = 0; i < scratch.rows.size(); ++i) {
        if (scratch.rows[i].group == RowGroup::contact) {
            scratch.rows[i].residual -= scratch.approach_mps[i];
            scratch.approach_mps[i] = 0.0;
        }
    }
}

}  // namespace

void limit_energy(const IslandView& island, const std::function<void()>& solve,
                  SolveScratch& scratch) {
    constexpr double k_rounding = 1e-10;
    if (!has_contact(scratch.rows)) {
        return;
    }
    const double exchanged = kinetic_energy(island, scratch);
    const double with_restitution = linear_work(scratch) + exchanged;
    if (with_restitution <= k_rounding * exchanged) {
        return;
    }
    std::swap(scratch.bouncing_lambda, scratch.lambda);
    std::swap(scratch.bouncing_moves_m, scratch.moves_m);
    std::swap(scratch.bouncing_rotations_rad, scratch.rotations_rad);
    clear_restitution(scratch);
    solve();
    const double linear = linear_work(scratch);
    const double quadratic = kinetic_energy(island, scratch);
    if (linear + quadratic > 0.0) {
        // The solution is inexact: takes a shorter step from the velocities before the solve.
        scale_moves(quadratic > 0.0 ? std::clamp(-linear / quadratic, 0.0, 1.0) : 0.0, scratch);
        return;
    }
    // Replaces scratch by the difference of both solutions, and restores it afterwards.
    scale_moves(-1.0, scratch);
    add_bouncing_moves(1.0, scratch);
    const double h = kinetic_energy(island, scratch);
    const double g = with_restitution - (linear + quadratic) - h;
    const double w = linear + quadratic;
    const double root = std::sqrt(std::max(0.0, g * g - 4.0 * h * w));
    const double s = h > 0.0 ? std::clamp((root - g) / (2.0 * h), 0.0, 1.0) : 0.0;
    scale_moves(s - 1.0, scratch);
    add_bouncing_moves(1.0, scratch);
}

}  // namespace handhold
