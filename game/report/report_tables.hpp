#pragma once

#include <string>

#include "components/stats.hpp"
#include "game/report/run_summary.hpp"

// The tables of report.html, each a <table> element.
namespace handhold {

// Run times: median, 99th percentile and maximum of each stage and of the whole frame, and each
// stage's share of the total.
std::string make_stage_table(const RunSummary& summary);
// Counters of the solver: totals, and means over `frames`.
std::string make_work_table(const RunSummary& summary, std::size_t frames);
// All fallbacks with their meanings; those that never occurred are greyed.
std::string make_fallback_table(const RunSummary& summary);
// The momentum that objects, players, the virtual player and fixed bodies received, and how far
// their sum is from zero, relative to all impulses.
std::string make_momentum_table(const MomentumFigures& momentum);
std::string make_player_table(const RunSummary& summary);

}  // namespace handhold
