#include "systems/body/clear_arms.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "components/body_tuning.hpp"
#include "engine/core/parallel.hpp"
#include "engine/math/scalar_rotation.hpp"

namespace handhold {
namespace {

struct Trunk {
    std::array<Vec3, 3> line_ws;  // chest, waist, hips
    double radius_m = 0.0;
};
constexpr double k_same_share = 0.08;  // share of that radius; smaller depths count as equal

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

constexpr double k_step_rad = 0.35;  // largest step of a search

// An arm whose elbow turns about the line from shoulder to hand.
struct Arm {
    Vec3 shoulder;
    Vec3 elbow;
    Vec3 hand;
    Vec3 axis;     // unit, from the shoulder to the hand
    Vec3 ahead;    // unit, to the middle finger
    Vec3 outward;  // unit, to the arm's side of the body

    Vec3 elbow_at(double angle) const {
        return shoulder + rotation_about(axis, angle) * (elbow - shoulder);
    }
};

double clamped(double angle) { return std::clamp(angle, -k_most_clear_rad, k_most_clear_rad); }

// Returns the angle nearest to `angle` at which the wrist is bent by at most k_wrist_follow_rad, or
// as little as a turn of the elbow can. The forearm along the hand is
// middle + reach cos(angle - best), because the hand is on the axis.
double follow_wrist(const Arm& arm, double angle) {
    constexpr double k_flat = 1e-3;  // share of the forearm: a turn changes nothing
    static const double k_least_cosine = [] {
        double sine = 0.0;
        double cosine = 1.0;
        sin_cos(k_wrist_follow_rad, sine, cosine);
        return cosine;
    }();
    const Vec3 upper = arm.elbow - arm.shoulder;
    const Vec3 along = upper.dot(arm.axis) * arm.axis;
    const double length = (arm.hand - arm.elbow).norm();
    const double cosine = -(upper - along).dot(arm.ahead);
    const double sine = -arm.axis.cross(upper).dot(arm.ahead);
    const double middle = (arm.hand - arm.shoulder - along).dot(arm.ahead);
    const double reach = std::sqrt(cosine * cosine + sine * sine);
    if (reach <= k_flat * length) {
        return angle;
    }
    const double least = std::clamp((k_least_cosine * length - middle) / reach, -1.0, 1.0);
    const double most_rad = arc_tangent2(std::sqrt(1.0 - least * least), least);
    double off_rad = angle - arc_tangent2(sine, cosine);
    off_rad -= std::abs(off_rad) > k_pi ? std::copysign(2.0 * k_pi, off_rad) : 0.0;
    return clamped(angle - off_rad + std::clamp(off_rad, -most_rad, most_rad));
}

// An angle, and how deep elbow or forearm are then in the trunk.
struct Cleared {
    double angle = 0.0;
    double depth_m = 0.0;
};

// Changes `angle` until elbow and forearm are outside of the trunk.
Cleared leave_trunk(const Trunk& trunk, const Arm& arm, double angle) {
    // Points of the forearm by their distance from the elbow. The rest of it goes with the hand.
    constexpr std::array<double, 4> k_points = {0.0, 0.25, 0.5, 0.75};
    constexpr int k_steps = 8;
    constexpr double k_bias = 0.4;  // an elbow in the middle of the trunk leaves to its own side
    double deepest_m = 0.0;
    for (int step = 0;; ++step) {
        const Vec3 turned = arm.elbow_at(angle);
        const Vec3 tangent = arm.axis.cross(turned - arm.shoulder);  // d turned / d angle
        double wanted = 0.0;
        deepest_m = 0.0;
        for (const double share : k_points) {
            const Vec3 apart = from_trunk(trunk, turned + share * (arm.hand - turned));
            const double distance = apart.norm();
            const double depth = trunk.radius_m - distance;
            if (depth <= 0.0) {
                continue;
            }
            deepest_m = std::max(deepest_m, depth);
            const Vec3 push = apart * (1.0 / std::max(distance, 1e-6));
            const Vec3 biased = push + k_bias * (depth / trunk.radius_m) * arm.outward;
            const double rate = (1.0 - share) * tangent.dot(biased);
            const double by = std::clamp(depth / std::max(std::abs(rate), 1e-3), 0.0, k_step_rad);
            if (by > std::abs(wanted)) {
                wanted = rate < 0.0 ? -by : by;
            }
        }
        if (wanted == 0.0 || step == k_steps) {
            break;
        }
        angle = clamped(angle + wanted);
    }
    return {angle, deepest_m};
}

// Returns an angle near `angle` at which the arm is outside of the trunk. If a search from there
// ends inside, tries others, and returns the one that ends least deep.
double clear_angle(const Trunk& trunk, const Arm& arm, double angle) {
    const double same_m = k_same_share * trunk.radius_m;
    Cleared best = leave_trunk(trunk, arm, angle);
    for (const double from : {0.0, 0.8 * k_most_clear_rad, -0.8 * k_most_clear_rad}) {
        if (best.depth_m < same_m) {
            break;
        }
        const Cleared other = leave_trunk(trunk, arm, from);
        if (other.depth_m < best.depth_m - same_m) {
            best = other;
        }
    }
    return best.angle;
}

void clear_arm(const Trunk& trunk, const Vec3& outward, double dt_s, ArmMemory::Arm& memory,
               ArmPose::Arm& out) {
    const Vec3 shoulder = out.upper_ws.position;
    const Vec3 line = out.hand_ws.position - shoulder;
    const double length = line.norm();
    if (length < 1e-6) {
        return;
    }
    const Arm arm{shoulder,
                  out.forearm_ws.position,
                  out.hand_ws.position,
                  line * (1.0 / length),
                  out.hand_ws.rotation * -Vec3::UnitZ(),
                  outward};
    double& cleared_rad = memory.cleared_rad;
    if (!memory.cleared_known) {
        cleared_rad = 0.0;
    }
    const double back = k_clear_back_radps * dt_s;
    const double from = cleared_rad - std::clamp(cleared_rad, -back, back);
    const double wanted = clear_angle(trunk, arm, follow_wrist(arm, from));
    const double most = k_clear_radps * dt_s;
    cleared_rad =
        memory.cleared_known ? std::clamp(wanted, cleared_rad - most, cleared_rad + most) : wanted;
    memory.cleared_known = true;
    if (cleared_rad != 0.0) {
        const Quat turn = rotation_about(arm.axis, cleared_rad);
        out.upper_ws.rotation = (turn * out.upper_ws.rotation).normalized();
        out.forearm_ws.position = shoulder + turn * (arm.elbow - shoulder);
        out.forearm_ws.rotation = (turn * out.forearm_ws.rotation).normalized();
    }
}

void clear_player(const ClearArmsIo& io, std::size_t index) {
    const Entity player = io.arms.owners()[index];
    ArmMemory* const memory = io.memory.find(player);
    const SpinePose* const spine = io.spine.find(player);
    const BodyMeasures* const measures = io.measures.find(player);
    if (memory == nullptr || spine == nullptr || measures == nullptr) {
        return;
    }
    ArmPose& arms = io.arms.elements()[index];
    const Trunk trunk{
        {spine->chest_ws.position, spine->spine_ws.back().position, spine->pelvis_ws.position},
        k_trunk_clearance_m * measures->eye_height_m / k_scale_eye_m};
    const Vec3 right = spine->chest_ws.rotation * Vec3::UnitX();
    clear_arm(trunk, -right, io.dt_s, memory->arms[0], arms.arms[0]);
    clear_arm(trunk, right, io.dt_s, memory->arms[1], arms.arms[1]);
}

}  // namespace

void clear_arms(const ClearArmsIo& io) {
    constexpr std::size_t k_players_per_slice = 32;
    parallel_each(io.arms.size(), k_players_per_slice,
                  [&io](std::size_t index) { clear_player(io, index); });
}

}  // namespace handhold
