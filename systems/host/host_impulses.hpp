// Impulses of hands and contacts as a host is told of them.

#pragma once

#include <cstddef>

#include "systems/host/host_world.hpp"

namespace handhold {

// Finds how much of the impulse of each constraint block of the last step to report. Call once
// after a step, before reported_impulse_ns.
//
// A hand that moves a light body does so as if its player could not be moved. In the frame in which
// that body meets a wall, hand and wall then press against each other without a bound, which moves
// nothing. What they can exchange is the momentum of the bodies and players of that island: with
// the velocities before the velocity solve, and the hands' speed on top. This is the limit for all
// hands of the island together, and for all its contacts; other islands have none.
void limit_impulses(hh_world& host);

// The impulse on the block's first body, world axes.
Vec3 reported_impulse_ns(const hh_world& host, std::size_t block);

}  // namespace handhold
