#pragma once

#include <span>
#include <string>
#include <vector>

// Line plots as SVG elements for inside an HTML page. Colours are CSS variables of line_plot_css(),
// which the page includes once: readable on light and on dark ground.
namespace handhold {

struct PlotPoint {
    double x = 0.0;
    double y = 0.0;
};

// Colours of PlotSeries::color: this many, then they repeat; and one for what the others are parts
// of.
constexpr int k_plot_colors = 6;
constexpr int k_plot_color_whole = -1;

struct PlotSeries {
    std::string name;  // in the legend
    std::vector<PlotPoint>
        points;  // joined in their order; the line breaks where one is not finite, or beyond 1e100
    int color = 0;  // >= 0, or k_plot_color_whole
};

enum class PlotScale {
    linear,       // both axes hold 0
    logarithmic,  // y in whole decades, six at most; what is below lies on the lower edge; x holds
                  // 0
    equal,  // both axes with as many pixels a unit, around the points: for paths, whose ends are
            // marked
};

struct LinePlot {
    std::string title;
    std::string x_label;  // with unit
    std::string y_label;
    PlotScale scale = PlotScale::linear;
    double width_px = 1000.0;  // of the drawing; it is scaled to the width that it gets
    double height_px = 260.0;
    std::vector<PlotSeries> series;  // one a name; a legend stands above from two on
};

// The <svg> element. "no data" inside of empty axes where there is no finite point. Size is bounded
// by the width, not by the number of points: see decimate_columns.
std::string draw_line_plot(const LinePlot& plot);

// Rules for all plots of a page, and the colours, for the page's own use too: var(--plot-0),
// --plot-text, --plot-ground.
std::string line_plot_css();

// Of each run of consecutive points within one column of width 1 in x: first, lowest, highest and
// last, in their order. A line through these covers the same pixels.
std::vector<PlotPoint> decimate_columns(std::span<const PlotPoint> points);

}  // namespace handhold
