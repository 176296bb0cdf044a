#pragma once

#include <array>

#include "components/arm.hpp"
#include "components/body_tuning.hpp"
#include "systems/body/shared/body_view.hpp"
#include "systems/body/shared/estimate_chest.hpp"

// One step of the estimate of chest, shoulders and elbows from head and hands. The talk's rows 19
// to 22 with a fitted correction: docs/decisions/0091-fitted-body-estimate.md.
namespace handhold {

// Values of one time step that are the same for all players of a scale.
struct EstimateStep {
    double dt_s = 0.0;
    std::array<double, k_look_filters> look_shares{};  // filter gains for the look direction
    double chest_share = 0.0;                          // filter gain for the chest
    TurnLimit limit;                                   // ArmTuning::chest_limit_rad
    double scale = 1.0;                                // PlayerOrigin::scale
    const ArmTuning& tuning;                           // numbers of a player of that scale
};
EstimateStep estimate_step(double dt_s, double scale, const ArmTuning& tuning);

// True if a point moved farther in dt_s than a person of that scale can move it.
bool has_jumped(const Vec3& before, const Vec3& now, double scale, double dt_s);

// Estimates chest, shoulders and elbow directions. `reset`: ignores `memory`, and initialises it so
// that nothing lags; the result then depends on `body` and the goals alone. Pulls in hands at rest
// (`out.arms[i].goal`) beyond k_rest_reach, and writes where the hands are to `out`.
void estimate_body(TrackedBody body, const EstimateStep& step, bool reset, ArmMemory& memory,
                   ArmEstimate& out);

}  // namespace handhold
