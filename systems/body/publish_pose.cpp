#include "systems/body/publish_pose.hpp"

#include "components/play_space.hpp"

namespace handhold {
namespace {

// Fingers of any rig until they are fitted to what they hold: at rest, or as a fist closes around a
// bar of 35 mm. The thumb stands first in its hand.
constexpr std::array<double, k_most_links> k_rest_rad = {0.35, 0.52, 0.26};
constexpr std::array<double, k_most_links> k_fist_rad = {0.95, 1.05, 0.70};
constexpr FingerAngles k_thumb_at_rest = {{0.17, 0.21, 0.17}, 0.0};
constexpr FingerAngles k_thumb_in_fist = {{0.10, 0.35, 0.55}, 0.55};

void pose_fingers(GripKind grip, std::array<FingerAngles, k_finger_count>& fingers) {
    const bool is_open = grip == GripKind::none;
    fingers.fill({is_open ? k_rest_rad : k_fist_rad, 0.0});
    fingers[0] = is_open ? k_thumb_at_rest : k_thumb_in_fist;
}

}  // namespace

void publish_pose(const PublishPoseIo& io, const Tuning& tuning) {
    for (std::size_t row = 0; row < io.render.size(); ++row) {
        const Entity player = io.render.owners()[row];
        RenderPose& out = io.render.rows()[row];
        const Pose& origin_ws = io.origin.at(player).pose_ws;
        const HeadTracking& head = io.head.at(player);
        out.head_ws = origin_ws * head.pose_ps;
        out.head_center_ws = transform_point(origin_ws, head_center_ps(head, tuning.head));
        const std::size_t body = find_body(io.frame.graph, io.persistent_id.at(player).value);
        out.push_back_m = body < io.frame.phase.size() ? io.frame.phase[body].push_back_m : 0.0;
    }
    for (std::size_t row = 0; row < io.owner.size(); ++row) {
        const Entity entity = io.owner.owners()[row];
        const HandOwner& owner = io.owner.rows()[row];
        const Grab& grab = io.grab.at(entity);
        RenderPose::Hand& out = io.render.at(owner.player).hands[index_of(owner.side)];
        out.tracked_ws = io.origin.at(owner.player).pose_ws * io.hand.at(entity).pose_ps;
        out.shown_ws = out.tracked_ws;
        out.grip = grab.kind;
        const bool is_there = io.body_pose.contains(grab.body) || io.origin.contains(grab.body);
        if (grab.kind != GripKind::none && is_there) {
            out.shown_ws =
                gripped_pose_ws(io.body_pose, io.origin, io.head, grab.body) * grab.anchor_bs;
        }
        pose_fingers(out.grip, out.fingers);
        const PalmRay ray = palm_ray(out.tracked_ws, owner.side, tuning.hand);
        out.ray_from_ws = ray.from_ws;
        out.ray_to_ws = ray.to_ws;
    }
}

}  // namespace handhold
