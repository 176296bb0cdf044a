#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include <handhold/handhold.hpp>
#include <handhold/math.hpp>

#include "game/arena/arena_game.hpp"
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
    hh::Body body = hh::Body{};
    hh::Vec3 point_bs = hh::Vec3{};
};

// One climber's player and settings. Constant while climbing.
struct ClimberTask {
    hh::Player player{};
    // Visited in order; the climber stays at the last one. Empty: wanders.
    std::vector<ClimberWaypoint> waypoints;
    // Rate of the regular samples, [10, 1000]. A hand that closes between two of them adds a
    // sample.
    double sample_hz = 90.0;
    double cruise_mps = 0.6;      // speed along the heading, [0.2, 1]
    bool may_leap = true;         // true: pushes off if no hold is in reach
    bool picks_up_bodies = true;  // picks up free bodies and throws them
    // Plays for this team where the scene has a game; nullopt: climbs.
    std::optional<ArenaTeam> team;
    // Releases one hand before the other closes, so both never hold at once.
    bool single_hand = false;
};

enum class ClimberHandMode : std::uint8_t {
    rest,      // hand at its rest pose in front of the chest, or moving there
    reaching,  // moving to its hold
    closing,   // hand at its hold, button just pressed; the runtime has not gripped yet
    holding,   // holds a support: a body that the climber pulls on
    carrying,  // holds a free body, at the rest pose or moving there
    throwing,  // draws back with a free body, swings, and lets go at the end
};

// A place where a hand can grip.
struct ClimberHold {
    hh::Body body = hh::Body{};        // null: a point in world space with nothing to grip
    hh::Pose wrist_bs = hh::k_origin;  // pose of the wrist when the hand grips
    hh::Vec3 away_bs = hh::k_y;        // unit normal of the surface, outward
};

struct ClimberHand {
    ClimberHandMode mode = ClimberHandMode::rest;
    hh::Pose wrist_ps = hh::k_origin;  // wrist without tremor
    hh::Vec3 velocity_ps_mps = hh::Vec3{};
    ClimberHold hold;  // valid if reaching, closing or holding
    // Start pose, start velocity and times of the current movement, or of the last one.
    hh::Pose from_ps = hh::k_origin;
    hh::Vec3 from_velocity_ps_mps = hh::Vec3{};
    double from_s = 0.0;
    double until_s = 0.0;            // end of the movement; closing: when the button was pressed
    hh::Vec3 swing_ps = hh::Vec3{};  // throwing: unit direction
    double change_s = 0.0;           // holding: start of the hold; carrying: when to release
};

// A climber's complete state. Copies of this state and of the world continue identically.
struct ClimberState {
    Random random;
    std::uint64_t next_sample = 0;  // index of the next regular sample; time: index / sample_hz
    hh::Sample last =
        hh::sample();          // the newest sample; its time may be after the end of the frame
    bool first_given = false;  // whether climb() has returned the sample of the start pose
    double tremor_phase_rad = 0.0;

    // The climber's body at time last.time_s. The head counts as fixed in play space, so it has the
    // velocity of the play space.
    hh::Vec3 eyes_ps = hh::Vec3{};
    hh::Quat look_ps = hh::k_no_turn;
    double chest_yaw_rad = 0.0;
    std::array<ClimberHand, 2> hands;
    hh::Vec3 velocity_ps_mps = hh::Vec3{};  // velocity of the head relative to the support
    hh::Vec3 wanted_ps_mps = hh::Vec3{};    // target of velocity_ps_mps

    // The climber's plan, and the observations that it is based on.
    hh::Vec3 heading_ws = -hh::k_z;  // unit
    hh::Vec3 gaze_ws = -hh::k_z;     // unit
    double heading_until_s = 0.0;
    double next_query_s = 0.0;
    double way_ahead_m = 0.0;  // free distance along the heading at the last query
    bool shore_ahead = false;  // whether a surface lies at the end of way_ahead_m
    std::uint32_t failed_queries = 0;
    std::uint32_t waypoint = 0;
    double waypoint_since_s = 0.0;
    double detour_until_s = 0.0;
    double yields_until_s = 0.0;  // arena: leaves the disc to others
    bool leaping = false;
    double leap_until_s = 0.0;
    double carried_s = 0.0;  // when the climber last had a support
    ClimberHold home;        // the last hold, or the place to return to
    hh::Vec3 thrust_ps = hh::Vec3{};
};

// The world as a climber queries it, and constants that a climber's decisions need.
struct ClimberSight {
    hh::World& world;
    std::span<const SceneRail> rails;
    hh::Vec3 palm_center_m{};          // centre of the right palm, in the frame of the wrist
    double heavy_body_kg = 0.0;        // lighter dynamic bodies cannot carry a climber
    const ArenaPlan* arena = nullptr;  // the scene's game; null: none
};
ClimberSight sight_of(Scene& scene);

// The initial state: the climber stands in the play space with both hands at rest. Equal seeds give
// equal states.
ClimberState begin_climber(const hh::World& world, const ClimberTask& task, std::uint64_t seed);

// Advances the climber by one frame; call it between two frames. Observes, decides, and moves head
// and hands to the first sample after `frame_end_s`. Replaces the contents of `samples` by the
// samples within the coming frame and the first one after it. The head stays below 3 m/s relative
// to the support, and the wrists within 0.75 m of the shoulders.
hh_commands climb(const ClimberSight& sight, const ClimberTask& task, double frame_end_s,
                  ClimberState& state, std::vector<hh::Sample>& samples);

// True once the climber has reached the last waypoint; never for a wandering climber.
bool is_at_target(const ClimberTask& task, const ClimberState& state);

}  // namespace handhold
