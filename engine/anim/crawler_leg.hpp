#pragma once

#include "engine/anim/pose_path.hpp"
#include "engine/math/math.hpp"

// Crawling two-bone legs as pure functions of time. A foot stands on its foothold while the torso
// passes over it, then swings to the next one. The knee follows from the law of cosines.
namespace handhold {

// Joint positions of a two-bone limb.
struct TwoBones {
    Vec3 root = Vec3::Zero();
    Vec3 middle = Vec3::Zero();
    Vec3 end = Vec3::Zero();  // target, or the nearest reachable point to it
};
// Places two bones of given lengths from `root` towards `target`, with the middle joint towards
// `pole` (not parallel to root - target). If the target is out of reach, the end is on the line to
// it, 1e-3 of the total length short of fully straight or folded.
TwoBones place_two_bones(const Vec3& root, const Vec3& target, double upper_m, double lower_m,
                         const Vec3& pole);

// One leg, in the torso's frame.
struct CrawlerLeg {
    Vec3 hip_bs = Vec3::Zero();
    Vec3 foot_bs = -Vec3::UnitY();  // foot position in the middle of its stance
    Vec3 knee_bs = Vec3::UnitY();   // direction in which the knee bends
    double upper_m = 0.5;           // hip to knee; > 0
    double lower_m = 0.5;           // knee to foot; > 0
    double phase = 0.0;             // phase offset in steps, [0, 1)
};

struct CrawlerGait {
    double step_s = 1.0;    // duration of one step cycle; > 0
    double standing = 0.6;  // stance fraction of the cycle; in (0, 1)
    double lift_m = 0.2;    // height of the swing along the torso's +Y
};

// Foot position of a leg whose torso follows `torso`. During stance the foot stays where foot_bs is
// in the torso's pose at mid-stance. Position, velocity and acceleration are continuous.
Vec3 crawler_foot(const PosePath& torso, const CrawlerGait& gait, const CrawlerLeg& leg,
                  double t_s);
TwoBones crawler_bones(const PosePath& torso, const CrawlerGait& gait, const CrawlerLeg& leg,
                       double t_s);

enum class LegBone : std::uint8_t { upper, lower };
// Pose of the bone's centre: +Y points up the leg, Z is the knee's axis.
Pose crawler_bone_pose(const PosePath& torso, const CrawlerGait& gait, const CrawlerLeg& leg,
                       LegBone bone, double t_s);

}  // namespace handhold
