#include "game/climber/climber_plan.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

#include "game/session/hand_pose.hpp"

namespace handhold {
namespace {

constexpr int k_glances = 14;  // rays in a search for holds
constexpr double k_glance_m = 1.2;
constexpr double k_nearest_m = 0.22;  // minimum distance of holds from the shoulder
constexpr double k_farthest_m = 0.62;
constexpr double k_fastest_mps = 2.2;   // maximum relative speed of a hold
constexpr double k_hold_gap_m = 0.004;  // gap between palm and surface
constexpr double k_rail_search_m = 0.9;
constexpr std::size_t k_queried_rails = 3;

std::uint64_t id_of(const ClimberSight& sight, Entity entity) {
    return sight.scene.world.persistent_id.at(entity).value;
}

std::optional<RayHit> look(const ClimberSight& sight, Entity player, const Vec3& from_ws,
                           const Vec3& to_ws) {
    const std::array<std::uint64_t, 1> own_id = {id_of(sight, player)};
    return sight.collision.cast_ray(from_ws, to_ws, own_id);
}

// The body with this id; null for a player's head. Searches only the bodies, because a world has
// far fewer bodies than entities.
Entity body_of_id(const World& world, std::uint64_t id) {
    for (const Entity body : world.body.owners()) {
        if (world.persistent_id.at(body).value == id) {
            return body;
        }
    }
    return k_no_entity;
}

// A point on a surface that the climber sees.
struct Seen {
    std::uint64_t id = 0;
    Vec3 point_ws;
    Vec3 normal_ws;
    Vec3 along_ws = Vec3::Zero();  // direction of the rail's axis; zero: the point is not on a rail
};

// The inputs of a search for holds, and values derived from them.
struct Search {
    const ClimberSight& sight;
    const HoldSearch& ask;
    const ClimberState& state;
    Vec3 eyes_ws;
    Vec3 shoulder_ws;
    Vec3 wrist_ws;
    Vec3 outward_ws;  // towards the hand's side
    Vec3 body_mps;    // velocity of the play space in the world
};

Search begin_search(const ClimberSight& sight, const HoldSearch& ask, const ClimberState& state) {
    const Pose& origin = ask.now.origin_ws;
    const double side = ask.side == HandSide::right ? 1.0 : -1.0;
    const Vec3 right_ps = rotation_about(Vec3::UnitY(), state.chest_yaw_rad) * Vec3(side, 0.0, 0.0);
    return {sight,
            ask,
            state,
            transform_point(origin, state.eyes_ps),
            transform_point(origin, shoulder_ps(state, ask.side)),
            transform_point(origin, state.hands[index_of(ask.side)].wrist_ps.position),
            origin.rotation * right_ps,
            ask.now.carried ? Vec3(ask.now.support_mps + origin.rotation * state.velocity_ps_mps)
                            : ask.now.origin_mps};
}

// A candidate hold. A higher value is better; an ideal hold has about 1.
struct HoldCandidate {
    Seen seen;
    Entity body;
    double value = 0.0;
    double reach_s = 0.0;
};

bool is_loose(const Search& search, const RigidBody& body) {
    return body.kind == BodyKind::free &&
           body.mass_kg < search.sight.scene.tuning.phases.heavy_body_kg;
}

// Rates a point as a hold. nullopt if the hand cannot or should not grip there.
std::optional<HoldCandidate> evaluate(const Search& search, const Seen& seen, double luck) {
    const World& world = search.sight.scene.world;
    const Entity body = body_of_id(world, seen.id);
    const RigidBody* const rigid = world.body.find(body);
    if (rigid == nullptr || (is_loose(search, *rigid) && !search.ask.loose_too)) {
        return std::nullopt;  // a head, or too light to climb on
    }
    const Vec3 relative_mps = search.body_mps - velocity_at(world, body, seen.point_ws);
    const double reach_s = reach_time_s((seen.point_ws - search.wrist_ws).norm());
    const Vec3 shoulder_then_ws = search.shoulder_ws + reach_s * relative_mps;
    const double distance_m = (seen.point_ws - shoulder_then_ws).norm();
    if (relative_mps.norm() > k_fastest_mps || distance_m < k_nearest_m ||
        distance_m > k_farthest_m) {
        return std::nullopt;
    }
    const ClimberHand& other = search.state.hands[1 - index_of(search.ask.side)];
    constexpr double k_hands_apart_m = 0.14;
    if (other.mode != ClimberHandMode::rest &&
        (transform_point(search.ask.now.origin_ws, other.wrist_ps.position) - seen.point_ws)
                .norm() < k_hands_apart_m) {
        return std::nullopt;
    }
    const Vec3 from_eyes = seen.point_ws - search.eyes_ws;
    const double progress_m = from_eyes.dot(search.ask.toward_ws);
    const double across_m = std::max(0.0, -from_eyes.dot(search.outward_ws) - 0.05);
    const bool is_rail = seen.along_ws.squaredNorm() > 0.0;
    HoldCandidate candidate{seen, body, 0.0, reach_s};
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
    const double length_m = k_glance_m + 0.6 * search.ask.now.relative_mps.norm();
    for (int i = 0; i < k_glances; ++i) {
        const Vec3 chance_ws = random.direction();
        const double luck = random.unit();
        constexpr double k_spread = 1.1;
        const Vec3 way_ws = search.ask.toward_ws + k_spread * chance_ws;
        if (way_ws.norm() < 1e-3) {
            continue;
        }
        const Vec3 to_ws = search.eyes_ws + length_m * way_ws.normalized();
        const auto hit = look(search.sight, search.ask.task.player.player, search.eyes_ws, to_ws);
        if (hit) {
            offer(search, {hit->id, hit->point_ws, hit->normal_ws}, luck, best);
        }
    }
}

// The point of a rail's axis nearest to the ideal point for the hand, and the distance between
// these two points.
struct RailPlace {
    Vec3 axis_ws;
    Vec3 along_ws;
    double off_m = 0.0;
};
RailPlace place_on(const SceneRail& rail, const Pose& body_ws, const Vec3& ideal_ws) {
    const Vec3 start = transform_point(body_ws, rail.start_bs);
    const Vec3 way = transform_point(body_ws, rail.end_bs) - start;
    const double length = way.norm();
    const Vec3 along = way / std::max(length, 1e-6);
    // Half a hand's width: minimum distance from the ends of the bar.
    constexpr double k_fist_m = 0.05;
    const double at = std::clamp(along.dot(ideal_ws - start), std::min(k_fist_m, 0.5 * length),
                                 std::max(length - k_fist_m, 0.5 * length));
    const Vec3 axis = start + at * along;
    return {axis, along, (axis - ideal_ws).norm()};
}

void query_rails(const Search& search, Random& random, std::optional<HoldCandidate>& best) {
    const World& world = search.sight.scene.world;
    const Vec3 ideal_ws = search.shoulder_ws + 0.4 * search.ask.toward_ws;
    std::array<RailPlace, k_queried_rails> places;
    std::size_t count = 0;
    for (const SceneRail& rail : search.sight.scene.rails) {
        const BodyPose* const pose = world.body_pose.find(rail.body);
        if (pose == nullptr) {
            continue;
        }
        const RailPlace place = place_on(rail, pose->pose_ws, ideal_ws);
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
        const Vec3 way = (place.axis_ws - search.eyes_ws).normalized();
        const auto hit = look(search.sight, search.ask.task.player.player, search.eyes_ws,
                              place.axis_ws + 0.01 * way);
        if (hit && (hit->point_ws - place.axis_ws).norm() < k_bar_m) {
            offer(search, {hit->id, hit->point_ws, hit->normal_ws, place.along_ws}, luck, best);
        }
    }
}

// Orients the hand. On a rail the fingers go round the bar; on another surface they point along it.
// Both ways they point away from the shoulder.
ClimberHold make_hold(const Search& search, const HoldCandidate& chosen) {
    const Seen& seen = chosen.seen;
    const Vec3 out = seen.point_ws - search.shoulder_ws;
    Vec3 fingers = out - seen.normal_ws * seen.normal_ws.dot(out);
    if (seen.along_ws.squaredNorm() > 0.0) {
        const Vec3 across = seen.along_ws.cross(seen.normal_ws);
        fingers = across.dot(out) >= 0.0 ? across : Vec3(-across);
    }
    constexpr double k_along_the_normal_m = 1e-3;
    if (fingers.norm() < k_along_the_normal_m) {
        const Quat tip = rotation_between(Vec3::UnitZ(), seen.normal_ws);
        fingers = tip * Vec3::UnitX();
    }
    const PalmTarget palm{seen.point_ws + k_hold_gap_m * seen.normal_ws, seen.normal_ws, fingers};
    const Pose wrist_ws = hand_on(palm, search.ask.side, search.sight.scene.tuning.hand);
    const Pose& body_ws = search.sight.scene.world.body_pose.at(chosen.body).pose_ws;
    return {chosen.body, inverse(body_ws) * wrist_ws,
            body_ws.rotation.conjugate() * seen.normal_ws};
}

}  // namespace

std::optional<double> free_distance_m(const ClimberSight& sight, Entity player, const Vec3& from_ws,
                                      const Vec3& direction_ws, double length_m) {
    const auto hit = look(sight, player, from_ws, from_ws + length_m * direction_ws);
    return hit ? std::optional(hit->distance_m) : std::nullopt;
}

Vec3 choose_heading(const ClimberSight& sight, Entity player, const Vec3& from_ws,
                    ClimberState& state) {
    constexpr int k_directions = 12;
    constexpr double k_far_m = 6.0;
    constexpr double k_open_m = 0.3;
    Vec3 best = -state.heading_ws;
    double best_value = -1e9;
    for (int i = 0; i < k_directions; ++i) {
        const Vec3 direction = state.random.direction();
        const double luck = state.random.unit();
        // A direction without any surface counts as short, because nothing there would stop the
        // climber.
        const double way_m =
            free_distance_m(sight, player, from_ws, direction, k_far_m).value_or(k_open_m);
        const double value = way_m + 1.0 * direction.dot(state.heading_ws) + 2.0 * luck;
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

std::optional<ClimberHold> find_shore(const ClimberSight& sight, Entity player, const Vec3& from_ws,
                                      Random& random) {
    constexpr int k_directions = 12;
    constexpr double k_far_m = 40.0;
    constexpr double k_all_m = 100.0;
    std::uint64_t id = 0;
    Vec3 point_ws = from_ws;
    double nearest_m = k_far_m;
    for (int i = 0; i < k_directions; ++i) {
        const auto hit = look(sight, player, from_ws, from_ws + k_far_m * random.direction());
        if (hit && hit->distance_m < nearest_m &&
            !is_null(body_of_id(sight.scene.world, hit->id))) {
            id = hit->id;
            point_ws = hit->point_ws;
            nearest_m = hit->distance_m;
        }
    }
    if (id == 0) {
        const std::array<std::uint64_t, 1> own_id = {id_of(sight, player)};
        const auto near = sight.collision.closest_point(from_ws, k_all_m, own_id);
        if (!near) {
            return std::nullopt;
        }
        id = near->id;
        point_ws = near->point_ws;
    }
    const Entity body = body_of_id(sight.scene.world, id);
    const BodyPose* const pose = sight.scene.world.body_pose.find(body);
    if (pose == nullptr) {
        return std::nullopt;  // another player's head
    }
    return ClimberHold{
        body, {inverse_transform_point(pose->pose_ws, point_ws), Quat::Identity()}, Vec3::UnitY()};
}

}  // namespace handhold
