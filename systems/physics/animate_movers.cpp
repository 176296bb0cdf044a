#include "systems/physics/animate_movers.hpp"

#include <algorithm>

namespace handhold {

Pose mover_pose(const Mover& mover, double t_s) {
    const Vec3& spin = mover.angular_velocity_ws_radps;
    const Vec3& velocity = mover.velocity_ws_mps;
    const double rate = spin.norm();
    Pose pose = mover.start_ws;
    if (rate < 1e-12) {
        pose.position += velocity * t_s;
        return pose;
    }
    const Vec3 axis = spin / rate;
    pose.rotation = (rotation_about(axis, rate * t_s) * mover.start_ws.rotation).normalized();
    if (!mover.turns_with_body) {
        pose.position += velocity * t_s;
        return pose;
    }
    // Integral of the rotating velocity: the component along the axis is linear, the rest moves on
    // a circle. Uses half angles, because 1 - cosine loses precision for slow spins.
    double sine = 0.0;
    double cosine = 1.0;
    sin_cos(0.5 * rate * t_s, sine, cosine);
    const Vec3 along = axis * axis.dot(velocity);
    const Vec3 across = velocity - along;
    pose.position +=
        along * t_s + (2.0 * sine / rate) * (across * cosine + axis.cross(across) * sine);
    return pose;
}

BodyVelocity mover_velocity(const Mover& mover, double t_s) {
    const Vec3& spin = mover.angular_velocity_ws_radps;
    if (!mover.turns_with_body) {
        return {mover.velocity_ws_mps, spin};
    }
    return {rotation_from_vector(spin * t_s) * mover.velocity_ws_mps, spin};
}

BodyVelocity leg_velocity(const PosePath& torso, const LegMover& mover, double t_s) {
    const auto pose_at = [&](double at_s) {
        return crawler_bone_pose(torso, mover.gait, mover.leg, mover.bone, at_s);
    };
    const Pose before = pose_at(t_s - k_leg_step_s);
    const Pose after = pose_at(t_s + k_leg_step_s);
    return {
        (after.position - before.position) / (2.0 * k_leg_step_s),
        rotation_to_vector(after.rotation * before.rotation.conjugate()) / (2.0 * k_leg_step_s)};
}

BodyVelocity told_velocity(const MoveTarget& target, double window_s, double end_s) {
    constexpr double k_equal = 1e-3;  // relative difference of spans that count as equal
    double span_s = 0.0;
    double shortest_s = 0.0;
    double longest_s = 0.0;
    Vec3 moved_m = Vec3::Zero();
    Vec3 turned_rad = Vec3::Zero();
    for (std::uint32_t i = 0; i < target.count && span_s < window_s; ++i) {
        const MoveTarget::Move& move = target.moves[i];
        if (i > 0 && move.span_s > k_span_ratio * shortest_s) {
            break;
        }
        shortest_s = i == 0 ? move.span_s : std::min(shortest_s, move.span_s);
        longest_s = std::max(longest_s, move.span_s);
        span_s += move.span_s;
        moved_m += move.moved_m;
        turned_rad += move.turned_rad;
    }
    const bool is_at_rest =
        target.count == 0 ||
        (end_s > target.moved_s && end_s - target.moved_s >= (1.0 - k_equal) * longest_s);
    if (is_at_rest) {
        return {};
    }
    if (longest_s - shortest_s <= k_equal * shortest_s) {
        const MoveTarget::Move& newest = target.moves[0];
        return {newest.moved_m / newest.span_s, newest.turned_rad / newest.span_s};
    }
    return {moved_m / span_s, turned_rad / span_s};
}

namespace {

// Notes that the target's body moved in a frame, if it did.
void note_move(const Pose& start_ws, double dt_s, double end_s, MoveTarget& target) {
    const Pose& end_ws = target.pose_ws;
    if (end_ws.position == start_ws.position &&
        end_ws.rotation.coeffs() == start_ws.rotation.coeffs()) {
        return;
    }
    const double longest_s = std::max(k_longest_move_s, dt_s);
    const double since_s = target.count == 0 ? longest_s : end_s - target.moved_s;
    const Quat turn = end_ws.rotation * start_ws.rotation.conjugate();
    std::shift_right(target.moves.begin(), target.moves.end(), 1);
    target.moves[0] = {std::clamp(since_s, dt_s, longest_s), end_ws.position - start_ws.position,
                       rotation_to_vector(turn.normalized())};
    target.count = std::min<std::uint32_t>(target.count + 1, MoveTarget::k_capacity);
    target.moved_s = end_s;
}

}  // namespace

void animate_movers(const AnimateMoversIo& io, const TrackingTuning& tuning) {
    const auto move = [&io](Entity body, const Pose& pose_ws, const BodyVelocity& velocity) {
        io.body_start.at(body).pose_ws = io.body_pose.at(body).pose_ws;
        io.body_pose.at(body).pose_ws = pose_ws;
        io.velocity.at(body) = velocity;
    };
    for (std::size_t index = 0; index < io.mover.size(); ++index) {
        const Mover& mover = io.mover.elements()[index];
        move(io.mover.owners()[index], mover_pose(mover, io.end_s),
             mover_velocity(mover, io.end_s));
    }
    for (std::size_t index = 0; index < io.path_mover.size(); ++index) {
        const PosePathState state = evaluate(io.path_mover.elements()[index].path, io.end_s);
        move(io.path_mover.owners()[index], state.pose,
             {state.velocity_mps, state.angular_velocity_radps});
    }
    for (std::size_t index = 0; index < io.leg_mover.size(); ++index) {
        const Entity body = io.leg_mover.owners()[index];
        const LegMover& mover = io.leg_mover.elements()[index];
        const PathMover* const torso = io.path_mover.find(mover.torso);
        if (torso == nullptr) {
            move(body, io.body_pose.at(body).pose_ws, {});
            continue;
        }
        move(body, crawler_bone_pose(torso->path, mover.gait, mover.leg, mover.bone, io.end_s),
             leg_velocity(torso->path, mover, io.end_s));
    }
    for (std::size_t index = 0; index < io.target.size(); ++index) {
        const Entity body = io.target.owners()[index];
        MoveTarget& target = io.target.elements()[index];
        note_move(io.body_pose.at(body).pose_ws, io.dt_s, io.end_s, target);
        move(body, target.pose_ws, told_velocity(target, tuning.release_window_s, io.end_s));
    }
}

}  // namespace handhold
