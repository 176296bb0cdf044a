#pragma once

#include <cmath>

#include "engine/geometry/chain_fit.hpp"

namespace handhold::test {

// A tapered chain of 93 mm that lies along -Z when open and curls down.
inline HingeChain three_link_chain(const Pose& base) {
    constexpr double k_rad_per_deg = M_PI / 180.0;
    HingeChain chain;
    chain.base = base;
    chain.length_m = {0.045, 0.026, 0.022};
    chain.radius_m = {0.009, 0.008, 0.007};
    chain.closed_rad = {75.0 * k_rad_per_deg, 105.0 * k_rad_per_deg, 75.0 * k_rad_per_deg};
    chain.rest_rad = {20.0 * k_rad_per_deg, 30.0 * k_rad_per_deg, 15.0 * k_rad_per_deg};
    return chain;
}

inline HingeChain three_link_chain(const Vec3& position) {
    return three_link_chain(Pose{position, Quat::Identity()});
}

// Depths of about a tenth of a link's radius, and at most 15 degrees of opening.
inline ChainFitSettings chain_fit_settings() {
    return {.plane_offset = 0.62,
            .search_depth_m = 1.2e-3,
            .open_depth_m = 8e-4,
            .open_step_rad = 0.0436,
            .open_steps = 6};
}

}  // namespace handhold::test
