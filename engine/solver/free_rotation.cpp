#include "engine/solver/free_rotation.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace handhold {
namespace {

// Axes from the smallest moment to the largest.
std::array<int, 3> axes_by_moment(const Vec3& inertia_kgm2) {
    std::array<int, 3> axes = {0, 1, 2};
    const auto order = [&](std::size_t i, std::size_t j) {
        if (inertia_kgm2[axes[j]] < inertia_kgm2[axes[i]]) {
            std::swap(axes[i], axes[j]);
        }
    };
    order(0, 1);
    order(1, 2);
    order(0, 1);
    return axes;
}

// Turns the body about one of its own axes; the momentum stays in the world, so it turns back in
// the body.
void turn_about_axis(int axis, double angle_rad, Quat& rotation, Vec3& momentum_bs) {
    double s = 0.0;  // of half the angle
    double c = 1.0;
    sin_cos(0.5 * angle_rad, s, c);
    const int next = (axis + 1) % 3;
    const int last = (axis + 2) % 3;
    const Quat before = rotation;
    rotation.w() = before.w() * c - before.vec()[axis] * s;
    rotation.vec()[axis] = before.vec()[axis] * c + before.w() * s;
    rotation.vec()[next] = before.vec()[next] * c + before.vec()[last] * s;
    rotation.vec()[last] = before.vec()[last] * c - before.vec()[next] * s;
    const double sine = 2.0 * s * c;
    const double cosine = c * c - s * s;
    const Vec3 momentum = momentum_bs;
    momentum_bs[next] = momentum[next] * cosine + momentum[last] * sine;
    momentum_bs[last] = momentum[last] * cosine - momentum[next] * sine;
}

int steps_for(double spin_radps, double dt_s) {
    constexpr double k_largest_turn_rad = 0.25;
    constexpr double k_most_steps = 256.0;
    return static_cast<int>(
        std::clamp(std::ceil(spin_radps * dt_s / k_largest_turn_rad), 1.0, k_most_steps));
}

}  // namespace

void advance_rotation(const Vec3& inertia_kgm2, double dt_s, Quat& rotation, Vec3& spin_radps) {
    constexpr double k_fastest_radps = 1e6;
    if (!(spin_radps.squaredNorm() < k_fastest_radps * k_fastest_radps)) {
        return;
    }
    const auto [least, middle, most] = axes_by_moment(inertia_kgm2);
    const Mat3 axes_before = rotation.toRotationMatrix();
    Vec3 momentum_bs = inertia_kgm2.cwiseProduct(axes_before.transpose() * spin_radps);
    const Vec3 momentum_ws = axes_before * momentum_bs;
    // Energy = m^2 / (2 I_middle) + what the outer two axes have more or less.
    const double shared = 1.0 / inertia_kgm2[middle];
    const double of_least = 1.0 / inertia_kgm2[least] - shared;
    const double of_most = 1.0 / inertia_kgm2[most] - shared;
    if (of_least == 0.0 || of_most == 0.0) {
        // Two equal moments: one axis only, and exact.
        const int axis = of_most == 0.0 ? least : most;
        const double rate = of_most == 0.0 ? of_least : of_most;
        if (rate != 0.0) {
            turn_about_axis(axis, dt_s * rate * momentum_bs[axis], rotation, momentum_bs);
        }
    } else {
        const int steps = steps_for(spin_radps.norm(), dt_s);
        const double step_s = dt_s / steps;
        for (int i = 0; i < steps; ++i) {
            const double half_s = 0.5 * step_s;
            turn_about_axis(least, half_s * of_least * momentum_bs[least], rotation, momentum_bs);
            turn_about_axis(most, step_s * of_most * momentum_bs[most], rotation, momentum_bs);
            turn_about_axis(least, half_s * of_least * momentum_bs[least], rotation, momentum_bs);
        }
    }
    rotation = (rotation_from_vector(dt_s * shared * momentum_ws) * rotation).normalized();
    // From the momentum in the world, which is what it was: no rounding adds up.
    const Mat3 axes = rotation.toRotationMatrix();
    momentum_bs = axes.transpose() * momentum_ws;
    spin_radps = axes * momentum_bs.cwiseQuotient(inertia_kgm2);
}

}  // namespace handhold
