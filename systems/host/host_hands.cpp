// Hands of the C interface: state, orders, joints of hands and bodies (handhold/players.h,
// handhold/skeletons.h).
#include <algorithm>
#include <array>

#include "components/play_space.hpp"
#include "components/world_edit.hpp"
#include "systems/host/host_skeleton.hpp"
#include "systems/host/host_world.hpp"
#include "systems/rigs/finger_curls.hpp"

namespace handhold {
namespace {

hh_grip_kind grip_of(GripKind kind) {
    switch (kind) {
        case GripKind::none:
            return HH_GRIP_NONE;
        case GripKind::surface:
            return HH_GRIP_SURFACE;
        case GripKind::held:
            return HH_GRIP_HELD;
        case GripKind::authored:
            return HH_GRIP_AUTHORED;
        case GripKind::player:
            return HH_GRIP_PLAYER;
    }
    return HH_GRIP_NONE;
}

hh_hand_state hand_state(const hh_world& host, Entity player, HandSide side) {
    const Entity hand = hand_of(host.world, player, side);
    const Grab& grab = host.world.grab.at(hand);
    const HandTracking& tracking = host.world.hand_tracking.at(hand);
    const RenderPose::Hand& shown = host.world.render_pose.at(player).hands[index_of(side)];
    hh_hand_state state{};
    state.tracked = to_c(shown.tracked_ws);
    state.shown = to_c(shown.shown_ws);
    state.anchor = hh_identity_pose();
    state.is_tracked = tracking.state == TrackingState::tracked;
    state.is_closed = tracking.pressed;
    state.is_inferred = tracking.state == TrackingState::inferred;
    const bool is_body = host.world.body.contains(grab.body);
    if (grab.kind == GripKind::none || (!is_body && !host.world.player.contains(grab.body))) {
        return state;
    }
    const AuthoredHold* const hold = host.world.authored_hold.find(hand);
    state.grip = hold != nullptr && hold->body == grab.body ? HH_GRIP_AUTHORED : grip_of(grab.kind);
    state.anchor = to_c(is_body ? to_host_bs(host, grab.body, grab.anchor_bs) : grab.anchor_bs);
    state.error_m = grab.error_m;
    if (is_body) {
        state.body = id_of<hh_body>(grab.body);
    } else {
        state.other = id_of<hh_player>(grab.body);
    }
    if (const HandReport* const report = host.hands.find(hand)) {
        state.force_impulse_ns = to_c(report->impulse_ns);
    }
    return state;
}

hh_player_pose player_pose(const hh_world& host, Entity player) {
    hh_player_pose pose{};
    pose.origin = to_c(samples_space_ws(host, player));
    pose.head = to_c(host.world.render_pose.at(player).head_ws);
    pose.velocity_mps = to_c(host.world.player_velocity.at(player).linear_mps);
    for (const HandSide side : {HandSide::left, HandSide::right}) {
        pose.hands[index_of(side)] = hand_state(host, player, side);
    }
    return pose;
}

// Sizes in version 0.2.0.
constexpr std::size_t k_first_hand_size = sizeof(hh_hand_state);
constexpr std::size_t k_first_pose_tail_size =
    sizeof(hh_player_pose) - offsetof(hh_player_pose, hands) - k_hand_count * sizeof(hh_hand_state);

NestedLayout pose_layout(std::size_t pose_size, std::size_t hand_size) {
    const NestedLayout layout{.size = pose_size,
                              .nested_size = hand_size,
                              .nested_at = offsetof(hh_player_pose, hands),
                              .nested_count = k_hand_count};
    const std::size_t own_tail_size = sizeof(hh_player_pose) - offsetof(hh_player_pose, hands) -
                                      k_hand_count * sizeof(hh_hand_state);
    require_size<hh_hand_state>(hand_size, k_first_hand_size);
    require_size<hh_player_pose>(pose_size, layout.tail_at() + k_first_pose_tail_size,
                                 layout.tail_at() + own_tail_size);
    return layout;
}

void order(hh_world& host, Entity hand, Entity body) {
    host.world.grab_order.remove(hand);
    host.world.grab_order.add(hand, {body});
}

}  // namespace
}  // namespace handhold

using namespace handhold;

hh_result hh_player_hand_sized(const hh_world* world, hh_player player, hh_side side,
                               hh_hand_state* hand, size_t hand_size) {
    return call([&] {
        const hh_world& host = world_of(world);
        require(hand != nullptr, HH_ERROR_NULL, "the output is null");
        require_size<hh_hand_state>(hand_size, k_first_hand_size);
        const hh_hand_state state = hand_state(host, player_of(host, player), side_of(side));
        std::memcpy(hand, &state, hand_size);
    });
}

hh_result hh_world_player_poses_sized(const hh_world* world, const hh_player* players, size_t count,
                                      hh_player_pose* poses, size_t pose_size, size_t hand_size) {
    return call([&] {
        const hh_world& host = world_of(world);
        const NestedLayout theirs = pose_layout(pose_size, hand_size);
        const NestedLayout ours = pose_layout(sizeof(hh_player_pose), sizeof(hh_hand_state));
        require(count == 0 || (players != nullptr && poses != nullptr), HH_ERROR_NULL,
                "the ids or the buffer are null");
        for (std::size_t i = 0; i < count; ++i) {
            player_of(host, players[i]);
        }
        for (std::size_t i = 0; i < count; ++i) {
            const hh_player_pose pose = player_pose(host, entity_of(players[i]));
            copy_common_fields(&sized_element(poses, pose_size, i), theirs, &pose, ours);
        }
    });
}

hh_result hh_hand_moves_player(const hh_world* world, hh_player player, hh_side side,
                               uint8_t* moves_player) {
    return call([&] {
        const hh_world& host = world_of(world);
        require(moves_player != nullptr, HH_ERROR_NULL, "the output is null");
        const Entity hand = hand_of(host.world, player_of(host, player), side_of(side));
        *moves_player = can_push_off(host.world.grab.at(hand));
    });
}

hh_result hh_hand_grip(hh_world* world, hh_player player, hh_side side, hh_body body) {
    return call([&] {
        hh_world& host = world_of(world);
        const Entity hand = hand_of(host.world, player_of(host, player), side_of(side));
        const Entity gripped = body_of(host, body);
        require(host.world.hand_tracking.at(hand).state != TrackingState::never, HH_ERROR_STATE,
                "the hand was never tracked (a pose at exactly (0, 0, 0) is ignored)");
        order(host, hand, gripped);
    });
}

hh_result hh_hand_release(hh_world* world, hh_player player, hh_side side) {
    return call([&] {
        hh_world& host = world_of(world);
        order(host, hand_of(host.world, player_of(host, player), side_of(side)), k_no_entity);
    });
}

hh_result hh_finger_curls_of(const hh_hand_joint* joints, hh_finger_curls* curls) {
    return call([&] {
        require(joints != nullptr && curls != nullptr, HH_ERROR_NULL,
                "the joints or the output are null");
        TrackedJoints seen;
        for (std::size_t i = 0; i < seen.size(); ++i) {
            if (joints[i].is_valid != 0) {
                seen[i] = from_c(joints[i].pose.position);
            }
        }
        std::ranges::copy(finger_curls(seen), curls->fingers);
    });
}

hh_result hh_player_hand_joints(const hh_world* world, hh_player player, hh_side side,
                                hh_space space, hh_hand_joint* joints) {
    return call([&] {
        const hh_world& host = world_of(world);
        require(joints != nullptr, HH_ERROR_NULL, "the output is null");
        require(space == HH_SPACE_WORLD || space == HH_SPACE_PARENT, HH_ERROR_VALUE,
                "a space is HH_SPACE_WORLD or HH_SPACE_PARENT");
        const Entity entity = player_of(host, player);
        const HandSide which = side_of(side);
        const HandRig& rig = hand_rig_of(host, hand_of(host.world, entity, which), which);
        const RenderPose::Hand& shown = host.world.render_pose.at(entity).hands[index_of(which)];
        const auto posed = pose_hand_joints(rig, host.world.player_origin.at(entity).scale,
                                            shown.fingers, shown.shown_ws);
        for (std::size_t i = 0; i < posed.size(); ++i) {
            Pose pose = posed[i].pose_ws;
            if (const std::int32_t parent = hand_joint_parent(i);
                space == HH_SPACE_PARENT && parent >= 0) {
                pose = inverse(posed[static_cast<std::size_t>(parent)].pose_ws) * pose;
            }
            joints[i] = {to_c(pose), posed[i].radius_m, posed[i].is_valid};
        }
    });
}

const char* hh_body_joint_name(size_t joint) {
    return joint < HH_BODY_JOINT_COUNT ? k_body_joints[joint].name : nullptr;
}

int32_t hh_body_joint_parent(size_t joint) {
    return joint < HH_BODY_JOINT_COUNT ? k_body_joints[joint].parent : -1;
}

hh_result hh_player_body_joints(const hh_world* world, hh_player player, hh_space space,
                                hh_pose* joints) {
    return call([&] {
        const hh_world& host = world_of(world);
        require(joints != nullptr, HH_ERROR_NULL, "the output is null");
        require(space == HH_SPACE_WORLD || space == HH_SPACE_PARENT, HH_ERROR_VALUE,
                "a space is HH_SPACE_WORLD or HH_SPACE_PARENT");
        const auto posed = pose_body_joints(host.world.render_pose.at(player_of(host, player)));
        for (std::size_t i = 0; i < posed.size(); ++i) {
            const std::int32_t parent = k_body_joints[i].parent;
            const bool is_local = space == HH_SPACE_PARENT && parent >= 0;
            joints[i] = to_c(is_local ? inverse(posed[static_cast<std::size_t>(parent)]) * posed[i]
                                      : posed[i]);
        }
    });
}
