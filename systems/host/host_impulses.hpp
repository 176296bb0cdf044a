// The impulses of hands and contacts that a host reads.

#pragma once

#include <cstddef>

#include "systems/host/host_world.hpp"

namespace handhold {

// Finds how much of the impulse of each constraint block of the last step to report. Call once
// after a step, before reported_impulse_ns.
//
// A hand that moves a light body does so as if its player could not be moved. In the frame in which
// that body meets a wall, the impulses of hand and wall on it are therefore opposite and
// arbitrarily large. The reported impulses are limited to the momentum that the bodies and players
// of the island can exchange, at their velocities before the velocity solve plus the hands' speed.
// The limit applies to the sum over all hands of the island, and to the sum over its contacts.
// Impulses in other islands are reported as they are.
void limit_impulses(hh_world& host);

// The reported impulse on the first body of the constraint block with this index, in the world's
// axes.
Vec3 reported_impulse_ns(const hh_world& host, std::size_t block);

}  // namespace handhold
