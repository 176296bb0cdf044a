#include "systems/physics/discard_broken_results.hpp"

#include <cmath>

namespace handhold {
namespace {

// False for NaN.
bool is_within(const Vec3& v, double limit) {
    return std::abs(v.x()) <= limit && std::abs(v.y()) <= limit && std::abs(v.z()) <= limit;
}

bool is_good(const Pose& pose) {
    return is_within(pose.position, k_farthest_result_m) && is_valid(pose);
}

void bound(double& number) { number = std::abs(number) <= k_farthest_result_m ? number : 0.0; }

}  // namespace

void discard_broken_results(const DiscardBrokenResultsIo& io, StageStats& stats) {
    for (const std::uint32_t i : io.frame.active.list) {
        const Entity body = io.frame.entities[i];
        if (!io.body_pose.contains(body)) {
            continue;  // players have no body components
        }
        Pose& pose_ws = io.body_pose.at(body).pose_ws;
        BodyVelocity& velocity = io.body_velocity.at(body);
        if (is_good(pose_ws) && is_within(velocity.linear_mps, k_fastest_result) &&
            is_within(velocity.angular_radps, k_fastest_result)) {
            continue;
        }
        pose_ws = io.body_start.at(body).pose_ws;
        velocity = {};
        stats.count(Fallback::restored_last_valid_pose);
    }
    for (std::size_t index = 0; index < io.player_origin.size(); ++index) {
        const Entity player = io.player_origin.owners()[index];
        Pose& pose_ws = io.player_origin.elements()[index].pose_ws;
        Vec3& velocity_mps = io.player_velocity.at(player).linear_mps;
        if (is_good(pose_ws) && is_within(velocity_mps, k_fastest_result)) {
            continue;
        }
        pose_ws = io.player_start.at(player).pose_ws;
        velocity_mps.setZero();
        stats.count(Fallback::restored_last_valid_pose);
    }
    for (const std::uint32_t i : io.frame.active.list) {
        LastValidPose* const found = io.last_valid.find(io.frame.entities[i]);
        if (found != nullptr && !is_good(found->pose_ws)) {
            LastValidPose& valid = *found;
            const BodyPose* const body = io.body_pose.find(io.frame.entities[i]);
            valid = body != nullptr ? LastValidPose{body->pose_ws, true}
                                    : LastValidPose{{}, false};  // a head is nowhere again
        }
    }
    for (JointState& state : io.joint_state.elements()) {
        bound(state.coordinate);
        bound(state.speed);
    }
    for (Grab& grab : io.grab.elements()) {
        bound(grab.error_m);
    }
    for (PushBack& push_back : io.frame.push_backs) {
        bound(push_back.distance_m);
    }
}

}  // namespace handhold
