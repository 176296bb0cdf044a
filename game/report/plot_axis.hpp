#pragma once

#include <string>
#include <vector>

// One axis of a plot: the map from values to pixels, and its ticks.
namespace handhold {

struct AxisTick {
    double value = 0.0;
    std::string label;
};

struct PlotAxis {
    double low = 0.0;  // at from_px; < high. Logarithmic: the decimal logarithm
    double high = 1.0;
    double from_px = 0.0;
    double to_px = 1.0;
    bool is_logarithmic = false;
    std::vector<AxisTick> ticks;
    std::string factor;  // divisor of the labels, "10⁻⁶", or empty; goes before the unit

    // Logarithmic: values below the axis, including zero and negative ones, map to its end.
    double to_pixel(double value) const;
};

// Round numbers within [low, high], about `count`, with a step of 1, 2 or 5 times a power of ten.
// low < high.
std::vector<double> choose_ticks(double low, double high, int count);

// From `low` to `high`, with ticks in between. If high is not above low by at least 1e-100, the
// span is 1.
PlotAxis make_exact_axis(double low, double high, int tick_count);
// The same, extended to the next ticks outside.
PlotAxis make_rounded_axis(double low, double high, int tick_count);
// Whole decades around [low, high], at most the six highest. 0 < low <= high.
PlotAxis make_logarithmic_axis(double low, double high);

}  // namespace handhold
