#pragma once

#include <cstdint>
#include <span>

#include "engine/math/four.hpp"
#include "engine/solver/triad_plan.hpp"

// The arithmetic of TriadSystem, over packed arrays: once for any processor, once for AVX2, with
// equal bits. TriadSystem fills the arrays and calls the kernels in turn; nothing here fails or
// allocates. Metres, seconds, kilograms, radians; the world's axes where nothing else is said.
namespace handhold {

// Three rows, one a world axis: a point held on a point, or a rotation on a rotation.
struct Triad {
    std::uint32_t block = 0;       // into the graph's blocks
    std::uint32_t bodies[2] = {};  // into TriadArrays::bodies: a, b
    bool turns = false;            // rotation on rotation
    bool is_hand = false;
    Four points[2] = {};  // of a and b, in their axes
};

struct TriadBody {
    Four position = {};  // of the centre
    Four rotation = {};  // unit, (x, y, z, w)
    Four velocity = {};
    Four spin = {};
    Rows3 axes{};                  // by columns: its own axes in the world
    Rows3 inverse_inertia{};       // in the world; with the stiffness
    Four inverse_inertia_bs = {};  // principal, body axes
    Four move = {};                // W J^T lambda of the last solve
    Four turn = {};
    double inverse_mass = 0.0;
    std::uint32_t index = 0;  // into the graph's bodies
    bool may_turn = false;
};

// A block's LDL^T: the inverse pivots and what lies below L's diagonal.
struct TriadPivots {
    double inverse[3];
    double l10, l20, l21;
};

// In a struct, for a template's argument would forget the alignment.
struct TriadVector {
    Four v = {};
};

struct TriadArrays {
    std::span<TriadBody> bodies;  // those that may move, then others
    std::size_t moving = 0;
    std::span<const Triad> triads;
    std::span<TriadVector>
        arms;  // by end, 2 * triad + side: from the centres, world axes; b's negative
    std::span<TriadVector> values;   // by triad: metres, angles at k_angle_m; or metres a second
    std::span<TriadVector> lambdas;  // by triad, of the last solve: on a, b's is the opposite
    std::span<Rows3> stiffness;      // by body that may move, world axes
    std::span<Rows3> sides;          // by end: J W of its rotation
    std::span<Rows3> blocks;         // the plan's
    std::span<TriadPivots> pivots;   // by step of the plan
    // Scratch by step: the diagonals while it is factorised, what is not yet solved for afterwards.
    std::span<TriadVector> unknowns;
    std::span<const double> masses;  // by sum of the plan: what its points share
    const TriadPlan* plan = nullptr;
    bool has_turn = false;  // some triad
};

struct TriadKernels {
    // Axes, arms and positional errors at the bodies' poses; rotations' errors are not its matter.
    void (*evaluate)(const TriadArrays& arrays);
    // What each triad's velocity lacks but for the hands' own.
    void (*evaluate_velocities)(const TriadArrays& arrays);
    // Geometric stiffness at the arms and multipliers of the last solve: positive_stiffness,
    // summed.
    void (*gather_stiffness)(const TriadArrays& arrays);
    void (*write_inertia)(const TriadArrays& arrays);
    void (*write_stiff_inertia)(const TriadArrays& arrays);
    // J W J^T in the plan's blocks.
    void (*multiply_out)(const TriadArrays& arrays);
    // In their place the factor. Alpha: a number of hands, a share of the diagonal of joints.
    void (*factorise)(const TriadArrays& arrays, double hand_alpha, double joint_alpha);
    // lambda of the values, and the bodies' moves and turns.
    void (*solve)(const TriadArrays& arrays);
    // Moves and turns the bodies by so much of it.
    void (*apply)(const TriadArrays& arrays, double scale);
};

// The fastest that this processor has; and those that every one has.
const TriadKernels& triad_kernels();
const TriadKernels& portable_triad_kernels();

}  // namespace handhold
