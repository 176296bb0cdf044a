#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "components/tracking.hpp"
#include "components/world.hpp"
#include "engine/collision/collision_world.hpp"
#include "game/scene/random.hpp"
#include "game/scene/scene.hpp"

// A scripted player: simulates a person in a headset who climbs. A climber perceives what such a
// person perceives: their head, their hands, and what they see. It outputs what a headset reports:
// poses of head and controllers, and buttons. Climbers reach for rails and surfaces with one hand
// while the other holds, pull, release, push off, catch holds, and turn round at dead ends.
namespace handhold {

// A point that the climber's head moves to, in the frame of `body`; in world space if `body` is
// null.
struct ClimberWaypoint {
    Entity body = k_no_entity;
    Vec3 point_bs = Vec3::Zero();
};

// One climber's player and settings. Constant while climbing.
struct ClimberTask {
    PlayerEntities player;
    // Visited in order; the climber stays at the last one. Empty: wanders.
    std::vector<ClimberWaypoint> waypoints;
    double sample_hz = 90.0;      // [10, 1000]; a hand that closes adds a sample of its own
    double cruise_mps = 0.6;      // [0.2, 1]
    bool may_leap = true;         // push off if nothing is in reach
    bool picks_up_bodies = true;  // picks up free bodies and throws them
    // Releases one hand before the other closes, so both never hold at once.
    bool single_hand = false;
};

enum class ClimberHandMode : std::uint8_t {
    rest,      // hand at its rest pose in front of the chest, or moving there
    reaching,  // moving to its hold
    closing,   // hand at its hold, button just pressed; the runtime has not gripped yet
    holding,   // holds a support: a body that the climber pulls on
    carrying,  // holds a free body, at the rest pose or moving there
};

// A place where a hand can grip.
struct ClimberHold {
    Entity body = k_no_entity;     // null: a point in world space with nothing to grip
    Pose wrist_bs;                 // pose of the wrist when the hand grips
    Vec3 away_bs = Vec3::UnitY();  // unit normal of the surface, outward
};

struct ClimberHand {
    ClimberHandMode mode = ClimberHandMode::rest;
    Pose wrist_ps;  // wrist without tremor
    Vec3 velocity_ps_mps = Vec3::Zero();
    ClimberHold hold;  // valid if reaching, closing or holding
    // Start and times of the current movement, or of the last one.
    Pose from_ps;
    Vec3 from_velocity_ps_mps = Vec3::Zero();
    double from_s = 0.0;
    double until_s = 0.0;   // end of the movement; closing: when the button was pressed
    double change_s = 0.0;  // holding: start of the hold; carrying: when to release
};

// A climber's complete state. Copies of this state and of the world continue identically.
struct ClimberState {
    Random random;
    std::uint64_t next_sample = 0;  // number of the next regular sample, at next_sample / sample_hz
    TrackingSample last;            // the newest sample; its time may be after the end of the frame
    bool first_given = false;       // whether climb() has returned the sample of the start pose
    double tremor_phase_rad = 0.0;

    // The climber's body at time last.t_s. The head's velocity is that of the play space.
    Vec3 eyes_ps = Vec3::Zero();
    Quat look_ps = Quat::Identity();
    double chest_yaw_rad = 0.0;
    std::array<ClimberHand, k_hand_count> hands;
    Vec3 velocity_ps_mps = Vec3::Zero();  // velocity of the head relative to the support
    Vec3 wanted_ps_mps = Vec3::Zero();    // target of velocity_ps_mps

    // What the climber plans to do, and what the plans follow from.
    Vec3 heading_ws = -Vec3::UnitZ();  // unit
    Vec3 gaze_ws = -Vec3::UnitZ();     // unit
    double heading_until_s = 0.0;
    double next_query_s = 0.0;
    double way_ahead_m = 0.0;  // free distance along the heading at the last query
    bool shore_ahead = false;  // whether a surface lies at the end of way_ahead_m
    std::uint32_t failed_queries = 0;
    std::uint32_t waypoint = 0;
    double waypoint_since_s = 0.0;
    double detour_until_s = 0.0;
    bool leaping = false;
    double leap_until_s = 0.0;
    double carried_s = 0.0;  // when the climber last had a support
    ClimberHold home;        // the last hold, or the place to return to
    Vec3 thrust_ps = Vec3::Zero();
};

// The scene as a climber can query it. Precondition: every collider of `collision` is at its
// current pose (place_scene).
struct ClimberSight {
    const Scene& scene;
    const CollisionWorld& collision;
};

// The initial state: the climber stands in the play space with both hands at rest. Equal seeds give
// equal states.
ClimberState begin_climber(const Scene& scene, const ClimberTask& task, std::uint64_t seed);

// Advances the climber by one frame; call it between two frames. Observes, decides, and moves head
// and hands to the first sample after `frame_end_s`. Replaces the contents of `samples` by the
// samples within the coming frame and the first one after it. The head stays below 3 m/s relative
// to the support, and the wrists within 0.75 m of the shoulders.
PlayerCommands climb(const ClimberSight& sight, const ClimberTask& task, double frame_end_s,
                     ClimberState& state, std::vector<TrackingSample>& samples);

// True once the climber has reached the last waypoint; never for a wandering climber.
bool is_at_target(const ClimberTask& task, const ClimberState& state);

}  // namespace handhold
