#include "components/tuning_check.hpp"

#include <string>

#include "engine/core/check.hpp"

namespace handhold {
namespace {

void check_number(const TuningInfo& info, double value) {
    if (!(value >= info.low && value <= info.high)) [[unlikely]] {
        fail_precondition("check_tuning",
                          (std::string(info.name) + " must lie in [" + number_text(info.low) +
                           ", " + number_text(info.high) + "]")
                              .c_str(),
                          number_text(value));
    }
}

struct NumberChecker {
    void operator()(const TuningInfo& info, double value) const { check_number(info, value); }
    void operator()(const TuningInfo& info, std::int32_t value) const {
        check_number(info, static_cast<double>(value));
    }
    void operator()(const TuningInfo& info, SupportFollow value) const {
        check_number(info, static_cast<double>(value));
    }
    void operator()(const TuningInfo& info, const Vec3& value) const {
        for (const double component : value) {
            check_number(info, component);
        }
    }
};

}  // namespace

void check_tuning(const Tuning& tuning) {
    visit_tuning(tuning, NumberChecker{});
    HH_CHECK(tuning.phases.kappa_heavy_kg > tuning.phases.kappa_light_kg,
             "phases.kappa_heavy_kg must be above kappa_light_kg", tuning.phases.kappa_heavy_kg);
}

}  // namespace handhold
