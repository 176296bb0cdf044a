// The talk's rows 19 to 22 with a fitted correction: docs/decisions/0091-fitted-body-estimate.md.
#include "systems/body/estimate_arms.hpp"

#include <algorithm>
#include <array>

#include "engine/core/parallel.hpp"
#include "engine/math/scalar_rotation.hpp"
#include "systems/body/shared/estimate_body.hpp"

namespace handhold {
namespace {

Pose between(const Pose& a, const Pose& b, double share) {
    const double sign = a.rotation.dot(b.rotation) < 0.0 ? -share : share;
    const Quat::Coefficients mixed =
        (1.0 - share) * a.rotation.coeffs() + sign * b.rotation.coeffs();
    return {a.position + share * (b.position - a.position),
            unit_quat(mixed[3], mixed[0], mixed[1], mixed[2])};
}

// Divides frames much longer than k_step_s into steps, with head and hands interpolated linearly.
// The state then evolves nearly equally at any frame rate down to 10 Hz. k_round_up ensures that
// the number of steps does not change at the frame length of a usual frame rate.
void estimate_player(const TrackedBody& now, const EstimateStep& frame, ArmMemory& memory,
                     ArmEstimate& out) {
    constexpr double k_step_s = 1.0 / 90.0;
    constexpr double k_max_steps = 9.0;
    constexpr double k_round_up = 0.3;
    const double dt_s = frame.dt_s;
    const bool reset = !memory.known ||
                       has_jumped(memory.head_ps.position, now.head_ps.position, frame.scale, dt_s);
    const int steps =
        reset ? 1 : static_cast<int>(std::clamp(dt_s / k_step_s + k_round_up, 1.0, k_max_steps));
    if (steps > 1) {
        TrackedBody before{memory.head_ps,
                           {memory.arms[0].hand_ps, memory.arms[1].hand_ps},
                           now.measures,
                           now.floor_m};
        for (std::size_t side = 0; side < k_hand_count; ++side) {
            if (has_jumped(before.hands_ps[side].position, now.hands_ps[side].position, frame.scale,
                           dt_s)) {
                before.hands_ps[side] = now.hands_ps[side];
            }
        }
        const EstimateStep step = estimate_step(dt_s / steps, frame.scale, frame.tuning);
        for (int i = 1; i < steps; ++i) {
            const double share = static_cast<double>(i) / steps;
            const TrackedBody then{between(before.head_ps, now.head_ps, share),
                                   {between(before.hands_ps[0], now.hands_ps[0], share),
                                    between(before.hands_ps[1], now.hands_ps[1], share)},
                                   now.measures,
                                   now.floor_m};
            estimate_body(then, step, false, memory, out);
        }
        estimate_body(now, step, false, memory, out);
    } else {
        estimate_body(now, frame, reset, memory, out);
    }
    memory.known = true;
    memory.head_ps = now.head_ps;
    for (std::size_t side = 0; side < k_hand_count; ++side) {
        memory.arms[side].hand_ps = now.hands_ps[side];
    }
}

// Writes the palms' poses to the estimates, in play space.
void take_hands(const EstimateArmsIo& io) {
    Entity player = k_no_entity;
    const Pose* origin_ws = nullptr;
    ArmEstimate* estimate = nullptr;
    for (std::size_t index = 0; index < io.owner.size(); ++index) {
        const HandOwner& owner = io.owner.elements()[index];
        if (owner.player != player) {  // a player's hands are usually adjacent
            player = owner.player;
            origin_ws = &io.origin.at(player).pose_ws;
            estimate = &io.estimate.at(player);
        }
        const Pose& palm_ws = io.palm.at(io.owner.owners()[index]).pose_ws;
        const Quat turn = product(origin_ws->rotation.conjugate(), palm_ws.rotation);
        estimate->arms[index_of(owner.side)].hand_ps = {
            inverse_transform_point(*origin_ws, palm_ws.position),
            unit_quat(turn.w(), turn.x(), turn.y(), turn.z())};
    }
}

}  // namespace

void estimate_arms(const EstimateArmsIo& io, const ArmTuning& tuning) {
    take_hands(io);
    const EstimateStep step = estimate_step(io.dt_s, 1.0, tuning);
    constexpr std::size_t k_players_per_slice = 16;
    const auto estimate = [&](std::size_t /*slice*/, std::size_t first, std::size_t last) {
        for (std::size_t index = first; index < last; ++index) {
            const Entity player = io.estimate.owners()[index];
            ArmMemory* const memory = io.memory.find(player);
            const HeadTracking* const head = io.head.find(player);
            const BodyMeasures* const measures = io.measures.find(player);
            if (memory != nullptr && head != nullptr && measures != nullptr) {
                ArmEstimate& out = io.estimate.elements()[index];
                const TrackedBody body{head->pose_ps,
                                       {out.arms[0].hand_ps, out.arms[1].hand_ps},
                                       *measures,
                                       head->shift_m.y()};
                const double scale = io.origin.at(player).scale;
                if (scale == 1.0) {
                    estimate_player(body, step, *memory, out);
                } else {
                    ArmTuning own = tuning;
                    own.shoulder_follow_m *= scale;
                    estimate_player(body, estimate_step(io.dt_s, scale, own), *memory, out);
                }
            }
        }
    };
    parallel_slices(io.estimate.size(), k_players_per_slice, estimate);
}

}  // namespace handhold
