#include "engine/solver/newton/regularisation_schedule.hpp"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "tests/random.hpp"

namespace handhold::regularisation_schedule_test {
namespace {

using test::Random;

double power_of_ten(Random& random, double low, double high) {
    return std::pow(10.0, random.between(low, high));
}

// A tuning file may set a maximum below its minimum. Bounds are those of the header, with the
// larger of both as the maximum.
TEST(RegularisationSchedule, AnySequenceOfStepsStaysWithinItsBounds) {
    for (std::uint64_t seed = 0; seed < 100; ++seed) {
        Random random(seed);
        NewtonSettings settings;
        StepControl& schedule = settings.schedule;
        schedule.min_drive_regularisation = power_of_ten(random, -12.0, -2.0);
        schedule.max_drive_regularisation = power_of_ten(random, -9.0, 0.0);
        schedule.max_contact_regularisation = power_of_ten(random, -12.0, -2.0);
        settings.regularisation.contact = power_of_ten(random, -12.0, -3.0);
        const double max_drive =
            std::max(schedule.max_drive_regularisation, schedule.min_drive_regularisation);
        const double max_contact =
            std::max(schedule.max_contact_regularisation, settings.regularisation.contact);
        Regularisation now = settings.regularisation;
        now.drive = max_drive;
        for (int step = 0; step < 50; ++step) {
            const bool progresses = random.between(0.0, 1.0) < 0.5;
            const double overlap_m = random.between(0.0, 1e-3);
            const double previous_m = random.between(0.0, 1e-3);
            update_regularisation(progresses, overlap_m, previous_m, settings, now);
            EXPECT_GE(now.drive, schedule.min_drive_regularisation) << seed;
            EXPECT_LE(now.drive, max_drive) << seed;
            EXPECT_GE(now.contact, settings.regularisation.contact) << seed;
            EXPECT_LE(now.contact, max_contact) << seed;
            EXPECT_EQ(now.joint, settings.regularisation.joint);
        }
    }
}

}  // namespace
}  // namespace handhold::regularisation_schedule_test
