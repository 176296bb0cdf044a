#include "tools/lab/body_baselines.hpp"

#include <algorithm>
#include <cmath>

namespace handhold::lab {
namespace {

// Offset from the eyes to the midpoint of the shoulders, in the chest's axes.
const Vec3 k_shoulders(0.0, -0.22, 0.07);

Vec3 level(const Vec3& v) {
    const Vec3 flat(v.x(), 0.0, v.z());
    const double length = flat.norm();
    return length > 1e-6 ? Vec3(flat / length) : Vec3(-Vec3::UnitZ());
}

Quat facing(const Vec3& ahead) {
    return rotation_about(Vec3::UnitY(), arc_tangent2(-ahead.x(), -ahead.z()));
}

Vec3 square_to(const Vec3& pole, const Vec3& axis) {
    const double length = axis.norm();
    const Vec3 unit = length > 1e-9 ? Vec3(axis / length) : Vec3(-Vec3::UnitY());
    const Vec3 aside = pole - unit * unit.dot(pole);
    return aside.norm() > 1e-6 ? Vec3(aside.normalized())
                               : Vec3(unit.cross(Vec3::UnitX()).normalized());
}

// Sets the chest, and shoulders rigidly attached to it. `pole_of(side)` is in play space.
template <typename PoleOf>
void hang_arms(const Pose& head_ps, const BodyMeasures& measures, const Vec3& ahead,
               const PoleOf& pole_of, ArmEstimate& out) {
    const double scale = measures.eye_height_m / 1.6;
    out.facing_ps = ahead;
    out.chest_ps.rotation = facing(ahead);
    out.chest_ps.position = head_ps.position + scale * (out.chest_ps.rotation * k_shoulders);
    const double arm_m = measures.upper_arm_m + measures.forearm_m;
    for (std::size_t side = 0; side < k_hand_count; ++side) {
        ArmEstimate::Arm& arm = out.arms[side];
        const double half = (side == 0 ? -0.5 : 0.5) * measures.shoulder_width_m;
        arm.shoulder_ps = out.chest_ps.position + out.chest_ps.rotation * Vec3(half, 0.0, 0.0);
        const Vec3 reach = arm.hand_ps.position - arm.shoulder_ps;
        arm.stretch = std::max(1.0, reach.norm() / arm_m);
        arm.bend_ps = square_to(pole_of(side), reach);
    }
}

}  // namespace

void estimate_naive(const Pose& head_ps, const BodyMeasures& measures, ArmEstimate& out) {
    const Vec3 ahead = level(head_ps.rotation * -Vec3::UnitZ());
    hang_arms(
        head_ps, measures, ahead, [](std::size_t) { return Vec3(-Vec3::UnitY()); }, out);
}

void estimate_as_talked(const Pose& head_ps, const BodyMeasures& measures, ArmEstimate& out) {
    constexpr double k_hand_weight = 0.5;
    const double arm_m = measures.upper_arm_m + measures.forearm_m;
    const Vec3 look = level(head_ps.rotation * -Vec3::UnitZ());
    Vec3 ahead = look;
    for (const ArmEstimate::Arm& arm : out.arms) {
        const Vec3 reach = arm.hand_ps.position - head_ps.position;
        const Vec3 flat(reach.x(), 0.0, reach.z());
        const double near = smooth_step(flat.norm() / arm_m, 0.2, 0.6);
        const Vec3 towards = level(flat);
        const double before = smooth_step(towards.dot(look), -0.5, 0.2);
        ahead += k_hand_weight * near * before * towards;
    }
    ahead = level(ahead);
    const Quat chest_ps = facing(ahead);
    const auto pole_of = [&](std::size_t side) {
        const double outward = side == 0 ? -1.0 : 1.0;
        const Vec3 rest = chest_ps * Vec3(0.3 * outward, -0.8, 0.5);
        // Blends the rest direction with the one opposite to the fingers, where the elbow
        // is.
        return Vec3(0.5 * rest - 0.5 * (out.arms[side].hand_ps.rotation * -Vec3::UnitZ()));
    };
    hang_arms(head_ps, measures, ahead, pole_of, out);
}

}  // namespace handhold::lab
