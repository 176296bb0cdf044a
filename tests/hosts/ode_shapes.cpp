// Vectors, and queries against boxes in closed form: ODE has no closest points.
#include <algorithm>
#include <cmath>

#include "ode_engine.hpp"

namespace host {

double length(hh::Vec3 v) { return std::sqrt(v.x * v.x + v.y * v.y + v.z * v.z); }

hh::Vec3 cross(hh::Vec3 a, hh::Vec3 b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

hh::Vec3 rotate(hh::Quat q, hh::Vec3 v) {
    const hh::Vec3 axis{q.x, q.y, q.z};
    const hh::Vec3 t = 2.0 * cross(axis, v);
    return v + q.w * t + cross(axis, t);
}

hh::Quat conjugate(hh::Quat q) { return {-q.x, -q.y, -q.z, q.w}; }

hh::Quat multiply(hh::Quat a, hh::Quat b) {
    return {a.w * b.x + a.x * b.w + a.y * b.z - a.z * b.y,
            a.w * b.y - a.x * b.z + a.y * b.w + a.z * b.x,
            a.w * b.z + a.x * b.y - a.y * b.x + a.z * b.w,
            a.w * b.w - a.x * b.x - a.y * b.y - a.z * b.z};
}

hh::Quat turn_about(hh::Vec3 axis, double angle_rad) {
    const double s = std::sin(0.5 * angle_rad);
    return {s * axis.x, s * axis.y, s * axis.z, std::cos(0.5 * angle_rad)};
}

double closest_on_box(const hh::Pose& pose, hh::Vec3 half_m, hh::Vec3 point, hh::Vec3& nearest,
                      hh::Vec3& normal) {
    const hh::Vec3 local = rotate(conjugate(pose.rotation), point - pose.position);
    const double p[3] = {local.x, local.y, local.z};
    const double h[3] = {half_m.x, half_m.y, half_m.z};
    double q[3];
    double n[3] = {};
    int exit = 0;
    bool is_inside = true;
    for (int i = 0; i < 3; ++i) {
        q[i] = std::clamp(p[i], -h[i], h[i]);
        is_inside = is_inside && q[i] == p[i];
        if (h[i] - std::fabs(p[i]) < h[exit] - std::fabs(p[exit])) {
            exit = i;
        }
    }
    double distance = 0.0;
    if (is_inside) {
        q[exit] = std::copysign(h[exit], p[exit]);
        n[exit] = std::copysign(1.0, p[exit]);
    } else {
        const hh::Vec3 offset{p[0] - q[0], p[1] - q[1], p[2] - q[2]};
        distance = length(offset);
        n[0] = offset.x / distance;
        n[1] = offset.y / distance;
        n[2] = offset.z / distance;
    }
    nearest = at(pose, {q[0], q[1], q[2]});
    normal = rotate(pose.rotation, {n[0], n[1], n[2]});
    return distance;
}

double cast_on_box(const hh::Pose& pose, hh::Vec3 half_m, hh::Vec3 from, hh::Vec3 to,
                   hh::Vec3& normal) {
    const hh::Vec3 a = rotate(conjugate(pose.rotation), from - pose.position);
    const hh::Vec3 b = rotate(conjugate(pose.rotation), to - pose.position);
    const double p[3] = {a.x, a.y, a.z};
    const double d[3] = {b.x - a.x, b.y - a.y, b.z - a.z};
    const double h[3] = {half_m.x, half_m.y, half_m.z};
    constexpr double k_nowhere = 2.0;
    double enter = -k_nowhere;
    double leave = k_nowhere;
    int enter_axis = 0;
    int leave_axis = 0;
    for (int i = 0; i < 3; ++i) {
        if (d[i] == 0.0) {
            if (std::fabs(p[i]) > h[i]) {
                return k_nowhere;
            }
            continue;
        }
        const double near = (-std::copysign(h[i], d[i]) - p[i]) / d[i];
        const double far = (std::copysign(h[i], d[i]) - p[i]) / d[i];
        if (near > enter) {
            enter = near;
            enter_axis = i;
        }
        if (far < leave) {
            leave = far;
            leave_axis = i;
        }
    }
    if (enter > leave || leave < 0.0) {
        return k_nowhere;
    }
    const bool is_outside = enter >= 0.0;
    const int axis = is_outside ? enter_axis : leave_axis;
    double n[3] = {};
    n[axis] = (is_outside ? -1.0 : 1.0) * std::copysign(1.0, d[axis]);
    normal = rotate(pose.rotation, {n[0], n[1], n[2]});
    return is_outside ? enter : leave;
}

}  // namespace host
