#include "game/report/plot_axis.hpp"

#include <algorithm>
#include <cmath>

#include "game/report/text.hpp"

namespace handhold {
namespace {

constexpr int k_max_ticks = 100;
constexpr double k_min_span = 1e-100;  // smaller spans count as empty

// An empty range gets a span of 1.
double choose_high(double low, double high) { return high - low > k_min_span ? high : low + 1.0; }

double choose_step(double span, int count) {
    const double rough = span / count;
    const double power = std::pow(10.0, std::floor(std::log10(rough)));
    const double digit = rough / power;
    // Chooses the round digit nearest in ratio: thresholds are the geometric means of neighbouring
    // digits.
    const double round_digit = digit < std::sqrt(2.0)    ? 1.0
                               : digit < std::sqrt(10.0) ? 2.0
                               : digit < std::sqrt(50.0) ? 5.0
                                                         : 10.0;
    return round_digit * power;
}

// The multiples of `step` in [low, high], including those that rounding puts just outside.
std::vector<double> list_multiples(double low, double high, double step) {
    constexpr double k_tolerance = 1e-9;
    const double first = std::ceil(low / step - k_tolerance);
    const double last = std::floor(high / step + k_tolerance);
    std::vector<double> ticks;
    // An integer counter: far from zero, first + 1 may equal first.
    for (int i = 0; i <= k_max_ticks && first + i <= last; ++i) {
        ticks.push_back((first + i) * step + 0.0);  // adding 0.0 turns -0 into 0
    }
    return ticks;
}

// Adds labels with as many decimals as the step needs. Very small and very large values share a
// power of ten, whose exponent is a multiple of three.
void label_ticks(PlotAxis& axis, const std::vector<double>& ticks, double step) {
    constexpr double k_least = 1e-3;
    constexpr double k_most = 1e5;
    const double size = std::max(std::abs(axis.low), std::abs(axis.high));
    int power = 0;
    if (size < k_least || size >= k_most) {
        power = 3 * static_cast<int>(std::floor(std::log10(size) / 3.0));
        axis.factor = format_power_of_ten(power);
    }
    const double scale = std::pow(10.0, power);
    const int decimals =
        std::max(0, -static_cast<int>(std::floor(std::log10(step / scale) + 1e-9)));
    for (const double tick : ticks) {
        std::string label = tick < 0.0 ? "−" : "";
        append_fixed(label, std::abs(tick / scale), decimals);
        axis.ticks.push_back({tick, std::move(label)});
    }
}

}  // namespace

double PlotAxis::to_pixel(double value) const {
    double place = value;
    if (is_logarithmic) {
        place = value > 0.0 ? std::max(std::log10(value), low) : low;
    }
    return from_px + (place - low) / (high - low) * (to_px - from_px);
}

std::vector<double> choose_ticks(double low, double high, int count) {
    return list_multiples(low, high, choose_step(high - low, count));
}

PlotAxis make_exact_axis(double low, double high, int tick_count) {
    high = choose_high(low, high);
    PlotAxis axis;
    axis.low = low;
    axis.high = high;
    label_ticks(axis, choose_ticks(low, high, tick_count), choose_step(high - low, tick_count));
    return axis;
}

PlotAxis make_rounded_axis(double low, double high, int tick_count) {
    high = choose_high(low, high);
    const double step = choose_step(high - low, tick_count);
    PlotAxis axis;
    axis.low = std::floor(low / step + 1e-9) * step;
    axis.high = std::ceil(high / step - 1e-9) * step;
    label_ticks(axis, list_multiples(axis.low, axis.high, step), step);
    return axis;
}

PlotAxis make_logarithmic_axis(double low, double high) {
    constexpr double k_max_decades = 6.0;
    constexpr double k_few_decades = 2.0;
    PlotAxis axis;
    axis.is_logarithmic = true;
    axis.high = std::ceil(std::log10(high));
    axis.low =
        std::max(std::min(std::floor(std::log10(low)), axis.high - 1.0), axis.high - k_max_decades);
    const bool has_room = axis.high - axis.low <= k_few_decades;
    for (double decade = axis.low; decade <= axis.high; decade += 1.0) {
        const double value = std::pow(10.0, decade);
        axis.ticks.push_back({value, format_figure(value)});
        if (has_room && decade < axis.high) {
            for (const double digit : {2.0, 5.0}) {
                axis.ticks.push_back({digit * value, format_figure(digit * value)});
            }
        }
    }
    return axis;
}

}  // namespace handhold
