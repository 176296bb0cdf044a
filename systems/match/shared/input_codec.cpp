#include "systems/match/shared/input_codec.hpp"

#include <algorithm>
#include <bit>
#include <cstdlib>
#include <utility>

namespace handhold {
namespace {

using Triple = std::array<std::int32_t, 3>;
using PosesBefore = std::array<const PackedPose*, 3>;

Triple rotation_of(const PackedPose& pose) {
    return {pose.rotation[0], pose.rotation[1], pose.rotation[2]};
}

// What the next value would be if the last difference continued.
Triple continued(const Triple& newest, const Triple& before) {
    return {2 * newest[0] - before[0], 2 * newest[1] - before[1], 2 * newest[2] - before[2]};
}

// Rice parameter for differences of the mean size of `last`.
unsigned rice_of(const Triple& last) {
    const auto sum = static_cast<std::uint32_t>(std::abs(last[0])) +
                     static_cast<std::uint32_t>(std::abs(last[1])) +
                     static_cast<std::uint32_t>(std::abs(last[2]));
    constexpr unsigned k_most = 24;
    return std::min(k_most, static_cast<unsigned>(std::bit_width(sum / 3)));
}
Triple difference(const Triple& a, const Triple& b) {
    return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}

// Predicted value of a triple, and the Rice parameter of its difference.
struct Forecast {
    Triple value;
    unsigned k = 0;
};
Forecast forecast(const Triple& newest, const Triple& middle, const Triple& oldest) {
    return {continued(newest, middle), rice_of(difference(newest, continued(middle, oldest)))};
}
Forecast forecast_position(const PosesBefore& before) {
    return forecast(before[0]->position, before[1]->position, before[2]->position);
}
// Components mean the same only if the same one was left out.
Forecast forecast_rotation(const PosesBefore& before) {
    constexpr unsigned k_unknown = 4;
    const Triple newest = rotation_of(*before[0]);
    if (before[1]->largest != before[0]->largest) {
        return {newest, k_unknown};
    }
    const Triple middle = rotation_of(*before[1]);
    return before[2]->largest == before[0]->largest
               ? forecast(newest, middle, rotation_of(*before[2]))
               : Forecast{continued(newest, middle), k_unknown};
}

void write_triple(const Triple& value, const Forecast& predicted, BitWriter& out) {
    for (std::size_t i = 0; i < 3; ++i) {
        out.put_rice(fold_sign(value[i] - predicted.value[i]), predicted.k);
    }
}
// Fails for values beyond `most`.
Triple read_triple(const Forecast& predicted, std::int32_t most, BitReader& in) {
    Triple value{};
    for (std::size_t i = 0; i < 3; ++i) {
        const std::int64_t read =
            std::int64_t{predicted.value[i]} + unfold_sign(in.take_rice(predicted.k));
        if (read > most || read < -most) {
            in.fail();
            return {};
        }
        value[i] = static_cast<std::int32_t>(read);
    }
    return value;
}

void write_pose(const PosesBefore& before, const PackedPose& pose, BitWriter& out) {
    write_triple(pose.position, forecast_position(before), out);
    out.put_flag(pose.largest == before[0]->largest);
    if (pose.largest == before[0]->largest) {
        write_triple(rotation_of(pose), forecast_rotation(before), out);
        return;
    }
    out.put(pose.largest, 2);
    for (const std::int16_t part : pose.rotation) {
        out.put(static_cast<std::uint64_t>(part + PackedPose::k_most_rotation), 12);
    }
}
PackedPose read_pose(const PosesBefore& before, BitReader& in) {
    PackedPose pose;
    pose.position = read_triple(forecast_position(before), PackedPose::k_most_units, in);
    if (in.take_flag()) {
        pose.largest = before[0]->largest;
        const Triple rotation =
            read_triple(forecast_rotation(before), PackedPose::k_most_rotation, in);
        for (std::size_t i = 0; i < 3; ++i) {
            pose.rotation[i] = static_cast<std::int16_t>(rotation[i]);
        }
        return pose;
    }
    pose.largest = in.take_as<std::uint8_t>(2);
    for (std::int16_t& part : pose.rotation) {
        const auto read = in.take_as<std::int32_t>(12) - PackedPose::k_most_rotation;
        if (read > PackedPose::k_most_rotation) {
            in.fail();
            return pose;
        }
        part = static_cast<std::int16_t>(read);
    }
    return pose;
}

PosesBefore heads_of(const InputsBefore& before) {
    return {&before[0]->head, &before[1]->head, &before[2]->head};
}
PosesBefore hands_of(const InputsBefore& before, std::size_t side) {
    return {&before[0]->hands[side].pose, &before[1]->hands[side].pose,
            &before[2]->hands[side].pose};
}
// An edge lies between this tick and the one before: predicted as the pose of the tick before.
PosesBefore edges_of(const InputsBefore& before, std::size_t side) {
    const PackedPose* const pose = &before[0]->hands[side].pose;
    return {pose, pose, pose};
}

// Flags of the input in one number, and whether each hand has an edge.
std::uint32_t states_of(const MatchInput& input) {
    std::uint32_t bits = (input.is_head_tracked ? 1U : 0U) | (input.is_head_inferred ? 2U : 0U);
    unsigned shift = 2;
    for (const MatchHand& hand : input.hands) {
        bits |= (hand.is_tracked ? 1U : 0U) << shift;
        bits |= (hand.is_inferred ? 1U : 0U) << (shift + 1);
        bits |= (hand.grab ? 1U : 0U) << (shift + 2);
        bits |= (hand.edge_at != 0 ? 1U : 0U) << (shift + 3);
        shift += 4;
    }
    return bits;
}
constexpr unsigned k_state_bits = 10;
constexpr std::uint32_t k_edge_states = (1U << 5) | (1U << 9);

void write_analogs(const MatchInput& before, const MatchInput& input, BitWriter& out) {
    for (std::size_t side = 0; side < k_hand_count; ++side) {
        const MatchHand& was = before.hands[side];
        const MatchHand& is = input.hands[side];
        for (const auto& [old, now] :
             {std::pair{was.squeeze, is.squeeze}, std::pair{was.trigger, is.trigger}}) {
            out.put_flag(now != old);
            if (now != old) {
                out.put(now, 8);
            }
        }
        out.put_flag(is.curls != was.curls);
        if (is.curls != was.curls) {
            for (const std::uint8_t curl : is.curls) {
                out.put(curl, 8);
            }
        }
    }
}
void read_analogs(MatchInput& input, BitReader& in) {
    for (MatchHand& hand : input.hands) {
        for (std::uint8_t* const analog : {&hand.squeeze, &hand.trigger}) {
            if (in.take_flag()) {
                *analog = in.take_as<std::uint8_t>(8);
            }
        }
        if (in.take_flag()) {
            for (std::uint8_t& curl : hand.curls) {
                curl = in.take_as<std::uint8_t>(8);
            }
        }
    }
}
bool have_equal_analogs(const MatchInput& a, const MatchInput& b) {
    for (std::size_t side = 0; side < k_hand_count; ++side) {
        if (a.hands[side].squeeze != b.hands[side].squeeze ||
            a.hands[side].trigger != b.hands[side].trigger ||
            a.hands[side].curls != b.hands[side].curls) {
            return false;
        }
    }
    return true;
}

void write_commands(const MatchInput& before, const MatchInput& input, BitWriter& out) {
    out.put(static_cast<std::uint8_t>(input.smooth_turn), 8);
    out.put(static_cast<std::uint8_t>(input.snap_turns), 8);
    out.put(input.brake, 8);
    for (const std::int8_t axis : input.thrust) {
        out.put(static_cast<std::uint8_t>(axis), 8);
    }
    out.put_flag(input.calibrate);
    out.put_flag(input.buttons != before.buttons);
    if (input.buttons != before.buttons) {
        out.put(input.buttons, 32);
    }
}
void read_commands(MatchInput& input, BitReader& in) {
    const auto take_signed = [&in] {
        return std::bit_cast<std::int8_t>(in.take_as<std::uint8_t>(8));
    };
    input.smooth_turn = take_signed();
    input.snap_turns = take_signed();
    input.brake = in.take_as<std::uint8_t>(8);
    for (std::int8_t& axis : input.thrust) {
        axis = take_signed();
    }
    input.calibrate = in.take_flag();
    if (in.take_flag()) {
        input.buttons = in.take_as<std::uint32_t>(32);
    }
}
bool have_equal_commands(const MatchInput& a, const MatchInput& b) {
    return a.smooth_turn == b.smooth_turn && a.snap_turns == b.snap_turns && a.brake == b.brake &&
           a.thrust == b.thrust && a.calibrate == b.calibrate && a.buttons == b.buttons;
}

}  // namespace

void write_input(const InputsBefore& before, const MatchInput& input, BitWriter& out) {
    const std::uint32_t states = states_of(input);
    const bool has_states = states != (states_of(*before[0]) & ~k_edge_states);
    out.put_flag(has_states);
    if (has_states) {
        out.put(states, k_state_bits);
    }
    const bool has_analogs = !have_equal_analogs(*before[0], input);
    out.put_flag(has_analogs);
    if (has_analogs) {
        write_analogs(*before[0], input, out);
    }
    const bool has_commands = !have_equal_commands(*before[0], input);
    out.put_flag(has_commands);
    if (has_commands) {
        write_commands(*before[0], input, out);
    }
    if (input.is_head_tracked) {
        write_pose(heads_of(before), input.head, out);
    }
    for (std::size_t side = 0; side < k_hand_count; ++side) {
        const MatchHand& hand = input.hands[side];
        if (hand.is_tracked) {
            write_pose(hands_of(before, side), hand.pose, out);
        }
        if (hand.edge_at != 0) {
            out.put(hand.edge_at, 8);
            write_pose(edges_of(before, side), hand.edge_pose, out);
        }
    }
}

MatchInput read_input(const InputsBefore& before, BitReader& in) {
    MatchInput input = *before[0];
    const std::uint32_t states = in.take_flag() ? in.take_as<std::uint32_t>(k_state_bits)
                                                : states_of(input) & ~k_edge_states;
    if (in.take_flag()) {
        read_analogs(input, in);
    }
    if (in.take_flag()) {
        read_commands(input, in);
    }
    input.is_head_tracked = (states & 1U) != 0;
    input.is_head_inferred = (states & 2U) != 0;
    input.head = input.is_head_tracked ? read_pose(heads_of(before), in) : PackedPose{};
    for (std::size_t side = 0; side < k_hand_count; ++side) {
        MatchHand& hand = input.hands[side];
        const std::uint32_t of_hand = states >> (2 + 4 * side);
        hand.is_tracked = (of_hand & 1U) != 0;
        hand.is_inferred = (of_hand & 2U) != 0;
        hand.grab = (of_hand & 4U) != 0;
        hand.edge_at = 0;
        hand.edge_pose = {};
        hand.pose = hand.is_tracked ? read_pose(hands_of(before, side), in) : PackedPose{};
        if ((of_hand & 8U) != 0) {
            hand.edge_at = in.take_as<std::uint8_t>(8);
            hand.edge_pose = read_pose(edges_of(before, side), in);
            if (hand.edge_at == 0) {
                in.fail();
            }
        }
    }
    return input;
}

MatchInput normalised(const MatchInput& input) {
    MatchInput out = input;
    if (!out.is_head_tracked) {
        out.head = {};
    }
    for (MatchHand& hand : out.hands) {
        if (!hand.is_tracked) {
            hand.pose = {};
        }
        if (hand.edge_at == 0) {
            hand.edge_pose = {};
        }
    }
    return out;
}

}  // namespace handhold
