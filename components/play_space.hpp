#pragma once

#include "components/body.hpp"
#include "components/body_part.hpp"
#include "components/player.hpp"
#include "components/tracking.hpp"
#include "components/tuning.hpp"
#include "engine/ecs/column.hpp"
#include "engine/math/math.hpp"

// Geometry of head and hands that several stages use.
namespace handhold {

// The palm ray of a hand: it starts behind the palm and passes through it along the palm's outward
// normal, the hand's -Y.
struct PalmRay {
    Vec3 from_ws;
    Vec3 to_ws;
    Vec3 palm_ws;  // HandTuning::palm_center_m, on the skin
};
inline PalmRay palm_ray(const Pose& hand_ws, HandSide side, const HandTuning& tuning) {
    Vec3 palm = tuning.palm_center_m;
    palm.x() *= side == HandSide::right ? 1.0 : -1.0;
    const Vec3 outward_ws = hand_ws.rotation * -Vec3::UnitY();
    const Vec3 palm_ws = transform_point(hand_ws, palm);
    const Vec3 from_ws = palm_ws - tuning.ray_back_m * outward_ws;
    return {from_ws, from_ws + tuning.ray_length_m * outward_ws, palm_ws};
}

// Returns the pose of the body, head or other part of a player that a hand grips. `hold`: the
// hand's BodyHold; null if the hand has none.
inline Pose gripped_pose_ws(const Column<BodyPose>& body_pose, const Column<PlayerOrigin>& origin,
                            const Column<HeadTracking>& head, Entity gripped,
                            const BodyHold* hold) {
    if (const BodyPose* const body = body_pose.find(gripped)) {
        return body->pose_ws;
    }
    return origin.at(gripped).pose_ws *
           (hold != nullptr ? hold->pose_ps : head.at(gripped).pose_ps);
}

// Centre of the head's collider. `tuning`: scaled like the player.
inline Vec3 head_center_ps(const HeadTracking& head, const HeadTuning& tuning) {
    return transform_point(head.pose_ps, tuning.center_m);
}
// The same with the tuning of a scale of 1, for a player of that scale (PlayerOrigin::scale).
inline Vec3 head_center_ps(const HeadTracking& head, double scale, const HeadTuning& tuning) {
    return transform_point(head.pose_ps, scale * tuning.center_m);
}

}  // namespace handhold
