#include "systems/grab/shared/joint_rail.hpp"

#include <algorithm>
#include <limits>

namespace handhold {
namespace {

bool is_hand_driven(const JointRailIo& io, Entity entity, const PhaseTuning& tuning) {
    const RigidBody* const body = io.body.find(entity);  // none: the world
    return body != nullptr && is_light(*body, tuning.heavy_body_kg);
}

}  // namespace

std::optional<JointRail> find_rail(const JointRailIo& io, Entity body, const PhaseTuning& tuning) {
    std::optional<JointRail> rail;
    for (std::size_t index = 0; index < io.joint.size(); ++index) {
        const Joint& joint = io.joint.elements()[index];
        const bool is_b = joint.b == body;
        const Entity holder = is_b ? joint.a : joint.b;
        if ((!is_b && joint.a != body) || is_hand_driven(io, holder, tuning)) {
            continue;
        }
        const bool is_rail = joint.kind == JointKind::hinge || joint.kind == JointKind::slider;
        const bool is_gone = !is_null(holder) && !io.body.contains(holder);
        if (rail || !is_rail || is_gone) {
            return std::nullopt;
        }
        const Pose& frame_hs = is_b ? joint.frame_a_bs : joint.frame_b_bs;
        const JointState& state = io.joint_state.at(io.joint.owners()[index]);
        const bool free = !joint.limited && !state.latched;
        const double infinity = std::numeric_limits<double>::infinity();
        const double lower = state.latched ? 0.0 : joint.lower - state.coordinate;
        const double upper = state.latched ? 0.0 : joint.upper - state.coordinate;
        rail = JointRail{holder,
                         frame_hs.position,
                         frame_hs.rotation * Vec3::UnitX(),
                         joint.kind == JointKind::hinge,
                         free ? -infinity : std::min(0.0, is_b ? lower : -upper),
                         free ? infinity : std::max(0.0, is_b ? upper : -lower)};
    }
    return rail;
}

double travel_along(const JointRail& rail, const Vec3& from_hs, const Vec3& to_hs) {
    if (!rail.turns) {
        return rail.axis_hs.dot(to_hs - from_hs);
    }
    const Vec3 from = rail.axis_hs.cross(from_hs - rail.point_hs);
    const Vec3 to = rail.axis_hs.cross(to_hs - rail.point_hs);
    return arc_tangent2(rail.axis_hs.dot(from.cross(to)), from.dot(to));
}

double weight_along(const JointRail& rail, const Vec3& from_hs) {
    return rail.turns ? rail.axis_hs.cross(from_hs - rail.point_hs).squaredNorm() : 1.0;
}

Pose moved_along(const JointRail& rail, const Pose& pose_hs, double travel) {
    const double clamped = std::clamp(travel, rail.back, rail.ahead);
    if (!rail.turns) {
        return {pose_hs.position + clamped * rail.axis_hs, pose_hs.rotation};
    }
    const Quat turn = rotation_about(rail.axis_hs, clamped);
    return {rail.point_hs + turn * (pose_hs.position - rail.point_hs),
            (turn * pose_hs.rotation).normalized()};
}

}  // namespace handhold
