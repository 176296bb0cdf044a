#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "components/tracking.hpp"
#include "components/world.hpp"
#include "engine/collision/collision_world.hpp"
#include "game/scene/random.hpp"
#include "game/scene/scene.hpp"

// A scripted player: a person in a headset who climbs. He knows what such a person knows (his own
// head and hands, and what he sees when he looks about) and answers with what a headset says:
// samples of head and controllers, and buttons. He reaches for rails and surfaces with one hand
// while the other holds, pulls, lets go, pushes off, catches himself, and turns round at dead ends.
namespace handhold {

// Where the head is to go, in a body's frame, or the world's where there is no body.
struct ClimberWaypoint {
    Entity body = k_no_entity;
    Vec3 point_bs = Vec3::Zero();
};

// Who climbs, and what for. Does not change while he climbs.
struct ClimberTask {
    PlayerEntities player;
    std::vector<ClimberWaypoint> waypoints;  // in turn, then he stays; empty: he wanders
    double sample_hz = 90.0;                 // [10, 1000]; buttons have samples of their own
    double cruise_mps = 0.6;                 // [0.2, 1]
    bool may_leap = true;                    // push off where there is nothing to reach for
    bool picks_up_bodies = true;             // picks up what floats about, and throws it
    bool single_hand = false;  // lets go before the other hand closes: never two supports
};

enum class ClimberHandMode : std::uint8_t {
    rest,      // on its way to its place before the chest, or there
    reaching,  // on its way to its hold
    closing,   // at its hold, the button just pressed: whether it grips is not known yet
    holding,   // holds something that carries him
    carrying,  // holds something loose, on its way to rest or there
};

// Where a hand is to grip.
struct ClimberHold {
    Entity body = k_no_entity;     // null: a place in the world, where nothing is to grip
    Pose wrist_bs;                 // of the hand that grips there
    Vec3 away_bs = Vec3::UnitY();  // unit, out of the surface
};

struct ClimberHand {
    ClimberHandMode mode = ClimberHandMode::rest;
    Pose wrist_ps;  // without tremor
    Vec3 velocity_ps_mps = Vec3::Zero();
    ClimberHold hold;  // reaching, closing, holding
    // Of the movement under way, or the last one.
    Pose from_ps;
    Vec3 from_velocity_ps_mps = Vec3::Zero();
    double from_s = 0.0;
    double until_s = 0.0;   // closing: when the button was pressed
    double change_s = 0.0;  // holding: since; carrying: until
};

// All that he remembers: with the world it decides everything he does next. A copy of both carries
// on alike.
struct ClimberState {
    Random random;
    std::uint64_t next_sample = 0;  // the next regular one, at next_sample / sample_hz
    TrackingSample last;            // the newest sample made; it may lie after the frame's end
    bool first_given = false;       // the sample of where he began
    double tremor_phase_rad = 0.0;

    // The body, at last.t_s. A head's velocity is that of its play space.
    Vec3 eyes_ps = Vec3::Zero();
    Quat look_ps = Quat::Identity();
    double chest_yaw_rad = 0.0;
    std::array<ClimberHand, k_hand_count> hands;
    Vec3 velocity_ps_mps = Vec3::Zero();  // of the head against what carries him
    Vec3 wanted_ps_mps = Vec3::Zero();    // what that is on its way to

    // Plans.
    Vec3 heading_ws = -Vec3::UnitZ();  // unit
    Vec3 gaze_ws = -Vec3::UnitZ();     // unit
    double heading_until_s = 0.0;
    double next_query_s = 0.0;
    double way_ahead_m = 0.0;  // free along the heading, as last seen
    bool shore_ahead = false;  // something ends that way
    std::uint32_t failed_queries = 0;
    std::uint32_t waypoint = 0;
    double waypoint_since_s = 0.0;
    double detour_until_s = 0.0;
    bool leaping = false;
    double leap_until_s = 0.0;
    double carried_s = 0.0;  // when something last carried him
    ClimberHold home;        // what did, or what he drifts back to
    Vec3 thrust_ps = Vec3::Zero();
};

// What he can ask the world: `collision` must hold every collider where it is now (place_scene).
struct ClimberSight {
    const Scene& scene;
    const CollisionWorld& collision;
};

// A climber who stands in his play space and has not been tracked yet. Equal seeds, equal climbers.
ClimberState begin_climber(const Scene& scene, const ClimberTask& task, std::uint64_t seed);

// Between two frames: looks, decides, and moves on to just after the end of the coming frame.
// Replaces `samples` by what the frame needs: all in it and the first after it. Head below 3 m/s
// against what carries him, wrists within 0.75 m of the shoulders.
PlayerCommands climb(const ClimberSight& sight, const ClimberTask& task, double frame_end_s,
                     ClimberState& state, std::vector<TrackingSample>& samples);

// True once the last waypoint has been reached; never for one who wanders.
bool is_at_target(const ClimberTask& task, const ClimberState& state);

}  // namespace handhold
