#include "game/report/report_tables.hpp"

#include <array>
#include <initializer_list>

#include "game/report/fallback_meanings.hpp"
#include "game/report/text.hpp"

namespace handhold {
namespace {

std::string make_head(std::initializer_list<const char*> texts,
                      std::initializer_list<const char*> numbers) {
    std::string row = "<tr>";
    for (const char* text : texts) {
        row += std::string("<th>") + text + "</th>";
    }
    for (const char* number : numbers) {
        row += std::string("<th class=\"number\">") + number + "</th>";
    }
    return "<thead>" + row + "</tr></thead>\n";
}

std::string make_number_cell(const std::string& number) {
    return "<td class=\"number\">" + number + "</td>";
}

std::string make_number_cell(double value) { return make_number_cell(format_figure(value)); }

std::string make_vector_cell(const hh::Vec3& v) {
    return make_number_cell(format_figure(v.x) + ", " + format_figure(v.y) + ", " +
                            format_figure(v.z));
}

std::string wrap_table(const std::string& rows) {
    return "<div class=\"scroll\"><table>\n" + rows + "</tbody></table></div>\n";
}

// A table cell with a fixed number of decimals, so that decimal points align.
std::string make_fixed_cell(double value, int decimals, const char* unit = "") {
    std::string text;
    append_fixed(text, value, decimals);
    return make_number_cell(text + unit);
}

std::string make_time_row(const std::string& name, const TimeFigures& times, double share,
                          const char* row_class) {
    const double percent = 100.0 * share;
    std::string width;
    append_fixed(width, percent, 1);
    return std::string("<tr") + row_class + "><td>" + name + "</td>" +
           make_fixed_cell(times.median_us, 1) + make_fixed_cell(times.p99_us, 1) +
           make_fixed_cell(times.max_us, 1) + make_fixed_cell(percent, 1, " %") +
           "<td class=\"share\"><span style=\"width:" + width + "%\"></span></td></tr>\n";
}

}  // namespace

std::string make_stage_table(const RunSummary& summary) {
    std::string rows = make_head({"stage"}, {"median µs", "p99 µs", "max µs", "of all time"});
    // The column of bars has no heading.
    const std::size_t head_end = rows.find("</tr>");
    rows.insert(head_end, "<th></th>");
    rows += "<tbody>\n";
    const double all_us = summary.frame.total_us;
    for (std::size_t i = 0; i < summary.stages.size(); ++i) {
        const TimeFigures& times = summary.stages[i];
        rows += make_time_row(hh_stage_name(i), times, all_us > 0.0 ? times.total_us / all_us : 0.0,
                              "");
    }
    rows +=
        make_time_row("whole frame", summary.frame, all_us > 0.0 ? 1.0 : 0.0, " class=\"total\"");
    return wrap_table(rows);
}

std::string make_work_table(const RunSummary& summary, std::size_t frames) {
    std::string rows = make_head({"counter", "meaning"}, {"total", "a frame"}) + "<tbody>\n";
    const auto add = [&](const char* name, const char* meaning, std::uint64_t total) {
        const auto count = static_cast<double>(total);
        rows += std::string("<tr><td>") + name + "</td><td>" + meaning + "</td>" +
                make_number_cell(count) +
                make_fixed_cell(frames == 0 ? 0.0 : count / static_cast<double>(frames), 3) +
                "</tr>\n";
    };
    const RunStats& totals = summary.totals;
    add("grab_onsets", "hands that closed", totals.grab_onsets);
    add("grabs_gripped", "of these, hands that found something to hold", totals.grabs_gripped);
    add("contacts", "contact points given to the solver", totals.contacts);
    add("contact_rounds", "searches for contacts during the solve", totals.contact_rounds);
    add("islands", "groups of bodies solved together", totals.islands);
    add("islands_pushed", "of these, groups that moved the player", totals.islands_pushed);
    add("newton_iterations", "over all groups and phases", totals.newton_iterations);
    return wrap_table(rows);
}

std::string make_fallback_table(const RunSummary& summary) {
    std::string rows =
        make_head({"fallback", "what happened, and what was done"}, {"times"}) + "<tbody>\n";
    for (std::size_t i = 0; i < summary.totals.fallbacks.size(); ++i) {
        const auto reason = static_cast<Fallback>(i);
        const std::uint64_t times = summary.totals.fallbacks[i];
        rows += std::string(times == 0 ? "<tr class=\"never\">" : "<tr>") + "<td>" +
                hh_fallback_name(i) + "</td><td>" + meaning_of(reason) + "</td>" +
                make_number_cell(static_cast<double>(times)) + "</tr>\n";
    }
    return wrap_table(rows);
}

std::string make_momentum_table(const MomentumFigures& momentum) {
    constexpr std::array<const char*, HH_MOMENTUM_RECEIVERS> k_receivers = {
        "objects", "players", "virtual player", "fixed and driven bodies"};
    std::string rows =
        make_head({"received by"}, {"linear x, y, z (kg m/s)", "angular x, y, z (kg m²/s)"}) +
        "<tbody>\n";
    for (std::size_t i = 0; i < k_receivers.size(); ++i) {
        rows += std::string("<tr><td>") + k_receivers[i] + "</td>" +
                make_vector_cell(momentum.sum.linear_kgmps[i]) +
                make_vector_cell(momentum.sum.angular_kgm2ps[i]) + "</tr>\n";
    }
    rows += "<tr class=\"total\"><td>residual of the sum, relative to all impulses</td>" +
            make_number_cell(momentum.linear_residual) +
            make_number_cell(momentum.angular_residual) + "</tr>\n";
    return wrap_table(rows);
}

std::string make_player_table(const RunSummary& summary) {
    std::string rows =
        make_head({"player"}, {"mass (kg)", "path of the origin (m)", "worst push-back (mm)"}) +
        "<tbody>\n";
    for (const PlayerFigures& player : summary.players) {
        rows += "<tr><td>" + escape_html(player.name) + "</td>" + make_number_cell(player.mass_kg) +
                make_number_cell(player.path_m) + make_number_cell(player.push_back_m * k_mm_in_m) +
                "</tr>\n";
    }
    return wrap_table(rows);
}

}  // namespace handhold
