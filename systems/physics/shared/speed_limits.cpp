#include "systems/physics/shared/speed_limits.hpp"

#include <algorithm>

namespace handhold {

std::optional<ObjectSpeedLimit> object_speed_limit(const FrameGraph& frame, const Island& island,
                                                   const Column<ReferenceVelocity>& reference,
                                                   const Column<PlayerOrigin>& origin,
                                                   const LocomotionTuning& tuning) {
    const std::span<const std::uint32_t> blocks = frame.graph.blocks_of(island);
    const auto hand = std::ranges::find_if(
        blocks, [&](std::uint32_t i) { return is_drive(frame.graph.blocks[i]); });
    if (hand == blocks.end()) {
        return std::nullopt;
    }
    const Entity player = frame.entities[frame.graph.blocks[*hand].a];
    return ObjectSpeedLimit{reference.at(player).linear_mps,
                            origin.at(player).scale * tuning.object_speed_max_mps};
}

double driven_speed(const FrameGraph& frame, const Island& island, const Vec3& reference_mps) {
    double fastest = 0.0;
    for (const std::uint32_t i : frame.graph.blocks_of(island)) {
        const RowBlock& block = frame.graph.blocks[i];
        for (const std::uint32_t index : {block.a, block.b}) {
            const SolverBody& body = frame.graph.bodies[index];
            if (body.role == BodyRole::fixed || body.role == BodyRole::heavy) {
                const Vec3 arm =
                    transform_point(frame.graph.bodies[block.a].pose_ws, block.point_a_bs) -
                    body.pose_ws.position;
                const Vec3 at_row = body.velocity_mps + body.spin_radps.cross(arm);
                fastest = std::max(fastest, (at_row - reference_mps).norm());
            }
        }
    }
    return fastest;
}

}  // namespace handhold
