#include "systems/input/read_tracking.hpp"

#include <algorithm>
#include <cmath>

#include "engine/core/check.hpp"

namespace handhold {
namespace {

constexpr double k_half_turn_rad = 3.14159265358979323846;

// What a tracking system can mean: beyond this it is broken, whatever it says.
bool is_trackable(const Pose& pose_ps) {
    constexpr double k_farthest_m = 1e4;
    return is_valid(pose_ps) && pose_ps.position.cwiseAbs().maxCoeff() < k_farthest_m;
}

bool is_stale(double t_s, bool has_sample, double last_t_s) {
    constexpr double k_latest_s = 1e9;  // beyond it a time is no time: a snapshot refuses it too
    return !(std::abs(t_s) <= k_latest_s) || (has_sample && t_s <= last_t_s);
}

// A sample of no time at all is not one after the frame.
bool is_later(double t_s, double end_s) { return std::isfinite(t_s) && t_s > end_s; }

// Where a player's head is and how his readings are shifted, sample by sample: the same walk for
// his head and for each of his hands.
struct HeadWalk {
    Vec3 shift_m;
    Vec3 head_ps;  // of the last valid sample, shifted
    double t_s;    // its time
    bool has_sample;
    bool jumped = false;  // in the sample followed last

    explicit HeadWalk(const HeadTracking& head)
        : shift_m(head.shift_m),
          head_ps(head.sample_ps.position),
          t_s(head.sample_t_s),
          has_sample(head.state != TrackingState::never) {}

    // A head that is farther from the last sample than any head moves has been re-centred: from
    // here on all is shifted back to where it was.
    void follow(const TrackingSample& sample, double max_jump_m) {
        jumped = false;
        if (is_stale(sample.t_s, has_sample, t_s) || !is_trackable(sample.head_ps)) {
            return;
        }
        Vec3 next_ps = sample.head_ps.position + shift_m;
        if (has_sample && (next_ps - head_ps).norm() > max_jump_m) {
            jumped = true;
            shift_m += head_ps - next_ps;
            next_ps = head_ps;
        }
        head_ps = next_ps;
        t_s = sample.t_s;
        has_sample = true;
    }
    bool reaches(const Vec3& hand_ps, double max_arm_m) const {
        return !has_sample || (hand_ps - head_ps).norm() <= max_arm_m;
    }
};

// The same for the head and for hands: state and the pose at the end of the frame.
// `later` is the first pose after the frame's end, or null.
template <typename Device>
void finish_device(Device& device, bool has_sample, const Pose* later, double later_t_s,
                   double end_s, double lost_after_s, StageStats& stats) {
    if (!has_sample && later == nullptr) {
        return;  // never tracked
    }
    const bool first = device.state == TrackingState::never;
    if (has_sample && later != nullptr && later_t_s - device.sample_t_s > lost_after_s) {
        later = nullptr;  // nobody knows the way across a gap that long
    }
    if (!has_sample) {
        device.sample_ps =
            *later;  // the session begins between two samples: the later one is yet to come
        device.sample_t_s = end_s;
    }
    if (later == nullptr && end_s - device.sample_t_s > lost_after_s) {
        if (device.state != TrackingState::lost) {
            stats.count(Fallback::tracking_lost);
        }
        device.state = TrackingState::lost;
        return;
    }
    device.state = TrackingState::tracked;
    device.pose_ps = device.sample_ps;
    if (later != nullptr && later_t_s > device.sample_t_s && end_s > device.sample_t_s) {
        const double t = (end_s - device.sample_t_s) / (later_t_s - device.sample_t_s);
        device.pose_ps = interpolate(device.sample_ps, *later, std::clamp(t, 0.0, 1.0));
    }
    if (first) {
        device.start_ps = device.pose_ps;
    }
}

void remember(HandHistory& history, const HandTracking& hand) {
    history.entries[history.next] = {hand.sample_t_s, hand.sample_ps};
    history.next = (history.next + 1) % HandHistory::k_capacity;
    history.count = std::min<std::uint32_t>(history.count + 1, HandHistory::k_capacity);
}

// The window, made longer where it holds too short a time to measure a speed in: samples
// microseconds apart would turn a tenth of a millimetre of noise into metres a second.
double measured_window(const HandHistory& history, double t_s, double window_s) {
    constexpr double k_shortest_span_s = 0.005;
    constexpr int k_longest = 4;  // windows
    for (int times = 1; times < k_longest; ++times) {
        double oldest_s = t_s;
        for (std::uint32_t i = 0; i < history.count; ++i) {
            const double at_s = history.entries[i].t_s;
            oldest_s = at_s >= t_s - times * window_s && at_s < oldest_s ? at_s : oldest_s;
        }
        if (t_s - oldest_s >= k_shortest_span_s) {
            return times * window_s;
        }
    }
    return k_longest * window_s;
}

// Least-squares slope of position and rotation over the window before t_s. Two samples give their
// difference, one gives zero.
void measure_release(const HandHistory& history, double t_s, double window_s, HandTracking& hand) {
    double weight = 0.0;
    double mean_t = 0.0;
    const double from_s = t_s - measured_window(history, t_s, window_s);
    const auto for_window = [&](auto&& visit) {
        for (std::uint32_t i = 0; i < history.count; ++i) {
            const HandHistory::Entry& entry = history.entries[i];
            if (entry.t_s >= from_s && entry.t_s <= t_s) {
                visit(entry);
            }
        }
    };
    for_window([&](const HandHistory::Entry& entry) {
        weight += 1.0;
        mean_t += entry.t_s - t_s;
    });
    hand.release_velocity_ps_mps.setZero();
    hand.release_spin_ps_radps.setZero();
    if (weight < 2.0) {
        return;
    }
    mean_t /= weight;
    double spread = 0.0;
    Vec3 linear = Vec3::Zero();
    Vec3 angular = Vec3::Zero();
    for_window([&](const HandHistory::Entry& entry) {
        const double dt = entry.t_s - t_s - mean_t;
        spread += dt * dt;
        linear += dt * (entry.hand_ps.position - hand.edge_ps.position);
        angular +=
            dt * rotation_to_vector(entry.hand_ps.rotation * hand.edge_ps.rotation.conjugate());
    });
    constexpr double k_min_spread_s2 = 1e-6;
    if (spread > k_min_spread_s2) {
        hand.release_velocity_ps_mps = linear / spread;
        hand.release_spin_ps_radps = angular / spread;
    }
}

void begin_edge(HandTracking& hand, const HandHistory& history, double t_s, const Pose& hand_ps,
                const TrackingTuning& tuning) {
    hand.pressed = !hand.pressed;
    hand.edge = hand.pressed ? GrabEdge::onset : GrabEdge::release;
    hand.edge_t_s = t_s;
    hand.edge_ps = hand_ps;
    if (hand.edge == GrabEdge::release) {
        measure_release(history, t_s, tuning.release_window_s, hand);
    }
}

struct HandRows {
    HandTracking& hand;
    HandHistory& history;
    HeadWalk walk;  // from the end of the last frame
    Pose joint;     // hand in controller
    HandSide side;
};

void read_hand(HandRows rows, const PlayerInput& input, const ReadTrackingIo& io,
               const Tuning& tuning, StageStats& stats) {
    HandTracking& hand = rows.hand;
    HeadWalk& walk = rows.walk;
    const TrackingState before = hand.state;
    bool has_sample = hand.state != TrackingState::never;
    bool jumped = false;
    hand.start_ps = hand.pose_ps;
    hand.edge = GrabEdge::none;
    const bool may_begin_now =
        before == TrackingState::tracked || (before == TrackingState::lost && hand.pressed);
    if (hand.raw_pressed != hand.pressed && may_begin_now) {
        begin_edge(hand, rows.history, io.frame_start_s, hand.start_ps, tuning.tracking);
    }
    Pose later;
    const Pose* later_or_null = nullptr;
    double later_t_s = 0.0;
    for (const TrackingSample& sample : input.samples) {
        const ControllerSample& reading = sample.controllers[index_of(rows.side)];
        walk.follow(sample, tuning.tracking.max_jump_m);
        Pose hand_ps = reading.controller_ps * rows.joint;
        hand_ps.position += walk.shift_m;
        const bool is_seen = is_trackable(reading.controller_ps);
        const bool is_believed = is_seen && walk.reaches(hand_ps.position, tuning.hand.max_arm_m);
        const bool jumps = has_sample && (hand_ps.position - hand.sample_ps.position).norm() >
                                             tuning.tracking.max_jump_m;
        if (is_later(sample.t_s, io.frame_end_s)) {
            if (is_believed && !jumps) {
                later = hand_ps;
                later_or_null = &later;
                later_t_s = sample.t_s;
            }
            break;
        }
        if (is_stale(sample.t_s, has_sample, hand.sample_t_s)) {
            continue;  // counted once a player, by the head
        }
        hand.raw_pressed = reading.grab;
        if (is_believed) {
            if (jumps) {
                jumped = true;
                rows.history.count = rows.history.next = 0;
                if (hand.edge == GrabEdge::onset) {  // it closes where it is now
                    hand.edge_ps = hand_ps;
                    hand.edge_t_s = std::max(sample.t_s, io.frame_start_s);
                }
            }
            hand.sample_ps = hand_ps;
            hand.sample_t_s = sample.t_s;
            has_sample = true;
            remember(rows.history, hand);
        } else {
            stats.count(is_seen ? Fallback::hand_out_of_reach : Fallback::sample_not_finite);
        }
        // A hand that cannot be seen may let go, but waits with closing until it is seen again.
        const bool may_begin = has_sample && (is_believed || !reading.grab);
        if (may_begin && reading.grab != hand.pressed && hand.edge == GrabEdge::none) {
            begin_edge(hand, rows.history, std::max(sample.t_s, io.frame_start_s), hand.sample_ps,
                       tuning.tracking);
        }
    }
    finish_device(hand, has_sample, later_or_null, later_t_s, io.frame_end_s,
                  tuning.tracking.lost_after_s, stats);
    hand.resumed = hand.state == TrackingState::tracked &&
                   (before == TrackingState::lost || (jumped && before != TrackingState::never));
    if (hand.resumed) {
        hand.start_ps = hand.pose_ps;
    }
}

void read_head(HeadTracking& head, const PlayerInput& input, const ReadTrackingIo& io,
               const TrackingTuning& tuning, StageStats& stats) {
    HeadWalk walk(head);
    bool has_sample = walk.has_sample;
    head.start_ps = head.pose_ps;
    Pose later;
    const Pose* later_or_null = nullptr;
    double later_t_s = 0.0;
    for (const TrackingSample& sample : input.samples) {
        const bool is_stale_now = is_stale(sample.t_s, has_sample, head.sample_t_s);
        walk.follow(sample, tuning.max_jump_m);
        const Pose head_ps{walk.head_ps, sample.head_ps.rotation.normalized()};
        if (is_later(sample.t_s, io.frame_end_s)) {
            if (is_trackable(sample.head_ps)) {
                later = head_ps;
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
            if (walk.jumped) {
                stats.count(Fallback::head_recentred);
            }
            head.shift_m = walk.shift_m;
            head.sample_ps = head_ps;
            head.sample_t_s = sample.t_s;
            has_sample = true;
        }
    }
    finish_device(head, has_sample, later_or_null, later_t_s, io.frame_end_s, tuning.lost_after_s,
                  stats);
}

// No samples and no commands for a player whom nothing is known of in this frame. Inputs mostly
// come in the order of the players: the expected place is looked at first.
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

// Commands within their ranges; numbers that are not finite ask for nothing.
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

void read_tracking(const ReadTrackingIo& io, const Tuning& tuning, StageStats& stats) {
    HH_CHECK(io.frame_end_s > io.frame_start_s, "the frame has no length",
             io.frame_end_s - io.frame_start_s);
    const Pose joints[k_hand_count] = {default_controller_to_hand(HandSide::left, tuning.hand),
                                       default_controller_to_hand(HandSide::right, tuning.hand)};
    for (std::size_t row = 0; row < io.commands.size(); ++row) {
        io.commands.rows()[row] =
            finite_commands(input_of(io, io.commands.owners()[row], row).commands);
    }
    // Hands first: they follow the head from where the last frame left it.
    for (std::size_t row = 0; row < io.owner.size(); ++row) {
        const Entity entity = io.owner.owners()[row];
        const HandOwner& owner = io.owner.rows()[row];
        const ControllerToHand* const own = io.controller_to_hand.find(entity);
        const HandRows rows{
            io.hand.at(entity), io.history.at(entity), HeadWalk(io.head.at(owner.player)),
            own != nullptr ? own->hand_in_controller : joints[index_of(owner.side)], owner.side};
        read_hand(rows, input_of(io, owner.player, row / k_hand_count), io, tuning, stats);
    }
    for (std::size_t row = 0; row < io.head.size(); ++row) {
        read_head(io.head.rows()[row], input_of(io, io.head.owners()[row], row), io,
                  tuning.tracking, stats);
    }
}

}  // namespace handhold
