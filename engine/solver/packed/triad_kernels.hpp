// Solver, packed: the arithmetic of TriadSystem over packed arrays, compiled once for any processor
// and once for AVX2, with the same bits. TriadSystem fills the arrays and calls the kernels in
// turn. Nothing here fails or allocates. Units are metres, seconds, kilograms and radians; vectors
// are in world axes unless noted. Terms are defined in triad_system.hpp.
//
// Work on bodies is done for four bodies at a time, work on triads block by block. Triads are those
// of the plan's rest unless noted; those of strands are stored four links at a time.

#pragma once

#include <cstdint>
#include <span>

#include "engine/math/wide_rotation.hpp"
#include "engine/solver/packed/triad_plan.hpp"

namespace handhold {

// Four bodies, one per lane. All zeros in a lane without a body or with an immovable one.
struct Bodies4 {
    Wide3 position;  // of the centre of mass
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

// One end at each of four bodies. Its contribution to the triad's residual is sign * position + arm
// (point triads) or lever * rotation (angular triads). For b's ends sign and lever are negative,
// and the arm points from the anchor point to the body's centre.
struct Ends4 {
    Wide3 point_bs;  // anchor point times the sign
    Double4 sign;    // +-1 for point triads, else 0
    Double4 lever;   // +-k_angle_lever_m for angular triads, else 0
    Wide3 arm;
};

// A 3x3 matrix per lane, by rows.
struct WideMat3 {
    Wide3 x, y, z;
};

// One step of a strand pack: a link per lane.
struct Links4 {
    Wide3 value;    // residual, as TriadArrays::values
    Wide3 unknown;  // scratch of the solve
    Wide3 impulse;  // sum of lambdas, N s
    // The step's row of the factor.
    WideSymmetric inverse;  // inverse of its own block, or the block's LDL^T
    WideMat3 next;          // inverse * block that couples it with the next link or with `after`
    // inverse * block that couples it with `before`; up to Strands4::decoupled_step
    WideMat3 before;
    bool has_pivots = false;
};

// The remainder of four strands once their links are eliminated.
struct Strands4 {
    WideSymmetric before;  // subtracted from the block of `before`
    WideSymmetric after;
    WideMat3 between;                // rows of `after`, columns of `before`
    Double4 inverse_sum;             // sum of 9 / (sum of the link's diagonal); see HarmonicMean
    std::size_t decoupled_step = 0;  // First step that is not coupled with `before`.
};

// A struct, because a template argument would lose the alignment.
struct TriadVector {
    Double4 v = {};
};

// The active rows of a strand pack, in all four lanes. Bodies outside are treated as immovable.
struct RowWindow {
    std::uint32_t begin = 0;
    std::uint32_t end = 0;  // > begin; length + 1 if the last row is included
};

// Where the plan names a dummy end, block or triad, an element exists that may be written and is
// never read, or (the dummy triad's multiplier) is 0.
struct TriadArrays {
    std::span<Bodies4> bodies;           // by place / 4
    std::span<Ends4> body_ends;          // by the plan's packed ends
    std::span<WideSymmetric> stiffness;  // as `bodies`
    std::span<Links4> links;             // by the plan's strand pack steps
    std::span<Wide3> multipliers;  // lambdas of strand packs: see TriadPlan::StrandPack::bound
    std::span<Strands4> strands;   // by strand pack
    std::span<TriadVector> ends;   // by end: its contribution to the triad's residual
    // By triad: residual, as Row::residual (metres or m/s; angles times k_angle_lever_m).
    std::span<TriadVector> values;
    std::span<TriadVector> lambdas;  // by triad, of the last solve: on a; b gets the opposite
    std::span<const std::uint8_t> is_drive;  // by triad: 1 for drives
    std::span<Rows3> blocks;                 // the plan's
    std::span<Rows3> inverses;               // by step: inverse of its own block
    // Scratch by step: the diagonals during factorisation, then intermediate results of the
    // substitution.
    std::span<TriadVector> unknowns;
    std::span<const RowWindow> windows;  // by strand pack
    const TriadPlan* plan = nullptr;
    bool has_turn = false;       // at least one triad is angular
    bool has_stiffness = false;  // inertia includes the geometric stiffness
};

// Largest squared translation and rotation of the bodies, m^2 and rad^2.
struct LargestMove {
    double move_square = 0.0;
    double turn_square = 0.0;
};

struct TriadKernels {
    // Computes axes, arms, ends and residuals at the bodies' poses; residuals of angular triads are
    // computed by TriadSystem. Ends at immovable bodies, and everything outside the windows, must
    // be up to date. The velocity kernels ignore the windows.
    void (*evaluate)(const TriadArrays& arrays);
    // Residuals of the velocities, without the drives' own velocities.
    void (*evaluate_velocities)(const TriadArrays& arrays);
    // Largest squared norm of a residual.
    double (*worst_square)(const TriadArrays& arrays);
    // Sums the geometric stiffness from the arms and multipliers of the last solve
    // (positive_stiffness).
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
