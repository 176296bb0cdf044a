#pragma once

#include "engine/anim/pose_path.hpp"
#include "engine/math/math.hpp"

// Legs of two bones that crawl, as pure functions of the time: a foot stands still on its foothold
// while the torso passes over it, then swings to the next one. The bend of the knee is the law of
// cosines.
namespace handhold {

// Root, middle and end of two bones.
struct TwoBones {
    Vec3 root = Vec3::Zero();
    Vec3 middle = Vec3::Zero();
    Vec3 end = Vec3::Zero();  // the target, or the nearest place to it that the bones reach
};
// Bones of given lengths from `root` to `target`, their middle towards `pole` (not along the line
// between root and target). A target out of reach is replaced by the nearest point on its line that
// leaves the bones a thousandth of their length short of straight or folded.
TwoBones place_two_bones(const Vec3& root, const Vec3& target, double upper_m, double lower_m,
                         const Vec3& pole);

// Of one leg, in the torso's frame.
struct CrawlerLeg {
    Vec3 hip_bs = Vec3::Zero();
    Vec3 foot_bs = -Vec3::UnitY();  // where the foot is in the middle of its stand
    Vec3 knee_bs = Vec3::UnitY();   // direction to which the knee bends
    double upper_m = 0.5;           // hip to knee; > 0
    double lower_m = 0.5;           // knee to foot; > 0
    double phase = 0.0;             // share of a step by which the leg is ahead, [0, 1)
};

struct CrawlerGait {
    double step_s = 1.0;    // from one stand of a foot to its next; > 0
    double standing = 0.6;  // share of it that the foot stands; in (0, 1)
    double lift_m = 0.2;    // of the swinging foot, along the torso's +Y
};

// Where the foot of a leg is, whose torso follows `torso`. It stands at the place under the torso's
// pose in the middle of the stand; position, velocity and acceleration are continuous.
Vec3 crawler_foot(const PosePath& torso, const CrawlerGait& gait, const CrawlerLeg& leg,
                  double t_s);
TwoBones crawler_bones(const PosePath& torso, const CrawlerGait& gait, const CrawlerLeg& leg,
                       double t_s);

enum class LegBone : std::uint8_t { upper, lower };
// The bone's middle; its +Y points up the leg, its Z is the axis of the knee.
Pose crawler_bone_pose(const PosePath& torso, const CrawlerGait& gait, const CrawlerLeg& leg,
                       LegBone bone, double t_s);

}  // namespace handhold
