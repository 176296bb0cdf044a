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

// Stage 1a. Who asks for it and holds a T-pose still for a second is measured: eye height, and from
// wrist to wrist what arms and shoulders are. Who sits gets the eye height of such a span. Once for
// each time it is asked for; without the pose nothing changes.
void calibrate_players(const CalibratePlayersIo& io, const CalibrationTuning& tuning);

// A head and two hands as a T-pose: both hands level below the eyes, the head between them, the
// span of an arm's order. Metres; nothing where it is none.
struct TPose {
    double eyes_m = 0.0;  // above the floor
    double span_m = 0.0;  // from wrist to wrist, level
};
std::optional<TPose> read_t_pose(const Vec3& head_ps, const Vec3& left_ps, const Vec3& right_ps);

// A body of this T-pose, by the proportions of people.
BodyMeasures measures_of(const TPose& pose);
// And of a height alone.
BodyMeasures measures_of_eye_height(double eye_height_m);

}  // namespace handhold
