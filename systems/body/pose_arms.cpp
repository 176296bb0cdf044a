#include "systems/body/pose_arms.hpp"

#include "systems/body/shared/pose_arm.hpp"

namespace handhold {

void pose_arms(const PoseArmsIo& io) {
    for (std::size_t index = 0; index < io.owner.size(); ++index) {
        const HandOwner& owner = io.owner.elements()[index];
        const ArmEstimate& estimate = io.estimate.at(owner.player);
        const Pose& origin_ws = io.origin.at(owner.player).pose_ws;
        ArmPose& pose = io.arms.at(owner.player);
        pose.chest_ws = origin_ws * estimate.chest_ps;
        const std::size_t side = index_of(owner.side);
        pose_arm({.origin_ws = origin_ws,
                  .chest_ws = pose.chest_ws,
                  .measures = io.measures.at(owner.player)},
                 estimate.arms[side], io.palm.at(io.owner.owners()[index]).pose_ws,
                 pose.arms[side]);
    }
}

}  // namespace handhold
