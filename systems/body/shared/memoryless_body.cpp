#include "systems/body/shared/memoryless_body.hpp"

#include "systems/body/shared/estimate_body.hpp"
#include "systems/body/shared/level_direction.hpp"
#include "systems/body/shared/lie_down.hpp"
#include "systems/body/shared/pose_arm.hpp"
#include "systems/body/shared/pose_spine.hpp"
#include "systems/body/shared/rest_hand.hpp"
#include "systems/body/shared/rest_spine.hpp"

namespace handhold {

namespace {

void place_hands_at_rest(const std::array<ArmGoal, k_hand_count>& goals, TrackedBody& body) {
    const BodyAxes axes = axes_of(body);
    const Pose view_ps =
        view_frame(body.head_ps.position, level_look(-axes.head.col(2), axes.head.col(1)));
    const double lying = trunk_view(body, axes).lying;
    for (const HandSide side : {HandSide::left, HandSide::right}) {
        if (goals[index_of(side)] == ArmGoal::rest) {
            body.hands_ps[index_of(side)] = rest_hand(side, view_ps, lying, body);
        }
    }
}

}  // namespace

GrippableBody memoryless_body(const PlayerOrigin& origin, TrackedBody body,
                              const std::array<ArmGoal, k_hand_count>& goals,
                              const ArmTuning& tuning) {
    constexpr double k_any_dt_s = 1.0 / 90.0;  // irrelevant without a memory
    place_hands_at_rest(goals, body);
    ArmMemory arm_memory;
    ArmEstimate estimate;
    for (std::size_t side = 0; side < k_hand_count; ++side) {
        estimate.arms[side].goal = goals[side];
    }
    estimate_body(body, estimate_step(k_any_dt_s, origin.scale, tuning), true, arm_memory,
                  estimate);

    GrippableBody out;
    const Pose& chest_ps = estimate.chest_ps;
    out.arms.chest_ws = origin.pose_ws * chest_ps;
    for (std::size_t side = 0; side < k_hand_count; ++side) {
        pose_arm(
            {.origin_ws = origin.pose_ws, .chest_ws = out.arms.chest_ws, .measures = body.measures},
            estimate.arms[side], origin.pose_ws * estimate.arms[side].hand_ps, out.arms.arms[side]);
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
