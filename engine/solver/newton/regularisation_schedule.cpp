// Solver, newton: the regularisation schedule. The rules are in the header.
#include "engine/solver/newton/regularisation_schedule.hpp"

#include <algorithm>

namespace handhold {
namespace {

// Overlap above which contacts may count as contradicting.
constexpr double k_unresolved_overlap_m = 1e-4;

}  // namespace

bool SteadyDecrease::take(const Step& step) {
    const bool falls = step.is_unscaled && !step.has_contact &&
                       step.residual_m < schedule_.linear_decrease_ratio * step.smallest_residual_m;
    steps_ = falls ? steps_ + 1 : 0;
    if (steps_ < schedule_.linear_decrease_steps) {
        return false;
    }
    steps_ = 0;
    return true;
}

void update_regularisation(bool progresses, double overlap_m, double previous_overlap_m,
                           const NewtonSettings& settings, Regularisation& regularisation) {
    const StepControl& schedule = settings.schedule;
    const double min_drive = schedule.min_drive_regularisation;
    const double max_drive = std::max(schedule.max_drive_regularisation, min_drive);
    const double min_contact = settings.regularisation.contact;
    const double max_contact = std::max(schedule.max_contact_regularisation, min_contact);
    const bool drive_at_max = regularisation.drive >= max_drive;
    const bool is_unresolved =
        drive_at_max && overlap_m > k_unresolved_overlap_m && overlap_m > 0.5 * previous_overlap_m;
    regularisation.drive =
        progresses ? std::max(regularisation.drive * schedule.regularisation_decrease, min_drive)
                   : std::min(regularisation.drive * schedule.regularisation_increase, max_drive);
    regularisation.contact =
        is_unresolved
            ? std::min(regularisation.contact * schedule.regularisation_increase, max_contact)
            : std::max(regularisation.contact * (1.0 / schedule.regularisation_increase),
                       min_contact);
}

}  // namespace handhold
