#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "components/tracking.hpp"
#include "components/world.hpp"
#include "engine/collision/collision_world.hpp"
#include "game/scene/random.hpp"
#include "game/scene/scene.hpp"

// A scripted player: a person in a headset who climbs. The climber knows what such a person knows
// (their head and hands, and what the eyes see) and acts as a headset would report it: samples of
// head and controllers, and buttons. They reach for rails and surfaces with one hand while the
// other holds, pull, release, push off, catch on, and turn round at dead ends.
namespace handhold {

// A target of the head, in a body's frame, or in the world's without a body.
struct ClimberWaypoint {
    Entity body = k_no_entity;
    Vec3 point_bs = Vec3::Zero();
};

// Who climbs, and how. Constant while climbing.
struct ClimberTask {
    PlayerEntities player;
    std::vector<ClimberWaypoint>
        waypoints;                // visited in order, then the climber stays; empty: wanders
    double sample_hz = 90.0;      // [10, 1000]; button edges have samples of their own
    double cruise_mps = 0.6;      // [0.2, 1]
    bool may_leap = true;         // push off if nothing is in reach
    bool picks_up_bodies = true;  // picks up free bodies and throws them
    bool single_hand = false;     // releases before the other hand closes: never two supports
};

enum class ClimberHandMode : std::uint8_t {
    rest,      // at, or on the way to, its rest pose before the chest
    reaching,  // on the way to its hold
    closing,   // at its hold, button just pressed; not known yet whether it grips
    holding,   // holds a support
    carrying,  // holds a free body, at or on the way to rest
};

// A place to grip.
struct ClimberHold {
    Entity body = k_no_entity;     // null: a place in the world, where nothing is to grip
    Pose wrist_bs;                 // of the gripping hand
    Vec3 away_bs = Vec3::UnitY();  // unit, out of the surface
};

struct ClimberHand {
    ClimberHandMode mode = ClimberHandMode::rest;
    Pose wrist_ps;  // without tremor
    Vec3 velocity_ps_mps = Vec3::Zero();
    ClimberHold hold;  // reaching, closing, holding
    // Of the present movement, or of the last one.
    Pose from_ps;
    Vec3 from_velocity_ps_mps = Vec3::Zero();
    double from_s = 0.0;
    double until_s = 0.0;   // closing: when the button was pressed
    double change_s = 0.0;  // holding: since; carrying: until
};

// All that a climber remembers. With the world it decides everything the climber does: copies of
// both continue equally.
struct ClimberState {
    Random random;
    std::uint64_t next_sample = 0;  // number of the next regular sample, at next_sample / sample_hz
    TrackingSample last;            // the newest sample; it may lie after the frame's end
    bool first_given = false;       // the sample of the starting pose was given
    double tremor_phase_rad = 0.0;

    // The climber's body at last.t_s. A head's velocity is that of its play space.
    Vec3 eyes_ps = Vec3::Zero();
    Quat look_ps = Quat::Identity();
    double chest_yaw_rad = 0.0;
    std::array<ClimberHand, k_hand_count> hands;
    Vec3 velocity_ps_mps = Vec3::Zero();  // of the head relative to the support
    Vec3 wanted_ps_mps = Vec3::Zero();    // target of velocity_ps_mps

    // Plans.
    Vec3 heading_ws = -Vec3::UnitZ();  // unit
    Vec3 gaze_ws = -Vec3::UnitZ();     // unit
    double heading_until_s = 0.0;
    double next_query_s = 0.0;
    double way_ahead_m = 0.0;  // free distance along the heading, as last seen
    bool shore_ahead = false;  // something ends that free distance
    std::uint32_t failed_queries = 0;
    std::uint32_t waypoint = 0;
    double waypoint_since_s = 0.0;
    double detour_until_s = 0.0;
    bool leaping = false;
    double leap_until_s = 0.0;
    double carried_s = 0.0;  // when the climber last had a support
    ClimberHold home;        // the last hold, or the place to drift to
    Vec3 thrust_ps = Vec3::Zero();
};

// What a climber can query. `collision` must have every collider at its present pose (place_scene).
struct ClimberSight {
    const Scene& scene;
    const CollisionWorld& collision;
};

// A climber who stands in the play space and has not been tracked yet. Equal seeds give equal
// climbers.
ClimberState begin_climber(const Scene& scene, const ClimberTask& task, std::uint64_t seed);

// Call between two frames. Observes, decides, and moves to just after the end of the coming frame.
// Replaces `samples` by those that the frame needs: all within it and the first after it. The head
// stays below 3 m/s relative to the support, and wrists within 0.75 m of the shoulders.
PlayerCommands climb(const ClimberSight& sight, const ClimberTask& task, double frame_end_s,
                     ClimberState& state, std::vector<TrackingSample>& samples);

// True once the last waypoint was reached; never for a wandering climber.
bool is_at_target(const ClimberTask& task, const ClimberState& state);

}  // namespace handhold
