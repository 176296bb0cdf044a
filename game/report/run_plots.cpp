#include "game/report/run_plots.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>

#include "game/report/text.hpp"

namespace handhold {
namespace {

constexpr double k_nothing = std::numeric_limits<double>::quiet_NaN();
constexpr char k_time_label[] = "time (s)";

// Projects a head's position onto a plot.
using PlacePoint = PlotPoint (*)(const hh::Vec3& head_ws);

LinePlot plot_head(const RunLog& log, PlacePoint place) {
    constexpr double k_path_width_px = 500.0;
    constexpr double k_path_height_px = 420.0;
    LinePlot plot;
    plot.scale = PlotScale::equal;
    plot.width_px = k_path_width_px;
    plot.height_px = k_path_height_px;
    const auto shown = std::min(log.player_names.size(), static_cast<std::size_t>(k_plot_colors));
    for (std::size_t i = 0; i < shown; ++i) {
        plot.series.push_back({log.player_names[i], {}, static_cast<int>(i)});
        plot.series.back().points.reserve(log.frames.size());
    }
    for (const FrameLog& frame : log.frames) {
        for (const PlayerLog& player : frame.players) {
            if (player.player < shown) {
                plot.series[player.player].points.push_back(place(player.head_ws));
            }
        }
    }
    return plot;
}

// One point for each frame: time and value.
template <typename ValueOf>
std::vector<PlotPoint> list_over_time(const RunLog& log, const ValueOf& value_of) {
    std::vector<PlotPoint> points;
    points.reserve(log.frames.size());
    for (const FrameLog& frame : log.frames) {
        points.push_back({frame.t_s, value_of(frame)});
    }
    return points;
}

LinePlot plot_over_time(const char* title, const char* y_label) {
    LinePlot plot;
    plot.title = title;
    plot.x_label = k_time_label;
    plot.y_label = y_label;
    return plot;
}

double worst_grab_error_mm(const FrameLog& frame, std::size_t side) {
    double worst_mm = k_nothing;
    for (const PlayerLog& player : frame.players) {
        const HandLog& hand = player.hands[side];
        if (hand.grip != 0) {
            worst_mm = std::fmax(worst_mm, hand.error_m * k_mm_in_m);
        }
    }
    return worst_mm;
}

}  // namespace

LinePlot plot_head_from_above(const RunLog& log) {
    LinePlot plot = plot_head(log, [](const hh::Vec3& head) { return PlotPoint{head.x, -head.z}; });
    plot.title = "Head from above";
    plot.x_label = "x, right (m)";
    plot.y_label = "−z, forward (m)";
    return plot;
}

LinePlot plot_head_from_side(const RunLog& log) {
    LinePlot plot = plot_head(log, [](const hh::Vec3& head) { return PlotPoint{-head.z, head.y}; });
    plot.title = "Head from the side";
    plot.x_label = "−z, forward (m)";
    plot.y_label = "y, up (m)";
    return plot;
}

LinePlot plot_grab_errors(const RunLog& log) {
    LinePlot plot = plot_over_time("Gripping hand against its anchor", "error (mm)");
    constexpr std::array<const char*, 2> k_hands = {"left hand", "right hand"};
    for (std::size_t side = 0; side < 2; ++side) {
        plot.series.push_back(
            {k_hands[side],
             list_over_time(log, [&](const FrameLog& f) { return worst_grab_error_mm(f, side); }),
             static_cast<int>(side)});
    }
    return plot;
}

LinePlot plot_residual(const RunLog& log) {
    LinePlot plot = plot_over_time("Contact overlap left at the end of the frame", "overlap (mm)");
    plot.series.push_back({"residual", list_over_time(log, [](const FrameLog& frame) {
                               return frame.stats.residual_m * k_mm_in_m;
                           })});
    return plot;
}

LinePlot plot_push_back(const RunLog& log) {
    LinePlot plot = plot_over_time("Push-back of the player", "in one frame (mm)");
    plot.series.push_back({"push-back", list_over_time(log, [](const FrameLog& frame) {
                               double worst_m = 0.0;
                               for (const PlayerLog& player : frame.players) {
                                   worst_m = std::max(worst_m, player.push_back_m);
                               }
                               return worst_m * k_mm_in_m;
                           })});
    return plot;
}

LinePlot plot_stage_times(const RunLog& log, const RunSummary& summary) {
    constexpr std::size_t k_shown_stages = 4;
    constexpr double k_time_height_px = 340.0;
    LinePlot plot = plot_over_time("Time of the frame and of its costliest stages", "time (µs)");
    plot.scale = PlotScale::logarithmic;
    plot.height_px = k_time_height_px;
    plot.series.push_back({"whole frame",
                           list_over_time(log,
                                          [](const FrameLog& frame) {
                                              const auto& us = frame.stats.stage_us;
                                              return std::accumulate(us.begin(), us.end(), 0.0);
                                          }),
                           k_plot_color_whole});
    std::vector<std::size_t> order(summary.stages.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
        return summary.stages[a].total_us > summary.stages[b].total_us;
    });
    for (std::size_t i = 0; i < k_shown_stages; ++i) {
        const std::size_t stage = order[i];
        plot.series.push_back(
            {hh_stage_name(stage),
             list_over_time(log, [stage](const FrameLog& f) { return f.stats.stage_us[stage]; }),
             static_cast<int>(i)});
    }
    return plot;
}

}  // namespace handhold
