#include "systems/hand/shared/hand_objective.hpp"

#include <algorithm>
#include <cmath>

#include "systems/hand/shared/digit_gaps.hpp"

namespace handhold {
namespace {

// The weights and lengths of hand_fit.hpp.
constexpr double k_touch = 2.0;
constexpr double k_tip = 1.0;
constexpr double k_thumb_tip = 1.0;
constexpr double k_pad = 0.05;
constexpr double k_palm_touch = 0.7;
constexpr double k_fan = 0.3;
constexpr double k_alike = 0.3;
constexpr double k_free_gap_m = 1e-3;  // gap at which fingers bend alike by half the weight
constexpr double k_couple = 0.1;
constexpr double k_coupling = 2.0 / 3.0;
constexpr double k_couple_thumb = 0.15;
constexpr double k_roll = 0.01;
constexpr double k_opposition = 0.02;
constexpr double k_spread = 0.2;
constexpr double k_rest = 2e-5;
constexpr double k_rest_of_free_thumb = 0.002;
// Stiffness of the inequalities.
constexpr double k_contact = 2000.0;
constexpr double k_joint_limit = 500.0;
constexpr double k_palm_limit = 20.0;
constexpr double k_bend_limit = 0.3;
constexpr double k_fan_limit = 2.0;
constexpr double k_claw_limit = 4.0;
constexpr double k_digit_contact = 500.0;  // weight of contacts between the thumb and a finger
constexpr double k_digit_reach_m = 0.03;   // digits farther apart need no inequality
constexpr double k_claw_share = 0.6;
constexpr double k_clear_m = 3e-4;  // gap that contacts aim for

constexpr double k_lever2 = k_fit_lever_m * k_fit_lever_m;

bool is_thumb(const FingerRig& finger) { return finger.name == FingerName::thumb; }

// Maximum number of inequalities: four per angle (limits and steps), two per finger (bend, claw),
// five per pair of neighbours, gaps, the palm's limits.
static_assert(4 * (k_max_unknowns - 6) + 2 * k_finger_count + 5 * (k_finger_count - 1) +
                  HandSpheres::k_max_count + k_max_digit_gaps + 3 <=
              k_max_penalty_rows);

}  // namespace

double opposition_share(const FingerRig& finger, double knuckle_rad) {
    const double bent = std::clamp(knuckle_rad / k_bent_spread_rad, 0.0, 1.0);
    return is_thumb(finger) ? 1.0 : 1.0 - (1.0 - k_bent_spread_share) * bent;
}

double HandObjective::evaluate(const HandPose& pose) {
    begin(pose);
    spheres_.query(pose_, frames_);
    add_wrist();
    for (std::size_t f = 0; f < rig_.fingers.size(); ++f) {
        add_digit(f);
    }
    add_palm_touch();
    add_neighbours();
    add_contacts(spheres_.all());
    add_digit_gaps();
    add_palm_limits();
    return problem_.cost_m2();
}

double HandObjective::evaluate_thumb(const HandPose& pose, std::size_t t) {
    begin(pose);
    spheres_.query_digit(t, pose_, frames_);
    add_digit(t);
    add_contacts(spheres_.of_digit(t));
    add_digit_gaps();
    return problem_.cost_m2();
}

void HandObjective::begin(const HandPose& pose) {
    pose_ = pose;
    place_links();
    problem_.clear();
}

void HandObjective::add_digit(std::size_t f) {
    add_hinges(f);
    if (layout_.opposition(f) >= 0 && is_thumb(rig_.fingers[f])) {
        add_opposition(f);
    } else if (layout_.opposition(f) >= 0) {
        add_spread(f);
    }
    add_attraction(f);
}

void HandObjective::place_links() {
    center_ = transform_point(pose_.wrist_bs, rig_.palm_center_hs);
    frames_ = link_frames(rig_, pose_);
    for (std::size_t f = 0; f < rig_.fingers.size(); ++f) {
        for (std::size_t i = 0; i < rig_.fingers[f].link_count; ++i) {
            hinge_axis_[f][i] = frames_[f][i].rotation * -Vec3::UnitX();
        }
        opposition_axis_[f] = pose_.wrist_bs.rotation * rig_.fingers[f].opposition_axis_hs;
    }
}

Unknowns HandObjective::solve() {
    add_step_limits(6, layout_.end());
    hold_fixed_unknowns();
    return problem_.solve();
}

Unknowns HandObjective::solve_thumb(std::size_t t) {
    const int first = layout_.hinge(t, 0);
    const int count = layout_.count_of(t);
    add_step_limits(first, first + count);
    return problem_.solve_some(first, count);
}

void HandObjective::add_step_limits(int first, int end) {
    const FitPart part(FitTerm::joints, FitTerms::k_palm);  // costs nothing where it starts
    for (int i = first; i < end; ++i) {
        problem_.add_limit(part, i, 1.0, goal_.max_flex_rad, k_joint_limit * k_lever2);
        problem_.add_limit(part, i, -1.0, goal_.max_flex_rad, k_joint_limit * k_lever2);
    }
}

void HandObjective::add_wrist() {
    const Vec3 moved = center_ - transform_point(hand_.wrist_bs, rig_.palm_center_hs);
    const Vec3 turned = rotation_to_vector(
        (pose_.wrist_bs.rotation * hand_.wrist_bs.rotation.conjugate()).normalized());
    for (int i = 0; i < 3; ++i) {
        problem_.add_square({FitTerm::sync, FitTerms::k_palm}, 1.0, moved[i], i);
        problem_.add_square({FitTerm::sync, FitTerms::k_palm}, k_fit_arm_m * k_fit_arm_m, turned[i],
                            3 + i);
    }
}

void HandObjective::add_hinges(std::size_t f) {
    const FingerRig& finger = rig_.fingers[f];
    const FingerAngles& angles = pose_.fingers[f];
    const bool is_free_thumb = is_thumb(finger) && !goal_.touches[f];
    for (std::size_t i = 0; i < finger.link_count; ++i) {
        const int place = layout_.hinge(f, i);
        const double angle_rad = angles.curl_rad[i];
        problem_.add_square({FitTerm::rest, f},
                            (is_free_thumb ? k_rest_of_free_thumb : k_rest) * k_lever2,
                            angle_rad - finger.rest_rad[i], place);
        problem_.add_limit({FitTerm::joints, f}, place, 1.0, angle_rad - finger.lower_rad[i],
                           k_joint_limit * k_lever2);
        problem_.add_limit({FitTerm::joints, f}, place, -1.0, finger.upper_rad[i] - angle_rad,
                           k_joint_limit * k_lever2);
    }
    if (finger.link_count == 3) {
        add_coupling(f);
    }
    if (!is_thumb(finger)) {
        add_shape(f);
    }
}

void HandObjective::add_coupling(std::size_t f) {
    const FingerAngles& angles = pose_.fingers[f];
    const bool is_of_thumb = is_thumb(rig_.fingers[f]);
    const double share = is_of_thumb ? 1.0 : k_coupling;
    problem_.add_square({FitTerm::couple, f}, (is_of_thumb ? k_couple_thumb : k_couple) * k_lever2,
                        angles.curl_rad[2] - share * angles.curl_rad[1],
                        unit(layout_.hinge(f, 2)) + unit(layout_.hinge(f, 1), -share));
}

void HandObjective::add_shape(std::size_t f) {
    const FingerAngles& angles = pose_.fingers[f];
    const Unknowns open = layout_.bend(f, -1.0);
    problem_.add_row({FitTerm::bend, f}, open, k_max_bend_rad + along(open),
                     k_bend_limit * k_lever2);
    problem_.add_square({FitTerm::roll, f}, k_roll * k_lever2,
                        angles.curl_rad[1] - angles.curl_rad[0],
                        unit(layout_.hinge(f, 1)) + unit(layout_.hinge(f, 0), -1.0));
    problem_.add_row({FitTerm::claw, f},
                     unit(layout_.hinge(f, 0)) + unit(layout_.hinge(f, 1), -k_claw_share),
                     angles.curl_rad[0] - k_claw_share * angles.curl_rad[1] + k_claw_rad,
                     k_claw_limit * k_lever2);
}

void HandObjective::add_opposition(std::size_t f) {
    const FingerRig& finger = rig_.fingers[f];
    const int place = layout_.opposition(f);
    const double angle_rad = pose_.fingers[f].opposition_rad;
    problem_.add_square({FitTerm::opposition, f}, k_opposition * k_lever2,
                        angle_rad - goal_.rest_opposition_rad, place);
    problem_.add_limit({FitTerm::joints, f}, place, 1.0, angle_rad - finger.lower_opposition_rad,
                       k_joint_limit * k_lever2);
    problem_.add_limit({FitTerm::joints, f}, place, -1.0, finger.upper_opposition_rad - angle_rad,
                       k_joint_limit * k_lever2);
}

void HandObjective::add_spread(std::size_t f) {
    const FingerRig& finger = rig_.fingers[f];
    const int place = layout_.opposition(f);
    const double spread_rad = pose_.fingers[f].opposition_rad;
    const double bend_rad = pose_.fingers[f].curl_rad[0];
    const double share = opposition_share(finger, bend_rad);
    const bool shrinks = bend_rad > 0.0 && bend_rad < k_bent_spread_rad;
    const double shrink_per_rad = shrinks ? -(1.0 - k_bent_spread_share) / k_bent_spread_rad : 0.0;
    problem_.add_square({FitTerm::spread, f}, k_spread * k_lever2, spread_rad, place);
    if (goal_.is_fixed[f]) {
        return;  // authored angles are kept, whatever their range
    }
    const int knuckle = layout_.hinge(f, 0);
    problem_.add_row({FitTerm::joints, f},
                     unit(place) + unit(knuckle, -finger.lower_opposition_rad * shrink_per_rad),
                     spread_rad - share * finger.lower_opposition_rad, k_joint_limit * k_lever2);
    problem_.add_row(
        {FitTerm::joints, f},
        unit(place, -1.0) + unit(knuckle, finger.upper_opposition_rad * shrink_per_rad),
        share * finger.upper_opposition_rad - spread_rad, k_joint_limit * k_lever2);
}

void HandObjective::add_attraction(std::size_t f) {
    for (const HandSphere& sphere : spheres_.of_digit(f)) {
        if (sphere.is_tip && is_thumb(rig_.fingers[f])) {
            add_thumb_tip(f, sphere);
        } else if (sphere.is_tip && sphere.has_gap) {
            add_pull({FitTerm::tip, f}, k_tip, sphere);
        }
    }
    const HandSphere* const nearest = spheres_.nearest(f);
    if (nearest != nullptr && (goal_.touches[f] || nearest->gap_m < k_sphere_reach_m)) {
        add_pull({FitTerm::touch, f}, k_touch, *nearest);
    }
}

void HandObjective::add_thumb_tip(std::size_t f, const HandSphere& tip) {
    if (!tip.has_gap) {  // leaving the reach of the surface must not be a gain
        problem_.add_constant({FitTerm::tip, f}, 0.5 * k_thumb_tip * k_tip_reach_m * k_tip_reach_m);
        problem_.add_constant({FitTerm::pad, f}, 2.0 * k_pad * k_lever2);
        return;
    }
    problem_.add_square({FitTerm::tip, f}, k_thumb_tip, tip.gap_m, slope_of(tip));
    const Vec3 pad = frames_[f][tip.link].rotation * -Vec3::UnitY();
    for (int i = 0; i < 3; ++i) {
        const Vec3 turns = pad.cross(Vec3::Unit(i));  // change of pad[i] per radian about each axis
        Unknowns slope = Unknowns::Zero();
        slope.segment<3>(3) = turns;
        for (std::size_t link = 0; link <= tip.link; ++link) {
            slope[layout_.hinge(f, link)] = hinge_axis_[f][link].dot(turns);
        }
        if (layout_.opposition(f) >= 0) {
            slope[layout_.opposition(f)] = opposition_axis_[f].dot(turns);
        }
        problem_.add_square({FitTerm::pad, f}, k_pad * k_lever2, pad[i] + tip.away[i], slope);
    }
}

void HandObjective::add_palm_touch() {
    const HandSphere* const nearest = spheres_.nearest_of_palm();
    if (nearest != nullptr && nearest->gap_m < k_sphere_reach_m) {
        add_pull({FitTerm::touch, FitTerms::k_palm}, k_palm_touch, *nearest);
    }
}

void HandObjective::add_pull(const FitPart& part, double pull, const HandSphere& sphere) {
    const double ratio = sphere.gap_m / k_let_go_m;
    const double share = 1.0 / (1.0 + ratio * ratio);
    const double weight = pull * share * share;
    problem_.add_square(part, weight, sphere.gap_m, slope_of(sphere));
    problem_.add_constant(part, 0.5 * (pull * share - weight) * sphere.gap_m * sphere.gap_m);
}

void HandObjective::add_neighbours() {
    std::size_t before = k_finger_count;
    for (std::size_t f = 0; f < rig_.fingers.size(); ++f) {
        if (is_thumb(rig_.fingers[f])) {
            continue;
        }
        if (before < k_finger_count) {
            add_neighbour(before, f);
        }
        before = f;
    }
}

double HandObjective::free_share(std::size_t f) const {
    const HandSphere* const nearest = spheres_.nearest(f);
    if (nearest == nullptr) {
        return 1.0;
    }
    const double ratio = std::max(0.0, nearest->gap_m) / k_free_gap_m;
    return ratio * ratio / (1.0 + ratio * ratio);
}

void HandObjective::add_neighbour(std::size_t a, std::size_t b) {
    const Unknowns fan = layout_.direction(b, 1.0) + layout_.direction(a, -1.0);
    const double fan_rad = along(fan);
    if (!goal_.is_fixed[a] && !goal_.is_fixed[b]) {
        add_alike(a, b);
        problem_.add_square({FitTerm::fan, a, b}, k_fan * k_lever2, fan_rad, fan);
    }
    problem_.add_row({FitTerm::apart, a, b}, fan, k_max_fan_rad + fan_rad, k_fan_limit * k_lever2);
    problem_.add_row({FitTerm::apart, a, b}, -fan, k_max_fan_rad - fan_rad, k_fan_limit * k_lever2);
    add_converging(a, b);
    const Unknowns apart = layout_.bend(b, 1.0) + layout_.bend(a, -1.0);
    const double apart_rad = along(apart);
    problem_.add_row({FitTerm::apart, a, b}, apart, k_max_apart_rad + apart_rad,
                     k_bend_limit * k_lever2);
    problem_.add_row({FitTerm::apart, a, b}, -apart, k_max_apart_rad - apart_rad,
                     k_bend_limit * k_lever2);
}

void HandObjective::add_converging(std::size_t a, std::size_t b) {
    const int of_a = layout_.opposition(a);
    const int of_b = layout_.opposition(b);
    if (of_a < 0 || of_b < 0 || (goal_.is_fixed[a] && goal_.is_fixed[b])) {
        return;
    }
    // Positive: away from each other. Spreads count towards the thumb's side.
    const double sign = rig_.fingers[a].name < rig_.fingers[b].name ? 1.0 : -1.0;
    const double away_rad =
        sign * (pose_.fingers[a].opposition_rad - pose_.fingers[b].opposition_rad);
    problem_.add_row({FitTerm::apart, a, b}, unit(of_a, sign) + unit(of_b, -sign),
                     k_max_converging_rad + away_rad, k_joint_limit * k_lever2);
}

void HandObjective::add_alike(std::size_t a, std::size_t b) {
    const double free = std::max(free_share(a), free_share(b));
    const std::size_t links = std::min(rig_.fingers[a].link_count, rig_.fingers[b].link_count);
    for (std::size_t i = 0; i < links; ++i) {
        problem_.add_square({FitTerm::alike, a, b}, k_alike * free * k_lever2,
                            pose_.fingers[b].curl_rad[i] - pose_.fingers[a].curl_rad[i],
                            unit(layout_.hinge(b, i)) + unit(layout_.hinge(a, i), -1.0));
    }
}

double HandObjective::along(const Unknowns& slope) const {
    double sum_rad = 0.0;
    for (std::size_t f = 0; f < rig_.fingers.size(); ++f) {
        for (std::size_t i = 0; i < rig_.fingers[f].link_count; ++i) {
            sum_rad += slope[layout_.hinge(f, i)] * pose_.fingers[f].curl_rad[i];
        }
    }
    return sum_rad;
}

void HandObjective::add_contacts(std::span<const HandSphere> spheres) {
    for (const HandSphere& sphere : spheres) {
        if (sphere.has_gap) {
            const std::size_t part = sphere.finger == HandSphere::k_palm
                                         ? FitTerms::k_palm
                                         : static_cast<std::size_t>(sphere.finger);
            problem_.add_row({FitTerm::penetration, part}, slope_of(sphere),
                             sphere.gap_m - k_clear_m, k_contact);
        }
    }
}

void HandObjective::add_digit_gaps() {
    std::array<DigitGap, k_max_digit_gaps> gaps;
    const std::size_t count =
        find_digit_gaps(rig_, digit_capsules(rig_, frames_), k_digit_reach_m, gaps);
    for (std::size_t i = 0; i < count; ++i) {
        const DigitGap& pair = gaps[i];
        Unknowns slope = Unknowns::Zero();
        add_digit_slope(pair.thumb, pair.thumb_link, pair.on_thumb, pair.away, slope);
        add_digit_slope(pair.finger, pair.finger_link, pair.on_finger, -pair.away, slope);
        problem_.add_row({FitTerm::overlap, pair.thumb, pair.finger}, slope, pair.gap_m,
                         k_digit_contact);
    }
}

void HandObjective::add_palm_limits() {
    const FitPart part(FitTerm::palm_limits, FitTerms::k_palm);
    const Vec3& normal = surface_.normal_bs;
    const double height_m = (center_ - surface_.point_bs).dot(normal);
    Unknowns slope = Unknowns::Zero();
    slope.head<3>() = normal;
    problem_.add_row(part, slope, height_m - tuning_.min_height_m, k_palm_limit);
    problem_.add_row(part, -slope, std::max(tuning_.min_height_m, tuning_.max_height_m) - height_m,
                     k_palm_limit);
    const Vec3 up = pose_.wrist_bs.rotation * -rig_.palm_normal_hs;
    const Vec3 across = up.cross(normal);
    if (across.norm() > 1e-9) {
        Unknowns turn = Unknowns::Zero();
        turn.segment<3>(3) = across.normalized();
        problem_.add_row(part, turn,
                         tuning_.max_angle_rad - arc_tangent2(across.norm(), up.dot(normal)),
                         k_palm_limit * k_fit_arm_m * k_fit_arm_m);
    }
}

Unknowns HandObjective::slope_of(const HandSphere& sphere) const {
    Unknowns slope = Unknowns::Zero();
    slope.head<3>() = sphere.away;
    slope.segment<3>(3) = (sphere.center - center_).cross(sphere.away);
    if (sphere.finger == HandSphere::k_palm) {
        return slope;
    }
    add_digit_slope(static_cast<std::size_t>(sphere.finger), sphere.link, sphere.center,
                    sphere.away, slope);
    return slope;
}

void HandObjective::add_digit_slope(std::size_t f, std::size_t link, const Vec3& point,
                                    const Vec3& away, Unknowns& slope) const {
    for (std::size_t i = 0; i <= link; ++i) {
        slope[layout_.hinge(f, i)] +=
            hinge_axis_[f][i].cross(point - frames_[f][i].position).dot(away);
    }
    if (layout_.opposition(f) >= 0) {
        slope[layout_.opposition(f)] +=
            opposition_axis_[f].cross(point - frames_[f][0].position).dot(away);
    }
}

void HandObjective::hold_fixed_unknowns() {
    for (int i = 0; goal_.is_wrist_fixed && i < 6; ++i) {
        problem_.hold(i);
    }
    for (std::size_t f = 0; f < rig_.fingers.size(); ++f) {
        for (std::size_t i = 0; goal_.is_fixed[f] && i < rig_.fingers[f].link_count; ++i) {
            problem_.hold(layout_.hinge(f, i));
        }
        if (goal_.is_fixed[f] && layout_.opposition(f) >= 0) {
            problem_.hold(layout_.opposition(f));
        }
    }
}

}  // namespace handhold
