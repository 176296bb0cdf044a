#pragma once

#include <string>
#include <vector>

// One axis of a plot: from values to pixels, and where its ticks stand.
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
    std::string factor;  // what labels were divided by, "10⁻⁶", or empty: belongs before the unit

    // Logarithmic: what is below the axis, zero and negative numbers too, lies on its end.
    double to_pixel(double value) const;
};

// Round numbers, 1, 2 or 5 times a power of ten apart, within [low, high]; about `count`. low <
// high.
std::vector<double> choose_ticks(double low, double high, int count);

// From `low` to `high`, ticks in between. Where high is not above low (by 1e-100), a span of 1; so
// too below.
PlotAxis make_exact_axis(double low, double high, int tick_count);
// The same, grown to the next ticks outside.
PlotAxis make_rounded_axis(double low, double high, int tick_count);
// Whole decades around [low, high], six at most: those at the top. 0 < low <= high.
PlotAxis make_logarithmic_axis(double low, double high);

}  // namespace handhold
