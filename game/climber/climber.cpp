#include "game/climber/climber.hpp"

#include <algorithm>
#include <cmath>

#include "engine/core/check.hpp"
#include "game/climber/climber_body.hpp"
#include "game/climber/climber_plan.hpp"
#include "game/climber/climber_steer.hpp"
#include "game/scene/player_defaults.hpp"

namespace handhold {
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

constexpr std::array<HandSide, k_hand_count> k_sides = {HandSide::left, HandSide::right};
HandSide other(HandSide side) { return side == HandSide::left ? HandSide::right : HandSide::left; }

std::size_t count_hands(const ClimberState& state, ClimberHandMode mode) {
    return static_cast<std::size_t>(
        std::ranges::count(state.hands, mode, [](const ClimberHand& hand) { return hand.mode; }));
}

// --- Results of grabs ---

void feel_closing(const ClimberMind& mind, HandSide side, const Grab& grab) {
    ClimberHand& hand = mind.hand(side);
    if (grab.kind == GripKind::surface) {
        hand.mode = ClimberHandMode::holding;
        hand.change_s = mind.now.t_s;
        mind.state.home = hand.hold;
        // The hand may have gripped a body in front of the planned hold.
        mind.state.home.body = grab.body;
        hand.hold.body = grab.body;
        hand.hold.wrist_bs = grab.anchor_bs;
    } else if (grab.kind == GripKind::held) {
        hand.mode = ClimberHandMode::carrying;
        hand.change_s = mind.now.t_s + mind.state.random.between(0.4, 1.6);
        begin_rest(mind.state, side);
    } else if (mind.now.t_s >= hand.until_s + k_missed_after_s) {
        let_go(mind.state, side);
    }
}

void feel_hands(const ClimberMind& mind) {
    for (const HandSide side : k_sides) {
        ClimberHand& hand = mind.hand(side);
        const Grab& grab = mind.world().grab.at(mind.task.player.hands[index_of(side)]);
        if (hand.mode == ClimberHandMode::closing) {
            feel_closing(mind, side, grab);
        } else if (hand.mode == ClimberHandMode::holding) {
            if (grab.kind != GripKind::surface || grab.error_m > k_grip_lost_m ||
                mind.stretch_m(side) > k_climber_arm_m + 0.01) {
                let_go(mind.state, side);
            }
        } else if (hand.mode == ClimberHandMode::carrying) {
            if (grab.kind == GripKind::none || mind.now.t_s >= hand.change_s) {
                let_go(mind.state, side);
            }
        } else if (hand.mode == ClimberHandMode::reaching && !is_null(hand.hold.body) &&
                   !mind.world().body.contains(hand.hold.body)) {
            let_go(mind.state, side);
        }
    }
    if (count_hands(mind.state, ClimberHandMode::holding) > 0) {
        mind.state.carried_s = mind.now.t_s;
    }
}

// --- Hand over hand ---

bool try_reach(const ClimberMind& mind, HandSide side, const Vec3& toward_ws) {
    const bool loose_too =
        mind.task.picks_up_bodies && mind.now.carried && mind.state.random.chance(0.15);
    const auto found =
        find_hold(mind.sight, {mind.task, mind.now, side, toward_ws, loose_too}, mind.state);
    if (!found) {
        return false;
    }
    begin_reach(found->hold, found->reach_s, mind.state, side);
    const Vec3 way = mind.wrist_ws(side) - mind.now.head_ws;
    mind.state.gaze_ws = (mind.state.heading_ws + 0.5 * way).normalized();
    return true;
}

// Precondition: both hands hold. Releases the hand that is farther back along the heading.
void release_trailing(const ClimberMind& mind) {
    const auto ahead_m = [&mind](HandSide side) {
        return (mind.wrist_ws(side) - mind.now.head_ws).dot(mind.state.heading_ws);
    };
    const double since_s =
        std::max(mind.hand(HandSide::left).change_s, mind.hand(HandSide::right).change_s);
    if (mind.now.t_s - since_s < k_both_hold_s) {
        return;
    }
    const double left_m = ahead_m(HandSide::left);
    const double right_m = ahead_m(HandSide::right);
    let_go(mind.state, left_m < right_m ? HandSide::left : HandSide::right);
}

// For ClimberTask::single_hand: releases the holding hand shortly before the other hand closes, so
// the climber floats for a moment.
void hand_over(const ClimberMind& mind) {
    constexpr double k_float_s = 0.06;
    for (const HandSide side : k_sides) {
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

void go_on(const ClimberMind& mind, const Vec3& wanted_mps) {
    ClimberState& state = mind.state;
    state.wanted_ps_mps = mind.now.origin_ws.rotation.conjugate() * wanted_mps;
    state.gaze_ws = state.heading_ws;
    if (is_at_target(mind.task, state) && wanted_mps.norm() < 0.1) {
        return;
    }
    if (count_hands(state, ClimberHandMode::holding) == k_hand_count) {
        release_trailing(mind);
        return;
    }
    for (const HandSide side : k_sides) {
        const ClimberHand& free_hand = mind.hand(side);
        const bool ready =
            free_hand.mode == ClimberHandMode::rest && state.last.t_s > free_hand.from_s + 0.1;
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
    const Vec3 heading_ps = mind.now.origin_ws.rotation.conjugate() * state.heading_ws;
    state.wanted_ps_mps = k_leap_mps * heading_ps;
    bool off = mind.now.t_s >= state.leap_until_s ||
               state.velocity_ps_mps.dot(heading_ps) > 0.9 * k_leap_mps;
    for (const HandSide side : k_sides) {
        off = off || (mind.hand(side).mode == ClimberHandMode::holding &&
                      mind.stretch_m(side) > k_leap_stretch_m);
    }
    if (!off) {
        return;
    }
    for (const HandSide side : k_sides) {
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
    const double jets_mps2 = mind.sight.scene.tuning.locomotion.thruster_mps2;
    Vec3 home_ws = transform_point(body_at(mind.world(), state.home.body, mind.now, mind.now.t_s),
                                   state.home.wrist_bs.position);
    constexpr double k_there_m = 0.5;
    if ((home_ws - mind.now.head_ws).norm() < k_there_m || state.random.chance(0.05)) {
        if (const auto shore =
                find_shore(mind.sight, mind.player(), mind.now.head_ws, state.random)) {
            state.home = *shore;
            home_ws =
                transform_point(body_at(mind.world(), state.home.body, mind.now, mind.now.t_s),
                                state.home.wrist_bs.position);
        }
    }
    const Vec3 way = home_ws - mind.now.head_ws;
    const double distance_m = way.norm();
    if (jets_mps2 <= 0.0 || distance_m < 1e-3) {
        return;
    }
    state.heading_ws = way / distance_m;
    const double speed_mps = std::clamp(0.5 * distance_m, 0.3, k_return_mps);
    const Vec3 change_mps = speed_mps * state.heading_ws - mind.now.relative_mps;
    constexpr double k_ease_s = 0.3;
    Vec3 thrust = change_mps / (jets_mps2 * k_ease_s);
    if (thrust.norm() > 1.0) {
        thrust.normalize();
    }
    state.thrust_ps = mind.now.origin_ws.rotation.conjugate() * thrust;
}

void drift(const ClimberMind& mind) {
    ClimberState& state = mind.state;
    state.leaping = false;
    state.wanted_ps_mps.setZero();
    if (count_hands(state, ClimberHandMode::reaching) > 0 ||
        count_hands(state, ClimberHandMode::closing) > 0) {
        return;
    }
    const double speed_mps = mind.now.relative_mps.norm();
    constexpr double k_drifts_mps = 0.15;
    const Vec3 toward_ws =
        speed_mps > k_drifts_mps ? Vec3(mind.now.relative_mps / speed_mps) : state.heading_ws;
    state.gaze_ws = toward_ws;
    const HandSide first = state.random.chance(0.5) ? HandSide::left : HandSide::right;
    for (const HandSide side : {first, other(first)}) {
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
    mind.state.thrust_ps.setZero();
    if (mind.now.carried) {
        const Vec3 wanted_mps = steer(mind);
        if (!mind.state.leaping) {
            go_on(mind, wanted_mps);
        }
    } else {
        drift(mind);
    }
}

}  // namespace

ClimberState begin_climber(const Scene& scene, const ClimberTask& task, std::uint64_t seed) {
    HH_CHECK(task.sample_hz >= 10.0 && task.sample_hz <= 1000.0,
             "sample_hz must lie between 10 and 1000", task.sample_hz);
    ClimberState state;
    state.random = Random(mix64(seed));
    const double now_s = scene.world.clock.t_s;
    state.next_sample = static_cast<std::uint64_t>(now_s * task.sample_hz) + 1;
    state.last.t_s = now_s;
    state.tremor_phase_rad = state.random.between(0.0, 6.0);
    const Pose& origin_ws = scene.world.player_origin.at(task.player.player).pose_ws;
    state.heading_ws = origin_ws.rotation * -Vec3::UnitZ();
    state.gaze_ws = state.heading_ws;
    state.next_query_s = now_s + state.random.between(0.0, k_query_interval_s);
    state.carried_s = now_s;
    state.waypoint_since_s = now_s;
    place_body(state);
    state.last = sample_body(scene, task, now_s, state);
    state.home.wrist_bs.position = transform_point(origin_ws, state.eyes_ps);
    return state;
}

PlayerCommands climb(const ClimberSight& sight, const ClimberTask& task, double frame_end_s,
                     ClimberState& state, std::vector<TrackingSample>& samples) {
    samples.clear();
    ClimberMind mind{sight, task, sense(sight.scene, task, state), state};
    if (state.last.t_s > mind.now.t_s || !state.first_given) {
        samples.push_back(state.last);
        state.first_given = true;
    }
    feel_hands(mind);
    // Again: feel_hands() may have changed the hold that supports the climber.
    mind.now = sense(sight.scene, task, state);
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
    while (state.last.t_s <= frame_end_s) {
        const double t_s = next_sample_time(task, state);
        move_body(sight.scene, mind.now, t_s, state);
        state.last = sample_body(sight.scene, task, t_s, state);
        samples.push_back(state.last);
    }
    PlayerCommands commands;
    commands.thrust_ps = state.thrust_ps;
    return commands;
}

bool is_at_target(const ClimberTask& task, const ClimberState& state) {
    return !task.waypoints.empty() && state.waypoint >= task.waypoints.size();
}

}  // namespace handhold
