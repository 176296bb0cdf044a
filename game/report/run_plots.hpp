#pragma once

#include "game/report/run_summary.hpp"
#include "game/report/svg_plot.hpp"
#include "game/run/run_log.hpp"

// The plots of report.html. With several players, paths are those of the first k_plot_colors
// players; errors and push-back are those of the worst player in each frame.
namespace handhold {

// Paths of the heads in the world, at equal scales. From above (+Y), forward (-Z) is up; from the
// side (+X), forward is to the right.
LinePlot plot_head_from_above(const RunLog& log);
LinePlot plot_head_from_side(const RunLog& log);
// Values over time. A hand that does not grip has no grab error.
LinePlot plot_grab_errors(const RunLog& log);
LinePlot plot_residual(const RunLog& log);
LinePlot plot_push_back(const RunLog& log);
// Times of the whole frame and of the most expensive stages. The axis is logarithmic, so that a
// rare slow frame does not flatten the rest.
LinePlot plot_stage_times(const RunLog& log, const RunSummary& summary);

}  // namespace handhold
