#pragma once

#include <optional>

#include "components/arm.hpp"
#include "components/body_tuning.hpp"
#include "components/calibration.hpp"
#include "components/grab.hpp"
#include "components/hand.hpp"
#include "components/player.hpp"
#include "components/tracking.hpp"
#include "engine/ecs/column.hpp"
#include "systems/body/shared/body_proportions.hpp"

namespace handhold {

struct CalibratePlayersIo {
    double dt_s;                             // in: > 0
    const Column<PlayerCommands>& commands;  // in
    const Column<PlayerOrigin>& origin;      // in: scale
    const Column<HeadTracking>& head;        // in
    const Column<HandOwner>& owner;          // in
    const Column<HandTracking>& hand;        // in
    Column<Calibration>& calibration;        // in/out
    Column<BodyMeasures>& measures;          // in/out
};

// Measures players who request it (PlayerCommands::calibrate) and hold a T-pose or an A-pose
// (read_t_pose) still for CalibrationTuning::hold_s. Measures the eye height, and arms and
// shoulders from the distance of the wrists. Seated players get the eye height that their arm span
// predicts. Measures once per request. Without the pose, nothing changes.
void calibrate_players(const CalibratePlayersIo& io, const CalibrationTuning& tuning);

// Least and greatest height of the eyes above the hands in a T- or A-pose, in arm spans.
inline constexpr double k_highest_hands = 0.02;
inline constexpr double k_lowest_hands = 0.47;

// Returns none unless the player is in a T- or A-pose: hands at nearly equal heights,
// k_highest_hands to k_lowest_hands arm spans below the eyes; head midway between the hands; span
// and eye height within TPoseRange and plausible for each other. Positions are relative to the
// tracked floor.
std::optional<TPose> read_t_pose(const Vec3& head_ps, const Vec3& left_ps, const Vec3& right_ps);

}  // namespace handhold
