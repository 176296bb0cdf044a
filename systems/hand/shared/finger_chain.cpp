#include "systems/hand/shared/finger_chain.hpp"

#include <algorithm>

#include "engine/collision/closest_point.hpp"

namespace handhold {
namespace {

constexpr double k_time_mps = 0.1;  // a hand that comes to rest need not wait for ever
constexpr double k_most_way_m = 1.0;
constexpr double k_look_again_m = 0.004;

// In the mesh's frame.
GraphPoint under_palm(const PlacedMesh& placed, const GripSurface& surface) {
    const SurfaceGraph& graph = placed.mesh->search;
    if (surface.triangle >= graph.triangles.size()) {
        return {};
    }
    const Vec3 point = inverse_transform_point(placed.pose, surface.point_bs);
    return {surface.triangle, closest_on_triangle(point, corners_of(graph, surface.triangle))};
}

GraphPoint before_finger(const PlacedMesh& placed, const HingeChain& chain) {
    const double radius_m = reach_m(chain);
    const Vec3 half_closed(0.0, -0.2 * radius_m, -0.4 * radius_m);  // about its middle
    const Vec3 middle = transform_point(inverse(placed.pose) * chain.base, half_closed);
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
    chain.relaxed_rad = finger.relaxed_rad;
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

void note_speed(double way_m, double dt_s, const FingerTuning& tuning, FingerPose& pose) {
    constexpr double k_most_s = 1.0;
    const bool is_fast = way_m > tuning.slow_mps * dt_s;
    pose.slow_s = is_fast ? 0.0 : std::min(pose.slow_s + dt_s, k_most_s);
}

bool is_slow(const FingerPose& pose) {
    constexpr double k_moment_s = 0.1;
    return pose.slow_s >= k_moment_s;
}

ChainFitSettings in_a_slide(ChainFitSettings settings, const ChainAngles& last_rad, bool is_slow) {
    settings.searches = false;
    settings.comes_back = is_slow;
    settings.near_rad = last_rad;
    return settings;
}

ChainSeed chain_seed(const HandSurroundings& hand, const GripSurface& surface,
                     std::uint32_t last_triangle, const HingeChain& chain) {
    const PlacedMesh& placed = hand.meshes.front();
    const SurfaceGraph& graph = placed.mesh->search;
    if (last_triangle >= graph.triangles.size()) {
        return {under_palm(placed, surface), before_finger(placed, chain)};
    }
    const Vec3 base = inverse_transform_point(placed.pose, chain.base.position);
    return {{{last_triangle, closest_on_triangle(base, corners_of(graph, last_triangle))}}};
}

double hand_way_m(const Pose& from, const Pose& to) {
    constexpr double k_arm_m = 0.1;
    const Pose moved = inverse(from) * to;
    return moved.position.norm() + k_arm_m * rotation_to_vector(moved.rotation).norm();
}

bool is_clearly_better(const ChainFit& fit, const ChainFit& than,
                       const ChainFitSettings& settings) {
    constexpr double k_clearly = 0.5;
    return fit.depth_m <= settings.open_depth_m || fit.depth_m < k_clearly * than.depth_m;
}

bool is_moment_later(const Pose& from, const Pose& to) {
    constexpr double k_moment_m = 0.008;  // 0.7 m/s at 90 frames a second
    return hand_way_m(from, to) < k_moment_m;
}

bool keeps_fit(const FingerPose& pose, const HandSurroundings& hand, const Pose& wrist_bs) {
    return pose.solved && pose.solved_body == hand.body &&
           is_moment_later(pose.solved_wrist_bs, wrist_bs);
}

bool has_arrived(const PalmOffset& offset) {
    return offset.shown_m == offset.target_m && offset.shown_turn_rad == offset.target_turn_rad;
}

void count_refusal(const PalmOffset& offset, std::size_t finger, FingerPose& pose,
                   StageStats& stats) {
    if (has_arrived(offset) && !pose.pose_refused[finger]) {
        pose.pose_refused[finger] = true;
        stats.count(Fallback::authored_finger_fitted);
    }
}

void age(FingerRetry& retry, double way_m, double dt_s) {
    retry.since_m = std::min(retry.since_m + way_m, k_most_way_m);
    retry.wait_m = std::max(retry.wait_m - way_m - k_time_mps * dt_s, -k_most_way_m);
}

bool may_retry(const FingerRetry& retry) { return retry.wait_m <= 0.0 && retry.since_m > 0.0; }

void note_try(FingerRetry& retry, bool in_vain, bool is_fast, std::uint32_t most) {
    constexpr double k_first_m = 0.006;
    constexpr std::uint32_t k_most_rounds = 2;
    constexpr std::uint32_t k_most_tries = 1000;
    retry.tries = in_vain ? retry.tries + 1 : 0;
    if (retry.tries > k_most_tries) {  // whose turn it is stays
        retry.tries -= most * ((retry.tries - k_most_rounds - 1) / most);
    }
    const std::uint32_t rounds = in_vain ? std::min(retry.tries - 1, k_most_rounds) : 0;
    retry.wait_m = k_first_m * (1U << rounds);
    retry.since_m = !is_fast && retry.tries % most == 0 ? 0.0 : retry.since_m;
    retry.was_fast = is_fast;
}

bool touches(const ChainFit& fit) {
    return fit.contact_link != DiscClosure::k_none && fit.fallback != ChainFallback::relaxed;
}

bool is_bent_away(const ChainFit& fit) {
    return fit.fallback == ChainFallback::bent && !touches(fit);
}

void age(FingerOutlook& outlook, double way_m, double dt_s) {
    if (way_m > 0.0) {
        outlook.wait_m = std::min(outlook.wait_m, k_look_again_m);
    }
    outlook.since_m = std::min(outlook.since_m + way_m, k_most_way_m);
    outlook.wait_m = std::max(outlook.wait_m - way_m - k_time_mps * dt_s, 0.0);
}

std::optional<bool> is_ahead(const FingerOutlook& outlook, bool may_look) {
    const bool is_told = outlook.wait_m > 0.0 || (outlook.is_known && !may_look);
    return is_told ? std::optional<bool>(outlook.is_ahead) : std::nullopt;
}

void note_outlook(ChainFit& fit, FingerOutlook& outlook) {
    if (fit.has_looked_ahead) {
        // What a hand that stands saw from one pose and not from the next, it would see again from
        // the first: it goes to and fro no more until the hand moves, or for ten seconds.
        const bool is_gone = outlook.is_known && outlook.is_ahead && !fit.is_ahead;
        const bool is_still = outlook.since_m <= 0.0;
        outlook = {is_gone && is_still ? k_most_way_m : k_look_again_m, 0.0, fit.is_ahead, true};
    } else if (touches(fit)) {
        outlook = {};
    } else if (outlook.since_m > 0.0) {
        fit.is_on_its_way = true;
    }
}

bool lift_if_sunk(const HandSurroundings& hand, double depth_m, const PalmTuning& tuning,
                  PalmOffset& offset) {
    constexpr double k_most_lifts = 3.0;
    const double most_m = k_most_lifts * tuning.lift_m;
    const bool is_on_its_way = !has_arrived(offset) || offset.target_lift_m != offset.lift_m;
    if (is_on_its_way || hand.authored != nullptr || depth_m <= tuning.lift_from_depth_m ||
        offset.lift_m >= most_m) {
        return false;
    }
    offset.lift_m = std::min(offset.lift_m + tuning.lift_m, most_m);
    offset.lifted_at_bs = hand.wrist_bs;
    return true;
}

bool lifts_at_once(const PalmTuning& tuning, double dt_s) {
    return tuning.rate_mps * dt_s >= tuning.lift_m;
}

void begin_change(const ChainAngles& to_rad, std::size_t finger, FingerPose& pose) {
    for (std::size_t i = 0; i < k_most_links; ++i) {
        pose.behind_rad[finger][i] = std::max(0.0, pose.shown[finger].curl_rad[i] - to_rad[i]);
    }
}

void follow_target(std::size_t finger, double dt_s, const FingerTuning& tuning, FingerPose& pose) {
    const double step_rad = dt_s * tuning.close_radps;
    const FingerAngles& target = pose.target[finger];
    FingerAngles& shown = pose.shown[finger];
    for (std::size_t i = 0; i < k_most_links; ++i) {
        double& behind_rad = pose.behind_rad[finger][i];
        const double left_rad = std::max(0.0, behind_rad - dt_s * tuning.change_radps);
        behind_rad = std::min(left_rad, std::max(0.0, shown.curl_rad[i] - target.curl_rad[i]));
        shown.curl_rad[i] = std::min(target.curl_rad[i] + behind_rad, shown.curl_rad[i] + step_rad);
    }
    shown.opposition_rad = std::clamp(target.opposition_rad, shown.opposition_rad - step_rad,
                                      shown.opposition_rad + step_rad);
}

}  // namespace handhold
