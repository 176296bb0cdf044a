#include "systems/body/shared/body_proportions.hpp"

namespace handhold {
namespace {

// A player counts as seated if the eyes are lower than this share of the eye height that the arm
// span predicts.
constexpr double k_seated_share = 0.87;

}  // namespace

double span_of_arm_m(double arm_m) { return 2.0 * arm_m / (1.0 - k_shoulder_share); }

double eye_height_of_arm_m(double arm_m) { return span_of_arm_m(arm_m) / k_span_share; }

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

}  // namespace handhold
