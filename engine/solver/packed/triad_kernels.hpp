// Solver, packed: the arithmetic of TriadSystem over packed arrays, compiled once for any processor
// and once for AVX2, with the same bits. TriadSystem fills the arrays and calls the kernels in
// turn. Nothing here fails or allocates. Units are metres, seconds, kilograms and radians; vectors
// are in world axes unless noted. Terms are defined in triad_system.hpp.
//
// Bodies are processed four at a time, triads block by block. Unless noted, triads are those
// outside strands (TriadPlan::rest); those of strands are stored four links at a time.

#pragma once

#include <cstdint>
#include <span>

#include "engine/math/wide_rotation.hpp"
#include "engine/solver/packed/triad_plan.hpp"

namespace handhold {

// Four bodies, one per lane. Inverse mass and inertia are 0 in a lane without a body or with an
// immovable one.
struct Bodies4 {
    Wide3 position;  // position of the centre of mass
    Wide4 rotation;  // unit
    Wide3 velocity;
    Wide3 spin;
    WideAxes axes;  // body axes in world axes
    // world axes, with the geometric stiffness; 0 if the body cannot rotate
    WideSymmetric inverse_inertia;
    Wide3 inverse_inertia_bs;  // principal, body axes
    Double4 inverse_mass;
    Wide3 move;  // translation in the last solve, part of W J^T lambda
    Wide3 turn;
};

// One end (side a or b of a triad) at each of four bodies. An end contributes sign * position + arm
// to its triad's residual (point triads), or lever * rotation (angular triads). For b's ends, sign
// and lever are negative, and the arm points from the anchor point to the body's centre.
struct Ends4 {
    Wide3 point_bs;  // anchor point times the sign
    Double4 sign;    // point triads: +1 for side a, -1 for side b; others: 0
    Double4 lever;   // +-k_angle_lever_m for angular triads, else 0
    Wide3 arm;
};

// A 3x3 matrix per lane, by rows.
struct WideMat3 {
    Wide3 x, y, z;
};

// One step of a strand pack: one link in each of its four strands. `before` and `after` are the
// nodes outside the strand at its ends (TriadPlan::StrandPack).
struct Links4 {
    Wide3 value;    // residual, see TriadArrays::values
    Wide3 unknown;  // scratch of the solve
    Wide3 impulse;  // sum of lambdas, N s
    // The step's row of the factor.
    WideSymmetric inverse;  // inverse of its own block, or the block's LDL^T
    // inverse times the block that couples the link with the next one, or with `after`
    WideMat3 next;
    // Inverse times the block that couples the link with `before`; valid up to
    // Strands4::decoupled_step.
    WideMat3 before;
    bool has_pivots = false;
};

// Contribution of four eliminated strands to the blocks of `before` and `after` (as in Links4).
struct Strands4 {
    WideSymmetric before;  // subtracted from the block of `before`
    WideSymmetric after;
    // Rows of `after`, columns of `before`; added to the block that couples them.
    WideMat3 between;
    Double4 inverse_sum;  // sum over links of 9 / (sum of its diagonal); see HarmonicMean
    std::size_t decoupled_step = 0;  // first step not coupled with `before`
};

// Wraps a Double4, which would lose its alignment as a template argument.
struct TriadVector {
    Double4 v = {};
};

// Active rows of a strand pack, the same in all four lanes. Bodies outside are treated as
// immovable.
struct RowWindow {
    std::uint32_t begin = 0;
    std::uint32_t end = 0;  // > begin; length + 1 if the last row is included
};

// `ends`, `lambdas` and `blocks` have one extra element for the dummies of the plan. A dummy end or
// block may be written, but has no effect. The dummy triad's multiplier is 0.
struct TriadArrays {
    std::span<Bodies4> bodies;           // one per group of four bodies: place / 4
    std::span<Ends4> body_ends;          // indexed by TriadPlan::packed_ends
    std::span<WideSymmetric> stiffness;  // indexed like `bodies`
    // indexed like StrandPlan::links(): one entry per step of each strand pack
    std::span<Links4> links;
    std::span<Wide3> multipliers;  // lambdas of strand packs: see TriadPlan::StrandPack::bound
    std::span<Strands4> strands;   // indexed by strand pack
    std::span<TriadVector> ends;   // contribution of each end to the triad's residual
    // By triad: residual, as Row::residual (metres or m/s; angles times k_angle_lever_m).
    std::span<TriadVector> values;
    std::span<TriadVector>
        lambdas;  // impulse of each triad on a in the last solve; b gets the opposite
    std::span<const std::uint8_t> is_drive;  // one per triad; 1: a drive
    std::span<Rows3> blocks;    // matrix, then factor; indexed by the plan's block index
    std::span<Rows3> inverses;  // inverse of each step's diagonal block
    // Scratch by step: the diagonals during factorisation, then intermediate results of the
    // substitution.
    std::span<TriadVector> unknowns;
    std::span<const RowWindow> windows;  // indexed by strand pack
    const TriadPlan* plan = nullptr;
    bool has_turn = false;       // true: one triad or more is angular
    bool has_stiffness = false;  // inertia includes the geometric stiffness
};

// Largest squared translation and rotation of the bodies, m^2 and rad^2.
struct LargestMove {
    double move_square = 0.0;
    double turn_square = 0.0;
};

struct TriadKernels {
    // Computes axes, arms, ends and residuals at the bodies' poses, except the residuals of angular
    // triads (TriadSystem::evaluate). Precondition: ends at immovable bodies, and all values
    // outside the windows, are up to date. The velocity kernels ignore the windows.
    void (*evaluate)(const TriadArrays& arrays);
    // Computes the velocity residuals, without the velocities of the drives' targets.
    void (*evaluate_velocities)(const TriadArrays& arrays);
    // Largest squared norm of a residual.
    double (*worst_square)(const TriadArrays& arrays);
    // Computes the bodies' geometric stiffness (positive_stiffness) from the arms and the
    // multipliers of the last solve.
    void (*gather_stiffness)(const TriadArrays& arrays);
    // Computes the inertia in world axes, writes J W J^T to the plan's blocks and factorises the
    // strands. `joint_alpha` is relative to the diagonal.
    void (*multiply_out)(const TriadArrays& arrays, double joint_alpha);
    // Replaces the blocks by their factor. `drive_alpha` is absolute, `joint_alpha` relative to the
    // diagonal.
    void (*factorise)(const TriadArrays& arrays, double drive_alpha, double joint_alpha);
    // Solves for lambda and the bodies' translations and rotations.
    LargestMove (*solve)(const TriadArrays& arrays);
    // Moves the bodies by `scale` times the last solve.
    void (*apply)(const TriadArrays& arrays, double scale);
    // Adds the last solve to the bodies' velocities.
    void (*apply_velocities)(const TriadArrays& arrays);
};

// The fastest kernels this processor supports, and the portable ones.
const TriadKernels& triad_kernels();
const TriadKernels& portable_triad_kernels();

}  // namespace handhold
