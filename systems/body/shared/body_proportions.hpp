#pragma once

#include "components/arm.hpp"

// Average human proportions (docs/decisions/, 40).
namespace handhold {

// Shoulder width / arm span, and arm span / eye height.
inline constexpr double k_shoulder_share = 0.25;
inline constexpr double k_span_share = 0.95;

// Measures of a T-pose or an A-pose.
struct TPose {
    double eyes_m = 0.0;  // height of the eyes above the floor
    double span_m = 0.0;  // arm span: distance between the wrists with the arms held level
};
// Body measures from a pose, with average human proportions.
BodyMeasures measures_of(const TPose& pose);
// The arm span and the standing eye height that are usual for arms of this length, shoulder to
// wrist.
double span_of_arm_m(double arm_m);
double eye_height_of_arm_m(double arm_m);
// Body measures from an eye height alone.
BodyMeasures measures_of_eye_height(double eye_height_m);

}  // namespace handhold
