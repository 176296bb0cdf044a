#include "tools/lab/measure.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "components/player.hpp"
#include "tools/lab/hand_paths.hpp"

namespace handhold::lab {
namespace {

constexpr double k_deg = 180.0 / k_pi;

Pose pose_of(const std::vector<Pose>& poses, int body) {
    return body == k_world ? Pose{} : poses[static_cast<std::size_t>(body)];
}

double beyond(double value, double lower, double upper) {
    return std::max({0.0, lower - value, value - upper});
}

double angle_between(const Quat& a, const Quat& b) {
    const Quat between = a.conjugate() * b;
    return 2.0 * std::atan2(between.vec().norm(), std::abs(between.w()));
}

double angle_between(const Vec3& a, const Vec3& b) {
    return std::atan2(a.cross(b).norm(), a.dot(b));
}

// Angle of b relative to a about a's local x, in (-pi, pi].
double hinge_angle(const Quat& a, const Quat& b) {
    const Vec3 y = a.conjugate() * (b * Vec3::UnitY());
    return std::atan2(y.z(), y.y());
}

double deepest_corner(const Vec3& half_m, const Pose& pose_ws, const Vec3& normal, double offset) {
    const Vec3 normal_bs = pose_ws.rotation.conjugate() * normal;
    return offset - (normal.dot(pose_ws.position) - normal_bs.cwiseAbs().dot(half_m));
}

}  // namespace

JointErrors joint_error(const LabJoint& joint, const std::vector<Pose>& poses) {
    const Pose a = pose_of(poses, joint.a) * joint.frame_a;
    const Pose b = pose_of(poses, joint.b) * joint.frame_b;
    const Vec3 apart = b.position - a.position;
    const Vec3 axis = a.rotation * Vec3::UnitX();
    switch (joint.kind) {
        case JointKind::hinge: {
            const double turned = joint.limited ? beyond(hinge_angle(a.rotation, b.rotation),
                                                         joint.lower, joint.upper)
                                                : 0.0;
            return {apart.norm(),
                    std::max(angle_between(axis, b.rotation * Vec3::UnitX()), turned)};
        }
        case JointKind::slider: {
            const double slid =
                joint.limited ? beyond(axis.dot(apart), joint.lower, joint.upper) : 0.0;
            return {std::max(axis.cross(apart).norm(), slid),
                    angle_between(a.rotation, b.rotation)};
        }
        case JointKind::fixed:
            return {apart.norm(), angle_between(a.rotation, b.rotation)};
        case JointKind::ball:
        case JointKind::distance:
            break;
    }
    return {apart.norm(), 0.0};
}

double grab_error_m(const LabHold& hold, const Pose& target_ws, const std::vector<Pose>& poses) {
    return (target_ws.position - transform_point(pose_of(poses, hold.body), hold.anchor_bs)).norm();
}

double penetration_m(const LabScene& scene, Holder holder, const std::vector<Pose>& poses) {
    double deepest = 0.0;
    for (const LabPlane& plane : scene.planes) {
        const Pose frame = pose_of(poses, plane.body);
        const Vec3 normal = frame.rotation * plane.normal;
        const double offset = plane.offset_m + normal.dot(frame.position);
        for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
            const LabBody& body = scene.bodies[i];
            if (body.kind == BodyKind::free && body.collides) {
                deepest = std::max(deepest, deepest_corner(body.half_m, poses[i], normal, offset));
            }
        }
        for (std::size_t i = 0; i < scene.players.size() && holder == Holder::player; ++i) {
            if (!scene.players[i].head_meets_planes) {
                continue;
            }
            const Vec3 head =
                transform_point(poses[scene.bodies.size() + i], scene.players[i].head_ps);
            deepest = std::max(deepest, offset - (normal.dot(head) - scene.tuning.head.radius_m));
        }
    }
    return deepest;
}

Momentum momentum(const LabScene& scene, Holder holder, const FrameRecord& frame) {
    Momentum sum;
    const auto add = [&sum](double mass_kg, const Pose& pose, const BodyVelocity& velocity,
                            const Vec3& inertia) {
        const Vec3 linear = mass_kg * velocity.linear_mps;
        const Vec3 own = pose.rotation *
                         inertia.cwiseProduct(pose.rotation.conjugate() * velocity.angular_radps);
        const Vec3 angular = pose.position.cross(linear) + own;
        sum.linear += linear;
        sum.angular += angular;
        sum.linear_size += linear.norm();
        sum.angular_size += angular.norm();
    };
    for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
        const LabBody& body = scene.bodies[i];
        if (body.kind == BodyKind::free) {
            add(body.mass_kg, frame.poses[i], frame.velocities[i], body.inertia_kgm2());
        }
    }
    for (std::size_t i = 0; i < scene.players.size() && holder == Holder::player; ++i) {
        const std::size_t place = scene.bodies.size() + i;
        add(PlayerBody{}.mass_kg, frame.poses[place], frame.velocities[place], Vec3::Zero());
    }
    return sum;
}

double Series::max() const {
    return values.empty() ? 0.0 : *std::max_element(values.begin(), values.end());
}

int Series::worst_frame() const {
    return values.empty()
               ? -1
               : static_cast<int>(std::max_element(values.begin(), values.end()) - values.begin());
}

double Series::quantile(double share) const {
    if (values.empty()) {
        return 0.0;
    }
    std::vector<double> sorted = values;
    const auto rank = static_cast<std::size_t>(
        std::max(0.0, std::ceil(share * static_cast<double>(sorted.size())) - 1.0));
    std::nth_element(sorted.begin(), sorted.begin() + static_cast<std::ptrdiff_t>(rank),
                     sorted.end());
    return sorted[rank];
}

void Measure::take(const FrameRecord& frame) {
    JointErrors worst;
    for (const LabJoint& joint : scene_.joints) {
        const JointErrors error = joint_error(joint, frame.poses);
        worst.point_m = std::max(worst.point_m, error.point_m);
        worst.angle_rad = std::max(worst.angle_rad, error.angle_rad);
    }
    joint_mm.add(1e3 * worst.point_m);
    joint_deg.add(k_deg * worst.angle_rad);
    double grab = 0.0;
    for (std::size_t i = 0; i < scene_.holds.size(); ++i) {
        if (frame.held[i] != 0) {
            grab = std::max(grab, grab_error_m(scene_.holds[i], frame.targets[i], frame.poses));
        }
    }
    grab_mm.add(1e3 * grab);
    penetration_mm.add(1e3 * penetration_m(scene_, holder_, frame.poses));
    if (!std::exchange(is_first_, false)) {
        step_us.add(frame.step_us);
        solve_us.add(frame.solve_us);
        frame_us.add(frame.frame_us);
    }
    iterations.add(frame.iterations);
    take_players(frame);
    take_momentum(frame);
    if (scene_.watch && (holder_ == Holder::player || scene_.players.empty())) {
        scene_.watch(frame, figures);
    }
}

void Measure::take_players(const FrameRecord& frame) {
    double worst = 0.0;
    for (std::size_t i = 0; i < scene_.players.size() && holder_ == Holder::player; ++i) {
        if (frame.t_s < scene_.players_still_until_s) {
            const Vec3& origin = frame.poses[scene_.bodies.size() + i].position;
            worst = std::max(worst, (origin - scene_.players[i].origin_ws).norm());
        }
    }
    player_mm.add(1e3 * worst);
}

void Measure::take_momentum(const FrameRecord& frame) {
    // A kinematic hand changes the scene's momentum as long as it holds. After its release the
    // scene is closed, as with a player.
    const bool ever_alone = scene_.closed_from_s > 0.0 || holder_ == Holder::player;
    if (frame.t_s < scene_.closed_from_s || !ever_alone) {
        return;
    }
    const Momentum now = momentum(scene_, holder_, frame);
    if (!is_closed_) {
        is_closed_ = true;
        closed_ = now;
        return;
    }
    const auto relative = [](const Vec3& change, double size) {
        return size > 0.0 ? change.norm() / size : 0.0;
    };
    momentum_residual = std::max(
        momentum_residual,
        relative(now.linear - closed_.linear, std::max(now.linear_size, closed_.linear_size)));
    if (scene_.closed_in_spin) {
        momentum_residual =
            std::max(momentum_residual, relative(now.angular - closed_.angular,
                                                 std::max(now.angular_size, closed_.angular_size)));
    }
}

}  // namespace handhold::lab
