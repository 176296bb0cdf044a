#include "systems/body/publish_pose.hpp"

#include "components/play_space.hpp"
#include "components/scaled_tuning.hpp"
#include "engine/core/parallel.hpp"

namespace handhold {
namespace {

void publish_head(const PublishPoseIo& io, std::size_t index, const HeadTuning& tuning) {
    const Entity player = io.render.owners()[index];
    RenderPose& out = io.render.elements()[index];
    const auto& [origin_ws, scale] = io.origin.at(player);
    const HeadTracking& head = io.head.at(player);
    out.head_ws = origin_ws * head.pose_ps;
    out.head_center_ws = transform_point(origin_ws, head_center_ps(head, scale, tuning));
    out.push_back_m = 0.0;
}

void publish_hand(const PublishPoseIo& io, std::size_t index, TuningOfPlayers& tunings) {
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

}  // namespace

void publish_pose(const PublishPoseIo& io, const Tuning& tuning) {
    constexpr std::size_t k_elements_per_slice = 64;
    parallel_each(io.render.size(), k_elements_per_slice,
                  [&](std::size_t index) { publish_head(io, index, tuning.head); });
    for (const PushBack& push_back : io.push_backs) {
        if (RenderPose* const out = io.render.find(push_back.player)) {
            out->push_back_m = push_back.distance_m;
        }
    }
    const auto hands = [&](std::size_t /*slice*/, std::size_t first, std::size_t last) {
        TuningOfPlayers tunings(tuning);
        for (std::size_t index = first; index < last; ++index) {
            publish_hand(io, index, tunings);
        }
    };
    parallel_slices(io.owner.size(), k_elements_per_slice, hands);
}

}  // namespace handhold
