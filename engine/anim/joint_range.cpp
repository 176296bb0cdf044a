#include "engine/anim/joint_range.hpp"

#include <algorithm>
#include <cmath>

namespace handhold {
namespace {

double approach_limit(const JointRange& range, double before_rad, double now_rad) {
    const double before = std::clamp(before_rad, range.low_rad, range.high_rad);
    return std::clamp(now_rad, before + range.share * (range.low_rad - before),
                      before + range.share * (range.high_rad - before));
}

}  // namespace

Vec3 clamp_to_cone(const Vec3& towards, const Vec3& rest, const JointRange& range,
                   double& angle_rad) {
    const double along = towards.dot(rest);
    const Vec3 aside = towards - along * rest;
    const double length = aside.norm();
    const double wanted = arc_tangent2(length, along);
    // The angle from `rest` is never negative, so only the upper limit is approached.
    angle_rad = std::min(wanted, approach_limit(range, angle_rad, std::max(wanted, angle_rad)));
    if (angle_rad >= wanted) {
        return towards;
    }
    if (length < 1e-9) {
        return rest;
    }
    double sine = 0.0;
    double cosine = 1.0;
    sin_cos(angle_rad, sine, cosine);
    return cosine * rest + aside * (sine / length);
}

Vec3 clamp_to_hinge(const Vec3& towards, const JointRange& range, double& angle_rad) {
    angle_rad = approach_limit(range, angle_rad, arc_tangent2(towards.z(), -towards.y()));
    double sine = 0.0;
    double cosine = 1.0;
    sin_cos(angle_rad, sine, cosine);
    return {0.0, -cosine, sine};
}

}  // namespace handhold
