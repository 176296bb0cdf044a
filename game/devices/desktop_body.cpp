#include "game/devices/desktop_body.hpp"

#include <algorithm>

namespace handhold {

using hh::conjugate;
using hh::dot;
using hh::interpolate;
using hh::inverse;
using hh::inverse_transform_point;
using hh::length;
using hh::normalized;
using hh::rotation_about;
using hh::transform_point;

namespace {

constexpr hh::Vec3 k_head_place_ps{0.0, 1.6, 0.0};
constexpr hh::Vec3 k_shoulder_hs{0.18, -0.2, 0.05};  // right shoulder, in the head's frame
constexpr double k_arm_m = 0.78;                     // arm's length from the shoulder
constexpr double k_clearance_m = 0.15;  // minimum distance of a pulling hand from the head
constexpr double k_steepest_rad = 1.5;
// The player reaches for a surface in view up to this distance.
constexpr double k_look_m = 0.85;
// A surface this near to the line of sight counts as in view.
constexpr double k_near_look_m = 0.08;
constexpr double k_hand_radius_m = 0.04;  // radius of an open hand, for surfaces that stop it
constexpr double k_fingers_m = 0.08;      // distance of the fingers' middle from the palm's centre
constexpr double k_no_surface_m = 0.6;
constexpr double k_reach_mps = 3.5;
constexpr double k_hand_return_mps = 2.5;
constexpr double k_longest_reach_s = 0.5;
constexpr double k_at_target_m = 0.005;
constexpr double k_pull_mps = 0.9;

double sign_of(hh::Side side) { return side == HH_RIGHT ? 1.0 : -1.0; }

hh::Vec3 mirrored(hh::Vec3 right, hh::Side side) {
    right.x *= sign_of(side);
    return right;
}

// Finger direction of a hand that lies on a surface: upwards on a wall, forward on a floor.
hh::Vec3 fingers_on(const hh::Vec3& away, const hh::Quat& head) {
    const hh::Vec3 wanted = head * hh::Vec3{0.0, 1.0, -0.3};
    const hh::Vec3 across = wanted - away * dot(away, wanted);
    constexpr double k_least = 0.1;
    return length(across) > k_least ? wanted : (head * hh::k_x);
}

}  // namespace

// Rest pose of a hand: open, at chest height, in view.
hh::Pose DesktopBody::rest_ps(hh::Side side, hh::Vec3 palm_center_m) const {
    const PalmTarget place{mirrored({0.2, -0.24, -0.42}, side),
                           normalized(mirrored({0.5, 0.85, 0.0}, side)), -hh::k_z};
    return head_ps_ * hand_on(place, side, palm_center_m);
}

// Moves an open hand back towards the head until neither palm nor fingers are in a surface.
void DesktopBody::stop_at_surface(hh::World& world, hh::Player player, hh::Side side,
                                  hh::Vec3 palm_center_m, hh::Pose& hand_ps) const {
    const hh::Pose origin_ws = world.pose(player)->origin;
    const hh::Vec3 head_ws = transform_point(origin_ws, head_ps_.position);
    for (const hh::Vec3 ahead_m : {hh::Vec3{}, hh::Vec3{0.0, 0.0, -k_fingers_m}}) {
        const hh::Vec3 part_hs = mirrored(palm_center_m, side) + ahead_m;
        const hh::Vec3 part_ws = transform_point(origin_ws * hand_ps, part_hs);
        const auto hit = world.cast_sphere(k_hand_radius_m, head_ws, part_ws, player);
        if (hit && hit->distance_m > 0.0) {  // 0: the head itself touches something
            const hh::Vec3 way_ws = part_ws - head_ws;
            const double back_m = std::max(length(way_ws) - hit->distance_m, 0.0);
            hand_ps.position -=
                conjugate(origin_ws.rotation) * (back_m / std::max(length(way_ws), 1e-9) * way_ws);
        }
    }
}

// Finds the surface on or near the line of sight and sets aim_ps_.
void DesktopBody::aim(hh::World& world, hh::Player player) {
    const hh::Pose origin_ws = world.pose(player)->origin;
    const hh::Vec3 from_ws = transform_point(origin_ws, head_ps_.position);
    const hh::Vec3 ahead_ps = head_ps_.rotation * -hh::k_z;
    const hh::Vec3 to_ws = from_ws + k_look_m * (origin_ws.rotation * ahead_ps);
    auto hit = world.cast_ray(from_ws, to_ws, player);
    if (!hit) {
        hit = world.cast_sphere(k_near_look_m, from_ws, to_ws, player);
    }
    aim_ps_.reset();
    if (hit) {
        const hh::Vec3 away = conjugate(origin_ws.rotation) * hit->normal;
        aim_ps_ = {inverse_transform_point(origin_ws, hit->point), away,
                   fingers_on(away, head_ps_.rotation)};
    }
}

// Target of a reach: on the surface in view; without one, in front of the player.
hh::Pose DesktopBody::target_ps(hh::Side side, hh::Vec3 palm_center_m) const {
    const PalmTarget ahead{transform_point(head_ps_, hh::Vec3{0.0, 0.0, -k_no_surface_m}),
                           head_ps_.rotation * hh::k_y, head_ps_.rotation * -hh::k_z};
    return hand_on(aim_ps_.value_or(ahead), side, palm_center_m);
}

// Moves the hand towards the target. Closes it at the target, or after k_longest_reach_s.
void DesktopBody::reach(const hh::Pose& target_ps, double dt_s, Hand& hand) {
    const double distance_m = length(target_ps.position - hand.hand_ps.position);
    const double share =
        distance_m > k_at_target_m ? std::min(1.0, k_reach_mps * dt_s / distance_m) : 1.0;
    hand.hand_ps = interpolate(hand.hand_ps, target_ps, share);
    hand.reaches_s += dt_s;
    if (share == 1.0 || hand.reaches_s > k_longest_reach_s) {
        hand.closed = true;
    }
}

// False if the move takes the hand out of the arm's reach or too near to the face. A move that
// brings the hand back is allowed.
bool DesktopBody::may_pull(const Hand& hand, hh::Side side, const hh::Vec3& move_ps) const {
    const hh::Vec3 next_ps = hand.hand_ps.position + move_ps;
    const hh::Vec3 shoulder_ps = transform_point(head_ps_, mirrored(k_shoulder_hs, side));
    const auto grows = [&](const hh::Vec3& about) {
        return length(next_ps - about) - length(hand.hand_ps.position - about);
    };
    const bool out = length(next_ps - shoulder_ps) > k_arm_m && grows(shoulder_ps) > 0.0;
    const bool in =
        length(next_ps - head_ps_.position) < k_clearance_m && grows(head_ps_.position) < 0.0;
    return !out && !in;
}

// Moves all pulling hands by the same amount, because what they hold does not move. If one hand may
// not move, none does.
void DesktopBody::pull(const hh::Vec3& move_ps) {
    for (std::size_t side = 0; side < 2; ++side) {
        if (uses_[side] == Use::pulls &&
            !may_pull(hands_[side], static_cast<hh::Side>(side), move_ps)) {
            return;
        }
    }
    for (std::size_t side = 0; side < 2; ++side) {
        if (uses_[side] == Use::pulls) {
            hands_[side].hand_ps.position += move_ps;
        }
    }
}

hh::Sample DesktopBody::advance(hh::World& world, hh::Player player, const DesktopInput& input,
                                double t_s, double dt_s) {
    yaw_rad_ += input.turn_left_rad;
    pitch_rad_ = std::clamp(pitch_rad_ + input.look_up_rad, -k_steepest_rad, k_steepest_rad);
    head_ps_.position = k_head_place_ps;
    head_ps_.rotation =
        normalized(rotation_about(hh::k_y, yaw_rad_) * rotation_about(hh::k_x, pitch_rad_));
    aim(world, player);
    const hh::Vec3 palm_center_m = *world.tuning_vector("hand.palm_center_m");
    for (std::size_t i = 0; i < 2; ++i) {
        const auto side = static_cast<hh::Side>(i);
        Hand& hand = hands_[i];
        if (!has_hands_) {
            hand.hand_ps = rest_ps(side, palm_center_m);
        }
        // True if the hand is empty, or holds a body that comes along instead of moving the player.
        const bool carries = !world.moves_player(player, side);
        uses_[i] = !input.grip[i] || input.opened[i] ? Use::opens
                   : !hand.closed                    ? Use::reaches
                   : carries                         ? Use::carries
                                                     : Use::pulls;
        if (uses_[i] == Use::opens) {
            hand.closed = false;
            hand.reaches_s = 0.0;
            const hh::Pose rest = rest_ps(side, palm_center_m);
            const double distance_m = length(rest.position - hand.hand_ps.position);
            const double share =
                std::min(1.0, k_hand_return_mps * dt_s / std::max(distance_m, 1e-9));
            hand.hand_ps = interpolate(hand.hand_ps, rest, share);
            stop_at_surface(world, player, side, palm_center_m, hand.hand_ps);
        } else if (uses_[i] == Use::reaches) {
            reach(target_ps(side, palm_center_m), dt_s, hand);
        } else if (uses_[i] == Use::carries) {
            const double z_m = hand.carried_hs.position.z;
            if (const double to_m = z_m - input.farther_m;
                to_m > -k_arm_m && to_m < -k_clearance_m) {
                hand.carried_hs.position.z = to_m;
            }
            hand.hand_ps = head_ps_ * hand.carried_hs;
        }
    }
    has_hands_ = true;
    const double speed_mps = (input.hurry ? 2.0 : 1.0) * k_pull_mps;
    const hh::Vec3 move_hs = -speed_mps * dt_s * input.move - input.farther_m * hh::k_z;
    pull(head_ps_.rotation * move_hs);

    for (std::size_t i = 0; i < 2; ++i) {
        if (uses_[i] != Use::carries) {
            hands_[i].carried_hs = inverse(head_ps_) * hands_[i].hand_ps;
        }
    }

    hh::Sample sample = hh::sample();
    sample.time_s = t_s;
    sample.head = head_ps_;
    for (const hh::Side side : {HH_LEFT, HH_RIGHT}) {
        sample.hands[side] =
            hands_[side].hand_ps * inverse(*world.hand_in_controller(player, side));
        sample.grab[side] = hands_[side].closed;
        sample.squeeze[side] = hands_[side].closed ? 1.0 : 0.0;
    }
    return sample;
}

void DesktopBody::face_nearest_surface(hh::World& world, hh::Player player) {
    const hh::Pose origin_ws = world.pose(player)->origin;
    const hh::Vec3 from_ws = transform_point(origin_ws, k_head_place_ps);
    const auto hit = world.closest_point(from_ws, k_look_m, player);
    if (!hit || hit->distance_m == 0.0) {
        return;
    }
    const hh::Vec3 way_ps = conjugate(origin_ws.rotation) * (hit->point - from_ws);
    const double level_m = length(hh::Vec3{way_ps.x, 0.0, way_ps.z});
    yaw_rad_ = level_m > 0.0 ? hh_atan2(-way_ps.x, -way_ps.z) : 0.0;
    pitch_rad_ = std::clamp(hh_atan2(way_ps.y, level_m), -k_steepest_rad, k_steepest_rad);
}

hh_commands DesktopBody::commands(const DesktopInput& input) const {
    hh_commands commands{};
    commands.brake = input.brake ? 1.0 : 0.0;
    commands.smooth_turn = input.smooth_turn;
    commands.snap_turns = input.snap_turns;
    // Has no effect unless the tuning has jets.
    commands.thrust = head_ps_.rotation * input.move;
    return commands;
}

}  // namespace handhold
