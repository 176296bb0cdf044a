#include "systems/body/pose_arms.hpp"

#include "engine/core/parallel.hpp"
#include "systems/body/shared/pose_arm.hpp"

namespace handhold {

void pose_arms(const PoseArmsIo& io) {
    for (std::size_t index = 0; index < io.arms.size(); ++index) {
        const Entity player = io.arms.owners()[index];
        io.arms.elements()[index].chest_ws =
            io.origin.at(player).pose_ws * io.estimate.at(player).chest_ps;
    }
    constexpr std::size_t k_hands_per_slice = 64;
    parallel_each(io.owner.size(), k_hands_per_slice, [&io](std::size_t index) {
        const HandOwner& owner = io.owner.elements()[index];
        ArmPose& arms = io.arms.at(owner.player);
        const std::size_t side = index_of(owner.side);
        pose_arm({.origin_ws = io.origin.at(owner.player).pose_ws,
                  .chest_ws = arms.chest_ws,
                  .measures = io.measures.at(owner.player)},
                 io.estimate.at(owner.player).arms[side],
                 io.palm.at(io.owner.owners()[index]).pose_ws, arms.arms[side]);
    });
}

}  // namespace handhold
