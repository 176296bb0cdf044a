#pragma once

#include "components/spine.hpp"
#include "engine/math/math.hpp"
#include "systems/body/shared/hang_body.hpp"

namespace handhold {

// The rest pose of the trunk below a chest, pulled by BodyPull::now. `lying`: ArmEstimate::lying.
TrunkLean lean_at(const Quat& chest_ps, const Vec3& pull_ps, double lying);

// Starts the chain at rest below a chest, without velocities, contacts and pull. Leaves the fields
// that propagate_spine writes at the end of each frame.
void rest_spine(const Quat& chest, double lying, double scale, double t_s, SpineMemory& memory);

}  // namespace handhold
