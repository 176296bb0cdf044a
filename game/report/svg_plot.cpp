#include "game/report/svg_plot.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "game/report/plot_axis.hpp"
#include "game/report/text.hpp"

namespace handhold {
namespace {

constexpr double k_margin_left_px = 58.0;
constexpr double k_margin_right_px = 14.0;
constexpr double k_title_px = 20.0;   // height of the title's line
constexpr double k_legend_px = 20.0;  // height of each line of the legend
constexpr double k_margin_bottom_px = 44.0;
constexpr double k_letter_px = 6.6;   // mean width of a letter, to lay out the legend
constexpr double k_swatch_px = 34.0;  // line sample and gaps in the legend
constexpr std::size_t k_max_name_letters = 28;

struct Range {
    double low = std::numeric_limits<double>::infinity();
    double high = -std::numeric_limits<double>::infinity();

    void add(double value) {
        low = std::min(low, value);
        high = std::max(high, value);
    }
    bool is_empty() const { return low > high; }
    double span() const { return high - low; }
};

struct PlotRanges {
    Range x;
    Range y;
    double least_positive_y = std::numeric_limits<double>::infinity();
};

struct PlotFrame {
    PlotAxis x;
    PlotAxis y;
};

// Points beyond 1e100 count as not finite: their span would overflow, and such values are errors
// anyway.
bool is_finite_point(const PlotPoint& point) {
    constexpr double k_most = 1e100;
    return std::abs(point.x) <= k_most && std::abs(point.y) <= k_most;
}

PlotRanges find_ranges(const LinePlot& plot) {
    PlotRanges ranges;
    for (const PlotSeries& series : plot.series) {
        for (const PlotPoint& point : series.points) {
            if (!is_finite_point(point)) {
                continue;
            }
            ranges.x.add(point.x);
            ranges.y.add(point.y);
            if (point.y > 0.0) {
                ranges.least_positive_y = std::min(ranges.least_positive_y, point.y);
            }
        }
    }
    return ranges;
}

Range widen_to(const Range& range, double span) {
    const double middle = 0.5 * (range.low + range.high);
    return {middle - 0.5 * span, middle + 0.5 * span};
}

// Gives both ranges the same scale, with a margin around the path.
void make_equal(PlotRanges& ranges, double width_px, double height_px) {
    constexpr double k_room = 1.1;
    constexpr double k_narrowest = 0.1;
    // Far from zero a span must exceed the spacing of doubles.
    constexpr double k_min_share = 1e-9;
    const double farthest = std::max({std::abs(ranges.x.low), std::abs(ranges.x.high),
                                      std::abs(ranges.y.low), std::abs(ranges.y.high)});
    const double least_span = std::max(k_narrowest, k_min_share * farthest);
    const double per_px =
        std::max({ranges.x.span() * k_room / width_px, ranges.y.span() * k_room / height_px,
                  least_span / std::min(width_px, height_px)});
    ranges.x = widen_to(ranges.x, per_px * width_px);
    ranges.y = widen_to(ranges.y, per_px * height_px);
}

PlotAxis make_value_axis(const PlotRanges& ranges, PlotScale scale, int tick_count) {
    if (scale == PlotScale::logarithmic && std::isfinite(ranges.least_positive_y)) {
        return make_logarithmic_axis(ranges.least_positive_y, ranges.y.high);
    }
    return make_rounded_axis(std::min(ranges.y.low, 0.0), std::max(ranges.y.high, 0.0), tick_count);
}

PlotFrame make_frame(const LinePlot& plot, double top_px) {
    constexpr double k_px_per_x_tick = 90.0;
    constexpr double k_px_per_y_tick = 45.0;
    const double right_px = plot.width_px - k_margin_right_px;
    const double bottom_px = plot.height_px - k_margin_bottom_px;
    const int x_ticks =
        std::max(2, static_cast<int>((right_px - k_margin_left_px) / k_px_per_x_tick));
    const int y_ticks = std::max(2, static_cast<int>((bottom_px - top_px) / k_px_per_y_tick));
    PlotRanges ranges = find_ranges(plot);
    if (ranges.x.is_empty()) {
        ranges.x = {0.0, 1.0};
        ranges.y = {0.0, 1.0};
    }
    PlotFrame frame;
    if (plot.scale == PlotScale::equal) {
        make_equal(ranges, right_px - k_margin_left_px, bottom_px - top_px);
        frame.y = make_exact_axis(ranges.y.low, ranges.y.high, y_ticks);
    } else {
        ranges.x.add(0.0);
        frame.y = make_value_axis(ranges, plot.scale, y_ticks);
    }
    frame.x = make_exact_axis(ranges.x.low, ranges.x.high, x_ticks);
    frame.x.from_px = k_margin_left_px;
    frame.x.to_px = right_px;
    frame.y.from_px = bottom_px;
    frame.y.to_px = top_px;
    return frame;
}

std::string pixel(double value) {
    std::string text;
    append_fixed(text, value, 1);
    return text;
}

std::string class_of(int color) {
    return color == k_plot_color_whole ? "sw" : "s" + std::to_string(color % k_plot_colors);
}

void append_line(std::string& svg, const char* kind, const PlotPoint& from, const PlotPoint& to) {
    svg += std::string("<line class=\"") + kind + "\" x1=\"" + pixel(from.x) + "\" y1=\"" +
           pixel(from.y) + "\" x2=\"" + pixel(to.x) + "\" y2=\"" + pixel(to.y) + "\"/>";
}

void append_text(std::string& svg, const char* kind, const PlotPoint& at, const std::string& text) {
    svg += std::string("<text class=\"") + kind + "\" x=\"" + pixel(at.x) + "\" y=\"" +
           pixel(at.y) + "\">" + escape_html(text) + "</text>";
}

void append_axes(std::string& svg, const PlotFrame& frame) {
    constexpr double k_x_label_gap_px = 17.0;
    constexpr double k_y_label_gap_px = 7.0;
    constexpr double k_half_letter_px = 4.0;
    for (const AxisTick& tick : frame.y.ticks) {
        const double y = frame.y.to_pixel(tick.value);
        append_line(svg, "grid", {frame.x.from_px, y}, {frame.x.to_px, y});
        append_text(svg, "ylab", {frame.x.from_px - k_y_label_gap_px, y + k_half_letter_px},
                    tick.label);
    }
    for (const AxisTick& tick : frame.x.ticks) {
        const double x = frame.x.to_pixel(tick.value);
        append_line(svg, "grid", {x, frame.y.from_px}, {x, frame.y.to_px});
        append_text(svg, "xlab", {x, frame.y.from_px + k_x_label_gap_px}, tick.label);
    }
    append_line(svg, "axis", {frame.x.from_px, frame.y.from_px}, {frame.x.to_px, frame.y.from_px});
}

// Inserts the factor before the unit: "error (mm)" becomes "error (10⁻⁶ mm)".
std::string add_factor(const std::string& label, const std::string& factor) {
    const std::size_t unit = label.find('(');
    if (factor.empty()) {
        return label;
    }
    return unit == std::string::npos
               ? label + " (" + factor + ")"
               : label.substr(0, unit + 1) + factor + " " + label.substr(unit + 1);
}

// Cuts the name after k_max_name_letters whole UTF-8 characters.
std::string shorten(const std::string& name) {
    std::size_t letters = 0;
    for (std::size_t i = 0; i < name.size(); ++i) {
        const bool begins_letter = (static_cast<unsigned char>(name[i]) & 0xC0U) != 0x80U;
        if (begins_letter && ++letters > k_max_name_letters) {
            return name.substr(0, i) + "…";
        }
    }
    return name;
}

struct LegendEntry {
    PlotPoint at;
    std::string name;
    int color = 0;
};

// Places the legend's entries from left to right below the title, in as many lines as needed.
std::vector<LegendEntry> place_legend(const LinePlot& plot) {
    constexpr double k_legend_left_px = 2.0;  // space for round line ends
    std::vector<LegendEntry> entries;
    if (plot.series.size() < 2) {
        return entries;
    }
    PlotPoint at = {k_legend_left_px, k_title_px + k_legend_px};
    for (const PlotSeries& series : plot.series) {
        std::string name = shorten(series.name);
        const double width = k_swatch_px + k_letter_px * static_cast<double>(name.size());
        if (at.x > k_legend_left_px && at.x + width > plot.width_px - k_margin_right_px) {
            at = {k_legend_left_px, at.y + k_legend_px};
        }
        entries.push_back({at, std::move(name), series.color});
        at.x += width;
    }
    return entries;
}

void append_legend(std::string& svg, const std::vector<LegendEntry>& entries) {
    constexpr double k_line_px = 16.0;
    constexpr double k_text_px = 21.0;
    constexpr double k_raise_px = 4.0;
    for (const LegendEntry& entry : entries) {
        const double y = entry.at.y - k_raise_px;
        append_line(svg, ("key " + class_of(entry.color)).c_str(), {entry.at.x, y},
                    {entry.at.x + k_line_px, y});
        append_text(svg, "name", {entry.at.x + k_text_px, entry.at.y}, entry.name);
    }
}

// Appends an unbroken part of a line to an SVG path. A single point becomes a dot: a line of zero
// length with round ends.
void append_run(std::string& path, std::span<const PlotPoint> run) {
    std::string last;
    std::size_t count = 0;
    for (const PlotPoint& point : decimate_columns(run)) {
        std::string text = pixel(point.x) + ' ' + pixel(point.y);
        if (text != last) {
            path += count == 0 ? 'M' : 'L';
            path += text;
            last = std::move(text);
            ++count;
        }
    }
    if (count == 1) {
        path += "h0";
    }
}

void append_ends(std::string& svg, const std::vector<PlotPoint>& pixels, int color) {
    const auto append_dot = [&](const char* kind, const PlotPoint& at) {
        svg += std::string("<circle class=\"") + kind + " " + class_of(color) + "\" cx=\"" +
               pixel(at.x) + "\" cy=\"" + pixel(at.y) + "\" r=\"4\"/>";
    };
    const auto first = std::find_if(pixels.begin(), pixels.end(), is_finite_point);
    const auto last = std::find_if(pixels.rbegin(), pixels.rend(), is_finite_point);
    if (first != pixels.end()) {
        append_dot("begin", *first);
        append_dot("end", *last);
    }
}

void append_series(std::string& svg, const PlotSeries& series, const PlotFrame& frame,
                   bool marks_ends) {
    std::vector<PlotPoint> pixels;
    pixels.reserve(series.points.size());
    for (const PlotPoint& point : series.points) {
        pixels.push_back(is_finite_point(point)
                             ? PlotPoint{frame.x.to_pixel(point.x), frame.y.to_pixel(point.y)}
                             : point);
    }
    std::string path;
    for (auto begin = pixels.begin(); begin != pixels.end();) {
        begin = std::find_if(begin, pixels.end(), is_finite_point);
        const auto end = std::find_if_not(begin, pixels.end(), is_finite_point);
        if (begin != end) {
            append_run(path, std::span<const PlotPoint>(begin, end));
        }
        begin = end;
    }
    if (path.empty()) {
        return;
    }
    svg += "<path class=\"line " + class_of(series.color) + "\" d=\"" + path + "\"><title>" +
           escape_html(series.name) + "</title></path>";
    if (marks_ends) {
        append_ends(svg, pixels, series.color);
    }
}

}  // namespace

std::vector<PlotPoint> decimate_columns(std::span<const PlotPoint> points) {
    std::vector<PlotPoint> kept;
    for (std::size_t begin = 0; begin < points.size();) {
        const double column = std::floor(points[begin].x);
        std::size_t lowest = begin;
        std::size_t highest = begin;
        std::size_t end = begin;
        for (; end < points.size() && std::floor(points[end].x) == column; ++end) {
            lowest = points[end].y < points[lowest].y ? end : lowest;
            highest = points[end].y > points[highest].y ? end : highest;
        }
        std::array<std::size_t, 4> wanted = {begin, lowest, highest, end - 1};
        std::sort(wanted.begin(), wanted.end());
        for (std::size_t i = 0; i < wanted.size(); ++i) {
            if (i == 0 || wanted[i] != wanted[i - 1]) {
                kept.push_back(points[wanted[i]]);
            }
        }
        begin = end;
    }
    return kept;
}

std::string draw_line_plot(const LinePlot& plot) {
    constexpr double k_label_gap_px = 6.0;
    const std::vector<LegendEntry> legend = place_legend(plot);
    const double unit_px = legend.empty() ? k_title_px + 2.0 * k_label_gap_px
                                          : legend.back().at.y + k_legend_px + k_label_gap_px;
    const double top_px = unit_px + 2.0 * k_label_gap_px;
    const PlotFrame frame = make_frame(plot, top_px);

    std::string svg = "<svg class=\"plot\" role=\"img\" aria-label=\"" + escape_html(plot.title) +
                      "\" viewBox=\"0 0 " + pixel(plot.width_px) + ' ' + pixel(plot.height_px) +
                      "\">";
    append_text(svg, "title", {0.0, k_title_px - k_label_gap_px}, plot.title);
    append_text(svg, "unit", {0.0, unit_px}, add_factor(plot.y_label, frame.y.factor));
    append_text(svg, "xunit", {0.5 * (frame.x.from_px + frame.x.to_px), plot.height_px - 6.0},
                add_factor(plot.x_label, frame.x.factor));
    append_legend(svg, legend);
    append_axes(svg, frame);
    const std::size_t empty_size = svg.size();
    for (const PlotSeries& series : plot.series) {
        append_series(svg, series, frame, plot.scale == PlotScale::equal);
    }
    if (svg.size() == empty_size) {
        append_text(
            svg, "empty",
            {0.5 * (frame.x.from_px + frame.x.to_px), 0.5 * (frame.y.from_px + frame.y.to_px)},
            "no data");
    }
    return svg + "</svg>\n";
}

std::string line_plot_css() {
    // Hues that colour-blind readers can tell apart, in order of use. They are darker for a light
    // background and lighter for a dark one.
    constexpr std::array<const char*, k_plot_colors> k_on_light = {"#1f6fd0", "#d9600a", "#0f8a63",
                                                                   "#8a4fc4", "#c2307a", "#8a6a10"};
    constexpr std::array<const char*, k_plot_colors> k_on_dark = {"#6fb0ff", "#ff9d57", "#4fcf9a",
                                                                  "#c09bf0", "#f584b6", "#d8b95c"};
    std::string light =
        ":root{--plot-ground:#ffffff;--plot-whole:#59636e;--plot-grid:#e4e7eb;--plot-axis:#8b949e;"
        "--plot-text:#59636e;--plot-title:#1f2328;";
    std::string dark =
        "@media (prefers-color-scheme:dark){:root{--plot-ground:#161b22;--plot-whole:#a5afba;"
        "--plot-grid:#2b3138;--plot-axis:#6b7580;--plot-text:#a5afba;"
        "--plot-title:#e6edf3;";
    std::string rules;
    for (std::size_t i = 0; i < k_on_light.size(); ++i) {
        const std::string variable = "--plot-" + std::to_string(i);
        light += variable + ":" + k_on_light[i] + ";";
        dark += variable + ":" + k_on_dark[i] + ";";
        rules += ".plot .s" + std::to_string(i) + "{color:var(" + variable + ")}\n";
    }
    return light + "}\n" + dark + "}}\n" + rules +
           ".plot .sw{color:var(--plot-whole)}\n"
           ".plot .line,.plot .key,.plot .begin,.plot .end{stroke:currentColor}\n"
           ".plot{display:block;width:100%;height:auto}\n"
           ".plot text{font:12px system-ui,sans-serif;fill:var(--plot-text)}\n"
           ".plot .title{font-size:14px;font-weight:600;fill:var(--plot-title)}\n"
           ".plot .name{fill:var(--plot-title)}\n"
           ".plot .xlab,.plot .xunit,.plot .empty{text-anchor:middle}\n"
           ".plot .ylab{text-anchor:end}\n"
           ".plot .xlab,.plot .ylab{font-variant-numeric:tabular-nums}\n"
           ".plot .grid{stroke:var(--plot-grid)}\n"
           ".plot .axis{stroke:var(--plot-axis)}\n"
           ".plot .line{fill:none;stroke-width:1.4;stroke-linejoin:round;stroke-linecap:round}\n"
           ".plot .key{stroke-width:3;stroke-linecap:round}\n"
           ".plot .begin{fill:var(--plot-ground);stroke-width:2}\n"
           ".plot .end{stroke-width:2;fill:currentColor}\n";
}

}  // namespace handhold
