#include "systems/input/read_paused_tracking.hpp"

#include "systems/input/shared/play_space_tracker.hpp"

namespace handhold {
namespace {

const TrackingSample* last_sample(std::span<const PlayerInput> inputs, Entity player) {
    for (const PlayerInput& input : inputs) {
        if (input.player == player && !input.samples.empty()) {
            return &input.samples.back();
        }
    }
    return nullptr;
}

template <typename Device>
void place(Device& device, const Pose& pose_ps) {
    device.pose_ps = device.start_ps = device.sample_ps = pose_ps;
}

// Converts a pose from the devices' space to play space.
Pose corrected(const HeadTracking& head, const Pose& pose) {
    return {head.shift_turn * pose.position + head.shift_m, head.shift_turn * pose.rotation};
}

}  // namespace

void read_paused_tracking(const ReadPausedTrackingIo& io) {
    for (std::size_t index = 0; index < io.owner.size(); ++index) {
        const Entity entity = io.owner.owners()[index];
        const HandOwner& owner = io.owner.elements()[index];
        HandTracking& hand = io.hand.at(entity);
        hand.edge = GrabEdge::none;
        hand.resumed = false;
        const TrackingSample* const sample = last_sample(io.inputs, owner.player);
        if (sample == nullptr || hand.state == TrackingState::never) {
            continue;
        }
        const ControllerSample& reading = sample->controllers[index_of(owner.side)];
        hand.raw_pressed = reading.grab;
        hand.squeeze = pressed_share(reading.squeeze);
        hand.trigger = pressed_share(reading.trigger);
        hand.curls = known_curls(reading.curls);
        hand.state = TrackingState::lost;
        HandHistory& history = io.history.at(entity);
        history.count = history.next = 0;
        if (is_valid(reading.controller_ps)) {
            const ControllerToHand* const joint = io.controller_to_hand.find(entity);
            Pose in_controller = io.hand_in_controller[index_of(owner.side)];
            in_controller.position *= io.origin.at(owner.player).scale;
            const Pose hand_ps = reading.controller_ps *
                                 (joint != nullptr ? joint->hand_in_controller : in_controller);
            place(hand, corrected(io.head.at(owner.player), hand_ps));
        }
    }
    for (std::size_t index = 0; index < io.head.size(); ++index) {
        HeadTracking& head = io.head.elements()[index];
        const TrackingSample* const sample = last_sample(io.inputs, io.head.owners()[index]);
        if (sample != nullptr && head.state != TrackingState::never && is_valid(sample->head_ps)) {
            place(head, corrected(head, {sample->head_ps.position,
                                         sample->head_ps.rotation.normalized()}));
        }
    }
}

}  // namespace handhold
