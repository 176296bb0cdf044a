#include "systems/body/clear_arms.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "components/body_tuning.hpp"
#include "engine/ecs/join.hpp"
#include "engine/math/scalar_rotation.hpp"

namespace handhold {
namespace {

struct Trunk {
    std::array<Vec3, 3> line_ws;  // chest, waist, hips
    double radius_m = 0.0;
};

// Vector to a point from the nearest point of the trunk's line.
Vec3 from_trunk(const Trunk& trunk, const Vec3& point) {
    Vec3 nearest = Vec3::Constant(1e9);
    for (std::size_t i = 0; i + 1 < trunk.line_ws.size(); ++i) {
        const Vec3 along = trunk.line_ws[i + 1] - trunk.line_ws[i];
        const Vec3 from = point - trunk.line_ws[i];
        const double share =
            std::clamp(along.dot(from) / std::max(along.squaredNorm(), 1e-12), 0.0, 1.0);
        const Vec3 apart = from - share * along;
        if (apart.squaredNorm() < nearest.squaredNorm()) {
            nearest = apart;
        }
    }
    return nearest;
}

// Returns the angle about the unit vector `axis` through `shoulder` by which the elbow is turned.
double clear_angle(const Trunk& trunk, const Vec3& shoulder, const Vec3& elbow, const Vec3& hand,
                   const Vec3& axis, const Vec3& outward) {
    // Points of the forearm by their distance from the elbow. The rest of it goes with the hand.
    constexpr std::array<double, 4> k_points = {0.0, 0.25, 0.5, 0.75};
    constexpr int k_steps = 8;
    constexpr double k_step_rad = 0.35;
    constexpr double k_bias = 0.4;  // an elbow in the middle of the trunk leaves to its own side
    double angle = 0.0;
    for (int step = 0; step < k_steps; ++step) {
        const Vec3 turned = shoulder + rotation_about(axis, angle) * (elbow - shoulder);
        const Vec3 tangent = axis.cross(turned - shoulder);  // d turned / d angle
        double wanted = 0.0;
        for (const double share : k_points) {
            const Vec3 apart = from_trunk(trunk, turned + share * (hand - turned));
            const double distance = apart.norm();
            const double depth = trunk.radius_m - distance;
            if (depth <= 0.0) {
                continue;
            }
            const Vec3 push = apart * (1.0 / std::max(distance, 1e-6));
            const Vec3 biased = push + k_bias * (depth / trunk.radius_m) * outward;
            const double rate = (1.0 - share) * tangent.dot(biased);
            const double by = std::clamp(depth / std::max(std::abs(rate), 1e-3), 0.0, k_step_rad);
            if (by > std::abs(wanted)) {
                wanted = rate < 0.0 ? -by : by;
            }
        }
        if (wanted == 0.0) {
            break;
        }
        angle = std::clamp(angle + wanted, -k_most_clear_rad, k_most_clear_rad);
    }
    return angle;
}

void clear_arm(const Trunk& trunk, const Vec3& outward, ArmPose::Arm& arm) {
    const Vec3 shoulder = arm.upper_ws.position;
    const Vec3 line = arm.hand_ws.position - shoulder;
    const double length = line.norm();
    if (length < 1e-6) {
        return;
    }
    const Vec3 axis = line * (1.0 / length);
    const double angle =
        clear_angle(trunk, shoulder, arm.forearm_ws.position, arm.hand_ws.position, axis, outward);
    if (angle != 0.0) {
        const Quat turn = rotation_about(axis, angle);
        arm.upper_ws.rotation = (turn * arm.upper_ws.rotation).normalized();
        arm.forearm_ws.position = shoulder + turn * (arm.forearm_ws.position - shoulder);
        arm.forearm_ws.rotation = (turn * arm.forearm_ws.rotation).normalized();
    }
}

}  // namespace

void clear_arms(const ClearArmsIo& io) {
    join(
        io.arms,
        [](Entity, ArmPose& arms, const SpinePose& spine, const BodyMeasures& measures) {
            const Trunk trunk{
                {spine.chest_ws.position, spine.spine_ws.back().position, spine.pelvis_ws.position},
                k_trunk_clearance_m * measures.eye_height_m / k_scale_eye_m};
            const Vec3 right = spine.chest_ws.rotation * Vec3::UnitX();
            clear_arm(trunk, -right, arms.arms[0]);
            clear_arm(trunk, right, arms.arms[1]);
        },
        io.spine, io.measures);
}

}  // namespace handhold
