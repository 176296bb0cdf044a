#include "game/climber/climber.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "game/climber/climber_body.hpp"
#include "game/climber/climber_plan.hpp"
#include "game/climber/climber_steer.hpp"
#include "game/climber/play_disc.hpp"
#include "game/scene/player_defaults.hpp"

namespace handhold {
using hh::conjugate;
using hh::dot;
using hh::length;
using hh::normalized;
using hh::transform_point;

namespace {

constexpr double k_query_interval_s = 0.1;
// A closed hand that holds nothing after this time has failed to grip.
constexpr double k_missed_after_s = 0.02;
// Grab error above which the hand releases, because something holds it back.
constexpr double k_grip_lost_m = 0.1;
// Both hands hold at least this long before one of them releases.
constexpr double k_both_hold_s = 0.15;
constexpr double k_leap_clearance_m = 1.2;  // minimum free distance ahead for a push-off
constexpr double k_leap_mps = 1.2;
constexpr double k_leap_longest_s = 0.8;
constexpr double k_leap_stretch_m = 0.62;
constexpr std::uint32_t k_failed_queries_before_leap = 3;
constexpr double k_adrift_s = 1.0;  // time without a hold before the climber may use jets
constexpr double k_return_mps = 1.2;

constexpr std::array<hh::Side, 2> k_sides = {HH_LEFT, HH_RIGHT};
hh::Side other(hh::Side side) { return side == HH_LEFT ? HH_RIGHT : HH_LEFT; }

std::size_t count_hands(const ClimberState& state, ClimberHandMode mode) {
    return static_cast<std::size_t>(
        std::ranges::count(state.hands, mode, [](const ClimberHand& hand) { return hand.mode; }));
}

// --- Results of grabs ---

// What a hand holds, as a climber feels it.
enum class Felt : std::uint8_t { nothing, support, free_body };
Felt feel(const ClimberMind& mind, const hh_hand_state& hand) {
    if (hand.grip == HH_GRIP_NONE || hand.body == hh::Body{}) {
        return Felt::nothing;  // the hand is empty or grips another player
    }
    const double mass_kg = mind.sight.world.mass_kg(hand.body).value_or(0.0);
    return mass_kg > 0.0 && mass_kg < mind.sight.heavy_body_kg ? Felt::free_body : Felt::support;
}

void feel_closing(const ClimberMind& mind, hh::Side side, const hh_hand_state& now) {
    ClimberHand& hand = mind.hand(side);
    const Felt felt = feel(mind, now);
    if (felt == Felt::support) {
        hand.mode = ClimberHandMode::holding;
        hand.change_s = mind.now.t_s;
        mind.state.home = hand.hold;
        // The hand may have gripped a body in front of the planned hold.
        mind.state.home.body = now.body;
        hand.hold.body = now.body;
        hand.hold.wrist_bs = now.anchor;
    } else if (felt == Felt::free_body) {
        hand.mode = ClimberHandMode::carrying;
        hand.change_s = mind.now.t_s + mind.state.random.between(0.4, 1.6);
        begin_rest(mind.state, side);
    } else if (mind.now.t_s >= hand.until_s + k_missed_after_s) {
        let_go(mind.state, side);
    }
}

void feel_hands(const ClimberMind& mind) {
    for (const hh::Side side : k_sides) {
        ClimberHand& hand = mind.hand(side);
        const hh_hand_state now = *mind.world().hand(mind.player(), side);
        if (hand.mode == ClimberHandMode::closing) {
            feel_closing(mind, side, now);
        } else if (hand.mode == ClimberHandMode::holding) {
            if (feel(mind, now) != Felt::support || now.error_m > k_grip_lost_m ||
                mind.stretch_m(side) > k_climber_arm_m + 0.01) {
                let_go(mind.state, side);
            }
        } else if (hand.mode == ClimberHandMode::carrying) {
            if (now.grip == HH_GRIP_NONE || mind.now.t_s >= hand.change_s) {
                let_go(mind.state, side);
            }
        } else if (hand.mode == ClimberHandMode::throwing) {
            if (now.grip == HH_GRIP_NONE || mind.state.last.time_s >= hand.until_s) {
                let_go(mind.state, side);
            }
        } else if (hand.mode == ClimberHandMode::reaching && !(hand.hold.body == hh::Body{}) &&
                   !mind.world().has(hand.hold.body)) {
            let_go(mind.state, side);
        }
    }
    if (count_hands(mind.state, ClimberHandMode::holding) > 0) {
        mind.state.carried_s = mind.now.t_s;
    }
}

// --- Hand over hand ---

bool try_reach(const ClimberMind& mind, hh::Side side, const hh::Vec3& toward_ws) {
    const bool loose_too =
        mind.task.picks_up_bodies && mind.now.carried && mind.state.random.chance(0.15);
    const auto found =
        find_hold(mind.sight, {mind.task, mind.now, side, toward_ws, loose_too}, mind.state);
    if (!found) {
        return false;
    }
    begin_reach(found->hold, found->reach_s, mind.state, side);
    const hh::Vec3 way = mind.wrist_ws(side) - mind.now.head_ws;
    mind.state.gaze_ws = normalized(mind.state.heading_ws + 0.5 * way);
    return true;
}

// Precondition: both hands hold. Releases the hand that is farther back along the heading.
void release_trailing(const ClimberMind& mind) {
    const auto ahead_m = [&mind](hh::Side side) {
        return dot(mind.wrist_ws(side) - mind.now.head_ws, mind.state.heading_ws);
    };
    const double since_s = std::max(mind.hand(HH_LEFT).change_s, mind.hand(HH_RIGHT).change_s);
    if (mind.now.t_s - since_s < k_both_hold_s) {
        return;
    }
    const double left_m = ahead_m(HH_LEFT);
    const double right_m = ahead_m(HH_RIGHT);
    let_go(mind.state, left_m < right_m ? HH_LEFT : HH_RIGHT);
}

// For ClimberTask::single_hand: releases the holding hand shortly before the other hand closes, so
// the climber floats for a moment.
void hand_over(const ClimberMind& mind) {
    constexpr double k_float_s = 0.06;
    for (const hh::Side side : k_sides) {
        const ClimberHand& next = mind.hand(other(side));
        if (mind.hand(side).mode == ClimberHandMode::holding &&
            (next.mode == ClimberHandMode::closing ||
             (next.mode == ClimberHandMode::reaching && next.until_s < mind.now.t_s + k_float_s))) {
            let_go(mind.state, side);
        }
    }
}

void begin_leap(const ClimberMind& mind) {
    mind.state.leaping = true;
    mind.state.leap_until_s = mind.now.t_s + k_leap_longest_s;
    mind.state.failed_queries = 0;
}

void go_on(const ClimberMind& mind, const hh::Vec3& wanted_mps) {
    ClimberState& state = mind.state;
    state.wanted_ps_mps = conjugate(mind.now.origin_ws.rotation) * wanted_mps;
    state.gaze_ws = state.heading_ws;
    if (is_at_target(mind.task, state) && length(wanted_mps) < 0.1) {
        return;
    }
    if (count_hands(state, ClimberHandMode::holding) == 2) {
        release_trailing(mind);
        return;
    }
    for (const hh::Side side : k_sides) {
        const ClimberHand& free_hand = mind.hand(side);
        const bool ready =
            free_hand.mode == ClimberHandMode::rest && state.last.time_s > free_hand.from_s + 0.1;
        if (!ready || mind.hand(other(side)).mode != ClimberHandMode::holding) {
            continue;
        }
        if (try_reach(mind, side, state.heading_ws)) {
            state.failed_queries = 0;
        } else if (++state.failed_queries >= k_failed_queries_before_leap) {
            if (mind.task.may_leap && state.shore_ahead && state.way_ahead_m > k_leap_clearance_m) {
                begin_leap(mind);
            } else if (mind.task.waypoints.empty()) {
                head_anywhere(mind);
            }
        }
    }
}

// Pushes off with the holding hand. Releases it once the climber is fast enough, the arm is nearly
// straight, or the push has lasted too long.
void leap(const ClimberMind& mind) {
    ClimberState& state = mind.state;
    const hh::Vec3 heading_ps = conjugate(mind.now.origin_ws.rotation) * state.heading_ws;
    state.wanted_ps_mps = k_leap_mps * heading_ps;
    bool off = mind.now.t_s >= state.leap_until_s ||
               dot(state.velocity_ps_mps, heading_ps) > 0.9 * k_leap_mps;
    for (const hh::Side side : k_sides) {
        off = off || (mind.hand(side).mode == ClimberHandMode::holding &&
                      mind.stretch_m(side) > k_leap_stretch_m);
    }
    if (!off) {
        return;
    }
    for (const hh::Side side : k_sides) {
        if (mind.hand(side).mode == ClimberHandMode::holding) {
            let_go(state, side);
        }
    }
    state.leaping = false;
}

// --- Without a hold ---

// Thrusts with the jets towards `home`. If the head is already near it, or now and then at random,
// first replaces `home` by a surface nearby.
void return_home(const ClimberMind& mind) {
    ClimberState& state = mind.state;
    const double jets_mps2 = mind.world().tuning("locomotion.thruster_mps2").value_or(0.0);
    hh::Vec3 home_ws =
        transform_point(body_at(mind.world(), state.home.body, mind.now, mind.now.t_s),
                        state.home.wrist_bs.position);
    constexpr double k_there_m = 0.5;
    if (length(home_ws - mind.now.head_ws) < k_there_m || state.random.chance(0.05)) {
        if (const auto shore =
                find_shore(mind.sight, mind.player(), mind.now.head_ws, state.random)) {
            state.home = *shore;
            home_ws =
                transform_point(body_at(mind.world(), state.home.body, mind.now, mind.now.t_s),
                                state.home.wrist_bs.position);
        }
    }
    const hh::Vec3 way = home_ws - mind.now.head_ws;
    const double distance_m = length(way);
    if (jets_mps2 <= 0.0 || distance_m < 1e-3) {
        return;
    }
    state.heading_ws = way / distance_m;
    const double speed_mps = std::clamp(0.5 * distance_m, 0.3, k_return_mps);
    const hh::Vec3 change_mps = speed_mps * state.heading_ws - mind.now.relative_mps;
    constexpr double k_ease_s = 0.3;
    hh::Vec3 thrust = change_mps / (jets_mps2 * k_ease_s);
    if (length(thrust) > 1.0) {
        thrust = normalized(thrust);
    }
    state.thrust_ps = conjugate(mind.now.origin_ws.rotation) * thrust;
}

void drift(const ClimberMind& mind) {
    ClimberState& state = mind.state;
    state.leaping = false;
    state.wanted_ps_mps = {};
    if (count_hands(state, ClimberHandMode::reaching) > 0 ||
        count_hands(state, ClimberHandMode::closing) > 0) {
        return;
    }
    const double speed_mps = length(mind.now.relative_mps);
    constexpr double k_drifts_mps = 0.15;
    const hh::Vec3 toward_ws =
        speed_mps > k_drifts_mps ? (mind.now.relative_mps / speed_mps) : state.heading_ws;
    state.gaze_ws = toward_ws;
    const hh::Side first = state.random.chance(0.5) ? HH_LEFT : HH_RIGHT;
    for (const hh::Side side : {first, other(first)}) {
        if (mind.hand(side).mode == ClimberHandMode::rest && try_reach(mind, side, toward_ws)) {
            return;
        }
    }
    if (mind.now.t_s - state.carried_s > k_adrift_s) {
        constexpr double k_far_m = 6.0;
        const bool path_is_blocked =
            speed_mps > k_drifts_mps &&
            free_distance_m(mind.sight, mind.player(), mind.now.head_ws, toward_ws, k_far_m);
        constexpr double k_patience_s = 4.0;
        if (!path_is_blocked || mind.now.t_s - state.carried_s > k_patience_s) {
            return_home(mind);
        }
    }
}

void decide(const ClimberMind& mind) {
    mind.state.thrust_ps = {};
    if (mind.sight.arena != nullptr && mind.task.team) {
        play_disc(mind);
    } else if (mind.now.carried) {
        const hh::Vec3 wanted_mps = steer(mind);
        if (!mind.state.leaping) {
            go_on(mind, wanted_mps);
        }
    } else {
        drift(mind);
    }
}

}  // namespace

ClimberSight sight_of(Scene& scene) {
    return {scene.host, scene.rails, *scene.host.tuning_vector("hand.palm_center_m"),
            *scene.host.tuning("phases.heavy_body_kg"), scene.arena ? &scene.arena->plan : nullptr};
}

ClimberState begin_climber(const hh::World& world, const ClimberTask& task, std::uint64_t seed) {
    if (!(task.sample_hz >= 10.0 && task.sample_hz <= 1000.0)) {
        throw std::invalid_argument("sample_hz must lie between 10 and 1000");
    }
    ClimberState state;
    state.random = Random::of(seed);
    const double now_s = world.time_s();
    state.next_sample = static_cast<std::uint64_t>(now_s * task.sample_hz) + 1;
    state.last.time_s = now_s;
    state.tremor_phase_rad = state.random.between(0.0, 6.0);
    const hh::Pose origin_ws = world.pose(task.player)->origin;
    state.heading_ws = origin_ws.rotation * -hh::k_z;
    state.gaze_ws = state.heading_ws;
    state.next_query_s = now_s + state.random.between(0.0, k_query_interval_s);
    state.carried_s = now_s;
    state.waypoint_since_s = now_s;
    place_body(state);
    state.last = sample_body(world, task, now_s, state);
    state.home.wrist_bs.position = transform_point(origin_ws, state.eyes_ps);
    return state;
}

hh_commands climb(const ClimberSight& sight, const ClimberTask& task, double frame_end_s,
                  ClimberState& state, std::vector<hh::Sample>& samples) {
    samples.clear();
    ClimberMind mind{sight, task, sense(sight.world, task, state), state};
    if (state.last.time_s > mind.now.t_s || !state.first_given) {
        samples.push_back(state.last);
        state.first_given = true;
    }
    feel_hands(mind);
    // Again: feel_hands() may have changed the hold that supports the climber.
    mind.now = sense(sight.world, task, state);
    if (mind.now.t_s >= state.next_query_s) {
        // The interval is random, so that the climbers of a crowd decide in different frames.
        state.next_query_s = mind.now.t_s + state.random.between(0.8, 1.2) * k_query_interval_s;
        decide(mind);
    }
    if (task.single_hand) {
        hand_over(mind);
    }
    if (state.leaping && mind.now.carried) {
        leap(mind);
    }
    while (state.last.time_s <= frame_end_s) {
        const double t_s = next_sample_time(task, state);
        move_body(sight.world, mind.now, t_s, state);
        state.last = sample_body(sight.world, task, t_s, state);
        samples.push_back(state.last);
    }
    hh_commands commands{};
    commands.thrust = state.thrust_ps;
    return commands;
}

bool is_at_target(const ClimberTask& task, const ClimberState& state) {
    return !task.waypoints.empty() && state.waypoint >= task.waypoints.size();
}

}  // namespace handhold
