#pragma once

#include <cstdint>
#include <span>

#include "engine/math/wide_rotation.hpp"
#include "engine/solver/packed/triad_plan.hpp"

// The arithmetic of TriadSystem, over packed arrays: once for any processor, once for AVX2, with
// equal bits. TriadSystem fills the arrays and calls the kernels in turn; nothing here fails or
// allocates. Metres, seconds, kilograms, radians; the world's axes where nothing else is said.
//
// A triad is three rows, one a world axis: a point held on a point, or a rotation on a rotation.
// Those of strands are in four lanes; where nothing else is said, triads are those of the plan's
// rest.
// Its ends, 2 * triad for a's and 2 * triad + 1 for b's, are what bodies see of it. Everything that
// belongs to a body is done for four bodies at once, everything between triads block by block.
namespace handhold {

// Lane i belongs to the i-th of four bodies that may move; all 0 where there is none, or where
// nothing moves it.
struct Bodies4 {
    Wide3 position;  // of the centre
    Wide4 rotation;  // unit
    Wide3 velocity;
    Wide3 spin;
    WideAxes axes;                  // its own axes in the world
    WideSymmetric inverse_inertia;  // with the stiffness; 0 where it cannot turn
    Wide3 inverse_inertia_bs;       // principal, body axes
    Double4 inverse_mass;
    Wide3 move;  // W J^T lambda of the last solve
    Wide3 turn;
};

// An end at each of four bodies. Its part in the triad's value is sign * position + arm, or
// lever * rotation: b's sign and lever are negative, and its arm points from its point to its
// centre.
struct Ends4 {
    Wide3 point_bs;  // times the sign
    Double4 sign;    // +-1 where it holds a point, else 0
    Double4 lever;   // +-k_angle_lever_m where it holds a rotation, else 0
    Wide3 arm;
};

// A 3x3 matrix in each lane, by rows.
struct WideMat3 {
    Wide3 x, y, z;
};

// Of one step of a braid, a link in each lane.
struct Links4 {
    Wide3 value;    // as TriadArrays::values
    Wide3 unknown;  // scratch of the solve
    Wide3 impulse;  // sum of lambdas
    // The step's row of the factor.
    WideSymmetric inverse;  // of its own block; or its pivots
    WideMat3 next;          // the inverse times the block with the next link, or with `after`
    WideMat3 before;        // and times that with `before`, up to Strands4::decoupled_step
    bool has_pivots = false;
};

// What is left of four strands once their links are eliminated.
struct Strands4 {
    WideSymmetric before;  // is taken off the block of `before`
    WideSymmetric after;
    WideMat3 between;                // rows of `after`, columns of `before`
    Double4 inverse_sum;             // of 9 / the sum of each link's diagonal
    std::size_t decoupled_step = 0;  // the first step from which on nothing is tied to `before`
};

// In a struct, for a template's argument would forget the alignment.
struct TriadVector {
    Double4 v = {};
};

// The rows of a braid that a step may move, in all four lanes; whatever lies beyond is held where
// it is, as if nothing could move it.
struct RowWindow {
    std::uint32_t begin = 0;
    std::uint32_t end = 0;  // > begin; one more than the braid's length where the last row is in it
};

// Where a plan speaks of a spare end or block, there is one: it is written and means nothing.
// The spare triad's multiplier is 0.
struct TriadArrays {
    std::span<Bodies4> bodies;           // by the plan's places
    std::span<Ends4> body_ends;          // as the plan's packed ends
    std::span<WideSymmetric> stiffness;  // as bodies
    std::span<Links4> links;             // by the plan's braid steps
    std::span<Wide3> multipliers;        // lambdas of braids: see TriadPlan::StrandPack::bound
    std::span<Strands4> strands;         // by braid
    std::span<TriadVector> ends;         // by end: its part in the triad's value
    std::span<TriadVector>
        values;  // by triad: metres, angles at k_angle_lever_m; or metres a second
    std::span<TriadVector> lambdas;  // by triad, of the last solve: on a, b's is the opposite
    std::span<const std::uint8_t> is_drive;  // by triad: whether it is a hand's
    std::span<Rows3> blocks;                 // the plan's
    std::span<Rows3> inverses;               // by step of the plan: of its own block
    // Scratch by step: the diagonals while it is factorised, what is not yet solved for afterwards.
    std::span<TriadVector> unknowns;
    std::span<const RowWindow> windows;  // by braid
    const TriadPlan* plan = nullptr;
    bool has_turn = false;       // some triad holds a rotation
    bool has_stiffness = false;  // inertia has the stiffness added
};

// The largest squares among the bodies, metres and radians.
struct LargestMove {
    double move_square = 0.0;
    double turn_square = 0.0;
};

struct TriadKernels {
    // Axes, arms, ends and positional errors at the bodies' poses; rotations' errors are not its
    // matter. What is at the ends of those that nothing moves is there already, and so is all that
    // belongs to rows beyond the windows. Velocities know no windows.
    void (*evaluate)(const TriadArrays& arrays);
    // What each triad's velocity lacks but for the hands' own.
    void (*evaluate_velocities)(const TriadArrays& arrays);
    // The largest square of a value.
    double (*worst_square)(const TriadArrays& arrays);
    // Geometric stiffness at the arms and multipliers of the last solve: positive_stiffness,
    // summed.
    void (*gather_stiffness)(const TriadArrays& arrays);
    // Inertia at the axes, J W J^T in the plan's blocks, and the factor of strands, whose links
    // have a share of the diagonal as alpha.
    void (*multiply_out)(const TriadArrays& arrays, double joint_alpha);
    // In their place the factor. Alpha: a number of hands, a share of the diagonal of joints.
    void (*factorise)(const TriadArrays& arrays, double drive_alpha, double joint_alpha);
    // lambda of the values, and the bodies' moves and turns.
    LargestMove (*solve)(const TriadArrays& arrays);
    // Moves and turns the bodies by so much of it.
    void (*apply)(const TriadArrays& arrays, double scale);
    // Adds it to their velocities.
    void (*apply_velocities)(const TriadArrays& arrays);
};

// The fastest that this processor has; and those that every one has.
const TriadKernels& triad_kernels();
const TriadKernels& portable_triad_kernels();

}  // namespace handhold
