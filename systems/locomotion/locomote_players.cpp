#include "systems/locomotion/locomote_players.hpp"

#include <algorithm>
#include <array>
#include <span>
#include <utility>

#include "components/hand_indices.hpp"

namespace handhold {
namespace {

// One player's gripping hands, first hand first.
struct Grips {
    struct Grip {
        const Grab* grab = nullptr;
        const HandTracking* hand = nullptr;
        HandSide side = HandSide::left;
    };
    std::array<Grip, k_hand_count> grips;
    std::size_t count = 0;
};

bool is_on_surface(const Grips::Grip& grip) { return grip.grab->kind == GripKind::surface; }

// True if grip a comes before b: surface grips first, then the hand that closed earlier, then the
// left hand. The order in the column has no effect.
bool comes_first(const Grips::Grip& a, const Grips::Grip& b) {
    if (is_on_surface(a) != is_on_surface(b)) {
        return is_on_surface(a);
    }
    return a.grab->since_s != b.grab->since_s ? a.grab->since_s < b.grab->since_s : a.side < b.side;
}

// `expected_index`: index of the player's first hand if all hands were created in the order of the
// players.
Grips grips_of(const LocomotePlayersIo& io, Entity player, std::size_t expected_index) {
    Grips found;
    const std::size_t first = find_hand_index(io.owner, player, expected_index);
    if (first == io.owner.size()) {
        return found;
    }
    const std::size_t second = find_hand_index(io.owner, player, first + 1);
    for (const std::size_t index : {std::min(first, second), std::max(first, second)}) {
        const Entity entity = io.owner.owners()[index];
        const Grab& grab = io.grab.at(entity);
        const bool holds = grab.phase == GrabPhase::holding || grab.phase == GrabPhase::releasing;
        const bool once = first != second || index != first || found.count == 0;
        if (holds && once) {
            found.grips[found.count++] = {&grab, &io.hand.at(entity),
                                          io.owner.elements()[index].side};
        }
    }
    if (found.count == 2 && comes_first(found.grips[1], found.grips[0])) {
        std::swap(found.grips[0], found.grips[1]);
    }
    return found;
}

// Rotates the play space about a point that keeps its place in the world.
void turn_about(PlayerOrigin& origin, const Vec3& pivot_ps, const Quat& turn_ws) {
    const Vec3 pivot_ws = transform_point(origin.pose_ws, pivot_ps);
    origin.pose_ws.rotation = (turn_ws * origin.pose_ws.rotation).normalized();
    origin.pose_ws.position = pivot_ws - origin.pose_ws.rotation * pivot_ps;
}

// If a player turns whose parts are gripped, those grips stay where they are in the world. From
// there they follow the parts (update_grabs).
void keep_holds_in_place(const LocomotePlayersIo& io, Entity player, const Pose& before_ws,
                         const Pose& now_ws) {
    for (const Entity hand : io.body_hold.owners()) {
        if (io.grab.at(hand).body == player) {
            BodyHold& hold = io.body_hold.at(hand);
            const Pose turned = inverse(now_ws) * before_ws;
            hold.start_ps = turned * hold.start_ps;
            hold.pose_ps = turned * hold.pose_ps;
        }
    }
}

Quat commanded_turn(const LocomotePlayersIo& io, const PlayerCommands& commands,
                    const Quat& play_space, const LocomotionTuning& tuning) {
    const double smooth =
        std::clamp(commands.smooth_turn, -1.0, 1.0) * tuning.smooth_turn_radps * io.dt_s;
    const double angle = smooth + commands.snap_turns * tuning.snap_turn_rad;
    return rotation_about(play_space * Vec3::UnitY(), angle);
}

// Rotation vector of a support in a frame. Bodies that the host moves: in the frame before, since
// their velocity is measured over several frames and their turns must add up exactly.
Vec3 turned_rad(const LocomotePlayersIo& io, Entity support) {
    const MoveTarget* const target = io.move_target.find(support);
    if (target == nullptr) {
        return io.body_velocity.at(support).angular_radps * io.dt_s;
    }
    const bool has_moved = target->count > 0 && target->moved_s == io.start_s;
    return has_moved ? target->moves[0].turned_rad : Vec3(Vec3::Zero());
}

// Rotation of the play space with its support in this frame.
Quat support_turn(const LocomotePlayersIo& io, const Grips& grips, const Quat& play_space,
                  const LocomotionTuning& tuning) {
    const bool both_on_one = grips.count == 2 && is_on_surface(grips.grips[0]) &&
                             is_on_surface(grips.grips[1]) &&
                             grips.grips[0].grab->body == grips.grips[1].grab->body;
    if (grips.count == 0 || !is_on_surface(grips.grips[0]) ||
        (tuning.support_follow == SupportFollow::off && !both_on_one)) {
        return Quat::Identity();
    }
    const Vec3 turned = turned_rad(io, grips.grips[0].grab->body);
    if (tuning.support_follow == SupportFollow::yaw && !both_on_one) {
        const Vec3 up = play_space * Vec3::UnitY();
        return rotation_about(up, up.dot(turned));
    }
    return rotation_from_vector(turned);
}

void update_reference(const LocomotePlayersIo& io, const Grips& grips,
                      ReferenceVelocity& reference) {
    if (grips.count > 0 && is_on_surface(grips.grips[0])) {
        reference.body = grips.grips[0].grab->body;
        reference.point_bs = grips.grips[0].grab->anchor_bs.position;
    }
    const BodyVelocity* const support = io.body_velocity.find(reference.body);
    if (support == nullptr) {
        reference.body = k_no_entity;
        reference.linear_mps = io.scene_velocity_mps;
        return;
    }
    // The velocity at the point last gripped, not at the player, where a turning body may be much
    // faster.
    const Vec3 arm = io.body_pose.at(reference.body).pose_ws.rotation * reference.point_bs;
    reference.linear_mps = support->linear_mps + support->angular_radps.cross(arm);
}

void drive(const LocomotePlayersIo& io, const PlayerCommands& commands, const Quat& play_space,
           double scale, const Vec3& reference_mps, const LocomotionTuning& tuning,
           Vec3& velocity_mps) {
    const double brake = std::clamp(commands.brake, 0.0, 1.0) * tuning.brake_drag_per_s;
    const double drag = (tuning.drift_drag_per_s + brake) * io.dt_s;
    // Implicit Euler, v' = v / (1 + drag dt): stable for any drag.
    velocity_mps = reference_mps + (velocity_mps - reference_mps) / (1.0 + drag);
    const Vec3 thrust_ps = commands.thrust_ps.cwiseMax(-1.0).cwiseMin(1.0);
    velocity_mps += (scale * tuning.thruster_mps2 * io.dt_s) * (play_space * thrust_ps);
}

}  // namespace

void locomote_players(const LocomotePlayersIo& io, const LocomotionTuning& tuning) {
    for (std::size_t index = 0; index < io.origin.size(); ++index) {
        const Entity player = io.origin.owners()[index];
        PlayerOrigin& origin = io.origin.elements()[index];
        const PlayerCommands& commands = io.commands.at(player);
        const HeadTracking& head = io.head.at(player);
        const Grips grips = grips_of(io, player, k_hand_count * index);
        update_reference(io, grips, io.reference.at(player));

        const Vec3 pivot_ps =
            grips.count > 0 ? grips.grips[0].hand->start_ps.position : head.start_ps.position;
        const Quat play_space = origin.pose_ws.rotation;
        const Quat turn = support_turn(io, grips, play_space, tuning) *
                          commanded_turn(io, commands, play_space, tuning);
        if (turn.vec().squaredNorm() > 0.0) {
            const Pose before_ws = origin.pose_ws;
            turn_about(origin, pivot_ps, turn);
            keep_holds_in_place(io, player, before_ws, origin.pose_ws);
        }
        const auto* const end = grips.grips.begin() + grips.count;
        if (std::none_of(grips.grips.begin(), end, is_on_surface)) {
            drive(io, commands, play_space, origin.scale, io.reference.at(player).linear_mps,
                  tuning, io.velocity.at(player).linear_mps);
        }
    }
}

}  // namespace handhold
