// A reach is a minimum-jerk movement (Flash and Hogan 1985): at time u in [0, 1] it has covered the
// fraction 10 u^3 - 15 u^4 + 6 u^5 of its path.
#include "game/climber/climber_body.hpp"

#include <algorithm>
#include <cmath>

#include "game/scene/player_defaults.hpp"

namespace handhold {
using hh::conjugate;
using hh::cross;
using hh::dot;
using hh::interpolate;
using hh::inverse;
using hh::length;
using hh::normalized;
using hh::rotation_about;
using hh::rotation_from_vector;
using hh::transform_point;

namespace {

constexpr double k_acceleration_mps2 = 2.5;
constexpr double k_braking_mps2 = 5.0;  // deceleration, also when catching a hold
constexpr double k_hurry_per_s = 8.0;   // rate at which the velocity approaches the wanted velocity
// A pulling arm extends at most at this rate times the length left until it is straight.
constexpr double k_stretch_rate_per_s = 4.0;
constexpr double k_turn_radps = 1.2;  // maximum turn rate of the chest
// Distance of a reaching hand from the straight path at half time, along the hold's normal.
constexpr double k_climber_lift_m = 0.06;
constexpr double k_rest_s = 0.5;
constexpr double k_throw_s = 0.6;  // drawing back and swinging
constexpr double k_swing_m = 0.55;
constexpr double k_tremor_m = 0.0005;  // amplitude of the hands' tremor

double outward(hh::Side side) { return side == HH_RIGHT ? 1.0 : -1.0; }

hh::Quat chest(const ClimberState& state) { return rotation_about(hh::k_y, state.chest_yaw_rad); }

// Position of the eyes in play space. A standing person sways slightly.
hh::Vec3 eyes_at(double t_s, double phase_rad) {
    return {0.02 * hh::sine(0.4 * t_s + phase_rad), k_eye_height_m + 0.01 * hh::sine(0.5 * t_s),
            0.02 * hh::sine(0.3 * t_s + 2.0 * phase_rad)};
}

// Rest pose of a wrist: beside and in front of the chest, palm down, fingers forward.
hh::Pose rest_ps(const ClimberState& state, hh::Side side) {
    const hh::Quat ahead = chest(state);
    return {state.eyes_ps + ahead * hh::Vec3{0.22 * outward(side), -0.42, -0.30}, ahead};
}

double minimum_jerk(double u) { return u * u * u * (10.0 + u * (-15.0 + 6.0 * u)); }

// The wrist's pose at `t_s` during a movement. It starts with the hand's start pose and velocity,
// and ends at `to_ps`, which may move meanwhile. `bow_ps`: offset from the direct path at half
// time.
hh::Pose on_the_way(const ClimberHand& hand, const hh::Pose& to_ps, const hh::Vec3& bow_ps,
                    double t_s) {
    const double seconds = std::max(hand.until_s - hand.from_s, 1e-3);
    const double u = std::clamp((t_s - hand.from_s) / seconds, 0.0, 1.0);
    hh::Pose pose = interpolate(hand.from_ps, to_ps, minimum_jerk(u));
    const double left = 1.0 - u;
    pose.position += (seconds * u * left * left * left) * hand.from_velocity_ps_mps;
    pose.position += (16.0 * u * u * left * left) * bow_ps;
    return pose;
}

// The wrist in a throw: draws back beside the shoulder, then swings at constant acceleration.
hh::Pose swing(const ClimberState& state, hh::Side side, double t_s) {
    const ClimberHand& hand = state.hands[side];
    constexpr double k_drawn_share = 0.65;
    const double u =
        std::clamp((t_s - hand.from_s) / std::max(hand.until_s - hand.from_s, 1e-3), 0.0, 1.0);
    const hh::Vec3 drawn = shoulder_ps(state, side) +
                           chest(state) * hh::Vec3{0.12 * outward(side), -0.12, 0.0} +
                           0.05 * hand.swing_ps;
    if (u < k_drawn_share) {
        hh::Pose pose = hand.from_ps;
        const double part = minimum_jerk(u / k_drawn_share);
        pose.position += part * (drawn - pose.position);
        return pose;
    }
    const double part = (u - k_drawn_share) / (1.0 - k_drawn_share);
    return {drawn + (k_swing_m * part * part) * hand.swing_ps, hand.from_ps.rotation};
}

void keep_in_reach(const hh::Vec3& shoulder, hh::Vec3& wrist) {
    const hh::Vec3 arm = wrist - shoulder;
    const double arm_m = length(arm);
    if (arm_m > k_climber_arm_m) {
        wrist = shoulder + arm * (k_climber_arm_m / arm_m);
    }
}

void begin_move(ClimberState& state, ClimberHand& hand, double seconds) {
    hand.from_ps = hand.wrist_ps;
    hand.from_velocity_ps_mps = hand.velocity_ps_mps;
    hand.from_s = state.last.time_s;
    hand.until_s = state.last.time_s + seconds;
}

bool pulls(const ClimberHand& hand) {
    return hand.mode == ClimberHandMode::holding || hand.mode == ClimberHandMode::closing;
}

// Moves the head's velocity towards the wanted velocity with limited acceleration. Limits it so
// that no pulling arm becomes straight.
void pull_body(double dt_s, ClimberState& state) {
    hh::Vec3 change = (k_hurry_per_s * dt_s) * (state.wanted_ps_mps - state.velocity_ps_mps);
    const bool brakes = length(state.wanted_ps_mps) < length(state.velocity_ps_mps);
    const double limit = (brakes ? k_braking_mps2 : k_acceleration_mps2) * dt_s;
    if (length(change) > limit) {
        change *= limit / length(change);
    }
    state.velocity_ps_mps += change;
    for (const hh::Side side : {HH_LEFT, HH_RIGHT}) {
        const ClimberHand& hand = state.hands[side];
        const hh::Vec3 arm = hand.wrist_ps.position - shoulder_ps(state, side);
        const double arm_m = length(arm);
        if (!pulls(hand) || arm_m < 1e-3) {
            continue;
        }
        const hh::Vec3 along = arm / arm_m;
        const double growth_mps = -dot(state.velocity_ps_mps, along);
        const double most_mps = k_stretch_rate_per_s * std::max(0.0, k_climber_arm_m - arm_m);
        if (growth_mps > most_mps) {
            state.velocity_ps_mps += (growth_mps - most_mps) * along;
        }
    }
}

// Turns the chest towards the heading, unless a pulling arm is nearly straight. Turns the head
// towards the gaze.
void turn_body(double dt_s, const hh::Quat& play_space, ClimberState& state) {
    const hh::Vec3 ahead = conjugate(play_space) * state.heading_ws;
    constexpr double k_steep = 0.4;
    const bool stretched =
        std::ranges::any_of(std::array{HH_LEFT, HH_RIGHT}, [&state](hh::Side side) {
            const ClimberHand& hand = state.hands[side];
            return pulls(hand) && length(hand.wrist_ps.position - shoulder_ps(state, side)) > 0.6;
        });
    if (!stretched && length(hh::Vec3{ahead.x, 0.0, ahead.z}) > k_steep) {
        const hh::Vec3 in_chest = conjugate(chest(state)) * ahead;
        const double off_rad = hh_atan2(-in_chest.x, -in_chest.z);
        state.chest_yaw_rad += std::clamp(off_rad, -k_turn_radps * dt_s, k_turn_radps * dt_s);
    }
    // The gaze's pitch is limited to 50 degrees, as a neck's is.
    hh::Vec3 gaze = conjugate(chest(state)) * (conjugate(play_space) * state.gaze_ws);
    gaze.z = std::min(gaze.z, -0.3);
    gaze.y = std::clamp(gaze.y, 1.2 * gaze.z, -1.2 * gaze.z);
    const hh::Quat wanted = chest(state) * hh::look_rotation(gaze, hh::k_y);
    const hh::Pose look =
        interpolate({hh::Vec3{}, state.look_ps}, {hh::Vec3{}, wanted}, std::min(1.0, 5.0 * dt_s));
    state.look_ps = look.rotation;
}

// A hold in play space: the wrist of a hand that grips it, and the surface's outward normal.
struct HoldPlace {
    hh::Pose wrist_ps = hh::k_origin;
    hh::Vec3 away_ps{};
};
HoldPlace place_of(const hh::World& world, const ClimberHold& hold, const ClimberMoment& now,
                   double t_s, const ClimberState& state) {
    const hh::Pose body_ws = body_at(world, hold.body, now, t_s);
    const hh::Vec3 own_mps =
        now.carried ? (now.support_mps + now.origin_ws.rotation * state.velocity_ps_mps)
                    : now.origin_mps;
    hh::Pose origin_ws = now.origin_ws;
    origin_ws.position += (t_s - now.t_s) * own_mps;
    const hh::Vec3 away_ws = body_ws.rotation * hold.away_bs;
    return {inverse(origin_ws) * (body_ws * hold.wrist_bs),
            conjugate(origin_ws.rotation) * away_ws};
}

// Sets the velocity of a drifting climber who catches a hold: that of the play space relative to
// the hold.
void catch_body(const hh::World& world, const ClimberMoment& now, const ClimberHold& hold,
                ClimberState& state) {
    const hh::Vec3 point_ws =
        transform_point(body_at(world, hold.body, now, now.t_s), hold.wrist_bs.position);
    state.velocity_ps_mps = conjugate(now.origin_ws.rotation) *
                            (now.origin_mps - velocity_at(world, hold.body, point_ws));
}

void move_hand(const hh::World& world, const ClimberMoment& now, double t_s, double dt_s,
               ClimberState& state, hh::Side side) {
    ClimberHand& hand = state.hands[side];
    const hh::Vec3 before = hand.wrist_ps.position;
    switch (hand.mode) {
        case ClimberHandMode::rest:
        case ClimberHandMode::carrying:
            hand.wrist_ps = on_the_way(hand, rest_ps(state, side), hh::Vec3{}, t_s);
            keep_in_reach(shoulder_ps(state, side), hand.wrist_ps.position);
            break;
        case ClimberHandMode::reaching: {
            const HoldPlace place = place_of(world, hand.hold, now, t_s, state);
            hand.wrist_ps = on_the_way(hand, place.wrist_ps, k_climber_lift_m * place.away_ps, t_s);
            keep_in_reach(shoulder_ps(state, side), hand.wrist_ps.position);
            if (t_s >= hand.until_s - 1e-9) {
                hand.mode = ClimberHandMode::closing;
                hand.until_s = t_s;
                if (!now.carried) {
                    catch_body(world, now, hand.hold, state);
                }
            }
            break;
        }
        case ClimberHandMode::throwing:
            hand.wrist_ps = swing(state, side, t_s);
            break;
        case ClimberHandMode::closing:
        case ClimberHandMode::holding:
            hand.wrist_ps.position -= dt_s * state.velocity_ps_mps;
            break;
    }
    hand.velocity_ps_mps = (hand.wrist_ps.position - before) / dt_s;
}

}  // namespace

hh::Vec3 shoulder_ps(const ClimberState& state, hh::Side side) {
    return state.eyes_ps + chest(state) * hh::Vec3{0.17 * outward(side), -0.22, 0.06};
}

double reach_time_s(double distance_m) { return std::clamp(0.25 + 0.7 * distance_m, 0.3, 0.8); }

hh::Vec3 velocity_at(const hh::World& world, hh::Body body, const hh::Vec3& point_ws) {
    if (!world.has(body)) {
        return {};
    }
    const hh::World::Motion motion = *world.motion(body);
    const hh::Vec3 arm = point_ws - world.pose(body)->position;
    return motion.velocity_mps + cross(motion.angular_velocity_radps, arm);
}

hh::Pose body_at(const hh::World& world, hh::Body body, const ClimberMoment& now, double t_s) {
    if (!world.has(body)) {
        return hh::k_origin;
    }
    const hh::Pose pose = *world.pose(body);
    const hh::World::Motion motion = *world.motion(body);
    const double dt_s = t_s - now.t_s;
    return {pose.position + dt_s * motion.velocity_mps,
            normalized(rotation_from_vector(dt_s * motion.angular_velocity_radps) * pose.rotation)};
}

ClimberMoment sense(const hh::World& world, const ClimberTask& task, const ClimberState& state) {
    const hh_player_pose player = *world.pose(task.player);
    ClimberMoment now;
    now.t_s = world.time_s();
    now.origin_ws = player.origin;
    now.origin_mps = player.velocity_mps;
    std::uint8_t is_tracked = 0;
    hh_player_head(world.get(), task.player, &now.head_ws, nullptr, &is_tracked);
    if (is_tracked == 0) {
        now.head_ws = transform_point(now.origin_ws, state.eyes_ps);
    }
    const ClimberHold* support = &state.home;
    for (const ClimberHand& hand : state.hands) {
        if (hand.mode == ClimberHandMode::holding) {
            support = &hand.hold;
            now.carried = true;
        }
    }
    const hh::Vec3 point_ws =
        transform_point(body_at(world, support->body, now, now.t_s), support->wrist_bs.position);
    now.support_mps = support->body == hh::Body{} ? world.reference_velocity_mps()
                                                  : velocity_at(world, support->body, point_ws);
    now.relative_mps = now.origin_mps - now.support_mps;
    return now;
}

void place_body(ClimberState& state) {
    state.eyes_ps = eyes_at(state.last.time_s, state.tremor_phase_rad);
    for (const hh::Side side : {HH_LEFT, HH_RIGHT}) {
        ClimberHand& hand = state.hands[side];
        hand.wrist_ps = rest_ps(state, side);
        hand.from_ps = hand.wrist_ps;
        hand.from_s = hand.until_s = state.last.time_s;
    }
}

void begin_reach(const ClimberHold& hold, double seconds, ClimberState& state, hh::Side side) {
    ClimberHand& hand = state.hands[side];
    begin_move(state, hand, seconds);
    hand.mode = ClimberHandMode::reaching;
    hand.hold = hold;
}

void begin_rest(ClimberState& state, hh::Side side) {
    begin_move(state, state.hands[side], k_rest_s);
}

void begin_throw(const hh::Vec3& along_ps, ClimberState& state, hh::Side side) {
    begin_move(state, state.hands[side], k_throw_s);
    state.hands[side].mode = ClimberHandMode::throwing;
    state.hands[side].swing_ps = along_ps;
}

void let_go(ClimberState& state, hh::Side side) {
    begin_rest(state, side);
    state.hands[side].mode = ClimberHandMode::rest;
}

double next_sample_time(const ClimberTask& task, ClimberState& state) {
    const double regular_s = static_cast<double>(state.next_sample) / task.sample_hz;
    double t_s = regular_s;
    // A hand that closes this near to a regular sample adds no sample.
    constexpr double k_apart_s = 1e-4;
    for (const ClimberHand& hand : state.hands) {
        if (hand.mode == ClimberHandMode::reaching &&
            hand.until_s > state.last.time_s + k_apart_s && hand.until_s < t_s - k_apart_s) {
            t_s = hand.until_s;
        }
    }
    state.next_sample += t_s == regular_s ? 1U : 0U;
    return t_s;
}

void move_body(const hh::World& world, const ClimberMoment& now, double t_s, ClimberState& state) {
    const double dt_s = t_s - state.last.time_s;
    state.eyes_ps = eyes_at(t_s, state.tremor_phase_rad);
    turn_body(dt_s, now.origin_ws.rotation, state);
    if (std::any_of(state.hands.begin(), state.hands.end(), pulls)) {
        pull_body(dt_s, state);
    } else {
        state.velocity_ps_mps = conjugate(now.origin_ws.rotation) * now.relative_mps;
    }
    for (const hh::Side side : {HH_LEFT, HH_RIGHT}) {
        move_hand(world, now, t_s, dt_s, state, side);
    }
}

hh::Sample sample_body(const hh::World& world, const ClimberTask& task, double t_s,
                       const ClimberState& state) {
    constexpr double k_tremor_radps = 56.0;  // 9 Hz
    hh::Sample sample = hh::sample();
    sample.time_s = t_s;
    sample.head = {state.eyes_ps, state.look_ps};
    for (const hh::Side side : {HH_LEFT, HH_RIGHT}) {
        const ClimberHand& hand = state.hands[side];
        const double phase = state.tremor_phase_rad + outward(side) + k_tremor_radps * t_s;
        hh::Pose wrist_ps = hand.wrist_ps;
        wrist_ps.position += k_tremor_m * hh::Vec3{hh::sine(phase), hh::sine(1.13 * phase + 1.0),
                                                   hh::sine(0.91 * phase + 2.0)};
        sample.hands[side] = wrist_ps * inverse(*world.hand_in_controller(task.player, side));
        sample.grab[side] =
            hand.mode != ClimberHandMode::rest && hand.mode != ClimberHandMode::reaching;
    }
    return sample;
}

}  // namespace handhold
