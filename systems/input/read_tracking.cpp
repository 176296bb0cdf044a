#include "systems/input/read_tracking.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <vector>

#include "components/hand_indices.hpp"
#include "components/scaled_tuning.hpp"
#include "engine/core/check.hpp"
#include "systems/input/shared/device_frame.hpp"
#include "systems/input/shared/hand_reader.hpp"
#include "systems/input/shared/play_space_tracker.hpp"

namespace handhold {
namespace {

constexpr double k_half_turn_rad = 3.14159265358979323846;

// Follows the samples up to the first one after the frame. The result is valid until the next call
// on this thread.
std::span<const FollowedSample> follow_samples(PlaySpaceTracker space,
                                               std::span<const TrackingSample> samples,
                                               double frame_end_s, const TrackingTuning& tuning) {
    constexpr std::size_t k_kept_samples = 64;  // memory that a thread keeps
    thread_local std::vector<FollowedSample> followed;
    if (followed.capacity() > k_kept_samples) {
        followed = std::vector<FollowedSample>();
    }
    followed.clear();
    for (const TrackingSample& sample : samples) {
        const PlaySpaceTracker::Jump jump = space.follow(sample, tuning);
        followed.push_back({&sample, space, jump});
        if (is_later(sample.t_s, frame_end_s)) {
            break;
        }
    }
    return followed;
}

void read_head(HeadTracking& head, std::span<const FollowedSample> samples,
               const ReadTrackingIo& io, const TrackingTuning& tuning, StageStats& stats) {
    bool has_sample = head.state != TrackingState::never;
    bool has_jumped = false;
    head.start_ps = head.pose_ps;
    Pose later;
    const Pose* later_or_null = nullptr;
    double later_t_s = 0.0;
    for (const auto& [followed, space, jump] : samples) {
        const TrackingSample& sample = *followed;
        const bool is_stale_now = is_stale(sample.t_s, has_sample, head.sample_t_s);
        if (is_later(sample.t_s, io.frame_end_s)) {
            if (is_trackable(sample.head_ps) && jump != PlaySpaceTracker::Jump::meant &&
                jump != PlaySpaceTracker::Jump::guess) {
                later = space.head_ps();
                later_or_null = &later;
                later_t_s = sample.t_s;
            }
            break;
        }
        if (is_stale_now) {
            stats.count(Fallback::sample_out_of_order);
        } else if (!is_trackable(sample.head_ps)) {
            stats.count(Fallback::sample_not_finite);
        } else {
            has_jumped = has_jumped || jump == PlaySpaceTracker::Jump::meant ||
                         jump == PlaySpaceTracker::Jump::guess;
            if (jump == PlaySpaceTracker::Jump::head ||
                jump == PlaySpaceTracker::Jump::play_space) {
                stats.count(jump == PlaySpaceTracker::Jump::head ? Fallback::head_recentred
                                                                 : Fallback::space_recentred);
            }
            head.shift_m = space.shift_m();
            head.shift_turn = space.shift_turn();
            head.before_ps = space.before_ps();
            head.before_t_s = space.before_t_s();
            head.sample_ps = space.head_ps();
            head.sample_t_s = sample.t_s;
            head.is_inferred = space.is_head_inferred();
            has_sample = true;
        }
    }
    finish_device(head, has_sample, later_or_null, later_t_s, io.frame_end_s, tuning.lost_after_s,
                  stats);
    if (has_jumped) {
        head.start_ps = head.pose_ps;  // no travel
    }
}

// Returns the input of a player; an empty one if this frame has none. Inputs are mostly in the
// order of the players, so the expected index is looked at first.
const PlayerInput& input_of(const ReadTrackingIo& io, Entity player, std::size_t expected) {
    static const PlayerInput k_silence{};
    if (expected < io.inputs.size() && io.inputs[expected].player == player) {
        return io.inputs[expected];
    }
    const auto found =
        std::find_if(io.inputs.begin(), io.inputs.end(),
                     [player](const PlayerInput& input) { return input.player == player; });
    return found == io.inputs.end() ? k_silence : *found;
}

// Clamps commands to their ranges. Numbers that are not finite become 0.
PlayerCommands finite_commands(PlayerCommands commands) {
    const auto bounded = [](double value, double low) {
        return std::isfinite(value) ? std::clamp(value, low, 1.0) : 0.0;
    };
    commands.smooth_turn = bounded(commands.smooth_turn, -1.0);
    commands.brake = bounded(commands.brake, 0.0);
    for (double& axis : commands.thrust_ps) {
        axis = bounded(axis, -1.0);
    }
    return commands;
}

Pose hand_in_controller(const ReadTrackingIo& io, Entity hand, HandSide side,
                        const HandTuning& tuning) {
    const ControllerToHand* const own = io.controller_to_hand.find(hand);
    return own != nullptr ? own->hand_in_controller : default_controller_to_hand(side, tuning);
}

// Indices in `io.owner` of a player's hands by side; the column's size where a hand is missing.
std::array<std::size_t, k_hand_count> hand_indices_of(const ReadTrackingIo& io, Entity player,
                                                      std::size_t player_index) {
    const std::size_t none = io.owner.size();
    std::array<std::size_t, k_hand_count> indices = {none, none};
    const std::size_t first = find_hand_index(io.owner, player, k_hand_count * player_index);
    if (first == none) {
        return indices;
    }
    for (const std::size_t index : {first, find_hand_index(io.owner, player, first + 1)}) {
        indices[index_of(io.owner.elements()[index].side)] = index;
    }
    return indices;
}

// True if one of the player's hands grips something that the player can pull on.
bool is_holding_on(const ReadTrackingIo& io, const std::array<std::size_t, k_hand_count>& indices) {
    return std::ranges::any_of(indices, [&](std::size_t index) {
        const Grab* const grab =
            index < io.owner.size() ? io.grab.find(io.owner.owners()[index]) : nullptr;
        return grab != nullptr && can_push_off(*grab);
    });
}

// Head and hands follow the same samples from the same state, so they agree on every correction.
void read_player(const ReadTrackingIo& io, std::size_t index, TuningOfPlayers& tunings,
                 StageStats& stats) {
    const Entity player = io.head.owners()[index];
    const PlayerOrigin& origin = io.origin.at(player);
    const Tuning& tuning = tunings.of(origin);
    HeadTracking& head = io.head.elements()[index];
    const PlayerInput& input = input_of(io, player, index);
    const std::array<std::size_t, k_hand_count> hand_indices = hand_indices_of(io, player, index);
    std::array<PlaySpaceTracker::Hand, k_hand_count> hands;
    for (const HandSide side : {HandSide::left, HandSide::right}) {
        const std::size_t hand_index = hand_indices[index_of(side)];
        if (hand_index < io.owner.size()) {
            const Entity entity = io.owner.owners()[hand_index];
            const HandTracking& hand = io.hand.at(entity);
            hands[index_of(side)] = {hand_in_controller(io, entity, side, tuning.hand),
                                     hand.reading_ps, hand.reading_t_s,
                                     hand.state != TrackingState::never};
        }
    }
    const RecenterGuess* const guess = io.recenter_guess.find(player);
    const bool holds_on = is_holding_on(io, hand_indices);
    const PlaySpaceTracker space(head, hands,
                                 {.corrects_jumps = guess == nullptr || guess->guesses,
                                  .freezes_guesses = holds_on,
                                  .scale = origin.scale});
    const std::span<const FollowedSample> samples =
        follow_samples(space, input.samples, io.frame_end_s, tuning.tracking);
    for (const HandSide side : {HandSide::left, HandSide::right}) {
        const std::size_t hand_index = hand_indices[index_of(side)];
        if (hand_index < io.owner.size()) {
            const Entity entity = io.owner.owners()[hand_index];
            const Grab* const grab = io.grab.find(entity);
            read_hand(
                {.frame_start_s = io.frame_start_s,
                 .frame_end_s = io.frame_end_s,
                 .side = side,
                 .scale = origin.scale,
                 .freezes_guesses = holds_on && grab != nullptr && grab->kind != GripKind::none,
                 .hand = io.hand.at(entity),
                 .history = io.history.at(entity)},
                samples, tuning, stats);
        }
    }
    read_head(head, samples, io, tuning.tracking, stats);
    if (PlayerCommands* const commands = io.commands.find(player)) {
        *commands = finite_commands(input.commands);
        commands->thrust_ps = head.shift_turn * commands->thrust_ps;
    }
}

}  // namespace

Pose default_controller_to_hand(HandSide side, const HandTuning& tuning) {
    const double outward = side == HandSide::right ? 1.0 : -1.0;
    Vec3 offset = tuning.controller_offset_m;
    offset.x() *= outward;
    // A fist around the handle: the back of the hand faces outward, the fingers' root points along
    // the controller.
    const Quat pitch = rotation_about(Vec3::UnitX(), tuning.controller_pitch_rad);
    const Quat roll = rotation_about(Vec3::UnitZ(), -0.5 * k_half_turn_rad * outward);
    return {offset, (pitch * roll).normalized()};
}

void read_tracking(const ReadTrackingIo& io, std::size_t first, std::size_t last,
                   const Tuning& tuning, StageStats& stats) {
    TuningOfPlayers tunings(tuning);
    for (std::size_t index = first; index < last; ++index) {
        read_player(io, index, tunings, stats);
    }
}

void read_tracking(const ReadTrackingIo& io, const Tuning& tuning, StageStats& stats) {
    HH_CHECK(io.frame_end_s > io.frame_start_s, "the frame has no length",
             io.frame_end_s - io.frame_start_s);
    read_tracking(io, 0, io.head.size(), tuning, stats);
}

}  // namespace handhold
