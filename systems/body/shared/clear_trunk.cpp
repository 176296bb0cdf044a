#include "systems/body/shared/clear_trunk.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "engine/math/scalar_rotation.hpp"

namespace handhold {
namespace {

double distance_to(const Vec3& point, const TrunkCapsule& trunk) {
    const Vec3 line = trunk.bottom_ts - trunk.top_ts;
    const double along = (point - trunk.top_ts).dot(line) / std::max(line.squaredNorm(), 1e-12);
    return (point - trunk.top_ts - std::clamp(along, 0.0, 1.0) * line).norm();
}

}  // namespace

TrunkCapsule trunk_capsule(const Vec3& chest_ts, const Vec3& down_ts, double scale) {
    constexpr double k_top_m = 0.08;  // distance below the middle between the shoulders
    constexpr double k_bottom_m = 0.45;
    return {chest_ts + scale * k_top_m * down_ts, chest_ts + scale * k_bottom_m * down_ts,
            scale * k_clear_trunk_m};
}

double depth_in_trunk(const Vec3& elbow_ts, const Vec3& hand_ts, const TrunkCapsule& trunk) {
    // Points of the forearm. The rest of it goes with the hand, whose place is given.
    constexpr std::array<double, 3> k_shares = {0.0, 0.25, 0.5};
    double nearest_m = distance_to(elbow_ts, trunk);
    for (const double share : k_shares) {
        const Vec3 point = elbow_ts + share * (hand_ts - elbow_ts);
        nearest_m = std::min(nearest_m, distance_to(point, trunk));
    }
    return trunk.radius_m - nearest_m;
}

Vec3 bend_clear_of_trunk(const ElbowCircle& circle, const Vec3& bend_ts, const Vec3& hand_ts,
                         HandSide side, const TrunkCapsule& trunk) {
    const auto depth_m = [&](const Vec3& bend) {
        return depth_in_trunk(circle.middle_ts + circle.radius_m * bend, hand_ts, trunk);
    };
    const double now_m = depth_m(bend_ts);
    const Vec3 outward(side == HandSide::right ? 1.0 : -1.0, 0.0, 0.0);
    const Vec3 aside = outward - circle.axis_ts * circle.axis_ts.dot(outward);
    const double length = aside.norm();
    if (now_m <= 0.0 || length < 1e-3) {
        return bend_ts;
    }
    const Vec3 out = aside * (1.0 / length);
    const Vec3 square = circle.axis_ts.cross(bend_ts);
    const double whole_rad = arc_tangent2(square.dot(out), bend_ts.dot(out));
    const auto turned = [&](double share) {
        double sine = 0.0;
        double cosine = 1.0;
        sin_cos(share * whole_rad, sine, cosine);
        return Vec3(cosine * bend_ts + sine * square);
    };
    // Arms that gain little turn little: the result is continuous where turning begins to help.
    const double least_m = std::max(depth_m(out), 0.0);
    const double gain = smooth_step(now_m - least_m, 0.0, std::min(k_trunk_gain_m, now_m));
    if (gain == 0.0) {
        return bend_ts;
    }
    constexpr int k_halvings = 10;
    double inside = 0.0;
    double outside = 1.0;
    for (int i = 0; i < k_halvings; ++i) {
        const double middle = 0.5 * (inside + outside);
        (depth_m(turned(middle)) > least_m ? inside : outside) = middle;
    }
    return turned(gain * outside).normalized();
}

}  // namespace handhold
