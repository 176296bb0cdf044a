#pragma once

#include "game/report/run_summary.hpp"
#include "game/report/svg_plot.hpp"
#include "game/session/run_log.hpp"

// The plots of report.html. With several players, paths are those of the first k_plot_colors
// players; errors and push-back are the worst player's in each frame.
namespace handhold {

// Equal axes; the head in the world, seen from above (+Y) and from the side (+X). Forward (-Z) is
// up, or to the right.
LinePlot plot_head_from_above(const RunLog& log);
LinePlot plot_head_from_side(const RunLog& log);
// Against time. A hand that does not grip has no error.
LinePlot plot_grab_errors(const RunLog& log);
LinePlot plot_residual(const RunLog& log);
LinePlot plot_push_back(const RunLog& log);
// The whole frame and the most expensive stages. Logarithmic, so that a rare slow frame does not
// flatten the rest.
LinePlot plot_stage_times(const RunLog& log, const RunSummary& summary);

}  // namespace handhold
