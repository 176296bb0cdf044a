#include "game/climber/climber_steer.hpp"

#include <algorithm>

#include "game/climber/climber_plan.hpp"
#include "game/scene/player_defaults.hpp"

namespace handhold {

using hh::dot;
using hh::length;
using hh::normalized;

namespace {

constexpr double k_near_waypoint_m = 0.3;
constexpr double k_detour_s = 2.0;
// Time without reaching the next waypoint before the climber takes a detour.
constexpr double k_stuck_s = 12.0;

hh::Vec3 waypoint_ws(const ClimberMind& mind) {
    const std::size_t index =
        std::min<std::size_t>(mind.state.waypoint, mind.task.waypoints.size() - 1);
    const ClimberWaypoint& waypoint = mind.task.waypoints[index];
    return mind.world().has(waypoint.body)
               ? hh::transform_point(*mind.world().pose(waypoint.body), waypoint.point_bs)
               : waypoint.point_bs;
}

// Sets the heading towards the current waypoint, or a detour if the climber is stuck. Returns false
// if the climber is at the last waypoint and stays.
bool head_for_waypoint(const ClimberMind& mind) {
    ClimberState& state = mind.state;
    hh::Vec3 way = waypoint_ws(mind) - mind.now.head_ws;
    if (length(way) < k_near_waypoint_m && !is_at_target(mind.task, state)) {
        ++state.waypoint;
        state.waypoint_since_s = mind.now.t_s;
        way = waypoint_ws(mind) - mind.now.head_ws;
    }
    if (is_at_target(mind.task, state) && length(way) < 2.0 * k_near_waypoint_m) {
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
    state.heading_ws = length(way) > 1e-6 ? (normalized(way)) : state.heading_ws;
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

hh::Vec3 steer(const ClimberMind& mind) {
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
    hh::Vec3 wanted_mps = hh::Vec3{};
    if (goes_on) {
        wanted_mps = (mind.task.cruise_mps * room) * state.heading_ws;
    }
    if (const auto near =
            mind.sight.world.closest_point(mind.now.head_ws, k_head_clear_m, mind.player())) {
        constexpr double k_push_mps = 0.5;
        const double into = dot(wanted_mps, near->normal);
        wanted_mps -= std::min(0.0, into) * near->normal;
        wanted_mps += (k_push_mps * (1.0 - near->distance_m / k_head_clear_m)) * near->normal;
    }
    return wanted_mps;
}

}  // namespace handhold
