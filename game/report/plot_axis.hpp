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
    // Values at from_px and to_px, low < high; on a logarithmic axis their decimal logarithms.
    double low = 0.0;
    double high = 1.0;
    double from_px = 0.0;
    double to_px = 1.0;
    bool is_logarithmic = false;
    std::vector<AxisTick> ticks;
    // Power of ten by which the labels must be multiplied, for example "10⁻⁶", shown before the
    // unit; empty: 1.
    std::string factor;

    // On a logarithmic axis, values below the range (also zero and negative values) map to the low
    // end.
    double to_pixel(double value) const;
};

// About `count` round numbers in [low, high], in steps of 1, 2 or 5 times a power of ten.
// Precondition: low < high.
std::vector<double> choose_ticks(double low, double high, int count);

// An axis from `low` to `high`, with ticks in between. If high is not above low by at least 1e-100,
// the span is 1.
PlotAxis make_exact_axis(double low, double high, int tick_count);
// Like make_exact_axis, but extended to the next ticks outside.
PlotAxis make_rounded_axis(double low, double high, int tick_count);
// A logarithmic axis that covers [low, high] with whole decades; of more than six, the six highest.
// Precondition: 0 < low <= high.
PlotAxis make_logarithmic_axis(double low, double high);

}  // namespace handhold
