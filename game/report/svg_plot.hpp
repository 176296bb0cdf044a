#pragma once

#include <span>
#include <string>
#include <vector>

// Line plots as SVG elements for an HTML page. Colours are CSS variables of line_plot_css(), which
// the page includes once. They are readable on light and dark backgrounds.
namespace handhold {

struct PlotPoint {
    double x = 0.0;
    double y = 0.0;
};

// k_plot_colors: number of colours; higher values of PlotSeries::color repeat them.
// k_plot_color_whole: the colour of a total whose parts are the other series.
constexpr int k_plot_colors = 6;
constexpr int k_plot_color_whole = -1;

struct PlotSeries {
    std::string name;  // shown in the legend
    // Joined in order; the line breaks at points that are not finite or beyond 1e100.
    std::vector<PlotPoint> points;
    int color = 0;  // >= 0, or k_plot_color_whole
};

enum class PlotScale {
    linear,       // both axes include 0
    logarithmic,  // y in whole decades, at most six, values below at the lower edge; x includes 0
    equal,        // same scale on both axes, for paths; marks the paths' ends
};

struct LinePlot {
    std::string title;
    std::string x_label;  // name with unit
    std::string y_label;
    PlotScale scale = PlotScale::linear;
    double width_px = 1000.0;  // width of the drawing, which is scaled to the available width
    double height_px = 260.0;
    std::vector<PlotSeries> series;  // a legend is drawn for two or more
};

// The <svg> element; without any finite point, empty axes with "no data". The length of the text
// depends on the plot's width, not on the number of points: see decimate_columns.
std::string draw_line_plot(const LinePlot& plot);

// Style rules and colours for all plots of a page. The page may use the colours too: var(--plot-0),
// --plot-text, --plot-ground.
std::string line_plot_css();

// Reduces points for drawing. A column contains the consecutive points whose x have the same
// integer part. Of each column, keeps the first, lowest, highest and last point, in their order. A
// line through these points covers the same pixels.
std::vector<PlotPoint> decimate_columns(std::span<const PlotPoint> points);

}  // namespace handhold
