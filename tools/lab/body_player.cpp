#include "tools/lab/body_player.hpp"

#include <numbers>
#include <utility>

#include "systems/body/clear_arms.hpp"
#include "systems/body/estimate_arms.hpp"
#include "systems/body/estimate_sizes.hpp"
#include "systems/body/layer_additives.hpp"
#include "systems/body/limit_feet.hpp"
#include "systems/body/limit_pelvis.hpp"
#include "systems/body/pose_arms.hpp"
#include "systems/body/propagate_spine.hpp"
#include "tools/lab/body_baselines.hpp"

namespace handhold::lab {

BodyPlayer::BodyPlayer(std::string estimator, BodyClips clips)
    : estimator_(std::move(estimator)), clips_(std::move(clips)) {
    EntityPool pool;
    player_ = pool.create();
    origin_.add(player_);
    velocity_.add(player_);
    reference_.add(player_);
    head_.add(player_);
    measures_.add(player_);
    calibration_.add(player_);
    size_.add(player_);
    memory_.add(player_);
    estimate_.add(player_);
    arms_.add(player_);
    shown_estimate_.add(player_);
    shown_arms_.add(player_);
    spine_memory_.add(player_);
    shown_spine_.add(player_);
    clip_state_.add(player_);
    for (std::size_t side = 0; side < k_hand_count; ++side) {
        hands_[side] = pool.create();
        owner_.add(hands_[side], {player_, side == 0 ? HandSide::left : HandSide::right});
        palm_.add(hands_[side]);
        tracking_.add(hands_[side]);
        grab_.add(hands_[side]);
    }
}

void BodyPlayer::start(const std::optional<BodyMeasures>& measures) {
    measures_.at(player_) = measures.value_or(BodyMeasures{});
    size_.at(player_) = {.is_measured = measures.has_value()};
    memory_.at(player_) = {};
    spine_memory_.at(player_) = {};
    clip_state_.at(player_) = {};
    for (const Entity hand : hands_) {
        tracking_.at(hand).state = TrackingState::never;
        palm_.at(hand) = {};
    }
}

void BodyPlayer::step(const BodySample& sample, double dt_s) {
    head_.at(player_).pose_ps = sample.head_ps;
    head_.at(player_).state = TrackingState::tracked;
    place_hands(sample);
    estimate_sizes({.dt_s = dt_s,
                    .origin = origin_,
                    .head = head_,
                    .owner = owner_,
                    .hand = tracking_,
                    .calibration = calibration_,
                    .size = size_,
                    .measures = measures_});
    estimate(sample, dt_s);
    pose(estimate_, arms_);
    show(dt_s);
}

void BodyPlayer::place_hands(const BodySample& sample) {
    for (std::size_t side = 0; side < k_hand_count; ++side) {
        // The runtime freezes a lost hand; estimate_arms then shows it elsewhere.
        HandTracking& tracking = tracking_.at(hands_[side]);
        if (!sample.is_lost[side]) {
            tracking.pose_ps = sample.hands_ps[side];
            tracking.state = TrackingState::tracked;
        } else if (tracking.state == TrackingState::tracked) {
            tracking.state = TrackingState::lost;
        }
        palm_.at(hands_[side]).pose_ws = tracking.pose_ps;
        estimate_.at(player_).arms[side].hand_ps = tracking.pose_ps;
    }
}

void BodyPlayer::estimate(const BodySample& sample, double dt_s) {
    const BodyMeasures& measures = measures_.at(player_);
    ArmEstimate& out = estimate_.at(player_);
    if (estimator_ == "naive") {
        estimate_naive(sample.head_ps, measures, out);
    } else if (estimator_ == "talk") {
        estimate_as_talked(sample.head_ps, measures, out);
    } else {
        estimate_arms({.dt_s = dt_s,
                       .origin = origin_,
                       .head = head_,
                       .measures = measures_,
                       .owner = owner_,
                       .hand = tracking_,
                       .grab = grab_,
                       .palm = palm_,
                       .memory = memory_,
                       .estimate = estimate_},
                      {});
    }
}

void BodyPlayer::pose(const Column<ArmEstimate>& estimate, Column<ArmPose>& arms) const {
    pose_arms({.origin = origin_,
               .measures = measures_,
               .owner = owner_,
               .palm = palm_,
               .estimate = estimate,
               .arms = arms});
}

void BodyPlayer::show(double dt_s) {
    t_s_ += dt_s;
    shown_estimate_.at(player_) = estimate_.at(player_);
    layer_clavicles({.clips = clips_, .measures = measures_, .estimate = shown_estimate_}, {}, {});
    pose(shown_estimate_, shown_arms_);
    propagate_spine({.dt_s = dt_s,
                     .t_s = t_s_,
                     .surfaces = {},
                     .persistent_id = {},
                     .origin = origin_,
                     .velocity = velocity_,
                     .reference = reference_,
                     .head = head_,
                     .measures = measures_,
                     .estimate = shown_estimate_,
                     .owner = owner_,
                     .grab = grab_,
                     .body_hold = {},
                     .memory = spine_memory_,
                     .pose = shown_spine_},
                    {});
    layer_additives({.dt_s = dt_s,
                     .clips = clips_,
                     .head = head_,
                     .origin = origin_,
                     .velocity = velocity_,
                     .reference = reference_,
                     .owner = owner_,
                     .grab = grab_,
                     .estimate = shown_estimate_,
                     .memory = spine_memory_,
                     .state = clip_state_,
                     .pose = shown_spine_},
                    {});
    limit_pelvis({.dt_s = dt_s, .origin = origin_, .memory = spine_memory_, .pose = shown_spine_});
    limit_feet({.dt_s = dt_s, .origin = origin_, .memory = spine_memory_, .pose = shown_spine_});
    clear_arms({.dt_s = dt_s,
                .measures = measures_,
                .spine = shown_spine_,
                .memory = memory_,
                .arms = shown_arms_});
}

double BodyPlayer::chest_yaw_deg() const {
    const Vec3& ahead = estimate_.at(player_).facing_ps;
    return arc_tangent2(-ahead.x(), -ahead.z()) * 180.0 / std::numbers::pi;
}

double BodyPlayer::arm_ratio(HandSide side) const {
    const ArmPose::Arm& arm = arms().arms[index_of(side)];
    const BodyMeasures& measures = measures_.at(player_);
    const double drawn_m = (arm.forearm_ws.position - arm.upper_ws.position).norm() +
                           (arm.hand_ws.position - arm.forearm_ws.position).norm();
    return drawn_m / (measures.upper_arm_m + measures.forearm_m);
}

}  // namespace handhold::lab
