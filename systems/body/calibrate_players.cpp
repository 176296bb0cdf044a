#include "systems/body/calibrate_players.hpp"

#include <algorithm>
#include <cmath>

#include "engine/ecs/join.hpp"

namespace handhold {
namespace {

// Body proportions: shoulder width / arm span, and arm span / eye height (docs/decisions/, 40).
constexpr double k_shoulder_share = 0.25;
constexpr double k_span_share = 0.95;
// Shoulder joints below the eyes / arm span.
constexpr double k_shoulder_drop_share = 0.145;
// Eyes lower than this share of what the span predicts: the player sits.
constexpr double k_seated_share = 0.87;

// Arm span of wrists that are `level_m` apart and `below_m` under the eyes. With span S, shoulders
// k_shoulder_share S apart and k_shoulder_drop_share S under the eyes, arms of length
// a = (1 - k_shoulder_share) S / 2 and half distance x = level_m / 2:
//   (x - k_shoulder_share S / 2)^2 + (below_m - k_shoulder_drop_share S)^2 = a^2.
// Hands at shoulder height or above give S = level_m.
double span_of_pose(double level_m, double below_m) {
    if (below_m <= k_shoulder_drop_share * level_m) {
        return level_m;
    }
    constexpr double k_half_shoulder = 0.5 * k_shoulder_share;
    constexpr double k_arm = 0.5 - k_half_shoulder;
    constexpr double k_square = k_arm * k_arm - k_half_shoulder * k_half_shoulder -
                                k_shoulder_drop_share * k_shoulder_drop_share;
    const double half_m = 0.5 * level_m;
    const double linear = k_half_shoulder * half_m + k_shoulder_drop_share * below_m;  // halved
    const double constant = half_m * half_m + below_m * below_m;
    return (std::sqrt(linear * linear + k_square * constant) - linear) / k_square;
}

// The ratio of arm span to eye height that people have, with a margin. Who sits has lower eyes, and
// cannot lower the arms.
bool is_plausible(double span_m, double eyes_m, bool are_arms_level) {
    constexpr double k_shortest_span = 0.80;
    constexpr double k_longest_span = 1.12;
    constexpr double k_lowest_seat = 0.45;  // eyes on the floor / eyes standing
    const double standing_m = span_m / k_span_share;
    return span_m >= k_shortest_span * eyes_m && eyes_m >= k_lowest_seat * standing_m &&
           (are_arms_level || span_m <= k_longest_span * eyes_m);
}

bool is_known(TrackingState state) { return state == TrackingState::tracked; }

Calibration begin_at(const Vec3& left_ps, const Vec3& right_ps) {
    Calibration begun;
    begun.left_ps = left_ps;
    begun.right_ps = right_ps;
    return begun;
}

void hold(double dt_s, const HeadTracking& head, const std::array<Vec3, k_hand_count>& hands_ps,
          const CalibrationTuning& tuning, Calibration& calibration, BodyMeasures& measures) {
    const Vec3 eyes_ps = head.pose_ps.position;
    const auto pose =
        read_t_pose(eyes_ps - head.shift_m, hands_ps[0] - head.shift_m, hands_ps[1] - head.shift_m);
    const bool is_still = (hands_ps[0] - calibration.left_ps).norm() < tuning.still_m &&
                          (hands_ps[1] - calibration.right_ps).norm() < tuning.still_m;
    if (!pose || !is_still) {
        calibration = begin_at(hands_ps[0], hands_ps[1]);
        return;
    }
    const double left_s = std::max(0.0, tuning.hold_s - calibration.held_s);
    const double share_s = std::min(dt_s, left_s);
    calibration.held_s += share_s;
    calibration.eyes_s_m += share_s * pose->eyes_m;
    calibration.span_s_m += share_s * pose->span_m;
    if (dt_s >= left_s) {
        measures = measures_of(
            {calibration.eyes_s_m / calibration.held_s, calibration.span_s_m / calibration.held_s});
        calibration = {};
        calibration.done = true;
    }
}

}  // namespace

std::optional<TPose> read_t_pose(const Vec3& head_ps, const Vec3& left_ps, const Vec3& right_ps) {
    constexpr double k_level = 0.12;   // of the span: one hand above the other
    constexpr double k_middle = 0.15;  // the head off the middle
    constexpr double k_highest = 0.02;
    constexpr double k_lowest = 0.47;      // the hands below the eyes: arms 60 degrees down
    constexpr double k_level_arms = 0.30;  // arms count as level down to this
    const Vec3 line = right_ps - left_ps;
    const Vec3 level(line.x(), 0.0, line.z());
    const Vec3 middle = 0.5 * (left_ps + right_ps);
    const double below_m = head_ps.y() - middle.y();
    const double span = span_of_pose(level.norm(), below_m);
    if (!is_finite(head_ps) || !(span >= TPoseRange::k_min_span_m) ||
        !(span <= TPoseRange::k_max_span_m)) {
        return std::nullopt;
    }
    const Vec3 aside(head_ps.x() - middle.x(), 0.0, head_ps.z() - middle.z());
    const double below = below_m / span;
    const bool is_one = std::abs(line.y()) <= k_level * span && aside.norm() <= k_middle * span &&
                        below >= k_highest && below <= k_lowest &&
                        head_ps.y() > TPoseRange::k_min_eyes_m &&
                        head_ps.y() < TPoseRange::k_max_eyes_m &&
                        is_plausible(span, head_ps.y(), below <= k_level_arms);
    return is_one ? std::optional(TPose{head_ps.y(), span}) : std::nullopt;
}

BodyMeasures measures_of(const TPose& pose) {
    const BodyMeasures usual;
    const double upper_share = usual.upper_arm_m / (usual.upper_arm_m + usual.forearm_m);
    BodyMeasures measures;
    measures.shoulder_width_m = k_shoulder_share * pose.span_m;
    const double arm_m = 0.5 * (pose.span_m - measures.shoulder_width_m);
    measures.upper_arm_m = upper_share * arm_m;
    measures.forearm_m = arm_m - measures.upper_arm_m;
    const double standing_m = pose.span_m / k_span_share;
    measures.eye_height_m = pose.eyes_m < k_seated_share * standing_m ? standing_m : pose.eyes_m;
    return measures;
}

BodyMeasures measures_of_eye_height(double eye_height_m) {
    return measures_of({eye_height_m, k_span_share * eye_height_m});
}

void calibrate_players(const CalibratePlayersIo& io, const CalibrationTuning& tuning) {
    for (std::size_t row = 0; row < io.calibration.size(); ++row) {
        const Entity player = io.calibration.owners()[row];
        Calibration& calibration = io.calibration.rows()[row];
        if (!io.commands.at(player).calibrate) {
            calibration = {};
        } else if (!calibration.done) {
            const HeadTracking& head = io.head.at(player);
            std::array<Vec3, k_hand_count> hands_ps{};
            std::size_t known = is_known(head.state) ? 1 : 0;
            for (std::size_t hand = 0; hand < io.owner.size(); ++hand) {
                const HandOwner& owner = io.owner.rows()[hand];
                const HandTracking& tracking = io.hand.at(io.owner.owners()[hand]);
                if (owner.player == player && is_known(tracking.state)) {
                    hands_ps[index_of(owner.side)] = tracking.pose_ps.position;
                    ++known;
                }
            }
            if (known == 1 + k_hand_count) {
                hold(io.dt_s, head, hands_ps, tuning, calibration, io.measures.at(player));
            } else {
                calibration = {};
            }
        }
    }
}

}  // namespace handhold
