#include "game/climber/climber_steer.hpp"

#include <algorithm>
#include <array>
#include <cstdint>

#include "game/climber/climber_plan.hpp"
#include "game/scene/player_defaults.hpp"

namespace handhold {
namespace {

constexpr double k_near_waypoint_m = 0.3;
constexpr double k_detour_s = 2.0;
// Time without reaching the next waypoint before the climber takes a detour.
constexpr double k_stuck_s = 12.0;

Vec3 waypoint_ws(const ClimberMind& mind) {
    const std::size_t index =
        std::min<std::size_t>(mind.state.waypoint, mind.task.waypoints.size() - 1);
    const ClimberWaypoint& waypoint = mind.task.waypoints[index];
    const BodyPose* const body = mind.world().body_pose.find(waypoint.body);
    return body != nullptr ? transform_point(body->pose_ws, waypoint.point_bs) : waypoint.point_bs;
}

// Sets the heading towards the current waypoint, or a detour if the climber is stuck. Returns false
// if the climber is at the last waypoint and stays.
bool head_for_waypoint(const ClimberMind& mind) {
    ClimberState& state = mind.state;
    Vec3 way = waypoint_ws(mind) - mind.now.head_ws;
    if (way.norm() < k_near_waypoint_m && !is_at_target(mind.task, state)) {
        ++state.waypoint;
        state.waypoint_since_s = mind.now.t_s;
        way = waypoint_ws(mind) - mind.now.head_ws;
    }
    if (is_at_target(mind.task, state) && way.norm() < 2.0 * k_near_waypoint_m) {
        return false;
    }
    if (mind.now.t_s < state.detour_until_s) {
        return true;
    }
    if (mind.now.t_s - state.waypoint_since_s > k_stuck_s) {
        state.waypoint_since_s = mind.now.t_s;
        state.detour_until_s = mind.now.t_s + k_detour_s;
        state.heading_ws = choose_heading(mind.sight, mind.player(), mind.now.head_ws, state);
        return true;
    }
    state.heading_ws = way.norm() > 1e-6 ? Vec3(way.normalized()) : state.heading_ws;
    return true;
}

void look_ahead(const ClimberMind& mind) {
    constexpr double k_far_m = 6.0;
    const auto way_m = free_distance_m(mind.sight, mind.player(), mind.now.head_ws,
                                       mind.state.heading_ws, k_far_m);
    mind.state.way_ahead_m = way_m.value_or(k_far_m);
    mind.state.shore_ahead = way_m.has_value();
}

}  // namespace

void head_anywhere(const ClimberMind& mind) {
    ClimberState& state = mind.state;
    state.heading_ws = choose_heading(mind.sight, mind.player(), mind.now.head_ws, state);
    state.heading_until_s = mind.now.t_s + state.random.between(3.0, 9.0);
    state.failed_queries = 0;
}

Vec3 steer(const ClimberMind& mind) {
    ClimberState& state = mind.state;
    bool goes_on = true;
    look_ahead(mind);
    if (!mind.task.waypoints.empty()) {
        goes_on = head_for_waypoint(mind);
        look_ahead(mind);
    } else if (mind.now.t_s >= state.heading_until_s || state.way_ahead_m < 1.5 * k_head_clear_m) {
        head_anywhere(mind);
        look_ahead(mind);
    }
    const double room = std::clamp((state.way_ahead_m - k_head_clear_m) / 0.4, 0.0, 1.0);
    Vec3 wanted_mps = Vec3::Zero();
    if (goes_on) {
        wanted_mps = (mind.task.cruise_mps * room) * state.heading_ws;
    }
    const std::array<std::uint64_t, 1> own_id = {
        mind.world().persistent_id.at(mind.player()).value};
    if (const auto near =
            mind.sight.collision.closest_point(mind.now.head_ws, k_head_clear_m, own_id)) {
        constexpr double k_push_mps = 0.5;
        const double into = wanted_mps.dot(near->normal_ws);
        wanted_mps -= std::min(0.0, into) * near->normal_ws;
        wanted_mps += (k_push_mps * (1.0 - near->distance_m / k_head_clear_m)) * near->normal_ws;
    }
    return wanted_mps;
}

}  // namespace handhold
