#include "game/climber/play_disc.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "game/climber/climber_plan.hpp"

namespace handhold {
using hh::conjugate;
using hh::dot;
using hh::length;
using hh::normalized;

namespace {

constexpr double k_flight_mps = 3.5;
constexpr double k_near_disc_m =
    1.3;  // distance within which a climber matches the disc's velocity
constexpr double k_throw_from_m = 6.5;  // distance of the goal at which a climber throws
constexpr double k_longest_carry_s = 8.0;
// Of two who pull at the disc for long, one yields, by chance, and stays away for a while.
constexpr double k_longest_pull_s = 1.5;
constexpr double k_yield_s = 2.0;
constexpr double k_disc_throw_mps = 4.5;  // speed of a swing at release
constexpr double k_aim_error = 0.06;      // largest error of a throw, as the tangent
constexpr std::array<hh::Side, 2> k_both_sides = {HH_LEFT, HH_RIGHT};

struct DiscPlay {
    const ClimberMind& mind;
    ArenaTeam team;
    hh::Vec3 disc_ws{};
    hh::Vec3 disc_mps{};
    hh::Vec3 target_ws{};  // centre of the other team's goal
    hh::Vec3 guarded_ws{};
};

std::optional<hh::Side> hand_with_disc(const DiscPlay& play) {
    for (const hh::Side side : k_both_sides) {
        const hh_hand_state now = *play.mind.world().hand(play.mind.player(), side);
        if (play.mind.hand(side).mode == ClimberHandMode::carrying &&
            now.body == play.mind.sight.arena->disc) {
            return side;
        }
    }
    return std::nullopt;
}

hh::Vec3 head_of(const hh::World& world, hh::Player player) {
    hh::Vec3 head_ws{};
    std::uint8_t is_tracked = 0;
    hh_player_head(world.get(), player, &head_ws, nullptr, &is_tracked);
    return is_tracked != 0 ? head_ws : world.pose(player)->origin.position;
}

// Of the team's players, the rank of this one by distance from a point; 0: the nearest.
std::size_t rank_in_team(const DiscPlay& play, const hh::Vec3& point_ws) {
    const hh::World& world = play.mind.world();
    const double own_m = length(play.mind.now.head_ws - point_ws);
    std::size_t rank = 0;
    std::size_t index = 0;
    for (const hh::Player player : world.players()) {
        if (team_of(index++) == play.team && !(player == play.mind.player()) &&
            length(head_of(world, player) - point_ws) < own_m) {
            ++rank;
        }
    }
    return rank;
}

// True if a player of the other team holds the disc.
bool is_contested(const DiscPlay& play) {
    const hh::World& world = play.mind.world();
    std::size_t index = 0;
    for (const hh::Player player : world.players()) {
        if (team_of(index++) == play.team) {
            continue;
        }
        for (const hh::Side side : k_both_sides) {
            const auto hand = world.hand(player, side);
            if (hand && hand->body == play.mind.sight.arena->disc) {
                return true;
            }
        }
    }
    return false;
}

// Thrusts towards a velocity, round what is in the way.
void fly(const DiscPlay& play, const hh::Vec3& wanted_mps) {
    const ClimberMind& mind = play.mind;
    const double jets_mps2 = mind.world().tuning("locomotion.thruster_mps2").value_or(0.0);
    if (jets_mps2 <= 0.0) {
        return;
    }
    hh::Vec3 velocity_mps = wanted_mps;
    const double speed_mps = length(wanted_mps);
    constexpr double k_ahead_m = 2.2;
    if (speed_mps > 0.3) {
        const hh::Vec3 way = wanted_mps / speed_mps;
        const auto hit = mind.sight.world.cast_ray(
            mind.now.head_ws + 0.25 * way, mind.now.head_ws + k_ahead_m * way, mind.player());
        if (hit && !(hit->body == mind.sight.arena->disc)) {
            const hh::Vec3 side = hh::cross(way, hh::Vec3{0.31, 0.87, 0.38});
            const hh::Vec3 round = way + 1.2 * hit->normal + 0.8 * normalized(side);
            velocity_mps = 0.6 * speed_mps * normalized(round);
        }
    }
    constexpr double k_ease_s = 0.25;
    hh::Vec3 thrust = (velocity_mps - mind.now.origin_mps) / (jets_mps2 * k_ease_s);
    if (length(thrust) > 1.0) {
        thrust = normalized(thrust);
    }
    mind.state.thrust_ps = conjugate(mind.now.origin_ws.rotation) * thrust;
}

void fly_to(const DiscPlay& play, const hh::Vec3& place_ws, const hh::Vec3& place_mps = {}) {
    const hh::Vec3 way = place_ws - play.mind.now.head_ws;
    const double distance_m = length(way);
    const double speed_mps = std::min(1.1 * distance_m, k_flight_mps);
    fly(play, place_mps + (distance_m > 1e-3 ? (speed_mps / distance_m) * way : hh::Vec3{}));
}

void look_to(const DiscPlay& play, const hh::Vec3& point_ws) {
    const hh::Vec3 way = point_ws - play.mind.now.head_ws;
    if (length(way) > 0.1) {
        play.mind.state.heading_ws = normalized(way);
        play.mind.state.gaze_ws = play.mind.state.heading_ws;
    }
}

// The direction of a swing that makes the disc fly to the goal, given how fast the thrower flies.
hh::Vec3 aim(const DiscPlay& play, const hh::Vec3& from_ws) {
    Random& random = play.mind.state.random;
    const hh::Vec3 way = normalized(play.target_ws - from_ws);
    const hh::Vec3 own_mps = play.mind.now.origin_mps;
    const hh::Vec3 across_mps = own_mps - dot(own_mps, way) * way;
    const hh::Vec3 error = k_aim_error * random.cube();
    return normalized(way - across_mps / k_disc_throw_mps + error);
}

void carry(const DiscPlay& play, hh::Side side) {
    const ClimberMind& mind = play.mind;
    ClimberHand& hand = mind.hand(side);
    constexpr double k_never_s = 1e9;  // feel_hands lets go otherwise
    const double since_s = mind.now.t_s - hand.from_s;
    if (since_s > k_longest_pull_s && is_contested(play) && mind.state.random.chance(0.1)) {
        mind.state.yields_until_s = mind.now.t_s + k_yield_s;
        let_go(mind.state, side);
        return;
    }
    hand.change_s = k_never_s;
    look_to(play, play.target_ws);
    const hh::Vec3 goal_way = play.target_ws - mind.now.head_ws;
    const bool is_clear = !mind.sight.world.cast_ray(play.disc_ws + 0.3 * normalized(goal_way),
                                                     play.target_ws, mind.player());
    const bool is_near = length(goal_way) < k_throw_from_m;
    const bool is_ready = since_s > 0.6;
    if (is_ready && ((is_near && is_clear) || since_s > k_longest_carry_s)) {
        begin_throw(conjugate(mind.now.origin_ws.rotation) * aim(play, mind.wrist_ws(side)),
                    mind.state, side);
    }
    fly_to(play, play.target_ws);
}

void fetch(const DiscPlay& play) {
    const ClimberMind& mind = play.mind;
    const double distance_m = length(play.disc_ws - mind.now.head_ws);
    constexpr double k_look_ahead = 0.7;
    const double ahead_s = std::min(1.5, k_look_ahead * distance_m / k_flight_mps);
    look_to(play, play.disc_ws);
    // Comes from behind the disc, with the chest a little above.
    const hh::Vec3 meet_ws = play.disc_ws + ahead_s * play.disc_mps + hh::Vec3{0.0, 0.25, 0.0};
    const hh::Vec3 back = normalized(mind.now.head_ws - meet_ws + 1e-6 * hh::k_y);
    fly_to(play, meet_ws + 0.35 * back, distance_m < k_near_disc_m ? play.disc_mps : hh::Vec3{});
    for (const hh::Side side : k_both_sides) {
        if (mind.hand(side).mode != ClimberHandMode::rest) {
            continue;
        }
        const HoldSearch ask{mind.task, mind.now, side,
                             normalized(play.disc_ws - mind.now.head_ws + 1e-6 * hh::k_y), true};
        if (const auto found = find_hold_on(mind.sight, ask, mind.sight.arena->disc, mind.state)) {
            begin_reach(found->hold, 0.6 * found->reach_s, mind.state, side);
            return;
        }
    }
}

}  // namespace

void play_disc(const ClimberMind& mind) {
    const hh::World& world = mind.world();
    const hh::Body disc = mind.sight.arena->disc;
    if (!world.has(disc)) {
        return;
    }
    DiscPlay play{mind, *mind.task.team};
    play.disc_ws = world.pose(disc)->position;
    play.disc_mps = world.motion(disc)->velocity_mps;
    play.target_ws = goal_of(other_team(play.team));
    play.guarded_ws = goal_of(play.team);
    mind.state.leaping = false;
    mind.state.wanted_ps_mps = {};
    for (const hh::Side side : k_both_sides) {
        if (mind.hand(side).mode == ClimberHandMode::throwing) {
            return;
        }
        if (mind.hand(side).mode == ClimberHandMode::holding) {
            let_go(mind.state, side);
        }
    }
    const std::optional<hh::Side> with_disc = hand_with_disc(play);
    constexpr std::size_t k_fetchers = 1;
    if (with_disc) {
        carry(play, *with_disc);
    } else if (mind.now.t_s >= mind.state.yields_until_s &&
               rank_in_team(play, play.disc_ws) < k_fetchers) {
        fetch(play);
    } else {
        const bool guards = rank_in_team(play, play.guarded_ws) == 0;
        const hh::Vec3 out = normalized(play.disc_ws - play.guarded_ws + 1e-6 * hh::k_y);
        look_to(play, play.disc_ws);
        fly_to(play, guards ? play.guarded_ws + 1.6 * out
                            : 0.5 * play.guarded_ws + 0.3 * play.disc_ws + hh::Vec3{0.0, 1.5, 0.0});
    }
}

}  // namespace handhold
