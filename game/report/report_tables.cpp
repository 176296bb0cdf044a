#include "game/report/report_tables.hpp"

#include <array>
#include <initializer_list>

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

std::string make_vector_cell(const Vec3& v) {
    return make_number_cell(format_figure(v.x()) + ", " + format_figure(v.y()) + ", " +
                            format_figure(v.z()));
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

const char* meaning_of(Fallback reason) {
    switch (reason) {
        case Fallback::sample_out_of_order:
            return "A tracking sample older than the one before it was ignored.";
        case Fallback::sample_not_finite:
            return "A device's pose that was not finite or not a rotation was ignored.";
        case Fallback::tracking_lost:
            return "A device sent nothing or invalid poses; its last pose was kept.";
        case Fallback::hand_out_of_reach:
            return "A hand was farther from its head than any arm reaches; the sample was "
                   "ignored.";
        case Fallback::head_recentred:
            return "The head's tracking jumped; the player stayed in place in the world.";
        case Fallback::device_asleep:
            return "A controller at exactly (0, 0, 0) was ignored: it is not tracked yet.";
        case Fallback::hand_implausible:
            return "A sample had a hand move faster than a hand can; it was ignored.";
        case Fallback::space_recentred:
            return "Head and hands jumped together: the play space was recentred, nobody moved.";
        case Fallback::grab_no_surface:
            return "A hand closed with no surface within reach; it holds nothing.";
        case Fallback::grip_stretched:
            return "A hand was pulled farther from its anchor than the stretch allows and let go.";
        case Fallback::grip_lost:
            return "A hand was open when its tracking returned; it released without a throw.";
        case Fallback::grip_body_gone:
            return "The gripped body was destroyed; the hand let go.";
        case Fallback::grip_reanchored:
            return "Tracking returned, or the other hand released: the grip took a new anchor "
                   "at the hand.";
        case Fallback::two_hand_grip_ended:
            return "One of two hands let go; nothing was thrown.";
        case Fallback::hands_too_close:
            return "Two hands on one body were too close to turn it; only the first one moved it.";
        case Fallback::grab_refused_by_rule:
            return "A hand closed where everything within reach refuses it by a rule or layer.";
        case Fallback::grab_needs_two_hands:
            return "One hand closed on a body that only both hands grip; it holds nothing.";
        case Fallback::grip_needs_two_hands:
            return "One of both hands left a body that needs two; the other let go.";
        case Fallback::grip_ended_by_host:
            return "The host ordered a gripping hand to let go.";
        case Fallback::grip_out_of_reach:
            return "After a tracking jump a palm was too far from what it gripped and let go.";
        case Fallback::grip_speed_limited:
            return "A gripping hand moved faster than a hand can; its grip slipped by the rest.";
        case Fallback::grab_out_of_sight:
            return "A hand closed behind a wall; it did not grip through it.";
        case Fallback::contact_rounds_exhausted:
            return "New contacts appeared after the last allowed round; they wait for the next "
                   "frame.";
        case Fallback::contacts_contradict:
            return "The hands' targets contradicted contacts; the hands' rows were dropped.";
        case Fallback::contacts_unresolved:
            return "Contacts still overlapped at the end of the frame.";
        case Fallback::restored_last_valid_pose:
            return "Bodies stayed inside a surface; they were restored to their last valid "
                   "pose.";
        case Fallback::active_set_not_converged:
            return "A solve ended before the set of pushing contacts converged; some may overlap.";
        case Fallback::hands_load_stepped:
            return "Hands jumped too far for one solve; it moved them in load steps.";
        case Fallback::load_stepping_failed:
            return "Hands jumped too far for one solve, and load stepping failed "
                   "too.";
        case Fallback::friction_not_converged:
            return "Sticking and sliding contacts did not converge; the result is approximate.";
        case Fallback::solver_budget:
            return "Bodies in contact needed more work than a frame allows; the rest went on in "
                   "the next frame.";
        case Fallback::release_speed_clamped:
            return "A release was faster than allowed; its speed was limited.";
        case Fallback::object_speed_clamped:
            return "A body moved by hands, or spinning, was faster than allowed; its speed was "
                   "limited.";
        case Fallback::head_ignores_full:
            return "The head passed through more bodies than it remembers; the oldest was "
                   "forgotten.";
        case Fallback::finger_full_search:
            return "A finger's searches failed; it tested every surface within its reach.";
        case Fallback::finger_depenetrated:
            return "A finger would have penetrated something, straight or while closing; it was "
                   "bent until it was clear.";
        case Fallback::finger_opened:
            return "A finger still penetrated something and was opened by a step.";
        case Fallback::finger_no_contact:
            return "A finger or thumb of a gripping hand met nothing; it goes with the others.";
        case Fallback::hand_penetrates:
            return "A hand did not fit; it is shown more than 3 mm inside a surface.";
        case Fallback::body_no_surface:
            return "A gripped body has no surface for hands; the hand is shown as tracked.";
        case Fallback::palm_no_surface:
            return "A gripping hand had nothing under its palm; it is shown as tracked.";
        case Fallback::authored_grip_occupied:
            return "Another hand occupied the authored grip; the hand took the next best.";
        case Fallback::authored_grip_blocked:
            return "Something stood between a hand and a grip; the hand took the next best.";
        case Fallback::authored_grip_abandoned:
            return "A hand turned far away from its grip; it holds on as to any surface.";
        case Fallback::authored_finger_rejected:
            return "An authored finger pose would have penetrated; the finger closed as on any "
                   "surface.";
        case Fallback::pull_refused_fixed:
            return "A distance grab hit a fixed or jointed body; nothing was pulled.";
        case Fallback::pull_refused_heavy:
            return "A distance grab hit a body that is too heavy; nothing was pulled.";
        case Fallback::pull_refused_held:
            return "A distance grab hit a body that another hand holds or pulls; nothing was "
                   "pulled.";
        case Fallback::pull_lost:
            return "The pulled body was destroyed, too far or in another hand, or the hand was "
                   "lost; the pull ended.";
        case Fallback::surface_answer_invalid:
            return "A host's surfaces gave numbers that mean nothing; the answer was ignored.";
        case Fallback::count:
            break;
    }
    return "";
}

std::string make_stage_table(const RunSummary& summary) {
    std::string rows = make_head({"stage"}, {"median µs", "p99 µs", "max µs", "of all time"});
    // The column of bars has no heading.
    const std::size_t head_end = rows.find("</tr>");
    rows.insert(head_end, "<th></th>");
    rows += "<tbody>\n";
    const double all_us = summary.frame.total_us;
    for (std::size_t i = 0; i < summary.stages.size(); ++i) {
        const TimeFigures& times = summary.stages[i];
        rows += make_time_row(name_of(static_cast<Stage>(i)), times,
                              all_us > 0.0 ? times.total_us / all_us : 0.0, "");
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
    const StageStats& totals = summary.totals;
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
                name_of(reason) + "</td><td>" + meaning_of(reason) + "</td>" +
                make_number_cell(static_cast<double>(times)) + "</tr>\n";
    }
    return wrap_table(rows);
}

std::string make_momentum_table(const MomentumFigures& momentum) {
    constexpr std::array<const char*, MomentumLedger::receiver_count> k_receivers = {
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
                make_number_cell(player.path_m) +
                make_number_cell(player.push_back_m * k_mm_per_m) + "</tr>\n";
    }
    return wrap_table(rows);
}

}  // namespace handhold
