#pragma once

#include "components/arm.hpp"
#include "components/body_part.hpp"
#include "components/render.hpp"
#include "engine/math/math.hpp"

// Arms, trunk and legs as capsules that hands can grip.
namespace handhold {

// The capsule's axis leads from the origin of `frame_ws` to `end_bs` in that frame.
struct PartCapsule {
    Pose frame_ws;
    Vec3 end_bs = Vec3::Zero();
    double radius_m = 0.0;
};
// Radii scale with the eye height.
PartCapsule part_capsule(const ArmPose& arms, const SpinePose& spine, const BodyMeasures& measures,
                         BodyPart part);
// Where hands can grip the part.
inline PartCapsule part_capsule(const GrippableBody& body, const BodyMeasures& measures,
                                BodyPart part) {
    return part_capsule(body.arms, body.spine, measures, part);
}
// Where the part was shown in the last frame.
inline PartCapsule part_capsule(const RenderPose& shown, const BodyMeasures& measures,
                                BodyPart part) {
    return part_capsule(shown.arms, shown.spine, measures, part);
}

}  // namespace handhold
