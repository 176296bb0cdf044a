#pragma once

#include "components/tracking.hpp"

// A hand's motion, measured from its last samples.
namespace handhold {

// Appends the hand's last sample.
void remember(HandHistory& history, const HandTracking& hand);
void clear(HandHistory& history);

// The hand's pose at constant velocity, from its last two samples (motion_limit.hpp).
Pose extrapolated(const HandTracking& hand, const HandHistory& history, double t_s);

// Samples microseconds apart would turn a tenth of a millimetre of noise into metres per second.
inline constexpr double k_shortest_span_s = 0.005;
inline constexpr int k_longest_window = 4;

// Velocity and spin at a release: the least-squares slopes of position and rotation vector, both
// relative to edge_ps, over the samples of the window before t_s. The window is enlarged, up to
// k_longest_window times, until its samples span k_shortest_span_s.
//     v = sum((t_i - t_mean) * (p_i - p_edge)) / sum((t_i - t_mean)^2).
// Two samples give their difference quotient, a single one gives zero.
void measure_release(const HandHistory& history, double t_s, double window_s, HandTracking& hand);

}  // namespace handhold
