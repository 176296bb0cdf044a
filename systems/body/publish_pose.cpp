#include "systems/body/publish_pose.hpp"

#include <algorithm>

#include "components/play_space.hpp"
#include "components/scaled_tuning.hpp"

namespace handhold {

void publish_pose(const PublishPoseIo& io, const Tuning& tuning) {
    for (std::size_t index = 0; index < io.render.size(); ++index) {
        const Entity player = io.render.owners()[index];
        RenderPose& out = io.render.elements()[index];
        const auto& [origin_ws, scale] = io.origin.at(player);
        const HeadTracking& head = io.head.at(player);
        out.head_ws = origin_ws * head.pose_ps;
        out.head_center_ws = transform_point(origin_ws, head_center_ps(head, scale, tuning.head));
        const auto push_back = std::ranges::find(io.push_backs, player, &PushBack::player);
        out.push_back_m = push_back != io.push_backs.end() ? push_back->distance_m : 0.0;
    }
    TuningOfPlayers tunings(tuning);
    for (std::size_t index = 0; index < io.owner.size(); ++index) {
        const Entity entity = io.owner.owners()[index];
        const HandOwner& owner = io.owner.elements()[index];
        const Grab& grab = io.grab.at(entity);
        RenderPose::Hand& out = io.render.at(owner.player).hands[index_of(owner.side)];
        out.tracked_ws = io.origin.at(owner.player).pose_ws * io.hand.at(entity).pose_ps;
        out.shown_ws = io.palm.at(entity).pose_ws;
        const AuthoredHold* const hold = io.authored_hold.find(entity);
        const bool is_authored =
            grab.kind != GripKind::none && hold != nullptr && hold->body == grab.body;
        out.grip = is_authored ? GripKind::authored : grab.kind;
        out.fingers = io.fingers.at(entity).shown;
        const PalmRay ray =
            palm_ray(out.tracked_ws, owner.side, tunings.of(io.origin.at(owner.player)).hand);
        out.ray_from_ws = ray.from_ws;
        out.ray_to_ws = ray.to_ws;
    }
}

}  // namespace handhold
