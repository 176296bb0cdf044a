#include "engine/solver/model/free_rotation.hpp"

#include <span>

#include "engine/math/wide_rotation.hpp"

namespace handhold {
namespace {

using FreeRotation4 = FreeRotations::FreeRotation4;

// One of a body's three axes: its moment, and what the momentum and the rotation's vector have
// along it.
struct PrincipalAxis {
    Double4 inertia;
    Double4 momentum;
    Double4 vector;
};
// From the smallest moment to the largest. An odd number of exchanges mirrors them: `hand` is -1.
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

// Turns the bodies about one of their own axes, by the sines of half the angle; the momentum stays
// in the world, so it turns back in the body. `following` and `remaining` come after it in the
// order of a right hand.
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
    const Double4 some = larger(zero4() + 1.0, up);
    return some < k_max_steps ? some : zero4() + k_max_steps;
}

HH_INLINE void turn_others(double dt_s, const Double4& spin_radps, const Double4& of_least,
                           const Double4& of_most, SortedAxes& axes, Double4& w) {
    PrincipalAxis& least = axes.axis[0];
    PrincipalAxis& middle = axes.axis[1];
    PrincipalAxis& most = axes.axis[2];
    const Double4 steps = steps_for(spin_radps, dt_s);
    const Double4 step_s = dt_s / steps;
    const double count = largest(steps);
    for (double i = 0.0; i < count; i += 1.0) {
        const Double4 now_s = steps > i ? step_s : zero4();  // some are there before others
        const Double4 half_s = 0.5 * now_s;
        turn_about_axis(half_s * of_least * least.momentum, axes.handedness, least, middle, most,
                        w);
        turn_about_axis(now_s * of_most * most.momentum, axes.handedness, most, least, middle, w);
        turn_about_axis(half_s * of_least * least.momentum, axes.handedness, least, middle, most,
                        w);
    }
}

// A four on its way through the stages below.
struct Rotation4 {
    Wide3 momentum_ws;
    SortedAxes axes;
    Mask4 exchanged[3];         // of the axes, in turn
    Double4 of_least, of_most;  // 1 / moment: what the outer axes have more or less than the middle
    Wide3 turn;        // the part all three moments share: about the momentum, in the world
    Double4 turn_rad;  // its length
    Double4 top_rad;   // tops: of the turn about their own axis
    Sines4 half_turn, half_top;
};

// Energy = m^2 / (2 I_middle) + what the outer two axes have more or less.
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
    out.of_least = 1.0 / axes.axis[0].inertia - shared;
    out.of_most = 1.0 / axes.axis[2].inertia - shared;
    const Wide3 turn = (dt_s * shared) * momentum_ws;
    out.turn_rad = square_root(dot(turn, turn));
    const Mask4 is_most = out.of_most != 0.0;
    out.top_rad = dt_s * (is_most ? out.of_most : out.of_least) *
                  (is_most ? axes.axis[2].momentum : axes.axis[0].momentum);
    assign(turn, out.turn);
    assign(momentum_ws, out.momentum_ws);
    out.axes = axes;
}

// Bodies two of whose moments are equal turn about one axis of their own only, and exactly.
HH_INLINE void turn_tops(const Rotation4& turning, SortedAxes& axes, Double4& w) {
    const Mask4 is_most = turning.of_most != 0.0;
    Double4 handedness = axes.handedness;
    exchange(is_most, axes.axis[0], axes.axis[2], handedness);
    turn_about_axis(turning.half_top, handedness, axes.axis[0], axes.axis[1], axes.axis[2], w);
    exchange(is_most, axes.axis[0], axes.axis[2], handedness);
}

template <bool AreTops>
HH_INLINE void turn_four(double dt_s, const Rotation4& turning, FreeRotation4& bodies) {
    SortedAxes axes = turning.axes;
    Double4 w = bodies.rotation.w;
    if (AreTops) {
        turn_tops(turning, axes, w);
    } else {
        turn_others(dt_s, square_root(dot(bodies.spin, bodies.spin)), turning.of_least,
                    turning.of_most, axes, w);
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

// From the momentum in the world, which is what it was: no rounding adds up.
HH_INLINE void write_spin(const Rotation4& turning, FreeRotation4& bodies) {
    const Wide3& inertia = bodies.inertia;
    const WideAxes after = axes_of(bodies.rotation);
    const Wide3 back = rotate_back(after, turning.momentum_ws);
    assign(rotate(after, {back.x / inertia.x, back.y / inertia.y, back.z / inertia.z}),
           bodies.spin);
}

// Stage by stage: a four's numbers wait for each other in long chains, and while one waits the
// processor looks ahead to the next only where that is near.
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

#ifdef __x86_64__
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
    constexpr double k_fastest_radps = 1e6;
    const double square = spin_radps.squaredNorm();
    if (square == 0.0 || !(square < k_fastest_radps * k_fastest_radps)) {
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
    // What has no body in the last four is a sphere at rest.
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
