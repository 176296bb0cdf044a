// Solver, packed: the kernels, compiled once for any processor and once for AVX2, with the same
// bits.
#include "engine/solver/packed/triad_kernels.hpp"

#include "engine/math/processor.hpp"
#include "engine/solver/packed/triad_bodies.hpp"
#include "engine/solver/packed/triad_factor.hpp"
#include "engine/solver/packed/triad_strand_factor.hpp"
#include "engine/solver/packed/triad_strands.hpp"

namespace handhold {
namespace {

HH_INLINE void evaluate_triads(const TriadArrays& arrays) {
    triads::evaluate_strands(arrays);
    triads::evaluate(arrays);
}
HH_INLINE void evaluate_triad_velocities(const TriadArrays& arrays) {
    triads::evaluate_strand_velocities(arrays);
    triads::evaluate_velocities(arrays);
}
HH_INLINE double worst_triad_square(const TriadArrays& arrays) {
    const double of_strands = triads::worst_strand_square(arrays);
    const double of_rest = triads::worst_square(arrays);
    return of_strands > of_rest ? of_strands : of_rest;
}
HH_INLINE void gather_triad_stiffness(const TriadArrays& arrays) {
    triads::gather_strand_stiffness(arrays);
    triads::gather_stiffness(arrays);
}
HH_INLINE void multiply_out_triads(const TriadArrays& arrays, double joint_alpha) {
    triads::multiply_out(arrays);
    triads::eliminate_strands(arrays, joint_alpha);
}
HH_INLINE void factorise_triads(const TriadArrays& arrays, double drive_alpha, double joint_alpha) {
    triads::note_diagonals(arrays);
    triads::subtract_strands(arrays);
    triads::factorise(arrays, drive_alpha, joint_alpha);
}
HH_INLINE LargestMove solve_triads(const TriadArrays& arrays) {
    triads::negate_values(arrays);
    triads::substitute_into_strands(arrays);
    triads::substitute(arrays);
    triads::substitute_back_into_strands(arrays);
    return triads::longer(triads::gather_moves(arrays), triads::gather_strand_moves(arrays));
}
HH_INLINE void apply_triads(const TriadArrays& arrays, double scale) {
    triads::apply_strands(arrays, scale);
    triads::apply(arrays, scale);
}

#ifdef HH_AVX2
HH_AVX2 void evaluate_avx2(const TriadArrays& arrays) { evaluate_triads(arrays); }
HH_AVX2 void evaluate_velocities_avx2(const TriadArrays& arrays) {
    evaluate_triad_velocities(arrays);
}
HH_AVX2 double worst_square_avx2(const TriadArrays& arrays) { return worst_triad_square(arrays); }
HH_AVX2 void gather_stiffness_avx2(const TriadArrays& arrays) { gather_triad_stiffness(arrays); }
HH_AVX2 void multiply_out_avx2(const TriadArrays& arrays, double joint_alpha) {
    multiply_out_triads(arrays, joint_alpha);
}
HH_AVX2 void factorise_avx2(const TriadArrays& arrays, double drive_alpha, double joint_alpha) {
    factorise_triads(arrays, drive_alpha, joint_alpha);
}
HH_AVX2 LargestMove solve_avx2(const TriadArrays& arrays) { return solve_triads(arrays); }
HH_AVX2 void apply_avx2(const TriadArrays& arrays, double scale) { apply_triads(arrays, scale); }
HH_AVX2 void apply_velocities_avx2(const TriadArrays& arrays) { triads::apply_velocities(arrays); }

constexpr TriadKernels k_avx2{
    evaluate_avx2,        evaluate_velocities_avx2, worst_square_avx2, gather_stiffness_avx2,
    multiply_out_avx2,    factorise_avx2,           solve_avx2,        apply_avx2,
    apply_velocities_avx2};
#endif

void evaluate_portable(const TriadArrays& arrays) { evaluate_triads(arrays); }
void evaluate_velocities_portable(const TriadArrays& arrays) { evaluate_triad_velocities(arrays); }
double worst_square_portable(const TriadArrays& arrays) { return worst_triad_square(arrays); }
void gather_stiffness_portable(const TriadArrays& arrays) { gather_triad_stiffness(arrays); }
void multiply_out_portable(const TriadArrays& arrays, double joint_alpha) {
    multiply_out_triads(arrays, joint_alpha);
}
void factorise_portable(const TriadArrays& arrays, double drive_alpha, double joint_alpha) {
    factorise_triads(arrays, drive_alpha, joint_alpha);
}
LargestMove solve_portable(const TriadArrays& arrays) { return solve_triads(arrays); }
void apply_portable(const TriadArrays& arrays, double scale) { apply_triads(arrays, scale); }
void apply_velocities_portable(const TriadArrays& arrays) { triads::apply_velocities(arrays); }

constexpr TriadKernels k_portable{evaluate_portable,        evaluate_velocities_portable,
                                  worst_square_portable,    gather_stiffness_portable,
                                  multiply_out_portable,    factorise_portable,
                                  solve_portable,           apply_portable,
                                  apply_velocities_portable};

}  // namespace

const TriadKernels& triad_kernels() {
#ifdef HH_AVX2
    return fastest_vectors() == Vectors::avx2 ? k_avx2 : k_portable;
#else
    return k_portable;
#endif
}
const TriadKernels& portable_triad_kernels() { return k_portable; }

}  // namespace handhold
