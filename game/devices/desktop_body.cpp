#include "game/devices/desktop_body.hpp"

#include <algorithm>

#include "game/devices/controller_profile.hpp"

namespace handhold {
namespace {

const Vec3 k_head_place_ps(0.0, 1.6, 0.0);
const Vec3 k_shoulder_hs(0.18, -0.2, 0.05);  // right shoulder, in the head's frame
constexpr double k_arm_m = 0.78;             // arm's length from the shoulder
constexpr double k_clearance_m = 0.15;       // minimum distance of a pulling hand from the head
constexpr double k_steepest_rad = 1.5;
// The player reaches for a surface in view up to this distance.
constexpr double k_look_m = 0.85;
// A surface this near to the line of sight counts as in view.
constexpr double k_near_look_m = 0.08;
constexpr double k_no_surface_m = 0.6;
constexpr double k_reach_mps = 3.5;
constexpr double k_hand_return_mps = 2.5;
constexpr double k_longest_reach_s = 0.5;
constexpr double k_at_target_m = 0.005;
constexpr double k_pull_mps = 0.9;

double sign_of(HandSide side) { return side == HandSide::right ? 1.0 : -1.0; }

Vec3 mirrored(Vec3 right, HandSide side) {
    right.x() *= sign_of(side);
    return right;
}

// Finger direction of a hand that lies on a surface: upwards on a wall, forward on a floor.
Vec3 fingers_on(const Vec3& away, const Quat& head) {
    const Vec3 wanted = head * Vec3(0.0, 1.0, -0.3);
    const Vec3 across = wanted - away * away.dot(wanted);
    constexpr double k_least = 0.1;
    return across.norm() > k_least ? wanted : Vec3(head * Vec3::UnitX());
}

}  // namespace

// Rest pose of a hand: open, at chest height, in view.
Pose DesktopBody::rest_ps(HandSide side, const HandTuning& tuning) const {
    const PalmTarget place{mirrored({0.2, -0.24, -0.42}, side),
                           mirrored({0.5, 0.85, 0.0}, side).normalized(), -Vec3::UnitZ()};
    return head_ps_ * hand_on(place, side, tuning);
}

// Finds the surface on or near the line of sight and sets aim_ps_.
void DesktopBody::aim(const Scene& scene, const CollisionWorld& collision,
                      const PlayerEntities& player) {
    const Pose& origin_ws = scene.world.player_origin.at(player.player).pose_ws;
    const std::uint64_t himself = scene.world.persistent_id.at(player.player).value;
    const Vec3 from_ws = transform_point(origin_ws, head_ps_.position);
    const Vec3 ahead_ps = head_ps_.rotation * -Vec3::UnitZ();
    const Vec3 to_ws = from_ws + k_look_m * (origin_ws.rotation * ahead_ps);
    auto hit = collision.cast_ray(from_ws, to_ws, {&himself, 1});
    if (!hit) {
        hit = collision.cast_sphere(k_near_look_m, from_ws, to_ws, {&himself, 1});
    }
    aim_ps_.reset();
    if (hit) {
        const Vec3 away = origin_ws.rotation.conjugate() * hit->normal_ws;
        aim_ps_ = {inverse_transform_point(origin_ws, hit->point_ws), away,
                   fingers_on(away, head_ps_.rotation)};
    }
}

// Target of a reach: on the surface in view; without one, in front of the player.
Pose DesktopBody::target_ps(HandSide side, const HandTuning& tuning) const {
    const PalmTarget ahead{transform_point(head_ps_, Vec3(0.0, 0.0, -k_no_surface_m)),
                           head_ps_.rotation * Vec3::UnitY(), head_ps_.rotation * -Vec3::UnitZ()};
    return hand_on(aim_ps_.value_or(ahead), side, tuning);
}

// Moves the hand towards the target. Closes it at the target, or after k_longest_reach_s.
void DesktopBody::reach(const Pose& target_ps, double dt_s, Hand& hand) {
    const double distance_m = (target_ps.position - hand.hand_ps.position).norm();
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
bool DesktopBody::may_pull(const Hand& hand, HandSide side, const Vec3& move_ps) const {
    const Vec3 next_ps = hand.hand_ps.position + move_ps;
    const Vec3 shoulder_ps = transform_point(head_ps_, mirrored(k_shoulder_hs, side));
    const auto grows = [&](const Vec3& about) {
        return (next_ps - about).norm() - (hand.hand_ps.position - about).norm();
    };
    const bool out = (next_ps - shoulder_ps).norm() > k_arm_m && grows(shoulder_ps) > 0.0;
    const bool in =
        (next_ps - head_ps_.position).norm() < k_clearance_m && grows(head_ps_.position) < 0.0;
    return !out && !in;
}

// Moves all pulling hands by the same amount, because what they hold does not move. If one hand may
// not move, none does.
void DesktopBody::pull(const Vec3& move_ps) {
    for (std::size_t side = 0; side < k_hand_count; ++side) {
        if (uses_[side] == Use::pulls &&
            !may_pull(hands_[side], static_cast<HandSide>(side), move_ps)) {
            return;
        }
    }
    for (std::size_t side = 0; side < k_hand_count; ++side) {
        if (uses_[side] == Use::pulls) {
            hands_[side].hand_ps.position += move_ps;
        }
    }
}

TrackingSample DesktopBody::advance(const Scene& scene, const CollisionWorld& collision,
                                    const PlayerEntities& player, const DesktopInput& input,
                                    double t_s, double dt_s) {
    yaw_rad_ += input.turn_left_rad;
    pitch_rad_ = std::clamp(pitch_rad_ + input.look_up_rad, -k_steepest_rad, k_steepest_rad);
    head_ps_.position = k_head_place_ps;
    head_ps_.rotation =
        (rotation_about(Vec3::UnitY(), yaw_rad_) * rotation_about(Vec3::UnitX(), pitch_rad_))
            .normalized();
    aim(scene, collision, player);
    for (std::size_t i = 0; i < k_hand_count; ++i) {
        const auto side = static_cast<HandSide>(i);
        Hand& hand = hands_[i];
        if (!has_hands_) {
            hand.hand_ps = rest_ps(side, scene.tuning.hand);
        }
        const Grab& grab = scene.world.grab.at(player.hands[i]);
        const bool carries =
            grab.kind == GripKind::none || (grab.kind == GripKind::held && !grab.jointed);
        uses_[i] = !input.grip[i] || input.opened[i] ? Use::opens
                   : !hand.closed                    ? Use::reaches
                   : carries                         ? Use::carries
                                                     : Use::pulls;
        if (uses_[i] == Use::opens) {
            hand.closed = false;
            hand.reaches_s = 0.0;
            const Pose rest = rest_ps(side, scene.tuning.hand);
            const double distance_m = (rest.position - hand.hand_ps.position).norm();
            const double share =
                std::min(1.0, k_hand_return_mps * dt_s / std::max(distance_m, 1e-9));
            hand.hand_ps = interpolate(hand.hand_ps, rest, share);
        } else if (uses_[i] == Use::reaches) {
            reach(target_ps(side, scene.tuning.hand), dt_s, hand);
        } else if (uses_[i] == Use::carries) {
            const double z_m = hand.carried_hs.position.z();
            if (const double to_m = z_m - input.farther_m;
                to_m > -k_arm_m && to_m < -k_clearance_m) {
                hand.carried_hs.position.z() = to_m;
            }
            hand.hand_ps = head_ps_ * hand.carried_hs;
        }
    }
    has_hands_ = true;
    const double speed_mps = (input.hurry ? 2.0 : 1.0) * k_pull_mps;
    const Vec3 move_hs = -speed_mps * dt_s * input.move - input.farther_m * Vec3::UnitZ();
    pull(head_ps_.rotation * move_hs);

    for (std::size_t i = 0; i < k_hand_count; ++i) {
        if (uses_[i] != Use::carries) {
            hands_[i].carried_hs = inverse(head_ps_) * hands_[i].hand_ps;
        }
    }

    TrackingSample sample;
    sample.t_s = t_s;
    sample.head_ps = head_ps_;
    for (std::size_t i = 0; i < k_hand_count; ++i) {
        const Pose joint = controller_joint(scene.world, player.hands[i], static_cast<HandSide>(i),
                                            scene.tuning.hand);
        sample.controllers[i] = {hands_[i].hand_ps * inverse(joint), hands_[i].closed,
                                 hands_[i].closed ? 1.0 : 0.0};
    }
    return sample;
}

PlayerCommands DesktopBody::commands(const DesktopInput& input) const {
    PlayerCommands commands;
    commands.brake = input.brake ? 1.0 : 0.0;
    commands.smooth_turn = input.smooth_turn;
    commands.snap_turns = input.snap_turns;
    // Has no effect unless the tuning has jets.
    commands.thrust_ps = head_ps_.rotation * input.move;
    return commands;
}

}  // namespace handhold
