// Makes the C interface's events of joints: latches that open or close, and limits reached.
#include "systems/host/host_events.hpp"

namespace handhold {
namespace {

// True if the joint is at its limit, with a tolerance: joints come to rest slightly before their
// limit.
bool is_at_limit(const Joint& joint, const JointState& state, bool was_at_limit) {
    const double near_limit = was_at_limit ? 1e-2 : 5e-3;  // rad or m
    const bool has_limits = joint.limited || joint.kind == JointKind::distance;
    return has_limits && joint.kind != JointKind::fixed && joint.lower < joint.upper &&
           (state.coordinate <= joint.lower + near_limit ||
            state.coordinate >= joint.upper - near_limit);
}

// Writes the hand that grips one of the joint's bodies into the event, if there is one.
void attribute(const hh_world& host, const Joint& joint, hh_event& event) {
    for (std::size_t index = 0; index < host.world.grab.size(); ++index) {
        const Grab& grab = host.world.grab.elements()[index];
        if (grab.kind != GripKind::none && (grab.body == joint.a || grab.body == joint.b)) {
            const HandOwner& owner = host.world.hand_owner.at(host.world.grab.owners()[index]);
            event.player = id_of<hh_player>(owner.player);
            event.side = owner.side == HandSide::left ? HH_LEFT : HH_RIGHT;
            return;
        }
    }
}

}  // namespace

void update_joint_reports(hh_world& host, bool makes_events) {
    for (std::size_t index = 0; index < host.world.joint.size(); ++index) {
        const Entity entity = host.world.joint.owners()[index];
        const Joint& joint = host.world.joint.elements()[index];
        const JointState& state = host.world.joint_state.at(entity);
        JointReport* const known = host.joints.find(entity);
        const bool was_at_limit = known != nullptr && known->at_limit;
        const JointReport now{state.latched, is_at_limit(joint, state, was_at_limit)};
        if (known == nullptr) {
            host.joints.add(entity, now);
            continue;
        }
        const auto add = [&](hh_event_kind kind) {
            hh_event event{};
            event.kind = kind;
            event.side = -1;
            event.joint = id_of<hh_joint>(entity);
            event.body = id_of<hh_body>(joint.b);
            event.position = to_c(transform_point(host.world.body_pose.at(joint.b).pose_ws,
                                                  joint.frame_b_bs.position));
            attribute(host, joint, event);
            host.events.push_back(event);
        };
        if (makes_events && now.latched != known->latched) {
            add(now.latched ? HH_EVENT_LATCH_CLOSED : HH_EVENT_LATCH_OPENED);
        }
        if (makes_events && now.at_limit && !known->at_limit) {
            add(HH_EVENT_LIMIT_REACHED);
        }
        *known = now;
    }
}

}  // namespace handhold
