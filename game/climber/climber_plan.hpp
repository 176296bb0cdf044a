#pragma once

#include <optional>

#include "game/climber/climber.hpp"
#include "game/climber/climber_body.hpp"

// A climber's queries of the surroundings: free directions, holds, and surfaces to return to.
namespace handhold {

// Distance from `from_ws` to the first surface in a direction; nullopt if it is more than
// `length_m`. `player`: the climber, whose own head is ignored.
std::optional<double> free_distance_m(const ClimberSight& sight, hh::Player player,
                                      const hh::Vec3& from_ws, const hh::Vec3& direction_ws,
                                      double length_m);

// Chooses a random heading for a wandering climber: preferably forward, and free for some metres.
hh::Vec3 choose_heading(const ClimberSight& sight, hh::Player player, const hh::Vec3& from_ws,
                        ClimberState& state);

// A search for a hold.
struct HoldSearch {
    const ClimberTask& task;
    const ClimberMoment& now;
    hh::Side side = HH_LEFT;
    hh::Vec3 toward_ws = hh::k_z;  // unit; holds in this direction are preferred
    // Also considers free bodies that are too light to support the climber.
    bool loose_too = false;
};
struct FoundHold {
    ClimberHold hold;
    double reach_s = 0.0;  // duration of the reach
};
// Finds the best visible hold, on a rail or another surface, that will be within reach when the
// hand arrives. nullopt if there is none.
std::optional<FoundHold> find_hold(const ClimberSight& sight, const HoldSearch& ask,
                                   ClimberState& state);

// The hold on one visible body that will be within reach when the hand arrives. nullopt: none.
std::optional<FoundHold> find_hold_on(const ClimberSight& sight, const HoldSearch& ask,
                                      hh::Body body, const ClimberState& state);

// A place to return to if nothing is within reach: the nearest surface in a dozen random
// directions, else the nearest surface within 100 m. nullopt if there is none.
std::optional<ClimberHold> find_shore(const ClimberSight& sight, hh::Player player,
                                      const hh::Vec3& from_ws, Random& random);

}  // namespace handhold
