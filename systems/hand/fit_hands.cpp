#include "systems/hand/fit_hands.hpp"

#include <algorithm>
#include <cmath>

#include "systems/hand/shared/finger_chain.hpp"
#include "systems/hand/shared/hand_fit.hpp"
#include "systems/hand/shared/outside_surfaces.hpp"
#include "systems/hand/shared/thumb_closing.hpp"
#include "systems/rigs/authored_hand.hpp"
#include "systems/rigs/hand_kinematics.hpp"

namespace handhold {
namespace {

constexpr std::int32_t k_closing_rounds = 10;
// Rounds from a closing of a hand that has a fit to the same body; the following frames continue.
constexpr std::int32_t k_closing_again_rounds = 2;
// Rounds from the last fit; the following frames continue.
constexpr std::int32_t k_rounds = 1;
constexpr double k_max_flex_rad = 0.15;  // largest step of an angle in a round from the last fit
constexpr double k_deep_m = 3e-3;        // a fit that penetrates deeper is counted, or given up

// How far a digit of an empty hand is closed: 0 at rest, 1 in a fist.
double closed_share(const HandTracking& hand, FingerName digit) {
    if (hand.pressed) {
        return 1.0;
    }
    return digit == FingerName::index ? std::max(hand.squeeze, hand.trigger) : hand.squeeze;
}

// Curl of a straight digit's hinge, radians.
double straight_rad(const FingerRig& finger, std::size_t link) {
    return std::clamp(0.0, finger.lower_rad[link], finger.upper_rad[link]);
}

// Angles of an empty hand's digit: as its curl says where that is known, else between the rest pose
// and a fist.
FingerAngles empty_angles(const FingerRig& finger, const HandTracking& hand,
                          const ThumbTuning& tuning) {
    const double curl = hand.curls[static_cast<std::size_t>(finger.name)];
    const bool is_known = curl >= 0.0;
    const double closed = is_known ? curl : closed_share(hand, finger.name);
    FingerAngles angles;
    for (std::size_t i = 0; i < finger.link_count; ++i) {
        const double open_rad = is_known ? straight_rad(finger, i) : finger.rest_rad[i];
        angles.curl_rad[i] = open_rad + closed * (finger.fist.curl_rad[i] - open_rad);
    }
    if (finger.name == FingerName::thumb) {
        const double open_rad = rest_opposition_rad(finger, tuning);
        angles.opposition_rad = open_rad + closed * (finger.fist.opposition_rad - open_rad);
    }
    return angles;
}

// The tracked wrist of a fist, moved to the player's side of surfaces, then until the fist touches
// what it grips, unless that would be behind another surface.
Pose fist_wrist_bs(const HandSurroundings& hand, const FingerPose& pose, double reach_m) {
    const HandPose outside = {wrist_outside_bs(hand, {hand.wrist_bs, pose.target}), pose.target};
    HandPose touching = outside;
    touching.wrist_bs.position += displacement_to_touch(hand, outside, reach_m);
    return is_outside(hand, touching) ? touching.wrist_bs : outside.wrist_bs;
}

void pose_unsupported_hand(const HandSurroundings& hand, const HandTracking& tracking,
                           const Tuning& tuning, PalmOffset& offset, FingerPose& pose) {
    for (std::size_t f = 0; f < hand.rig->fingers.size(); ++f) {
        const FingerRig& finger = hand.rig->fingers[f];
        if (pose.is_authored[f]) {
            pose.target[f] = pose.closed[f];
        } else {
            pose.target[f] =
                hand.is_gripping ? finger.fist : empty_angles(finger, tracking, tuning.thumb);
        }
    }
    offset.target_m = offset.held_m;
    offset.target_turn_rad = offset.held_turn_rad;
    if (hand.authored == nullptr && !hand.meshes.empty()) {
        const Pose fist_bs = fist_wrist_bs(hand, pose, tuning.palm.reach_m);
        offset.target_m = inverse_transform_point(hand.wrist_bs, fist_bs.position);
    }
    pose.fitted_body = k_no_entity;
    pose.is_converged = false;
}

HandFitGoal common_goal(const HandSurroundings& hand, const FingerPose& pose,
                        const ThumbTuning& tuning) {
    HandFitGoal goal;
    for (const FingerRig& finger : hand.rig->fingers) {
        if (finger.name == FingerName::thumb) {
            goal.rest_opposition_rad = rest_opposition_rad(finger, tuning);
        }
    }
    goal.touches = pose.touches;
    goal.is_fixed = pose.is_authored;
    goal.is_wrist_fixed = hand.authored != nullptr;
    return goal;
}

// Starts at the palm within its limits and the closed digits. `is_first`: of the grip.
HandFit fit_closed(const HandSurroundings& hand, const GripSurface& surface,
                   const PalmOffset& offset, const FingerPose& pose, bool is_first,
                   const Tuning& tuning, std::vector<PenaltyRow>& rows) {
    HandFitGoal goal = common_goal(hand, pose, tuning.thumb);
    goal.first = {held_wrist_bs(hand, offset), pose.closed};
    goal.is_clear = pose.is_closed_clear;
    goal.rounds = is_first ? k_closing_rounds : k_closing_again_rounds;
    return fit_hand(hand, surface, goal, tuning.palm, rows);
}

// A thumb that the closing left in a bad place is moved in the frames after it, one try in each.
bool tries_thumb(const HandSurroundings& hand, const FingerPose& pose) {
    return pose.thumbs_tried < k_thumb_tries && hand.authored == nullptr &&
           std::ranges::any_of(hand.rig->fingers, can_oppose);
}

// Starts at the last fit, carried along with the tracked wrist.
HandFit fit_last(const HandSurroundings& hand, const GripSurface& surface, const PalmOffset& offset,
                 const FingerPose& pose, const Tuning& tuning, std::vector<PenaltyRow>& rows) {
    HandFitGoal goal = common_goal(hand, pose, tuning.thumb);
    const Pose target{offset.target_m, rotation_from_vector(offset.target_turn_rad)};
    goal.first = {goal.is_wrist_fixed ? held_wrist_bs(hand, offset) : hand.wrist_bs * target,
                  pose.target};
    for (std::size_t f = 0; f < hand.rig->fingers.size(); ++f) {
        if (pose.is_authored[f]) {  // other digits do not move with the trigger
            goal.first.fingers[f] = pose.closed[f];
        }
    }
    goal.is_clear = pose.is_clear;
    goal.rounds = k_rounds;
    goal.max_flex_rad = k_max_flex_rad;
    if (tries_thumb(hand, pose)) {
        goal.thumb_try = static_cast<std::int32_t>(pose.thumbs_tried);
    }
    return fit_hand(hand, surface, goal, tuning.palm, rows);
}

struct BestFit {
    HandFit fit;
    bool is_of_closing = false;
};

BestFit best_fit(const HandSurroundings& hand, const GripSurface& surface, const Tuning& tuning,
                 const PalmOffset& offset, const FingerPose& pose, std::vector<PenaltyRow>& rows) {
    if (!pose.is_newly_closed) {
        return {fit_last(hand, surface, offset, pose, tuning, rows)};
    }
    const bool has_last = pose.fitted_body == hand.body && hand.authored == nullptr;
    HandFit closed = fit_closed(hand, surface, offset, pose, !has_last, tuning, rows);
    if (!has_last) {
        return {closed, true};
    }
    HandFit last = fit_last(hand, surface, offset, pose, tuning, rows);
    const bool changes = closed.cost < k_change_cost_share * last.cost;
    return {changes ? closed : last, changes};
}

// True if the hand keeps its last fit; the surroundings are unchanged. A hand at rest is fitted
// until the fit has converged.
bool sticks(const HandSurroundings& hand, const FingerTuning& tuning, const FingerPose& pose) {
    const double travel_m = hand_travel_m(pose.fitted_wrist_bs, hand.wrist_bs);
    return travel_m < tuning.reuse_travel_m ? pose.is_converged
                                            : hand.authored == nullptr && travel_m < k_stick_m;
}

void fit_one(const HandSurroundings& hand, const GripSurface& surface, const Tuning& tuning,
             StageStats& stats, PalmOffset& offset, FingerPose& pose,
             std::vector<PenaltyRow>& rows) {
    if (!pose.is_newly_closed && !tries_thumb(hand, pose) &&
        pose.fitted_signature == hand.signature && sticks(hand, tuning.finger, pose)) {
        return;
    }
    const auto [fit, is_of_closing] = best_fit(hand, surface, tuning, offset, pose, rows);
    const Pose target = inverse(hand.wrist_bs) * fit.pose.wrist_bs;
    offset.target_m = target.position;
    offset.target_turn_rad = rotation_to_vector(target.rotation);
    pose.target = fit.pose.fingers;
    for (std::size_t f = 0; f < hand.rig->fingers.size(); ++f) {
        pose.is_clear[f] = fit.gap_m[f] > -clear_depth_m(hand.rig->fingers[f]);
    }
    if (pose.is_newly_closed && fit.penetration_m > k_deep_m) {
        stats.count(Fallback::hand_penetrates);
    }
    if (is_of_closing) {
        pose.thumbs_tried = 0;
    } else if (tries_thumb(hand, pose)) {
        ++pose.thumbs_tried;
    }
    // A fit from the last one may lead into a solid, and one round a frame need not lead out again:
    // the hand closes again in the next frame. A fit in the frame of a closing asks for no other.
    // So a hand at rest closes no more once its fit from the last one sticks (`sticks`).
    if (!pose.is_newly_closed && hand.authored == nullptr && fit.penetration_m > k_deep_m) {
        pose.closed_body = k_no_entity;
    }
    pose.is_newly_closed = false;
    pose.fitted_body = hand.body;
    pose.fitted_wrist_bs = hand.wrist_bs;
    pose.fitted_signature = hand.signature;
    pose.is_converged = fit.is_converged;
}

// Moves the authored digits of an authored grip between their pose and their pressed pose.
void follow_trigger(const HandSurroundings& hand, double trigger, FingerPose& pose) {
    for (std::size_t f = 0; hand.authored != nullptr && f < hand.rig->fingers.size(); ++f) {
        if (pose.is_authored[f]) {
            pose.target[f] =
                triggered_angles(hand.rig->fingers[f], *hand.authored, pose.closed[f], trigger);
        }
    }
}

// Returns the target wrist relative to the present tracked one. PalmOffset::target_* is relative to
// the tracked wrist of the last fit, because a fitted hand stays where it is on its body.
Pose target_in_hand(const HandSurroundings& hand, const FingerPose& pose,
                    const PalmOffset& offset) {
    const Pose target{offset.target_m, rotation_from_vector(offset.target_turn_rad)};
    return pose.fitted_body == k_no_entity
               ? target
               : inverse(hand.wrist_bs) * (pose.fitted_wrist_bs * target);
}

// Translation and rotation advance by the same share; rotation counts tilt_cost_m_per_rad metres
// per radian. The hand moves into an authored grip at the rate at which a free body moves into the
// hand (anchor_grabs): at PalmTuning::rate_mps alone. Returns true if it is there.
bool follow_palm(const Pose& target_hs, double dt_s, bool is_authored, const PalmTuning& tuning,
                 PalmOffset& offset) {
    const Vec3 target_turn_rad = rotation_to_vector(target_hs.rotation);
    const Vec3 remaining_m = target_hs.position - offset.shown_m;
    const Vec3 turn_rad = target_turn_rad - offset.shown_turn_rad;
    const double distance_m = remaining_m.norm() + tuning.tilt_cost_m_per_rad * turn_rad.norm();
    const double share = is_authored ? 0.0 : 1.0 / (1.0 + k_palm_settle_s / dt_s);
    const double step_m = std::max(tuning.rate_mps * dt_s, share * distance_m);
    if (distance_m <= step_m) {
        offset.shown_m = target_hs.position;
        offset.shown_turn_rad = target_turn_rad;
        return true;
    }
    offset.shown_m += step_m / distance_m * remaining_m;
    offset.shown_turn_rad += step_m / distance_m * turn_rad;
    return false;
}

// All angles advance by the same share of their remaining change, the largest share at which none
// exceeds its speed. Otherwise one angle would reach its target first and swing the digit through
// the surface. Opposition is as fast as opening: the thumb of an empty hand is often in what the
// hand grips next. Returns true if the digit is there.
bool follow_digit(double dt_s, const FingerTuning& tuning, const FingerAngles& target,
                  FingerAngles& shown) {
    double share = 1.0;
    const auto limit = [&](double change_rad, double most_radps) {
        const double most_rad = dt_s * most_radps;
        if (std::abs(change_rad) > most_rad) {
            share = std::min(share, most_rad / std::abs(change_rad));
        }
    };
    for (std::size_t i = 0; i < k_max_links; ++i) {
        const double change_rad = target.curl_rad[i] - shown.curl_rad[i];
        limit(change_rad, change_rad < 0.0 ? tuning.open_radps : tuning.close_radps);
    }
    limit(target.opposition_rad - shown.opposition_rad, tuning.open_radps);
    const auto advance = [share](double to_rad, double& shown_rad) {
        shown_rad = share < 1.0 ? shown_rad + share * (to_rad - shown_rad) : to_rad;
    };
    for (std::size_t i = 0; i < k_max_links; ++i) {
        advance(target.curl_rad[i], shown.curl_rad[i]);
    }
    advance(target.opposition_rad, shown.opposition_rad);
    return share == 1.0;
}

// A hand on its way to a pose with parts out of sight, as round the rim of a sheet, is not moved:
// it would come and go as the fit changes.
bool may_be_moved_out(const HandSurroundings& hand, const Pose& target_hs, const FingerPose& pose) {
    return hand.authored == nullptr && is_outside(hand, {hand.wrist_bs * target_hs, pose.target});
}

Pose shown_wrist_ws(const HandSurroundings& hand, bool may_be_moved, const PalmOffset& offset,
                    const FingerPose& pose) {
    const bool is_tracked = offset.shown_m.isZero() && offset.shown_turn_rad.isZero();
    Pose wrist_bs = is_tracked ? hand.wrist_bs
                               : hand.wrist_bs * Pose{offset.shown_m,
                                                      rotation_from_vector(offset.shown_turn_rad)};
    if (may_be_moved) {
        wrist_bs = wrist_outside_bs(hand, {wrist_bs, pose.shown});
    }
    return hand.body_ws * Pose{hand.scale * wrist_bs.position, wrist_bs.rotation};
}

}  // namespace

void fit_hands(const FitHandsIo& io, const Tuning& tuning, StageStats& stats) {
    std::vector<PenaltyRow> rows;
    fit_hands(io, tuning, stats, rows);
}

void fit_hands(const FitHandsIo& io, const Tuning& tuning, StageStats& stats,
               std::vector<PenaltyRow>& rows) {
    for (const HandSurroundings& hand : io.hands) {
        const GripSurface& surface = io.surface.at(hand.hand);
        PalmOffset& offset = io.offset.at(hand.hand);
        FingerPose& pose = io.fingers.at(hand.hand);
        if (surface.triangle == GripSurface::k_none) {
            pose_unsupported_hand(hand, io.hand.at(hand.hand), tuning, offset, pose);
        } else {
            fit_one(hand, surface, tuning, stats, offset, pose, rows);
        }
        follow_trigger(hand, io.hand.at(hand.hand).trigger, pose);
        const Pose target_hs = target_in_hand(hand, pose, offset);
        bool is_there =
            follow_palm(target_hs, io.dt_s, hand.authored != nullptr, tuning.palm, offset);
        for (std::size_t f = 0; f < hand.rig->fingers.size(); ++f) {
            is_there &= follow_digit(io.dt_s, tuning.finger, pose.target[f], pose.shown[f]);
        }
        const bool may_be_moved = !is_there && may_be_moved_out(hand, target_hs, pose);
        io.palm.at(hand.hand).pose_ws = shown_wrist_ws(hand, may_be_moved, offset, pose);
    }
}

std::optional<FitTerms> shown_fit_terms(const HandSurroundings& hand, const GripSurface& surface,
                                        const PalmPose& palm, const FingerPose& pose,
                                        const Tuning& tuning) {
    if (surface.triangle == GripSurface::k_none || hand.meshes.empty()) {
        return std::nullopt;
    }
    Pose wrist_bs = inverse(hand.body_ws) * palm.pose_ws;
    wrist_bs.position /= hand.scale;
    HandFitGoal goal = common_goal(hand, pose, tuning.thumb);
    goal.first = {wrist_bs, pose.shown};
    goal.is_clear = pose.is_clear;
    return fit_terms(hand, surface, goal, tuning.palm);
}

}  // namespace handhold
