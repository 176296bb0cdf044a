#include "engine/solver/newton/load_stepping.hpp"

#include <algorithm>

namespace handhold {
namespace {

constexpr int k_parts = 4;
constexpr double k_on_its_way_m = 1e-5;  // all but the last part end where this is left

// Gives up where one part cannot be had.
NewtonResult go_in_parts(const IslandView& island, const NewtonSettings& settings,
                         SolveScratch& scratch, SolvePart solve) {
    NewtonSettings on_its_way = settings;
    on_its_way.tolerance_m = std::max(settings.tolerance_m, k_on_its_way_m);
    scratch.led.go_back(island);
    NewtonResult result;
    int iterations = 0;
    for (int part = 1; part <= k_parts; ++part) {
        scratch.led.hold_back(island, 1.0 - static_cast<double>(part) / k_parts);
        result = solve(island, part < k_parts ? on_its_way : settings, scratch);
        iterations += result.iterations;
        if (!result.converged) {
            break;
        }
    }
    scratch.led.hold_back(island, 0.0);
    result.iterations = iterations;
    return result;
}

}  // namespace

void reserve_leading(const IslandView& island, SolveScratch& scratch) {
    scratch.led.reserve(island);
    reserve_poses(island, scratch.at_once);
}

bool needs_leading(const NewtonResult& at_once, const NewtonSettings& settings) {
    return !at_once.converged && at_once.iterations == settings.max_iterations &&
           at_once.hands_from_m - at_once.residual_m > settings.lead_from_m;
}

NewtonResult lead_hands(const IslandView& island, const NewtonSettings& settings,
                        const NewtonResult& at_once, SolveScratch& scratch, SolvePart solve) {
    keep_poses(island, scratch.at_once);
    NewtonResult led = go_in_parts(island, settings, scratch, solve);
    led.iterations += at_once.iterations;
    if (led.converged) {
        led.hands_from_m = at_once.hands_from_m;
        led.leading = Leading::arrived;
        return led;
    }
    put_back(island, scratch.at_once);
    // With the hands where they were: the solve of velocities goes on from here. What has been
    // loaded before is so again; and if it were not, velocities would load for themselves.
    scratch.triads.load(island);
    NewtonResult result = at_once;
    result.iterations = led.iterations;
    result.leading = Leading::in_vain;
    return result;
}

}  // namespace handhold
