#include "engine/solver/model/free_rotation.hpp"

#include <span>

#include "engine/math/wide_rotation.hpp"

namespace handhold {
namespace {

using FourTumbling = FreeRotations::FourTumbling;

// One of a body's three axes: its moment, and what the momentum and the rotation's vector have
// along it.
struct PrincipalAxis {
    Four inertia;
    Four momentum;
    Four vector;
};
// From the smallest moment to the largest. An odd number of exchanges mirrors them: `hand` is -1.
struct SortedAxes {
    PrincipalAxis axis[3];
    Four hand;
};

HH_INLINE FourBits exchange(const FourBits& where, PrincipalAxis& a, PrincipalAxis& b, Four& hand) {
    const PrincipalAxis first = a;
    a.inertia = where ? b.inertia : a.inertia;
    a.momentum = where ? b.momentum : a.momentum;
    a.vector = where ? b.vector : a.vector;
    b.inertia = where ? first.inertia : b.inertia;
    b.momentum = where ? first.momentum : b.momentum;
    b.vector = where ? first.vector : b.vector;
    hand = where ? -hand : hand;
    return where;
}
HH_INLINE FourBits sort_two(PrincipalAxis& a, PrincipalAxis& b, Four& hand) {
    return exchange(b.inertia < a.inertia, a, b, hand);
}

struct FourSines {
    Four sine, cosine;
};

// Turns the bodies about one of their own axes, by the sines of half the angle; the momentum stays
// in the world, so it turns back in the body. `following` and `remaining` come after it in the
// order of a right hand.
HH_INLINE void turn_about_axis(const FourSines& half, const Four& hand, PrincipalAxis& about,
                               PrincipalAxis& following, PrincipalAxis& remaining, Four& w) {
    const Four& s = half.sine;
    const Four& c = half.cosine;
    const Four before = w;
    w = before * c - about.vector * s;
    about.vector = about.vector * c + before * s;
    const Four along = following.vector;
    const Four handed = hand * s;
    following.vector = along * c + remaining.vector * handed;
    remaining.vector = remaining.vector * c - along * handed;
    const Four sine = 2.0 * handed * c;
    const Four cosine = c * c - s * s;
    const Four momentum = following.momentum;
    following.momentum = momentum * cosine + remaining.momentum * sine;
    remaining.momentum = remaining.momentum * cosine - momentum * sine;
}
HH_INLINE void turn_about_axis(const Four& angle_rad, const Four& hand, PrincipalAxis& about,
                               PrincipalAxis& following, PrincipalAxis& remaining, Four& w) {
    FourSines half;
    sin_cos(0.5 * angle_rad, half.sine, half.cosine);
    turn_about_axis(half, hand, about, following, remaining, w);
}

HH_INLINE Four steps_for(const Four& spin_radps, double dt_s) {
    constexpr double k_largest_turn_rad = 0.25;
    constexpr double k_most_steps = 256.0;
    const Four wanted = spin_radps * dt_s / k_largest_turn_rad;
    const Four nearest = (wanted + k_last_place_one) - k_last_place_one;
    const Four up = nearest < wanted ? nearest + 1.0 : nearest;
    const Four some = larger(zero_four() + 1.0, up);
    return some < k_most_steps ? some : zero_four() + k_most_steps;
}

HH_INLINE void turn_others(double dt_s, const Four& spin_radps, const Four& of_least,
                           const Four& of_most, SortedAxes& axes, Four& w) {
    PrincipalAxis& least = axes.axis[0];
    PrincipalAxis& middle = axes.axis[1];
    PrincipalAxis& most = axes.axis[2];
    const Four steps = steps_for(spin_radps, dt_s);
    const Four step_s = dt_s / steps;
    const double count = largest(steps);
    for (double i = 0.0; i < count; i += 1.0) {
        const Four now_s = steps > i ? step_s : zero_four();  // some are there before others
        const Four half_s = 0.5 * now_s;
        turn_about_axis(half_s * of_least * least.momentum, axes.hand, least, middle, most, w);
        turn_about_axis(now_s * of_most * most.momentum, axes.hand, most, least, middle, w);
        turn_about_axis(half_s * of_least * least.momentum, axes.hand, least, middle, most, w);
    }
}

// A four on its way through the stages below.
struct FourTurning {
    Wide3 momentum_ws;
    SortedAxes axes;
    FourBits exchanged[3];   // of the axes, in turn
    Four of_least, of_most;  // 1 / moment: what the outer axes have more or less than the middle
    Wide3 turn;              // the part all three moments share: about the momentum, in the world
    Four turn_rad;           // its length
    Four top_rad;            // tops: of the turn about their own axis
    FourSines half_turn, half_top;
};

// Energy = m^2 / (2 I_middle) + what the outer two axes have more or less.
HH_INLINE void begin_turn(double dt_s, const FourTumbling& bodies, FourTurning& out) {
    const WideAxes before = axes_of(bodies.rotation);
    const Wide3 spin_bs = rotate_back(before, bodies.spin);
    const Wide3& inertia = bodies.inertia;
    const Wide3 momentum_bs{inertia.x * spin_bs.x, inertia.y * spin_bs.y, inertia.z * spin_bs.z};
    const Wide3 momentum_ws = rotate(before, momentum_bs);
    SortedAxes axes{{{inertia.x, momentum_bs.x, bodies.rotation.x},
                     {inertia.y, momentum_bs.y, bodies.rotation.y},
                     {inertia.z, momentum_bs.z, bodies.rotation.z}},
                    zero_four() + 1.0};
    out.exchanged[0] = sort_two(axes.axis[0], axes.axis[1], axes.hand);
    out.exchanged[1] = sort_two(axes.axis[1], axes.axis[2], axes.hand);
    out.exchanged[2] = sort_two(axes.axis[0], axes.axis[1], axes.hand);
    const Four shared = 1.0 / axes.axis[1].inertia;
    out.of_least = 1.0 / axes.axis[0].inertia - shared;
    out.of_most = 1.0 / axes.axis[2].inertia - shared;
    const Wide3 turn = (dt_s * shared) * momentum_ws;
    out.turn_rad = square_root(dot(turn, turn));
    const FourBits is_most = out.of_most != 0.0;
    out.top_rad = dt_s * (is_most ? out.of_most : out.of_least) *
                  (is_most ? axes.axis[2].momentum : axes.axis[0].momentum);
    assign(turn, out.turn);
    assign(momentum_ws, out.momentum_ws);
    out.axes = axes;
}

// Bodies two of whose moments are equal turn about one axis of their own only, and exactly.
HH_INLINE void turn_tops(const FourTurning& turning, SortedAxes& axes, Four& w) {
    const FourBits is_most = turning.of_most != 0.0;
    Four hand = axes.hand;
    exchange(is_most, axes.axis[0], axes.axis[2], hand);
    turn_about_axis(turning.half_top, hand, axes.axis[0], axes.axis[1], axes.axis[2], w);
    exchange(is_most, axes.axis[0], axes.axis[2], hand);
}

template <bool AreTops>
HH_INLINE void turn_four(double dt_s, const FourTurning& turning, FourTumbling& bodies) {
    SortedAxes axes = turning.axes;
    Four w = bodies.rotation.w;
    if (AreTops) {
        turn_tops(turning, axes, w);
    } else {
        turn_others(dt_s, square_root(dot(bodies.spin, bodies.spin)), turning.of_least,
                    turning.of_most, axes, w);
    }
    Four hand = axes.hand;
    exchange(turning.exchanged[2], axes.axis[0], axes.axis[1], hand);
    exchange(turning.exchanged[1], axes.axis[1], axes.axis[2], hand);
    exchange(turning.exchanged[0], axes.axis[0], axes.axis[1], hand);
    constexpr double k_still_rad = 1e-12;
    const Four share = turning.turn_rad < k_still_rad ? zero_four() + 0.5
                                                      : turning.half_turn.sine / turning.turn_rad;
    assign(turned(share * turning.turn, turning.half_turn.cosine,
                  {axes.axis[0].vector, axes.axis[1].vector, axes.axis[2].vector, w}),
           bodies.rotation);
}

// From the momentum in the world, which is what it was: no rounding adds up.
HH_INLINE void write_spin(const FourTurning& turning, FourTumbling& bodies) {
    const Wide3& inertia = bodies.inertia;
    const WideAxes after = axes_of(bodies.rotation);
    const Wide3 back = rotate_back(after, turning.momentum_ws);
    assign(rotate(after, {back.x / inertia.x, back.y / inertia.y, back.z / inertia.z}),
           bodies.spin);
}

// Stage by stage: a four's numbers wait for each other in long chains, and while one waits the
// processor looks ahead to the next only where that is near.
template <bool AreTops>
HH_INLINE void advance_fours(double dt_s, std::span<FourTumbling> fours) {
    FourTurning turnings[FreeRotations::k_fours];
    for (std::size_t i = 0; i < fours.size(); ++i) {
        begin_turn(dt_s, fours[i], turnings[i]);
    }
    for (std::size_t i = 0; i < fours.size(); ++i) {
        FourTurning& turning = turnings[i];
        sin_cos(0.5 * turning.turn_rad, turning.half_turn.sine, turning.half_turn.cosine);
    }
    for (std::size_t i = 0; AreTops && i < fours.size(); ++i) {
        FourTurning& turning = turnings[i];
        sin_cos(0.5 * turning.top_rad, turning.half_top.sine, turning.half_top.cosine);
    }
    for (std::size_t i = 0; i < fours.size(); ++i) {
        turn_four<AreTops>(dt_s, turnings[i], fours[i]);
    }
    for (std::size_t i = 0; i < fours.size(); ++i) {
        write_spin(turnings[i], fours[i]);
    }
}

void advance_tops_portable(double dt_s, std::span<FourTumbling> fours) {
    advance_fours<true>(dt_s, fours);
}
void advance_any_portable(double dt_s, std::span<FourTumbling> fours) {
    advance_fours<false>(dt_s, fours);
}

#ifdef __x86_64__
HH_AVX2 void advance_tops_avx2(double dt_s, std::span<FourTumbling> fours) {
    advance_fours<true>(dt_s, fours);
}
HH_AVX2 void advance_any_avx2(double dt_s, std::span<FourTumbling> fours) {
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
    FourTumbling& four = batch.fours[place / k_lanes];
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
        const FourTumbling& four = batch.fours[place / k_lanes];
        get_lane(place % k_lanes, four.rotation, *batch.out[place].rotation);
        get_lane(place % k_lanes, four.spin, *batch.out[place].spin_radps);
    }
    batch.count = 0;
}

}  // namespace handhold
