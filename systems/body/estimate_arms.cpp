// The talk's rows 19 to 22 with a fitted correction: docs/decisions/0091-fitted-body-estimate.md.
#include "systems/body/estimate_arms.hpp"

#include <algorithm>
#include <array>

#include "engine/core/parallel.hpp"
#include "engine/math/scalar_rotation.hpp"
#include "systems/body/shared/estimate_body.hpp"
#include "systems/body/shared/level_direction.hpp"
#include "systems/body/shared/lie_down.hpp"
#include "systems/body/shared/rest_hand.hpp"

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
        memory.arms[side].cleared_known = memory.arms[side].cleared_known && !reset;
        memory.arms[side].hand_ps = out.arms[side].hand_ps;
    }
}

// Replaces the hands of `body` by where they are shown, if they are lost or come back.
void place_lost_hands(const EstimateStep& frame, const ArmEstimate& estimate, TrackedBody& body,
                      ArmMemory& memory) {
    const auto is_exact = [&](std::size_t side) {
        return estimate.arms[side].goal != ArmGoal::rest && !memory.arms[side].rest.is_away &&
               memory.arms[side].rest.share == 0.0;
    };
    if (is_exact(0) && is_exact(1)) {
        return;
    }
    const BodyAxes axes = axes_of(body);
    const Vec3 look_ps =
        memory.known ? memory.looks_ps[0] : level_look(-axes.head.col(2), axes.head.col(1));
    const Pose view_ps = view_frame(body.head_ps.position, look_ps);
    const Pose view_before_ps = view_frame(memory.head_ps.position, look_ps);
    const double lying = trunk_view(body, axes).lying;
    for (const HandSide side : {HandSide::left, HandSide::right}) {
        const ArmGoal goal = estimate.arms[index_of(side)].goal;
        ArmMemory::Arm& arm = memory.arms[index_of(side)];
        if (!memory.known) {
            start_hand(goal, arm.rest);
        }
        Pose& hand_ps = body.hands_ps[index_of(side)];
        hand_ps = place_hand({goal, hand_ps, rest_hand(side, view_ps, lying, body), view_ps,
                              arm.hand_ps, view_before_ps},
                             frame.scale, frame.dt_s, arm.rest);
    }
}

// Writes the palms' poses to the estimates, in play space, and what the arms reach for.
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
        ArmEstimate::Arm& arm = estimate->arms[index_of(owner.side)];
        arm.hand_ps = {inverse_transform_point(*origin_ws, palm_ws.position),
                       unit_quat(turn.w(), turn.x(), turn.y(), turn.z())};
        const Entity hand = io.owner.owners()[index];
        arm.goal = arm_goal(io.grab.at(hand), io.hand.at(hand));
    }
}

// Shows the palms of hands that are at rest, or on their way to it or back, where the arms end.
void give_hands(const EstimateArmsIo& io) {
    for (std::size_t index = 0; index < io.owner.size(); ++index) {
        const HandOwner& owner = io.owner.elements()[index];
        const HandRest& rest = io.memory.at(owner.player).arms[index_of(owner.side)].rest;
        if (rest.is_away || rest.share > 0.0) {
            io.palm.at(io.owner.owners()[index]).pose_ws =
                io.origin.at(owner.player).pose_ws *
                io.estimate.at(owner.player).arms[index_of(owner.side)].hand_ps;
        }
    }
}

}  // namespace

void estimate_arms(const EstimateArmsIo& io, const ArmTuning& tuning) {
    take_hands(io);
    const EstimateStep step = estimate_step(io.dt_s, 1.0, tuning);
    constexpr std::size_t k_players_per_slice = 16;
    parallel_each(io.estimate.size(), k_players_per_slice, [&](std::size_t index) {
        const Entity player = io.estimate.owners()[index];
        ArmMemory* const memory = io.memory.find(player);
        const HeadTracking* const head = io.head.find(player);
        const BodyMeasures* const measures = io.measures.find(player);
        if (memory != nullptr && head != nullptr && measures != nullptr) {
            ArmEstimate& out = io.estimate.elements()[index];
            TrackedBody body{head->pose_ps,
                             {out.arms[0].hand_ps, out.arms[1].hand_ps},
                             *measures,
                             head->shift_m.y()};
            const auto estimate_at = [&](const EstimateStep& frame) {
                place_lost_hands(frame, out, body, *memory);
                estimate_player(body, frame, *memory, out);
            };
            const double scale = io.origin.at(player).scale;
            if (scale == 1.0) {
                estimate_at(step);
            } else {
                ArmTuning own = tuning;
                own.shoulder_follow_m *= scale;
                estimate_at(estimate_step(io.dt_s, scale, own));
            }
        }
    });
    give_hands(io);
}

}  // namespace handhold
