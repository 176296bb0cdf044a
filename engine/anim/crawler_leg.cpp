#include "engine/anim/crawler_leg.hpp"

#include <algorithm>
#include <cmath>

namespace handhold {
namespace {

// Smoother step: 0 to 1, with zero velocity and acceleration at both ends.
double smoother_step(double s) { return s * s * s * (10.0 + s * (6.0 * s - 15.0)); }

// 0 at both ends, with zero velocity and acceleration there; 1 in the middle.
double arch(double s) {
    const double product = 4.0 * s * (1.0 - s);
    return product * product * product;
}

}  // namespace

TwoBones place_two_bones(const Vec3& root, const Vec3& target, double upper_m, double lower_m,
                         const Vec3& pole) {
    const double slack = 1e-3 * (upper_m + lower_m);
    const Vec3 to_target = target - root;
    const double target_m = to_target.norm();
    const double nearest = std::abs(upper_m - lower_m) + slack;
    const double reach = std::clamp(target_m, nearest, upper_m + lower_m - slack);
    const Vec3 along = target_m > 0.0 ? Vec3(to_target / target_m) : Vec3(-pole.normalized());
    const Vec3 across = (pole - along * along.dot(pole)).normalized();
    // Law of cosines: distance of the knee along the line from root to end, and its height off it.
    const double foot_m = (upper_m * upper_m - lower_m * lower_m + reach * reach) / (2.0 * reach);
    const double height = std::sqrt(std::max(0.0, upper_m * upper_m - foot_m * foot_m));
    return {root, root + foot_m * along + height * across, root + reach * along};
}

Vec3 crawler_foot(const PosePath& torso, const CrawlerGait& gait, const CrawlerLeg& leg,
                  double t_s) {
    const double steps = t_s / gait.step_s + leg.phase;
    const double step = std::floor(steps);
    const auto foothold = [&](double number) {
        const double middle_s = (number + 0.5 * gait.standing - leg.phase) * gait.step_s;
        return transform_point(evaluate(torso, middle_s).pose, leg.foot_bs);
    };
    const double share = steps - step;
    Vec3 here = foothold(step);
    if (share <= gait.standing) {
        return here;
    }
    const double swing = (share - gait.standing) / (1.0 - gait.standing);
    const Vec3 up = evaluate(torso, t_s).pose.rotation * Vec3::UnitY();
    return here + smoother_step(swing) * (foothold(step + 1.0) - here) +
           (gait.lift_m * arch(swing)) * up;
}

TwoBones crawler_bones(const PosePath& torso, const CrawlerGait& gait, const CrawlerLeg& leg,
                       double t_s) {
    const Pose pose = evaluate(torso, t_s).pose;
    return place_two_bones(transform_point(pose, leg.hip_bs), crawler_foot(torso, gait, leg, t_s),
                           leg.upper_m, leg.lower_m, pose.rotation * leg.knee_bs);
}

Pose crawler_bone_pose(const PosePath& torso, const CrawlerGait& gait, const CrawlerLeg& leg,
                       LegBone bone, double t_s) {
    const TwoBones bones = crawler_bones(torso, gait, leg, t_s);
    const Vec3& top = bone == LegBone::upper ? bones.root : bones.middle;
    const Vec3& bottom = bone == LegBone::upper ? bones.middle : bones.end;
    Mat3 axes;
    axes.col(1) = (top - bottom).normalized();
    axes.col(2) = (bones.middle - bones.root).cross(bones.end - bones.root).normalized();
    axes.col(0) = axes.col(1).cross(axes.col(2));
    return {0.5 * (top + bottom), Quat(axes).normalized()};
}

}  // namespace handhold
