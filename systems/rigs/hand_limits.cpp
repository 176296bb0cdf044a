// The opposition axis leans towards the little finger, so that a flexed thumb ends below the index
// and middle fingers instead of beside them.
#include "systems/rigs/hand_limits.hpp"

#include <algorithm>

#include "engine/geometry/closest_point.hpp"
#include "systems/rigs/hand_kinematics.hpp"

namespace handhold {
namespace {

struct CurlLimits {
    std::array<double, k_max_links> lower_deg, upper_deg, relaxed_deg, fist_deg;
};
constexpr CurlLimits k_finger = {
    {-10.0, 0.0, 0.0}, {115.0, 105.0, 75.0}, {20.0, 30.0, 15.0}, {110.0, 105.0, 75.0}};
constexpr CurlLimits k_two_bones = {
    {-10.0, 0.0, 0.0}, {115.0, 110.0, 0.0}, {20.0, 35.0, 0.0}, {110.0, 105.0, 0.0}};
// The thumb of a fist lies across the fingers, on the palm's side of them.
constexpr CurlLimits k_thumb = {
    {-10.0, -10.0, -10.0}, {28.0, 50.0, 65.0}, {10.0, 12.0, 10.0}, {-10.0, 50.0, 65.0}};
constexpr double k_fist_opposition_deg = 50.0;
constexpr double k_opposition_lower_deg = -85.0;
constexpr double k_opposition_upper_deg = 70.0;
// Range of a finger's spread to either side. Hands spread by 20 to 30 degrees between neighbours.
constexpr double k_spread_deg = 10.0;
// Sideways component of the opposition axis / forward component.
constexpr double k_opposition_lean = 0.25;

// Greatest depth of the thumb in the fingers, all closed to a fist; 0 if they do not overlap.
double fist_overlap_m(const HandRig& rig, const FingerRig& thumb) {
    double depth_m = 0.0;
    const auto on_thumb = finger_points(thumb, thumb.fist);
    for (const FingerRig& finger : rig.fingers) {
        const auto on_finger = finger_points(finger, finger.fist);
        for (std::size_t i = 0; finger.name != FingerName::thumb && i < thumb.link_count; ++i) {
            for (std::size_t k = 0; k < finger.link_count; ++k) {
                const auto [a, b] = closest_between_segments({on_thumb[i], on_thumb[i + 1]},
                                                             {on_finger[k], on_finger[k + 1]});
                depth_m =
                    std::max(depth_m, thumb.radius_m[i] + finger.radius_m[k] - (a - b).norm());
            }
        }
    }
    return depth_m;
}

}  // namespace

void set_hand_limits(HandSide side, FingerRig& finger) {
    const bool is_thumb = finger.name == FingerName::thumb;
    const CurlLimits& limits = is_thumb ? k_thumb : finger.link_count == 2 ? k_two_bones : k_finger;
    for (std::size_t link = 0; link < k_max_links; ++link) {
        finger.lower_rad[link] = limits.lower_deg[link] * k_degree;
        finger.upper_rad[link] = limits.upper_deg[link] * k_degree;
        finger.rest_rad[link] = limits.relaxed_deg[link] * k_degree;
        finger.fist.curl_rad[link] = limits.fist_deg[link] * k_degree;
    }
    const double sign = side == HandSide::right ? 1.0 : -1.0;
    if (!is_thumb) {
        finger.lower_opposition_rad = -k_spread_deg * k_degree;
        finger.upper_opposition_rad = k_spread_deg * k_degree;
        finger.opposition_axis_hs = sign * Vec3::UnitY();
        return;
    }
    finger.fist.opposition_rad = k_fist_opposition_deg * k_degree;
    finger.lower_opposition_rad = k_opposition_lower_deg * k_degree;
    finger.upper_opposition_rad = k_opposition_upper_deg * k_degree;
    // A positive angle turns from the thumb's side to the palm's side, on either hand.
    const Vec3 right_axis = -Vec3(k_opposition_lean, 0.0, -1.0).normalized();
    finger.opposition_axis_hs = Vec3(right_axis.x(), sign * right_axis.y(), sign * right_axis.z());
}

void clear_fist_thumb(HandRig& rig) {
    constexpr int k_steps = 16;
    for (FingerRig& thumb : rig.fingers) {
        if (thumb.name != FingerName::thumb) {
            continue;
        }
        const FingerAngles closed = thumb.fist;
        FingerAngles best = closed;
        double least_m = fist_overlap_m(rig, thumb);
        for (int step = 1; step <= k_steps && least_m > k_fist_touch_m; ++step) {
            for (std::size_t link = 0; link < thumb.link_count; ++link) {
                const double opens_rad =
                    std::max(0.0, closed.curl_rad[link] - thumb.rest_rad[link]);
                thumb.fist.curl_rad[link] = closed.curl_rad[link] - opens_rad * step / k_steps;
            }
            if (const double overlap_m = fist_overlap_m(rig, thumb); overlap_m < least_m) {
                least_m = overlap_m;
                best = thumb.fist;
            }
        }
        thumb.fist = best;
    }
}

}  // namespace handhold
