#include "engine/anim/two_bone_ik.hpp"

namespace handhold {

Vec3 solve_two_bone_ik(const TwoBoneIk& ik) {
    const Vec3 reach = ik.tip - ik.root;
    const double distance = reach.norm();
    const MiddleJoint joint = middle_joint(distance, ik.upper_m, ik.lower_m);
    const double along = distance > 0.0 ? joint.along_m / distance : 0.0;
    return ik.root + along * reach + joint.aside_m * ik.bend;
}

}  // namespace handhold
