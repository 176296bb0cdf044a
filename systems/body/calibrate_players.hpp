#pragma once

#include <optional>

#include "components/arm.hpp"
#include "components/body_tuning.hpp"
#include "components/calibration.hpp"
#include "components/grab.hpp"
#include "components/hand.hpp"
#include "components/tracking.hpp"
#include "engine/ecs/column.hpp"

namespace handhold {

struct CalibratePlayersIo {
    double dt_s = 0.0;                       // in: > 0
    const Column<PlayerCommands>& commands;  // in
    const Column<HeadTracking>& head;        // in
    const Column<HandOwner>& owner;          // in
    const Column<HandTracking>& hand;        // in
    Column<Calibration>& calibration;        // in/out
    Column<BodyMeasures>& measures;          // in/out
};

// Stage 1a. Measures players who ask for it and hold a T-pose or an A-pose (arms up to 60 degrees
// down) still for CalibrationTuning::hold_s: eye height, and arms and shoulders from the distance
// of the wrists. Seated players get the eye height that their arm span predicts. Measures once per
// request. Changes nothing without the pose.
void calibrate_players(const CalibratePlayersIo& io, const CalibrationTuning& tuning);

// What a T-pose or an A-pose measures.
struct TPose {
    double eyes_m = 0.0;  // above the floor
    double span_m = 0.0;  // from wrist to wrist with level arms
};
// Nothing if the pose is another one: hands at equal heights between the eyes and 0.47 spans below,
// the head in the middle between them, and arms as long as people of that height have.
std::optional<TPose> read_t_pose(const Vec3& head_ps, const Vec3& left_ps, const Vec3& right_ps);

// The body of this pose, with people's proportions.
BodyMeasures measures_of(const TPose& pose);
// The body of an eye height alone.
BodyMeasures measures_of_eye_height(double eye_height_m);

}  // namespace handhold
