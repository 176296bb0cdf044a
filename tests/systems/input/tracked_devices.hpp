#pragma once

#include <initializer_list>
#include <span>
#include <vector>

#include "systems/input/read_tracking.hpp"
#include "tests/systems/frame/column_scene.hpp"

// Shared by the tests of read_tracking: players' devices as columns, and made-up samples.
namespace handhold::test {

inline constexpr double k_frame_s = 0.01;

// Not (0, 0, 0), where a controller counts as asleep.
inline const Vec3 k_rest(0.0, 0.0, 0.125);

inline TrackingSample sample_at(double t_s, const Vec3& place = k_rest, bool grab = false) {
    TrackingSample sample;
    sample.t_s = t_s;
    sample.head_ps = pose_at(place);
    sample.controllers = {ControllerSample{pose_at(place), grab},
                          ControllerSample{pose_at(place), grab}};
    return sample;
}

// One player whose hands are where the controllers are.
struct Devices {
    Column<PlayerOrigin> origin;
    Column<HandOwner> owner;
    Column<ControllerToHand> joint;
    Column<RecenterGuess> recenter_guess;
    Column<Grab> grab;  // of hands that grip; the others need none
    Column<HeadTracking> head;
    Column<HandTracking> hand;
    Column<HandHistory> history;
    Column<PlayerCommands> commands;
    Tuning tuning;
    StageStats stats;
    double t_s = 0.0;

    // No speed limit: devices may jump. Tests of implausible samples set a limit.
    Devices() {
        tuning.tracking.max_hand_speed_mps = 1e9;
        add_player(k_player, {HandSide::left, HandSide::right});
    }
    void add_player(Entity player, std::initializer_list<HandSide> order) {
        origin.add(player);
        head.add(player);
        commands.add(player);
        for (const HandSide side : order) {
            const Entity entity = hand_of(player, side);
            owner.add(entity, {player, side});
            joint.add(entity);
            hand.add(entity);
            history.add(entity);
        }
    }
    static Entity hand_of(Entity player, HandSide side) {
        return entity(player.slot + 1 + static_cast<std::uint32_t>(index_of(side)));
    }
    const HeadTracking& player_head() const { return head.at(k_player); }
    const HandTracking& right() const { return hand.at(hand_of(k_player, HandSide::right)); }
    const HandTracking& left() const { return hand.at(hand_of(k_player, HandSide::left)); }

    void step_inputs(std::span<const PlayerInput> inputs, double dt_s = k_frame_s) {
        stats = {};
        read_tracking({.inputs = inputs,
                       .frame_start_s = t_s,
                       .frame_end_s = t_s + dt_s,
                       .origin = origin,
                       .owner = owner,
                       .controller_to_hand = joint,
                       .recenter_guess = recenter_guess,
                       .grab = grab,
                       .head = head,
                       .hand = hand,
                       .history = history,
                       .commands = commands},
                      tuning, stats);
        t_s += dt_s;
    }
    void step(const std::vector<TrackingSample>& samples, double dt_s = k_frame_s) {
        const PlayerInput input{k_player, samples, {}};
        step_inputs(std::span(&input, 1), dt_s);
    }
};

}  // namespace handhold::test
