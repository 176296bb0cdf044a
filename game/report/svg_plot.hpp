#pragma once

#include <span>
#include <string>
#include <vector>

// Line plots as SVG elements for an HTML page. Colours are CSS variables of line_plot_css(), which
// the page includes once; they are readable on light and dark ground.
namespace handhold {

struct PlotPoint {
    double x = 0.0;
    double y = 0.0;
};

// Number of colours of PlotSeries::color, which then repeat; and the colour of a total whose parts
// are the other series.
constexpr int k_plot_colors = 6;
constexpr int k_plot_color_whole = -1;

struct PlotSeries {
    std::string name;  // in the legend
    std::vector<PlotPoint>
        points;  // joined in order; the line breaks at points that are not finite or beyond 1e100
    int color = 0;  // >= 0, or k_plot_color_whole
};

enum class PlotScale {
    linear,       // both axes include 0
    logarithmic,  // y in whole decades, at most six, values below at the lower edge; x includes 0
    equal,        // equal scales around the points: for paths, whose ends are marked
};

struct LinePlot {
    std::string title;
    std::string x_label;  // with unit
    std::string y_label;
    PlotScale scale = PlotScale::linear;
    double width_px = 1000.0;  // of the drawing; it is scaled to the available width
    double height_px = 260.0;
    std::vector<PlotSeries> series;  // one for each name; a legend is drawn for two or more
};

// The <svg> element. Without a finite point: "no data" in empty axes. Its size depends on the
// width, not on the number of points: see decimate_columns.
std::string draw_line_plot(const LinePlot& plot);

// Style rules and colours for all plots of a page. The page may use the colours too: var(--plot-0),
// --plot-text, --plot-ground.
std::string line_plot_css();

// Of each run of consecutive points within one column of width 1 in x: first, lowest, highest and
// last, in their order. A line through these covers the same pixels.
std::vector<PlotPoint> decimate_columns(std::span<const PlotPoint> points);

}  // namespace handhold
