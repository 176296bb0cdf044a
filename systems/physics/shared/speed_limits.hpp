// What limits the speeds of the bodies in an island that hands drive.

#pragma once

#include <optional>

#include "components/frame_graph.hpp"
#include "components/player.hpp"
#include "components/tuning.hpp"
#include "engine/ecs/column.hpp"

namespace handhold {

// World axes, m/s. `max_mps`: LocomotionTuning::object_speed_max_mps times the player's scale.
struct ObjectSpeedLimit {
    Vec3 reference_mps = Vec3::Zero();
    double max_mps = 0.0;
};

// The limit for the objects of an island, from the player of its first hand; nothing if it has no
// hand. Reads ReferenceVelocity and PlayerOrigin::scale of that player.
std::optional<ObjectSpeedLimit> object_speed_limit(const FrameGraph& frame, const Island& island,
                                                   const Column<ReferenceVelocity>& reference,
                                                   const Column<PlayerOrigin>& origin,
                                                   const LocomotionTuning& tuning);

// Highest speed, relative to the reference, of the island's kinematic and heavy bodies at their
// constraints, m/s. A body that is not faster than this may have got its velocity from one of them.
double driven_speed(const FrameGraph& frame, const Island& island, const Vec3& reference_mps);

}  // namespace handhold
