#include "engine/solver/free_rotation.hpp"

#include "engine/math/wide_rotation.hpp"

namespace handhold {
namespace {

struct FourTumbling {
    Wide3 inertia;
    Wide4 rotation;
    Wide3 spin;
};

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

// Turns the bodies about one of their own axes; the momentum stays in the world, so it turns back
// in the body. `following` and `remaining` come after it in the order of a right hand.
HH_INLINE void turn_about_axis(const Four& angle_rad, const Four& hand, PrincipalAxis& about,
                               PrincipalAxis& following, PrincipalAxis& remaining, Four& w) {
    Four s;
    Four c;
    sin_cos(0.5 * angle_rad, s, c);
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

// What the moments have more or less than the middle one, for bodies two of whose moments are
// equal: one axis only, and exact.
HH_INLINE void turn_tops(double dt_s, const Four& of_least, const Four& of_most, SortedAxes& axes,
                         Four& w) {
    const FourBits is_most = of_most != 0.0;
    Four hand = axes.hand;
    exchange(is_most, axes.axis[0], axes.axis[2], hand);
    const Four rate = is_most ? of_most : of_least;
    turn_about_axis(dt_s * rate * axes.axis[0].momentum, hand, axes.axis[0], axes.axis[1],
                    axes.axis[2], w);
    exchange(is_most, axes.axis[0], axes.axis[2], hand);
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

template <bool AreTops>
HH_INLINE void advance_four(double dt_s, FourTumbling& bodies) {
    const WideAxes before = axes_of(bodies.rotation);
    const Wide3 spin_bs = rotate_back(before, bodies.spin);
    const Wide3& inertia = bodies.inertia;
    const Wide3 momentum_bs{inertia.x * spin_bs.x, inertia.y * spin_bs.y, inertia.z * spin_bs.z};
    const Wide3 momentum_ws = rotate(before, momentum_bs);
    SortedAxes axes{{{inertia.x, momentum_bs.x, bodies.rotation.x},
                     {inertia.y, momentum_bs.y, bodies.rotation.y},
                     {inertia.z, momentum_bs.z, bodies.rotation.z}},
                    zero_four() + 1.0};
    const FourBits first = sort_two(axes.axis[0], axes.axis[1], axes.hand);
    const FourBits second = sort_two(axes.axis[1], axes.axis[2], axes.hand);
    const FourBits third = sort_two(axes.axis[0], axes.axis[1], axes.hand);
    // Energy = m^2 / (2 I_middle) + what the outer two axes have more or less.
    const Four shared = 1.0 / axes.axis[1].inertia;
    const Four of_least = 1.0 / axes.axis[0].inertia - shared;
    const Four of_most = 1.0 / axes.axis[2].inertia - shared;
    Four w = bodies.rotation.w;
    if (AreTops) {
        turn_tops(dt_s, of_least, of_most, axes, w);
    } else {
        turn_others(dt_s, square_root(dot(bodies.spin, bodies.spin)), of_least, of_most, axes, w);
    }
    Four hand = axes.hand;
    exchange(third, axes.axis[0], axes.axis[1], hand);
    exchange(second, axes.axis[1], axes.axis[2], hand);
    exchange(first, axes.axis[0], axes.axis[1], hand);
    // The shared part: about the momentum, in the world.
    constexpr double k_still_rad = 1e-12;
    const Wide3 turn = (dt_s * shared) * momentum_ws;
    const Four angle = square_root(dot(turn, turn));
    Four s;
    Four c;
    sin_cos(0.5 * angle, s, c);
    const Four share = angle < k_still_rad ? zero_four() + 0.5 : s / angle;
    assign(
        turned(share * turn, c, {axes.axis[0].vector, axes.axis[1].vector, axes.axis[2].vector, w}),
        bodies.rotation);
    // From the momentum in the world, which is what it was: no rounding adds up.
    const WideAxes after = axes_of(bodies.rotation);
    const Wide3 back = rotate_back(after, momentum_ws);
    assign(rotate(after, {back.x / inertia.x, back.y / inertia.y, back.z / inertia.z}),
           bodies.spin);
}

void advance_tops_portable(double dt_s, FourTumbling& bodies) { advance_four<true>(dt_s, bodies); }
void advance_any_portable(double dt_s, FourTumbling& bodies) { advance_four<false>(dt_s, bodies); }

#ifdef __x86_64__
HH_AVX2 void advance_tops_avx2(double dt_s, FourTumbling& bodies) {
    advance_four<true>(dt_s, bodies);
}
HH_AVX2 void advance_any_avx2(double dt_s, FourTumbling& bodies) {
    advance_four<false>(dt_s, bodies);
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
    batch.bodies[batch.count++] = {&inertia_kgm2, &rotation, &spin_radps};
    if (batch.count == batch.bodies.size()) {
        advance(kind);
    }
}

void FreeRotations::finish() {
    advance(Kind::top);
    advance(Kind::any);
}

void FreeRotations::advance(Kind kind) {
    Batch& batch = batches_[static_cast<std::size_t>(kind)];
    if (batch.count == 0) {
        return;
    }
    for (std::size_t i = batch.count; i < batch.bodies.size(); ++i) {
        batch.bodies[i] = batch.bodies[0];
    }
    FourTumbling four;
    for (std::size_t lane = 0; lane < batch.bodies.size(); ++lane) {
        const Body& body = batch.bodies[lane];
        set_lane(lane, *body.inertia_kgm2, four.inertia);
        set_lane(lane, *body.rotation, four.rotation);
        set_lane(lane, *body.spin_radps, four.spin);
    }
    const bool has_avx2 = vectors_ == Vectors::avx2;
    if (kind == Kind::top) {
        (has_avx2 ? advance_tops_avx2 : advance_tops_portable)(dt_s_, four);
    } else {
        (has_avx2 ? advance_any_avx2 : advance_any_portable)(dt_s_, four);
    }
    for (std::size_t lane = 0; lane < batch.count; ++lane) {
        *batch.bodies[lane].rotation = quat_in_lane(lane, four.rotation);
        *batch.bodies[lane].spin_radps = vec3_in_lane(lane, four.spin);
    }
    batch.count = 0;
}

}  // namespace handhold
