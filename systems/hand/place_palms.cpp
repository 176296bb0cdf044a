#include "systems/hand/place_palms.hpp"

#include "components/play_space.hpp"

namespace handhold {

void place_palms(const PlacePalmsIo& io) {
    for (std::size_t row = 0; row < io.owner.size(); ++row) {
        const Entity entity = io.owner.owners()[row];
        const Grab& grab = io.grab.at(entity);
        Pose& palm_ws = io.palm.at(entity).pose_ws;
        const bool is_there = io.body_pose.contains(grab.body) || io.origin.contains(grab.body);
        if (grab.kind != GripKind::none && is_there) {
            palm_ws = gripped_pose_ws(io.body_pose, io.origin, io.head, grab.body) * grab.anchor_bs;
        } else {
            palm_ws =
                io.origin.at(io.owner.rows()[row].player).pose_ws * io.hand.at(entity).pose_ps;
        }
    }
}

}  // namespace handhold
