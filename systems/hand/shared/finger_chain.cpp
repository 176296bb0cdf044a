#include "systems/hand/shared/finger_chain.hpp"

#include <algorithm>

#include "engine/collision/closest_point.hpp"

namespace handhold {
namespace {

// Travel added per second of elapsed time, so that back-offs also expire for a hand at rest.
constexpr double k_travel_per_time_mps = 0.1;
constexpr double k_max_travel_m = 1.0;  // upper bound of all stored travel values
constexpr double k_lookahead_interval_m = 0.004;

// seed_under_palm and seed_near_finger return a point in the mesh's frame.
GraphPoint seed_under_palm(const PlacedMesh& placed, const GripSurface& surface) {
    const SurfaceGraph& graph = placed.mesh->search;
    if (surface.triangle >= graph.triangles.size()) {
        return {};
    }
    const Vec3 point = inverse_transform_point(placed.pose, surface.point_bs);
    return {surface.triangle, closest_on_triangle(point, corners_of(graph, surface.triangle))};
}

GraphPoint seed_near_finger(const PlacedMesh& placed, const HingeChain& chain) {
    const double radius_m = reach_m(chain);
    const Vec3 half_closed_middle(0.0, -0.2 * radius_m, -0.4 * radius_m);  // in the base's frame
    const Vec3 middle = transform_point(inverse(placed.pose) * chain.base, half_closed_middle);
    const auto near = placed.mesh->search_bvh.closest_point(middle, radius_m);
    return near ? GraphPoint{near->triangle, near->point} : GraphPoint{};
}

}  // namespace

HingeChain finger_chain(const FingerRig& finger, double opposition_rad, const Pose& wrist) {
    HingeChain chain;
    Pose base = finger.base_hs;
    base.rotation = rotation_about(finger.opposition_axis_hs, opposition_rad) * base.rotation;
    chain.base = wrist * base;
    chain.link_count = finger.link_count;
    chain.length_m = finger.length_m;
    chain.radius_m = finger.radius_m;
    chain.open_rad = finger.lower_rad;
    chain.closed_rad = finger.upper_rad;
    chain.rest_rad = finger.rest_rad;
    return chain;
}

ChainFitSettings chain_settings(const FingerTuning& tuning) {
    ChainFitSettings settings;
    settings.plane_offset = tuning.plane_offset;
    settings.search_depth_m = tuning.search_depth_m;
    settings.open_depth_m = tuning.open_depth_m;
    settings.open_step_rad = tuning.open_step_rad;
    settings.open_steps = tuning.open_steps;
    return settings;
}

void update_slow_time(double travel_m, double dt_s, const FingerTuning& tuning, FingerPose& pose) {
    constexpr double k_max_s = 1.0;
    const bool is_fast = travel_m > tuning.slow_speed_mps * dt_s;
    pose.slow_s = is_fast ? 0.0 : std::min(pose.slow_s + dt_s, k_max_s);
}

bool is_slow(const FingerPose& pose) {
    constexpr double k_moment_s = 0.1;
    return pose.slow_s >= k_moment_s;
}

ChainFitSettings sliding_refit_settings(ChainFitSettings settings, const ChainAngles& last_rad,
                                        bool is_slow) {
    settings.searches = false;
    settings.recloses_to_touch = is_slow;
    settings.near_rad = last_rad;
    return settings;
}

ChainSeed chain_seed(const HandSurroundings& hand, const GripSurface& surface,
                     std::uint32_t last_triangle, const HingeChain& chain) {
    const PlacedMesh& placed = hand.meshes.front();
    const SurfaceGraph& graph = placed.mesh->search;
    if (last_triangle >= graph.triangles.size()) {
        return {seed_under_palm(placed, surface), seed_near_finger(placed, chain)};
    }
    const Vec3 base = inverse_transform_point(placed.pose, chain.base.position);
    return {{{last_triangle, closest_on_triangle(base, corners_of(graph, last_triangle))}}};
}

double hand_travel_m(const Pose& from, const Pose& to) {
    constexpr double k_arm_m = 0.1;
    const Pose moved = inverse(from) * to;
    return moved.position.norm() + k_arm_m * rotation_to_vector(moved.rotation).norm();
}

bool is_clearly_better(const ChainFit& fit, const ChainFit& current,
                       const ChainFitSettings& settings) {
    constexpr double k_max_depth_ratio = 0.5;
    return fit.depth_m <= settings.open_depth_m ||
           fit.depth_m < k_max_depth_ratio * current.depth_m;
}

bool is_small_move(const Pose& from, const Pose& to) {
    constexpr double k_small_move_m = 0.008;  // 0.7 m/s at 90 frames a second
    return hand_travel_m(from, to) < k_small_move_m;
}

bool can_reuse_fit(const FingerPose& pose, const HandSurroundings& hand, const Pose& wrist_bs) {
    return pose.solved && pose.solved_body == hand.body &&
           is_small_move(pose.solved_wrist_bs, wrist_bs);
}

bool is_at_target(const PalmOffset& offset) {
    return offset.shown_m == offset.target_m && offset.shown_turn_rad == offset.target_turn_rad;
}

void count_rejected_pose(const PalmOffset& offset, std::size_t finger, FingerPose& pose,
                         StageStats& stats) {
    if (is_at_target(offset) && !pose.authored_pose_rejected[finger]) {
        pose.authored_pose_rejected[finger] = true;
        stats.count(Fallback::authored_finger_rejected);
    }
}

void advance(FingerBackoff& backoff, double travel_m, double dt_s) {
    backoff.travel_since_m = std::min(backoff.travel_since_m + travel_m, k_max_travel_m);
    backoff.retry_in_m =
        std::max(backoff.retry_in_m - travel_m - k_travel_per_time_mps * dt_s, -k_max_travel_m);
}

bool is_retry_due(const FingerBackoff& backoff) {
    return backoff.retry_in_m <= 0.0 && backoff.travel_since_m > 0.0;
}

void record_attempt(FingerBackoff& backoff, bool has_failed, bool is_fast,
                    std::uint32_t option_count) {
    constexpr double k_first_backoff_m = 0.006;
    constexpr std::uint32_t k_max_doublings = 2;
    constexpr std::uint32_t k_max_failures = 1000;
    backoff.failures = has_failed ? backoff.failures + 1 : 0;
    if (backoff.failures > k_max_failures) {
        // Reduces the count without changing failures % option_count, which selects the next
        // option.
        backoff.failures -=
            option_count * ((backoff.failures - k_max_doublings - 1) / option_count);
    }
    const std::uint32_t doublings =
        has_failed ? std::min(backoff.failures - 1, k_max_doublings) : 0;
    backoff.retry_in_m = k_first_backoff_m * (1U << doublings);
    backoff.travel_since_m =
        !is_fast && backoff.failures % option_count == 0 ? 0.0 : backoff.travel_since_m;
    backoff.was_fast_hand = is_fast;
}

bool touches(const ChainFit& fit) {
    return fit.contact_link != DiscClosure::k_none && fit.fallback != ChainFallback::rest_pose;
}

bool is_bent_clear(const ChainFit& fit) {
    return fit.fallback == ChainFallback::sample_pose && !touches(fit);
}

void advance(FingerLookahead& lookahead, double travel_m, double dt_s) {
    if (travel_m > 0.0) {
        lookahead.retry_in_m = std::min(lookahead.retry_in_m, k_lookahead_interval_m);
    }
    lookahead.travel_since_m = std::min(lookahead.travel_since_m + travel_m, k_max_travel_m);
    lookahead.retry_in_m =
        std::max(lookahead.retry_in_m - travel_m - k_travel_per_time_mps * dt_s, 0.0);
}

std::optional<bool> has_surface_ahead(const FingerLookahead& lookahead, bool may_query_lookahead) {
    const bool is_cached =
        lookahead.retry_in_m > 0.0 || (lookahead.is_known && !may_query_lookahead);
    return is_cached ? std::optional<bool>(lookahead.has_surface_ahead) : std::nullopt;
}

void update_lookahead(ChainFit& fit, FingerLookahead& lookahead) {
    if (fit.has_look_ahead) {
        // A finger of a hand at rest may have a surface ahead in one pose and none in the next. To
        // keep it from oscillating between these poses, the next query waits until the hand moves,
        // or for ten seconds.
        const bool is_lost =
            lookahead.is_known && lookahead.has_surface_ahead && !fit.has_surface_ahead;
        const bool is_still = lookahead.travel_since_m <= 0.0;
        lookahead = {is_lost && is_still ? k_max_travel_m : k_lookahead_interval_m, 0.0,
                     fit.has_surface_ahead, true};
    } else if (touches(fit)) {
        lookahead = {};
    } else if (lookahead.travel_since_m > 0.0) {
        fit.is_turn_limited = true;
    }
}

bool lift_if_penetrating(const HandSurroundings& hand, double depth_m, const PalmTuning& tuning,
                         PalmOffset& offset) {
    constexpr double k_max_lifts = 3.0;
    const double max_lift_m = k_max_lifts * tuning.lift_m;
    const bool is_moving = !is_at_target(offset) || offset.solved_lift_m != offset.lift_m;
    if (is_moving || hand.authored != nullptr || depth_m <= tuning.lift_from_depth_m ||
        offset.lift_m >= max_lift_m) {
        return false;
    }
    offset.lift_m = std::min(offset.lift_m + tuning.lift_m, max_lift_m);
    offset.lift_wrist_bs = hand.wrist_bs;
    return true;
}

bool lifts_within_frame(const PalmTuning& tuning, double dt_s) {
    return tuning.rate_mps * dt_s >= tuning.lift_m;
}

void begin_transition(const ChainAngles& to_rad, std::size_t finger, FingerPose& pose) {
    for (std::size_t i = 0; i < k_max_links; ++i) {
        pose.opening_lag_rad[finger][i] = std::max(0.0, pose.shown[finger].curl_rad[i] - to_rad[i]);
    }
}

void follow_target(std::size_t finger, double dt_s, const FingerTuning& tuning, FingerPose& pose) {
    const double step_rad = dt_s * tuning.close_radps;
    const FingerAngles& target = pose.target[finger];
    FingerAngles& shown = pose.shown[finger];
    for (std::size_t i = 0; i < k_max_links; ++i) {
        double& opening_lag_rad = pose.opening_lag_rad[finger][i];
        const double max_lag_rad = std::max(0.0, shown.curl_rad[i] - target.curl_rad[i]);
        const double reduced_rad = std::max(0.0, opening_lag_rad - dt_s * tuning.transition_radps);
        opening_lag_rad = std::min(reduced_rad, max_lag_rad);
        shown.curl_rad[i] =
            std::min(target.curl_rad[i] + opening_lag_rad, shown.curl_rad[i] + step_rad);
    }
    shown.opposition_rad = std::clamp(target.opposition_rad, shown.opposition_rad - step_rad,
                                      shown.opposition_rad + step_rad);
}

}  // namespace handhold
