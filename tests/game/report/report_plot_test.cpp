#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <regex>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "game/report/plot_axis.hpp"
#include "game/report/svg_plot.hpp"

namespace handhold::report_plot_test {
namespace {

constexpr double k_nan = std::numeric_limits<double>::quiet_NaN();

std::vector<std::string> labels_of(const PlotAxis& axis) {
    std::vector<std::string> labels;
    for (const AxisTick& tick : axis.ticks) {
        labels.push_back(tick.label);
    }
    return labels;
}

std::size_t count_matches(const std::string& text, const std::string& pattern) {
    const std::regex expression(pattern);
    return static_cast<std::size_t>(
        std::distance(std::sregex_iterator(text.begin(), text.end(), expression), {}));
}

// The numbers of the first match's groups.
std::vector<double> find_numbers(const std::string& text, const std::string& pattern) {
    std::smatch match;
    std::vector<double> numbers;
    if (std::regex_search(text, match, std::regex(pattern))) {
        std::transform(match.begin() + 1, match.end(), std::back_inserter(numbers),
                       [](const auto& group) { return std::stod(group.str()); });
    }
    return numbers;
}

LinePlot make_plot(std::vector<PlotPoint> points, PlotScale scale = PlotScale::linear) {
    LinePlot plot;
    plot.title = "t";
    plot.x_label = "time (s)";
    plot.y_label = "error (mm)";
    plot.scale = scale;
    plot.series = {{"a", std::move(points), 0}};
    return plot;
}

RC_GTEST_PROP(DecimateColumns, KeepsEveryColumnsFirstLastLowestAndHighestInOrder, ()) {
    const auto steps = *rc::gen::container<std::vector<int>>(rc::gen::inRange(0, 5));
    std::vector<PlotPoint> points;
    points.reserve(steps.size());
    double x = 0.0;
    for (const int step : steps) {
        x += 0.1 * step;
        points.push_back({x, static_cast<double>(*rc::gen::inRange(-9, 10))});
    }
    const std::vector<PlotPoint> kept = decimate_columns(points);
    const auto in_column = [](const std::vector<PlotPoint>& all, double column) {
        std::vector<double> ys;
        for (const PlotPoint& point : all) {
            if (std::floor(point.x) == column) {
                ys.push_back(point.y);
            }
        }
        return ys;
    };
    for (double column = 0.0; column <= std::floor(x); column += 1.0) {
        const std::vector<double> before = in_column(points, column);
        const std::vector<double> after = in_column(kept, column);
        RC_ASSERT(before.empty() == after.empty());
        RC_ASSERT(after.size() <= 4U);
        if (!before.empty()) {
            RC_ASSERT(after.front() == before.front());
            RC_ASSERT(after.back() == before.back());
            RC_ASSERT(std::minmax_element(after.begin(), after.end()).first[0] ==
                      std::minmax_element(before.begin(), before.end()).first[0]);
            RC_ASSERT(std::minmax_element(after.begin(), after.end()).second[0] ==
                      std::minmax_element(before.begin(), before.end()).second[0]);
        }
    }
    RC_ASSERT(std::is_sorted(kept.begin(), kept.end(),
                             [](const auto& a, const auto& b) { return a.x < b.x; }));
}

TEST(DrawLinePlot, OneSlowFrameOfAHundredThousandIsSeenAndThePlotStaysSmall) {
    constexpr int k_frames = 100'000;
    std::vector<PlotPoint> points;
    points.reserve(k_frames);
    for (int i = 0; i < k_frames; ++i) {
        points.push_back({0.01 * i, i == 77'777 ? 100.0 : 1.0 + std::sin(0.9 * i)});
    }
    const std::string svg = draw_line_plot(make_plot(points));
    EXPECT_LT(svg.size(), 60'000U);  // 1000 columns of at most 4 points of 12 bytes, and the axes
    // The axis ends at 100: the peak is on its upper grid line.
    const std::vector<double> top =
        find_numbers(svg,
                     "y1=\"([0-9.]+)\" x2=\"[0-9.]+\" y2=\"[0-9.]+\"/><text class=\"ylab\" "
                     "x=\"[0-9.]+\" y=\"[0-9.]+\">100<");
    ASSERT_EQ(top.size(), 1U);
    std::string peak = std::to_string(top[0]);
    peak.erase(peak.find('.') + 2);
    EXPECT_NE(svg.find(' ' + peak + 'L'), std::string::npos) << peak;
}

TEST(DrawLinePlot, LineBreaksWhereThereIsNoValue) {
    const std::string svg =
        draw_line_plot(make_plot({{0, 1}, {1, 2}, {2, k_nan}, {3, 2}, {4, k_nan}, {5, 1}, {6, 0}}));
    EXPECT_EQ(count_matches(svg, "M[0-9.]+ [0-9.]+"), 3U);
    EXPECT_EQ(count_matches(svg, "h0"), 1U);  // the point between two gaps is a dot
    EXPECT_EQ(svg.find("nan"), std::string::npos);
}

TEST(DrawLinePlot, EqualAxesHaveTheSamePixelsAUnit) {
    const std::string svg = draw_line_plot(make_plot({{-1, 5}, {1, 8}, {6, 7}}, PlotScale::equal));
    const std::vector<double> begin =
        find_numbers(svg, "class=\"begin s0\" cx=\"([0-9.]+)\" cy=\"([0-9.]+)\"");
    const std::vector<double> end =
        find_numbers(svg, "class=\"end s0\" cx=\"([0-9.]+)\" cy=\"([0-9.]+)\"");
    ASSERT_EQ(begin.size(), 2U);
    ASSERT_EQ(end.size(), 2U);
    const double px_per_unit = (end[0] - begin[0]) / 7.0;
    EXPECT_GT(px_per_unit, 0.0);
    EXPECT_NEAR((begin[1] - end[1]) / 2.0, px_per_unit, 0.1);  // pixels have one decimal
}

TEST(DrawLinePlot, NothingToShowSaysSo) {
    for (const PlotScale scale : {PlotScale::linear, PlotScale::logarithmic, PlotScale::equal}) {
        EXPECT_NE(draw_line_plot(make_plot({}, scale)).find("no data"), std::string::npos);
        EXPECT_NE(draw_line_plot(make_plot({{0, k_nan}}, scale)).find("no data"),
                  std::string::npos);
        const std::string still = draw_line_plot(make_plot({{0, 0}}, scale));
        EXPECT_EQ(still.find("no data"), std::string::npos);
        EXPECT_EQ(still.find("nan"), std::string::npos);
        EXPECT_EQ(still.find("inf"), std::string::npos);
    }
}

TEST(DrawLinePlot, OneSeriesNeedsNoLegendAndNamesAreText) {
    LinePlot plot = make_plot({{0, 1}, {1, 2}});
    EXPECT_EQ(count_matches(draw_line_plot(plot), "class=\"key"), 0U);
    plot.series.push_back({"<b> & \"c\"", {{0, 2}, {1, 3}}, 1});
    const std::string svg = draw_line_plot(plot);
    EXPECT_EQ(count_matches(svg, "class=\"key"), 2U);
    EXPECT_EQ(svg.find("<b>"), std::string::npos);
    EXPECT_NE(svg.find("&lt;b&gt; &amp; &quot;c&quot;"), std::string::npos);
}

TEST(DrawLinePlot, SmallValuesShareAPowerOfTenInTheUnit) {
    const std::string svg = draw_line_plot(make_plot({{0, 0}, {1, 2e-7}}));
    EXPECT_NE(svg.find("error (10⁻⁹ mm)"), std::string::npos);
    EXPECT_NE(svg.find(">200<"), std::string::npos);
}

// Finite numbers of any size and spacing: pixels stay inside the drawing.
RC_GTEST_PROP(DrawLinePlot, EveryPixelIsInside, ()) {
    const auto points = *rc::gen::container<std::vector<std::pair<double, double>>>(
        rc::gen::pair(rc::gen::arbitrary<double>(), rc::gen::arbitrary<double>()));
    const auto exponent = *rc::gen::inRange(-120, 90);
    const auto scale =
        *rc::gen::element(PlotScale::linear, PlotScale::logarithmic, PlotScale::equal);
    std::vector<PlotPoint> plotted;
    plotted.reserve(points.size());
    for (const auto& [x, y] : points) {
        plotted.push_back({x, y * std::pow(10.0, exponent)});
    }
    const std::string svg = draw_line_plot(make_plot(plotted, scale));
    const std::regex pair("[ML](-?[0-9.]+) (-?[0-9.]+)");
    for (auto match = std::sregex_iterator(svg.begin(), svg.end(), pair);
         match != std::sregex_iterator(); ++match) {
        const double x = std::stod((*match)[1]);
        const double y = std::stod((*match)[2]);
        RC_ASSERT(x >= 0.0 && x <= 1000.0 && y >= 0.0 && y <= 260.0);
    }
    RC_ASSERT(svg.find("nan") == std::string::npos);
    RC_ASSERT(svg.find("inf") == std::string::npos);
}

TEST(PlotAxis, TicksAreRoundNumbersInside) {
    EXPECT_EQ(labels_of(make_exact_axis(0.0, 1.0, 5)),
              (std::vector<std::string>{"0.0", "0.2", "0.4", "0.6", "0.8", "1.0"}));
    EXPECT_EQ(labels_of(make_exact_axis(-3.2, 7.9, 5)),
              (std::vector<std::string>{"−2", "0", "2", "4", "6"}));
    EXPECT_EQ(labels_of(make_exact_axis(10'000.1, 10'000.4, 3)),
              (std::vector<std::string>{"10000.1", "10000.2", "10000.3", "10000.4"}));
}

TEST(PlotAxis, RoundedAxisGrowsToTheNextTicks) {
    const PlotAxis axis = make_rounded_axis(0.0, 37.0, 4);
    EXPECT_EQ(axis.low, 0.0);
    EXPECT_EQ(axis.high, 40.0);
    EXPECT_EQ(labels_of(axis), (std::vector<std::string>{"0", "10", "20", "30", "40"}));
    const PlotAxis nothing = make_rounded_axis(0.0, 0.0, 2);
    EXPECT_EQ(nothing.high, 1.0);
}

TEST(PlotAxis, LogarithmicAxisHoldsWholeDecadesSixAtMost) {
    PlotAxis axis = make_logarithmic_axis(3.0, 4000.0);
    axis.from_px = 0.0;
    axis.to_px = 400.0;
    EXPECT_EQ(axis.low, 0.0);
    EXPECT_EQ(axis.high, 4.0);
    EXPECT_DOUBLE_EQ(axis.to_pixel(100.0), 200.0);
    EXPECT_EQ(axis.to_pixel(0.0), 0.0);
    EXPECT_EQ(axis.to_pixel(-5.0), 0.0);
    EXPECT_EQ(make_logarithmic_axis(1e-9, 1e3).low, -3.0);
}

RC_GTEST_PROP(PlotAxis, StepsAreOneTwoOrFiveTimesAPowerOfTen, ()) {
    const double low = *rc::gen::inRange(-100'000, 100'000) / 128.0;
    const double span = *rc::gen::inRange(1, 1'000'000) / 1024.0;
    const std::vector<double> ticks = choose_ticks(low, low + span, 6);
    RC_ASSERT(ticks.size() >= 3U);
    RC_ASSERT(ticks.size() <= 10U);
    const double tolerance = 1e-6 * span;
    RC_ASSERT(ticks.front() >= low - tolerance);
    RC_ASSERT(ticks.back() <= low + span + tolerance);
    const double step = ticks[1] - ticks[0];
    const double digit = step / std::pow(10.0, std::floor(std::log10(step * (1.0 + 1e-6))));
    RC_ASSERT(std::abs(digit - 1.0) < 1e-3 || std::abs(digit - 2.0) < 1e-3 ||
              std::abs(digit - 5.0) < 1e-3);
}

}  // namespace
}  // namespace handhold::report_plot_test
