#pragma once

#include <optional>

#include "game/climber/climber.hpp"
#include "game/climber/climber_body.hpp"

// Where a climber looks, and what he chooses of what he sees.
namespace handhold {

// How far the way is free for him; nothing where it is for more than length_m.
std::optional<double> free_distance_m(const ClimberSight& sight, Entity player, const Vec3& from_ws,
                                      const Vec3& direction_ws, double length_m);

// A direction for someone who wanders: free for some metres, rather ahead than back.
Vec3 choose_heading(const ClimberSight& sight, Entity player, const Vec3& from_ws,
                    ClimberState& state);

// Who looks for something to hold.
struct HoldSearch {
    const ClimberTask& task;
    const ClimberMoment& now;
    HandSide side = HandSide::left;
    Vec3 toward_ws = Vec3::UnitZ();  // unit: holds in this direction are the better ones
    bool loose_too = false;          // also what would not carry him
};
struct FoundHold {
    ClimberHold hold;
    double reach_s = 0.0;  // how long the hand will take
};
// The best place that the hand can reach by the time it gets there: on a rail, or on any surface
// that the eyes see.
std::optional<FoundHold> find_hold(const ClimberSight& sight, const HoldSearch& ask,
                                   ClimberState& state);

// The nearest surface of a dozen directions, else the nearest of all within a hundred metres:
// where to drift when nothing is in reach. Nothing in an empty world.
std::optional<ClimberHold> find_shore(const ClimberSight& sight, Entity player, const Vec3& from_ws,
                                      Random& random);

}  // namespace handhold
