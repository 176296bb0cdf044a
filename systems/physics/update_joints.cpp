#include "systems/physics/update_joints.hpp"

#include <cmath>

namespace handhold {
namespace {

bool handle_is_turned(const UpdateJointsIo& io, const JointLatch& latch) {
    const JointState* const handle = io.state.find(latch.handle);
    return handle != nullptr && std::abs(handle->coordinate) >= latch.handle_at;
}

// False if the latch opens: its lock impulse has reached the limit given by its strength, or its
// handle is turned.
bool stays_latched(const UpdateJointsIo& io, const JointLatch& latch, double lock_impulse) {
    constexpr double k_limit_ratio = 1.0 - 1e-9;
    const bool broken =
        latch.strength > 0.0 && lock_impulse >= k_limit_ratio * latch.strength * io.dt_s;
    return !broken && !handle_is_turned(io, latch);
}

// True if the latch closes. It catches only an approaching or resting coordinate, not one that was
// just pulled out.
bool catches(const UpdateJointsIo& io, const JointLatch& latch, const JointState& state) {
    constexpr double k_still = 1e-6;  // m or rad
    const double offset = state.coordinate - latch.at;
    const bool approaches = std::abs(offset) > k_still && offset * state.speed < 0.0;
    const bool rests = std::abs(state.speed) * io.dt_s < k_still;
    return std::abs(offset) <= latch.catch_range && (approaches || rests) &&
           !handle_is_turned(io, latch);
}

}  // namespace

void update_joints(const UpdateJointsIo& io) {
    const ConstraintGraph& graph = io.frame.graph;
    for (const RowBlock& block : graph.blocks) {
        if (is_joint(block)) {
            JointState& state = io.state.at(io.joint.owners()[block.source]);
            state.coordinate = joint_coordinate(graph.bodies, block);
            state.speed = joint_speed(graph.bodies, block);
        }
    }
    // Second pass: latches read the coordinates of other joints.
    for (const RowBlock& block : graph.blocks) {
        const JointLatch* const latch =
            is_joint(block) ? &io.joint.elements()[block.source].latch : nullptr;
        if (latch == nullptr || latch->catch_range <= 0.0) {
            continue;
        }
        JointState& state = io.state.at(io.joint.owners()[block.source]);
        state.latched = state.latched ? stays_latched(io, *latch, block.joint.lock_impulse)
                                      : catches(io, *latch, state);
    }
}

}  // namespace handhold
