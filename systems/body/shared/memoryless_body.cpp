#include "systems/body/shared/memoryless_body.hpp"

#include "systems/body/shared/estimate_body.hpp"
#include "systems/body/shared/pose_arm.hpp"
#include "systems/body/shared/pose_spine.hpp"
#include "systems/body/shared/rest_spine.hpp"

namespace handhold {

GrippableBody memoryless_body(const PlayerOrigin& origin, const TrackedBody& body,
                              const ArmTuning& tuning) {
    constexpr double k_any_dt_s = 1.0 / 90.0;  // irrelevant without a memory
    ArmTuning own = tuning;
    own.shoulder_follow_m *= origin.scale;
    ArmMemory arm_memory;
    ArmEstimate estimate;
    estimate_body(body, estimate_step(k_any_dt_s, origin.scale, own), true, arm_memory, estimate);

    GrippableBody out;
    const Pose& chest_ps = estimate.chest_ps;
    out.arms.chest_ws = origin.pose_ws * chest_ps;
    for (std::size_t side = 0; side < k_hand_count; ++side) {
        pose_arm(
            {.origin_ws = origin.pose_ws, .chest_ws = out.arms.chest_ws, .measures = body.measures},
            estimate.arms[side], origin.pose_ws * body.hands_ps[side], out.arms.arms[side]);
    }

    const double scale = body.measures.eye_height_m / k_scale_eye_m;
    SpineMemory spine_memory;
    rest_spine(chest_ps.rotation, estimate.lying, scale, 0.0, spine_memory);
    pose_spine(
        out.arms.chest_ws, spine_memory, chest_ps,
        {.chest_m = chest_ps.position.y() - body.floor_m, .scale = scale, .lying = estimate.lying},
        out.spine);
    return out;
}

}  // namespace handhold
