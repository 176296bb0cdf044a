#pragma once

#include "game/climber/climber.hpp"
#include "game/climber/climber_body.hpp"

// Where a climber goes: waypoints, detours, and distance from surfaces.
namespace handhold {

// The inputs and state of one frame's decision.
struct ClimberMind {
    const ClimberSight& sight;
    const ClimberTask& task;
    ClimberMoment now;
    ClimberState& state;

    const hh::World& world() const { return sight.world; }
    hh::Player player() const { return task.player; }
    ClimberHand& hand(hh::Side side) const { return state.hands[side]; }
    hh::Vec3 wrist_ws(hh::Side side) const {
        return hh::transform_point(now.origin_ws, hand(side).wrist_ps.position);
    }
    double stretch_m(hh::Side side) const {
        return hh::length(hand(side).wrist_ps.position - shoulder_ps(state, side));
    }
};

// Chooses a new heading for a wandering climber.
void head_anywhere(const ClimberMind& mind);

// Updates the heading. Returns the wanted velocity of the head in the world: along the heading,
// slower in front of a wall, and away from surfaces nearby.
hh::Vec3 steer(const ClimberMind& mind);

}  // namespace handhold
