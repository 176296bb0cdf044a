// Solver, newton: the Levenberg-Marquardt schedule, that is, the regularisation of each Newton step
// from the progress of the steps before.
//
//   drives     progress: times regularisation_decrease, not below min_drive_regularisation
//              none: times regularisation_increase, not above max_drive_regularisation
//   contacts   contradicting: times regularisation_increase, not above max_contact_regularisation
//              else: divided by it, not below the initial value
//   joints     constant
//
// Progress: the error fell below half of the smallest so far, or steadily (SteadyDecrease). A step
// that oscillates around the solution is no progress. Contacts count as contradicting if the drives
// are at their maximum and the overlap still does not halve. Otherwise their multipliers would grow
// without bound and push in directions that nothing opposes.

#pragma once

#include "engine/solver/newton/settings.hpp"

namespace handhold {

// Detects slow but steady convergence. On a light link at the end of heavy ones the regularisation
// of the drive itself limits the rate, so a slow decrease is a reason to reduce it.
//
// A run of steps has to be `linear_decrease_steps` long. Until then its steps count as no progress:
// drives increase twice and decrease once, which about cancels. Steps that reuse a factor are not
// reported here; they say nothing about the regularisation. Steps with contacts never count.
class SteadyDecrease {
  public:
    explicit SteadyDecrease(const StepControl& schedule) : schedule_(schedule) {}

    struct Step {
        double residual_m = 0.0;
        double smallest_residual_m = 0.0;  // least residual of all steps before
        bool is_unscaled = false;
        bool has_contact = false;
    };
    // True if this step completes a run; the next step starts a new one.
    bool take(const Step& step);

  private:
    const StepControl& schedule_;
    int steps_ = 0;
};

// `overlap_m`: deepest contact overlap, now and before the last step.
void update_regularisation(bool progresses, double overlap_m, double previous_overlap_m,
                           const NewtonSettings& settings, Regularisation& regularisation);

}  // namespace handhold
