#include "systems/body/calibrate_players.hpp"

#include <algorithm>
#include <cmath>

#include "engine/ecs/join.hpp"

namespace handhold {
namespace {

// Distance of the shoulder joints below the eyes / arm span.
constexpr double k_shoulder_drop_share = 0.145;

// Arm span of a player whose wrists are `level_m` apart horizontally and `below_m` below the eyes.
// Let S be the span. The shoulders are k_shoulder_share S apart and k_shoulder_drop_share S below
// the eyes. An arm has the length a = (1 - k_shoulder_share) S / 2. With x half of level_m, S
// solves
//   (x - k_shoulder_share S / 2)^2 + (below_m - k_shoulder_drop_share S)^2 = a^2.
// If the hands are at shoulder height or above, S = level_m.
double span_of_pose(double level_m, double below_m) {
    if (below_m <= k_shoulder_drop_share * level_m) {
        return level_m;
    }
    constexpr double k_half_shoulder = 0.5 * k_shoulder_share;
    constexpr double k_arm = 0.5 - k_half_shoulder;
    constexpr double k_square = k_arm * k_arm - k_half_shoulder * k_half_shoulder -
                                k_shoulder_drop_share * k_shoulder_drop_share;
    const double half_m = 0.5 * level_m;
    // Half the linear coefficient.
    const double linear = k_half_shoulder * half_m + k_shoulder_drop_share * below_m;
    const double constant = half_m * half_m + below_m * below_m;
    return (std::sqrt(linear * linear + k_square * constant) - linear) / k_square;
}

// True if the ratio of arm span to eye height is human, with a margin. A seated player's eyes are
// lower, so the upper bound applies only to lowered arms, which a seated player cannot hold.
bool is_plausible(double span_m, double eyes_m, bool are_arms_level) {
    constexpr double k_shortest_span = 0.80;
    constexpr double k_longest_span = 1.12;
    constexpr double k_lowest_seat = 0.45;  // eye height sitting on the floor / eye height standing
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

// Tracked points in the player's metres: those of play space over PlayerOrigin::scale.
struct TrackedPoints {
    Vec3 eyes = Vec3::Zero();
    Vec3 shift = Vec3::Zero();  // HeadTracking::shift_m
    std::array<Vec3, k_hand_count> hands = {};
};

// Returns the measures, in the player's metres, once the pose has been held for long enough.
std::optional<BodyMeasures> hold(double dt_s, const TrackedPoints& points,
                                 const CalibrationTuning& tuning, Calibration& calibration) {
    const std::array<Vec3, k_hand_count>& hands_ps = points.hands;
    const auto pose = read_t_pose(points.eyes - points.shift, hands_ps[0] - points.shift,
                                  hands_ps[1] - points.shift);
    const bool is_still = (hands_ps[0] - calibration.left_ps).norm() < tuning.still_m &&
                          (hands_ps[1] - calibration.right_ps).norm() < tuning.still_m;
    if (!pose || !is_still) {
        calibration = begin_at(hands_ps[0], hands_ps[1]);
        return std::nullopt;
    }
    const double left_s = std::max(0.0, tuning.hold_s - calibration.held_s);
    const double share_s = std::min(dt_s, left_s);
    calibration.held_s += share_s;
    calibration.eyes_s_m += share_s * pose->eyes_m;
    calibration.span_s_m += share_s * pose->span_m;
    if (dt_s < left_s) {
        return std::nullopt;
    }
    const BodyMeasures measures = measures_of(
        {calibration.eyes_s_m / calibration.held_s, calibration.span_s_m / calibration.held_s});
    calibration = {};
    calibration.done = true;
    return measures;
}

}  // namespace

std::optional<TPose> read_t_pose(const Vec3& head_ps, const Vec3& left_ps, const Vec3& right_ps) {
    constexpr double k_level = 0.12;  // largest height difference of the hands / span
    // Largest distance of the head from the middle between the hands / span.
    constexpr double k_middle = 0.15;
    // Arms count as level if the hands are at most this far below the eyes, in arm spans.
    constexpr double k_level_arms = 0.30;
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
                        below >= k_highest_hands && below <= k_lowest_hands &&
                        head_ps.y() > TPoseRange::k_min_eyes_m &&
                        head_ps.y() < TPoseRange::k_max_eyes_m &&
                        is_plausible(span, head_ps.y(), below <= k_level_arms);
    return is_one ? std::optional(TPose{head_ps.y(), span}) : std::nullopt;
}

void calibrate_players(const CalibratePlayersIo& io, const CalibrationTuning& tuning) {
    for (std::size_t index = 0; index < io.calibration.size(); ++index) {
        const Entity player = io.calibration.owners()[index];
        Calibration& calibration = io.calibration.elements()[index];
        if (!io.commands.at(player).calibrate) {
            calibration = {};
        } else if (!calibration.done) {
            const HeadTracking& head = io.head.at(player);
            const double scale = io.origin.at(player).scale;
            TrackedPoints points{head.pose_ps.position / scale, head.shift_m / scale};
            std::size_t known = is_known(head.state) && !head.is_inferred ? 1 : 0;
            for (std::size_t hand = 0; hand < io.owner.size(); ++hand) {
                const HandOwner& owner = io.owner.elements()[hand];
                const HandTracking& tracking = io.hand.at(io.owner.owners()[hand]);
                if (owner.player == player && is_known(tracking.state)) {
                    points.hands[index_of(owner.side)] = tracking.pose_ps.position / scale;
                    ++known;
                }
            }
            if (known < 1 + k_hand_count) {
                calibration = {};
            } else if (const auto measures = hold(io.dt_s, points, tuning, calibration)) {
                io.measures.at(player) = scaled(*measures, scale);
            }
        }
    }
}

}  // namespace handhold
