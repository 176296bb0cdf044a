// Solver, model: torque-free rotation of rigid bodies, four bodies at a time. The equations and
// their source are in free_rotation.hpp.
#include "engine/solver/model/free_rotation.hpp"

#include <span>

#include "engine/math/wide_rotation.hpp"

namespace handhold {
namespace {

using FreeRotation4 = FreeRotations::FreeRotation4;

// One principal axis of four bodies: its moment of inertia, and the components of the angular
// momentum and of the rotation quaternion's vector part along it.
struct PrincipalAxis {
    Double4 inertia;
    Double4 momentum;
    Double4 vector;
};
// The axes sorted by moment, smallest first. `handedness` is -1 if an odd number of exchanges has
// mirrored the axes, else +1.
struct SortedAxes {
    PrincipalAxis axis[3];
    Double4 handedness;
};

HH_INLINE Mask4 exchange(const Mask4& where, PrincipalAxis& a, PrincipalAxis& b,
                         Double4& handedness) {
    const PrincipalAxis first = a;
    a.inertia = where ? b.inertia : a.inertia;
    a.momentum = where ? b.momentum : a.momentum;
    a.vector = where ? b.vector : a.vector;
    b.inertia = where ? first.inertia : b.inertia;
    b.momentum = where ? first.momentum : b.momentum;
    b.vector = where ? first.vector : b.vector;
    handedness = where ? -handedness : handedness;
    return where;
}
HH_INLINE Mask4 sort_two(PrincipalAxis& a, PrincipalAxis& b, Double4& handedness) {
    return exchange(b.inertia < a.inertia, a, b, handedness);
}

struct Sines4 {
    Double4 sine, cosine;
};

// Rotates the bodies about one of their own axes; `half` holds sine and cosine of half the angle.
// The angular momentum is constant in the world, so its body-frame components rotate the opposite
// way. `about`, `following`, `remaining` are in right-handed cyclic order.
HH_INLINE void turn_about_axis(const Sines4& half, const Double4& handedness, PrincipalAxis& about,
                               PrincipalAxis& following, PrincipalAxis& remaining, Double4& w) {
    const Double4& s = half.sine;
    const Double4& c = half.cosine;
    const Double4 before = w;
    w = before * c - about.vector * s;
    about.vector = about.vector * c + before * s;
    const Double4 along = following.vector;
    const Double4 handed = handedness * s;
    following.vector = along * c + remaining.vector * handed;
    remaining.vector = remaining.vector * c - along * handed;
    const Double4 sine = 2.0 * handed * c;
    const Double4 cosine = c * c - s * s;
    const Double4 momentum = following.momentum;
    following.momentum = momentum * cosine + remaining.momentum * sine;
    remaining.momentum = remaining.momentum * cosine - momentum * sine;
}
HH_INLINE void turn_about_axis(const Double4& angle_rad, const Double4& handedness,
                               PrincipalAxis& about, PrincipalAxis& following,
                               PrincipalAxis& remaining, Double4& w) {
    Sines4 half;
    sin_cos(0.5 * angle_rad, half.sine, half.cosine);
    turn_about_axis(half, handedness, about, following, remaining, w);
}

HH_INLINE Double4 steps_for(const Double4& spin_radps, double dt_s) {
    constexpr double k_largest_turn_rad = 0.25;
    constexpr double k_max_steps = 256.0;
    const Double4 wanted = spin_radps * dt_s / k_largest_turn_rad;
    const Double4 nearest = (wanted + k_last_place_one) - k_last_place_one;
    const Double4 up = nearest < wanted ? nearest + 1.0 : nearest;
    const Double4 at_least_one = larger(zero4() + 1.0, up);
    return at_least_one < k_max_steps ? at_least_one : zero4() + k_max_steps;
}

HH_INLINE void turn_asymmetric(double dt_s, const Double4& spin_radps, const Double4& min_rate,
                               const Double4& max_rate, SortedAxes& axes, Double4& w) {
    PrincipalAxis& minor = axes.axis[0];
    PrincipalAxis& middle = axes.axis[1];
    PrincipalAxis& major = axes.axis[2];
    const Double4 steps = steps_for(spin_radps, dt_s);
    const Double4 step_s = dt_s / steps;
    const double count = largest(steps);
    for (double i = 0.0; i < count; i += 1.0) {
        const Double4 now_s = steps > i ? step_s : zero4();  // lanes that are done do nothing
        const Double4 half_s = 0.5 * now_s;
        turn_about_axis(half_s * min_rate * minor.momentum, axes.handedness, minor, middle, major,
                        w);
        turn_about_axis(now_s * max_rate * major.momentum, axes.handedness, major, minor, middle,
                        w);
        turn_about_axis(half_s * min_rate * minor.momentum, axes.handedness, minor, middle, major,
                        w);
    }
}

// Intermediate values of four bodies, passed between the stages below.
struct Rotation4 {
    Wide3 momentum_ws;
    SortedAxes axes;
    Mask4 exchanged[3];  // exchanges that sorted the axes, in order
    // 1/moment of the outer axis minus 1/moment of the middle axis, 1/(kg m^2).
    Double4 min_rate, max_rate;
    // The rotation common to all three axes: a rotation vector along the momentum, world axes.
    Wide3 turn;
    Double4 turn_rad;  // length of `turn`
    Double4 top_rad;   // symmetric tops: angle about the symmetry axis
    Sines4 half_turn, half_top;
};

// Splits the energy into |m|^2 / (2 I_middle), and (1/I - 1/I_middle) m_axis^2 / 2 for each of the
// two outer axes. m: angular momentum, I: principal moments.
HH_INLINE void begin_turn(double dt_s, const FreeRotation4& bodies, Rotation4& out) {
    const WideAxes before = axes_of(bodies.rotation);
    const Wide3 spin_bs = rotate_back(before, bodies.spin);
    const Wide3& inertia = bodies.inertia;
    const Wide3 momentum_bs{inertia.x * spin_bs.x, inertia.y * spin_bs.y, inertia.z * spin_bs.z};
    const Wide3 momentum_ws = rotate(before, momentum_bs);
    SortedAxes axes{{{inertia.x, momentum_bs.x, bodies.rotation.x},
                     {inertia.y, momentum_bs.y, bodies.rotation.y},
                     {inertia.z, momentum_bs.z, bodies.rotation.z}},
                    zero4() + 1.0};
    out.exchanged[0] = sort_two(axes.axis[0], axes.axis[1], axes.handedness);
    out.exchanged[1] = sort_two(axes.axis[1], axes.axis[2], axes.handedness);
    out.exchanged[2] = sort_two(axes.axis[0], axes.axis[1], axes.handedness);
    const Double4 shared = 1.0 / axes.axis[1].inertia;
    out.min_rate = 1.0 / axes.axis[0].inertia - shared;
    out.max_rate = 1.0 / axes.axis[2].inertia - shared;
    const Wide3 turn = (dt_s * shared) * momentum_ws;
    out.turn_rad = square_root(dot(turn, turn));
    const Mask4 about_max = out.max_rate != 0.0;
    out.top_rad = dt_s * (about_max ? out.max_rate : out.min_rate) *
                  (about_max ? axes.axis[2].momentum : axes.axis[0].momentum);
    assign(turn, out.turn);
    assign(momentum_ws, out.momentum_ws);
    out.axes = axes;
}

// Symmetric tops (two equal moments) need, besides the common rotation, only one about a body axis.
// The result is exact.
HH_INLINE void turn_tops(const Rotation4& turning, SortedAxes& axes, Double4& w) {
    const Mask4 about_max = turning.max_rate != 0.0;
    Double4 handedness = axes.handedness;
    exchange(about_max, axes.axis[0], axes.axis[2], handedness);
    turn_about_axis(turning.half_top, handedness, axes.axis[0], axes.axis[1], axes.axis[2], w);
    exchange(about_max, axes.axis[0], axes.axis[2], handedness);
}

template <bool AreTops>
HH_INLINE void turn_four(double dt_s, const Rotation4& turning, FreeRotation4& bodies) {
    SortedAxes axes = turning.axes;
    Double4 w = bodies.rotation.w;
    if (AreTops) {
        turn_tops(turning, axes, w);
    } else {
        turn_asymmetric(dt_s, square_root(dot(bodies.spin, bodies.spin)), turning.min_rate,
                        turning.max_rate, axes, w);
    }
    Double4 handedness = axes.handedness;
    exchange(turning.exchanged[2], axes.axis[0], axes.axis[1], handedness);
    exchange(turning.exchanged[1], axes.axis[1], axes.axis[2], handedness);
    exchange(turning.exchanged[0], axes.axis[0], axes.axis[1], handedness);
    constexpr double k_still_rad = 1e-12;
    const Double4 share =
        turning.turn_rad < k_still_rad ? zero4() + 0.5 : turning.half_turn.sine / turning.turn_rad;
    assign(turned(share * turning.turn, turning.half_turn.cosine,
                  {axes.axis[0].vector, axes.axis[1].vector, axes.axis[2].vector, w}),
           bodies.rotation);
}

// Recomputes the spin from the conserved world momentum, so that rounding does not accumulate.
HH_INLINE void write_spin(const Rotation4& turning, FreeRotation4& bodies) {
    const Wide3& inertia = bodies.inertia;
    const WideAxes after = axes_of(bodies.rotation);
    const Wide3 back = rotate_back(after, turning.momentum_ws);
    assign(rotate(after, {back.x / inertia.x, back.y / inertia.y, back.z / inertia.z}),
           bodies.spin);
}

// Runs each stage for all groups of four before the next stage. Each stage is a long dependency
// chain, and a processor overlaps the chains of several groups only if they are close together in
// the code.
template <bool AreTops>
HH_INLINE void advance_fours(double dt_s, std::span<FreeRotation4> fours) {
    Rotation4 turnings[FreeRotations::k_fours];
    for (std::size_t i = 0; i < fours.size(); ++i) {
        begin_turn(dt_s, fours[i], turnings[i]);
    }
    for (std::size_t i = 0; i < fours.size(); ++i) {
        Rotation4& turning = turnings[i];
        sin_cos(0.5 * turning.turn_rad, turning.half_turn.sine, turning.half_turn.cosine);
    }
    for (std::size_t i = 0; AreTops && i < fours.size(); ++i) {
        Rotation4& turning = turnings[i];
        sin_cos(0.5 * turning.top_rad, turning.half_top.sine, turning.half_top.cosine);
    }
    for (std::size_t i = 0; i < fours.size(); ++i) {
        turn_four<AreTops>(dt_s, turnings[i], fours[i]);
    }
    for (std::size_t i = 0; i < fours.size(); ++i) {
        write_spin(turnings[i], fours[i]);
    }
}

void advance_tops_portable(double dt_s, std::span<FreeRotation4> fours) {
    advance_fours<true>(dt_s, fours);
}
void advance_any_portable(double dt_s, std::span<FreeRotation4> fours) {
    advance_fours<false>(dt_s, fours);
}

#ifdef HH_AVX2
HH_AVX2 void advance_tops_avx2(double dt_s, std::span<FreeRotation4> fours) {
    advance_fours<true>(dt_s, fours);
}
HH_AVX2 void advance_any_avx2(double dt_s, std::span<FreeRotation4> fours) {
    advance_fours<false>(dt_s, fours);
}
#else
constexpr auto advance_tops_avx2 = advance_tops_portable;
constexpr auto advance_any_avx2 = advance_any_portable;
#endif

bool is_top(const Vec3& inertia_kgm2) {
    return inertia_kgm2.x() == inertia_kgm2.y() || inertia_kgm2.y() == inertia_kgm2.z() ||
           inertia_kgm2.z() == inertia_kgm2.x();
}

}  // namespace

void FreeRotations::add(const Vec3& inertia_kgm2, Quat& rotation, Vec3& spin_radps) {
    const double square = spin_radps.squaredNorm();
    if (square == 0.0 || !(square < k_fastest_spin_radps * k_fastest_spin_radps)) {
        return;
    }
    const Kind kind = is_top(inertia_kgm2) ? Kind::top : Kind::any;
    Batch& batch = batches_[static_cast<std::size_t>(kind)];
    write(batch.count, inertia_kgm2, rotation, spin_radps, batch);
    batch.out[batch.count++] = {&rotation, &spin_radps};
    if (batch.count == k_batch) {
        advance(kind);
    }
}

void FreeRotations::finish() {
    advance(Kind::top);
    advance(Kind::any);
}

void FreeRotations::write(std::size_t place, const Vec3& inertia_kgm2, const Quat& rotation,
                          const Vec3& spin_radps, Batch& batch) {
    FreeRotation4& four = batch.fours[place / k_lanes];
    set_lane(place % k_lanes, inertia_kgm2, four.inertia);
    set_lane(place % k_lanes, rotation, four.rotation);
    set_lane(place % k_lanes, spin_radps, four.spin);
}

void FreeRotations::advance(Kind kind) {
    Batch& batch = batches_[static_cast<std::size_t>(kind)];
    if (batch.count == 0) {
        return;
    }
    // Empty lanes of the last group hold a sphere at rest.
    const std::size_t fours = (batch.count + k_lanes - 1) / k_lanes;
    for (std::size_t place = batch.count; place < fours * k_lanes; ++place) {
        write(place, Vec3::Ones(), Quat::Identity(), Vec3::Zero(), batch);
    }
    const bool has_avx2 = vectors_ == Vectors::avx2;
    if (kind == Kind::top) {
        (has_avx2 ? advance_tops_avx2 : advance_tops_portable)(dt_s_, {batch.fours.data(), fours});
    } else {
        (has_avx2 ? advance_any_avx2 : advance_any_portable)(dt_s_, {batch.fours.data(), fours});
    }
    for (std::size_t place = 0; place < batch.count; ++place) {
        const FreeRotation4& four = batch.fours[place / k_lanes];
        get_lane(place % k_lanes, four.rotation, *batch.out[place].rotation);
        get_lane(place % k_lanes, four.spin, *batch.out[place].spin_radps);
    }
    batch.count = 0;
}

}  // namespace handhold
