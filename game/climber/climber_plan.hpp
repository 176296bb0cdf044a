#pragma once

#include <optional>

#include "game/climber/climber.hpp"
#include "game/climber/climber_body.hpp"

// Where a climber looks, and what they choose of what they see.
namespace handhold {

// The free distance for the climber's head in a direction; empty if it is more than length_m.
std::optional<double> free_distance_m(const ClimberSight& sight, Entity player, const Vec3& from_ws,
                                      const Vec3& direction_ws, double length_m);

// A direction for a wandering climber: free for some metres, preferably forward.
Vec3 choose_heading(const ClimberSight& sight, Entity player, const Vec3& from_ws,
                    ClimberState& state);

// A search for a hold.
struct HoldSearch {
    const ClimberTask& task;
    const ClimberMoment& now;
    HandSide side = HandSide::left;
    Vec3 toward_ws = Vec3::UnitZ();  // unit; holds in this direction are preferred
    bool loose_too = false;          // also free bodies that support nothing
};
struct FoundHold {
    ClimberHold hold;
    double reach_s = 0.0;  // duration of the reach
};
// The best hold in reach by the time the hand arrives there: on a rail, or on any visible surface.
std::optional<FoundHold> find_hold(const ClimberSight& sight, const HoldSearch& ask,
                                   ClimberState& state);

// A place to drift to when nothing is in reach: the nearest surface in a dozen directions, else the
// nearest within a hundred metres. Empty in an empty world.
std::optional<ClimberHold> find_shore(const ClimberSight& sight, Entity player, const Vec3& from_ws,
                                      Random& random);

}  // namespace handhold
