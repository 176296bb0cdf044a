// The opposition axis leans towards the little finger, so that a flexed thumb ends below the index
// and middle fingers instead of beside them.
#include "systems/rigs/hand_limits.hpp"

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

}  // namespace handhold
