#include "game/climber/climber_plan.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

#include "game/session/hand_pose.hpp"

namespace handhold {
using hh::conjugate;
using hh::cross;
using hh::dot;
using hh::inverse;
using hh::length;
using hh::normalized;
using hh::transform_point;

namespace {

constexpr int k_glances = 14;  // rays in a search for holds
constexpr double k_glance_m = 1.2;
constexpr double k_nearest_m = 0.22;  // minimum distance of holds from the shoulder
constexpr double k_farthest_m = 0.62;
constexpr double k_fastest_mps = 2.2;   // maximum relative speed of a hold
constexpr double k_hold_gap_m = 0.004;  // gap between palm and surface
constexpr double k_rail_search_m = 0.9;
constexpr std::size_t k_queried_rails = 3;

// A point on a surface that the climber sees.
struct Seen {
    hh::Body body{};  // null: a player's head
    hh::Vec3 point_ws{};
    hh::Vec3 normal_ws{};
    hh::Vec3 along_ws =
        hh::Vec3{};  // direction of the rail's axis; zero: the point is not on a rail
};

// The inputs of a search for holds, and values derived from them.
struct Search {
    const ClimberSight& sight;
    const HoldSearch& ask;
    const ClimberState& state;
    hh::Vec3 eyes_ws{};
    hh::Vec3 shoulder_ws{};
    hh::Vec3 wrist_ws{};
    hh::Vec3 outward_ws{};  // unit; from the chest towards the hand's side
    hh::Vec3 body_mps{};    // velocity of the play space in the world
};

Search begin_search(const ClimberSight& sight, const HoldSearch& ask, const ClimberState& state) {
    const hh::Pose& origin = ask.now.origin_ws;
    const double side = ask.side == HH_RIGHT ? 1.0 : -1.0;
    const hh::Vec3 right_ps =
        hh::rotation_about(hh::k_y, state.chest_yaw_rad) * hh::Vec3{side, 0.0, 0.0};
    return {sight,
            ask,
            state,
            transform_point(origin, state.eyes_ps),
            transform_point(origin, shoulder_ps(state, ask.side)),
            transform_point(origin, state.hands[ask.side].wrist_ps.position),
            origin.rotation * right_ps,
            ask.now.carried ? (ask.now.support_mps + origin.rotation * state.velocity_ps_mps)
                            : ask.now.origin_mps};
}

// A candidate hold. A higher value is better; an ideal hold has about 1.
struct HoldCandidate {
    Seen seen;
    double value = 0.0;
    double reach_s = 0.0;
};

bool is_loose(const Search& search, hh::Body body) {
    const double mass_kg = search.sight.world.mass_kg(body).value_or(0.0);
    return mass_kg > 0.0 && mass_kg < search.sight.heavy_body_kg;
}

// Rates a point as a hold. nullopt if the hand cannot or should not grip there.
std::optional<HoldCandidate> evaluate(const Search& search, const Seen& seen, double luck) {
    const hh::World& world = search.sight.world;
    if (!world.has(seen.body) || (is_loose(search, seen.body) && !search.ask.loose_too)) {
        return std::nullopt;  // a head, or too light to climb on
    }
    const hh::Vec3 relative_mps = search.body_mps - velocity_at(world, seen.body, seen.point_ws);
    const double reach_s = reach_time_s(length(seen.point_ws - search.wrist_ws));
    const hh::Vec3 shoulder_then_ws = search.shoulder_ws + reach_s * relative_mps;
    const double distance_m = length(seen.point_ws - shoulder_then_ws);
    if (length(relative_mps) > k_fastest_mps || distance_m < k_nearest_m ||
        distance_m > k_farthest_m) {
        return std::nullopt;
    }
    const ClimberHand& other = search.state.hands[search.ask.side == HH_LEFT ? HH_RIGHT : HH_LEFT];
    constexpr double k_hands_apart_m = 0.14;
    if (other.mode != ClimberHandMode::rest &&
        length(transform_point(search.ask.now.origin_ws, other.wrist_ps.position) - seen.point_ws) <
            k_hands_apart_m) {
        return std::nullopt;
    }
    const hh::Vec3 from_eyes = seen.point_ws - search.eyes_ws;
    const double progress_m = dot(from_eyes, search.ask.toward_ws);
    const double across_m = std::max(0.0, -dot(from_eyes, search.outward_ws) - 0.05);
    const bool is_rail = dot(seen.along_ws, seen.along_ws) > 0.0;
    HoldCandidate candidate{seen, 0.0, reach_s};
    candidate.value = 1.4 * std::min(progress_m, 0.5) - 1.5 * across_m -
                      0.6 * std::abs(distance_m - 0.42) + (is_rail ? 0.35 : 0.0) + 0.15 * luck;
    return candidate;
}

void offer(const Search& search, const Seen& seen, double luck,
           std::optional<HoldCandidate>& best) {
    const std::optional<HoldCandidate> candidate = evaluate(search, seen, luck);
    if (candidate && (!best || candidate->value > best->value)) {
        best = candidate;
    }
}

void glance_about(const Search& search, Random& random, std::optional<HoldCandidate>& best) {
    // A moving climber looks farther: holds that are out of reach now may be in reach when the hand
    // arrives.
    const double length_m = k_glance_m + 0.6 * length(search.ask.now.relative_mps);
    for (int i = 0; i < k_glances; ++i) {
        const hh::Vec3 chance_ws = random.direction();
        const double luck = random.unit();
        constexpr double k_spread = 1.1;
        const hh::Vec3 way_ws = search.ask.toward_ws + k_spread * chance_ws;
        if (length(way_ws) < 1e-3) {
            continue;
        }
        const hh::Vec3 to_ws = search.eyes_ws + length_m * normalized(way_ws);
        const auto hit = search.sight.world.cast_ray(search.eyes_ws, to_ws, search.ask.task.player);
        if (hit) {
            offer(search, {hit->body, hit->point, hit->normal}, luck, best);
        }
    }
}

// The point of a rail's axis nearest to the ideal point for the hand, and the distance between
// these two points.
struct RailPlace {
    hh::Vec3 axis_ws{};
    hh::Vec3 along_ws{};
    double off_m = 0.0;
};
RailPlace place_on(const SceneRail& rail, const hh::Pose& body_ws, const hh::Vec3& ideal_ws) {
    const hh::Vec3 start = transform_point(body_ws, rail.start_bs);
    const hh::Vec3 way = transform_point(body_ws, rail.end_bs) - start;
    const double rail_m = length(way);
    const hh::Vec3 along = way / std::max(rail_m, 1e-6);
    // Half a hand's width: minimum distance from the ends of the bar.
    constexpr double k_fist_m = 0.05;
    const double at = std::clamp(dot(along, ideal_ws - start), std::min(k_fist_m, 0.5 * rail_m),
                                 std::max(rail_m - k_fist_m, 0.5 * rail_m));
    const hh::Vec3 axis = start + at * along;
    return {axis, along, length(axis - ideal_ws)};
}

void query_rails(const Search& search, Random& random, std::optional<HoldCandidate>& best) {
    const hh::World& world = search.sight.world;
    const hh::Vec3 ideal_ws = search.shoulder_ws + 0.4 * search.ask.toward_ws;
    std::array<RailPlace, k_queried_rails> places;
    std::size_t count = 0;
    for (const SceneRail& rail : search.sight.rails) {
        if (!world.has(rail.body)) {
            continue;
        }
        const RailPlace place = place_on(rail, *world.pose(rail.body), ideal_ws);
        if (place.off_m > k_rail_search_m) {
            continue;
        }
        // Inserts the rail into the list of the nearest rails, sorted by distance.
        auto* const at = std::find_if(places.begin(), places.begin() + count,
                                      [&](const RailPlace& p) { return place.off_m < p.off_m; });
        count = std::min(count + 1, places.size());
        if (at != places.begin() + count) {
            std::move_backward(at, places.begin() + count - 1, places.begin() + count);
            *at = place;
        }
    }
    for (const RailPlace& place : std::span(places).first(count)) {
        const double luck = random.unit();
        constexpr double k_bar_m = 0.04;  // radius of a rail, roughly
        const hh::Vec3 way = normalized(place.axis_ws - search.eyes_ws);
        const auto hit = search.sight.world.cast_ray(search.eyes_ws, place.axis_ws + 0.01 * way,
                                                     search.ask.task.player);
        if (hit && length(hit->point - place.axis_ws) < k_bar_m) {
            offer(search, {hit->body, hit->point, hit->normal, place.along_ws}, luck, best);
        }
    }
}

// Returns the hold at a candidate, with the wrist's pose. The fingers wrap around a rail and lie
// along any other surface. In both cases they point away from the shoulder.
ClimberHold make_hold(const Search& search, const HoldCandidate& chosen) {
    const Seen& seen = chosen.seen;
    const hh::Vec3 out = seen.point_ws - search.shoulder_ws;
    hh::Vec3 fingers = out - seen.normal_ws * dot(seen.normal_ws, out);
    if (dot(seen.along_ws, seen.along_ws) > 0.0) {
        const hh::Vec3 across = cross(seen.along_ws, seen.normal_ws);
        fingers = dot(across, out) >= 0.0 ? across : (-across);
    }
    constexpr double k_along_the_normal_m = 1e-3;
    if (length(fingers) < k_along_the_normal_m) {
        const hh::Quat tip = hh::rotation_between(hh::k_z, seen.normal_ws);
        fingers = tip * hh::k_x;
    }
    const PalmTarget palm{seen.point_ws + k_hold_gap_m * seen.normal_ws, seen.normal_ws, fingers};
    const hh::Pose wrist_ws = hand_on(palm, search.ask.side, search.sight.palm_center_m);
    const hh::Pose body_ws = *search.sight.world.pose(seen.body);
    return {seen.body, inverse(body_ws) * wrist_ws, conjugate(body_ws.rotation) * seen.normal_ws};
}

}  // namespace

std::optional<double> free_distance_m(const ClimberSight& sight, hh::Player player,
                                      const hh::Vec3& from_ws, const hh::Vec3& direction_ws,
                                      double length_m) {
    const auto hit = sight.world.cast_ray(from_ws, from_ws + length_m * direction_ws, player);
    return hit ? std::optional(hit->distance_m) : std::nullopt;
}

hh::Vec3 choose_heading(const ClimberSight& sight, hh::Player player, const hh::Vec3& from_ws,
                        ClimberState& state) {
    constexpr int k_directions = 12;
    constexpr double k_far_m = 6.0;
    constexpr double k_open_m = 0.3;
    hh::Vec3 best = -state.heading_ws;
    double best_value = -1e9;
    for (int i = 0; i < k_directions; ++i) {
        const hh::Vec3 direction = state.random.direction();
        const double luck = state.random.unit();
        // A direction without any surface counts as short, because nothing there would stop the
        // climber.
        const double way_m =
            free_distance_m(sight, player, from_ws, direction, k_far_m).value_or(k_open_m);
        const double value = way_m + 1.0 * dot(direction, state.heading_ws) + 2.0 * luck;
        if (value > best_value) {
            best_value = value;
            best = direction;
        }
    }
    return best;
}

std::optional<FoundHold> find_hold(const ClimberSight& sight, const HoldSearch& ask,
                                   ClimberState& state) {
    const Search search = begin_search(sight, ask, state);
    std::optional<HoldCandidate> best;
    query_rails(search, state.random, best);
    glance_about(search, state.random, best);
    if (!best) {
        return std::nullopt;
    }
    return FoundHold{make_hold(search, *best), best->reach_s};
}

std::optional<FoundHold> find_hold_on(const ClimberSight& sight, const HoldSearch& ask,
                                      hh::Body body, const ClimberState& state) {
    const Search search = begin_search(sight, ask, state);
    const hh::Vec3 center_ws = sight.world.pose(body)->position;
    const hh::Vec3 beyond_ws =
        center_ws + 0.05 * normalized(center_ws - search.eyes_ws + 1e-6 * hh::k_y);
    const auto hit = sight.world.cast_ray(search.eyes_ws, beyond_ws, ask.task.player);
    if (!hit || !(hit->body == body)) {
        return std::nullopt;
    }
    const auto candidate = evaluate(search, {hit->body, hit->point, hit->normal}, 0.0);
    if (!candidate) {
        return std::nullopt;
    }
    return FoundHold{make_hold(search, *candidate), candidate->reach_s};
}

std::optional<ClimberHold> find_shore(const ClimberSight& sight, hh::Player player,
                                      const hh::Vec3& from_ws, Random& random) {
    constexpr int k_directions = 12;
    constexpr double k_far_m = 40.0;
    constexpr double k_all_m = 100.0;
    std::optional<hh::Hit> nearest;
    for (int i = 0; i < k_directions; ++i) {
        const auto hit =
            sight.world.cast_ray(from_ws, from_ws + k_far_m * random.direction(), player);
        if (hit && hit->distance_m < (nearest ? nearest->distance_m : k_far_m) &&
            sight.world.has(hit->body)) {
            nearest = hit;
        }
    }
    if (!nearest) {
        nearest = sight.world.closest_point(from_ws, k_all_m, player);
    }
    if (!nearest || !sight.world.has(nearest->body)) {
        return std::nullopt;  // nothing, or another player's head
    }
    const hh::Pose body_ws = *sight.world.pose(nearest->body);
    return ClimberHold{nearest->body,
                       {hh::inverse_transform_point(body_ws, nearest->point), hh::k_no_turn},
                       hh::k_y};
}

}  // namespace handhold
