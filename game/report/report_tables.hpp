#pragma once

#include <string>

#include "components/stats.hpp"
#include "game/report/run_summary.hpp"

// The tables of report.html, each a <table> element.
namespace handhold {

// Median, 99th percentile and maximum of each stage and of the whole frame, and the stage's share
// of all time.
std::string make_stage_table(const RunSummary& summary);
// What the solver did: totals, and means over `frames`.
std::string make_work_table(const RunSummary& summary, std::size_t frames);
// Every fallback with its meaning; those that never happened are greyed.
std::string make_fallback_table(const RunSummary& summary);
// Momentum by who received it, and what is missing to zero.
std::string make_momentum_table(const MomentumFigures& momentum);
std::string make_player_table(const RunSummary& summary);

// What happened and what the runtime did instead, as a sentence for people.
const char* meaning_of(Fallback reason);

}  // namespace handhold
