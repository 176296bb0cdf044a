#include "game/report/report_html.hpp"

#include "engine/core/text_file.hpp"
#include "game/mesh/image.hpp"
#include "game/report/report_tables.hpp"
#include "game/report/run_plots.hpp"
#include "game/report/run_summary.hpp"
#include "game/report/text.hpp"

namespace handhold {
namespace {

constexpr char k_page_css[] = R"(
:root{color-scheme:light dark;--page:#f4f5f7;--line:#dfe3e8;--ink:#1f2328;--soft:#59636e}
@media (prefers-color-scheme:dark){:root{--page:#0d1117;--line:#2b3138;--ink:#e6edf3;--soft:#a5afba}}
*{box-sizing:border-box}
body{margin:0;background:var(--page);color:var(--ink);font:15px/1.5 system-ui,sans-serif}
main{max-width:1120px;margin:0 auto;padding:32px 24px 64px}
h1{font-size:28px;line-height:1.2;margin:0 0 4px}
h2{font-size:18px;margin:36px 0 12px}
p{margin:0 0 12px;max-width:75ch}
.soft{color:var(--soft)}
code,.hash{font-family:ui-monospace,"DejaVu Sans Mono",monospace;font-size:.92em}
.card{background:var(--plot-ground);border:1px solid var(--line);border-radius:8px;padding:16px;margin:0 0 16px}
.tiles{display:grid;grid-template-columns:repeat(auto-fit,minmax(230px,1fr));gap:12px;margin:20px 0 0}
.tiles .card{margin:0;padding:12px 16px}
.tiles dt{color:var(--soft);font-size:13px}
.tiles dd{margin:0;font-size:22px;font-weight:600;font-variant-numeric:tabular-nums}
.tiles dd.note{font-size:13px;font-weight:400;color:var(--soft)}
dl{margin:0}
.facts{display:grid;grid-template-columns:max-content 1fr;gap:2px 16px;margin:12px 0 0}
.facts dt{color:var(--soft)}
.facts dd{margin:0;overflow-wrap:anywhere}
.pictures,.pair{display:grid;grid-template-columns:repeat(auto-fit,minmax(min(100%,420px),1fr));gap:16px}
figure{margin:0}
.pair .card{margin:0 0 16px}
figure img,video{display:block;width:100%;height:auto;border-radius:8px;border:1px solid var(--line)}
figcaption{color:var(--soft);font-size:13px;margin-top:6px}
video{margin:0 0 16px}
.scroll{overflow-x:auto}
table{border-collapse:collapse;width:100%;font-size:14px}
th{text-align:left;font-weight:600;color:var(--soft);font-size:13px}
th,td{padding:5px 12px 5px 0;border-bottom:1px solid var(--line);vertical-align:top}
tbody tr:last-child td{border-bottom:0}
td:first-child{white-space:nowrap}
.number{text-align:right;font-variant-numeric:tabular-nums;white-space:nowrap}
td:last-child,th:last-child{padding-right:0}
.total td{font-weight:600}
.never td{color:var(--soft);opacity:.7}
.share{width:22%;min-width:90px;vertical-align:middle}
.share span{display:block;height:8px;min-width:1px;border-radius:2px;background:var(--plot-0)}
)";

// A relative link. Special characters are percent-encoded, so that no name is read as a scheme or a
// query.
std::string escape_link(std::string_view path) {
    constexpr char k_digits[] = "0123456789ABCDEF";
    constexpr std::string_view k_plain =
        "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789-._~/";
    std::string link;
    for (const char c : path) {
        if (k_plain.find(c) != std::string_view::npos) {
            link += c;
        } else {
            const auto byte = static_cast<unsigned char>(c);
            link += {'%', k_digits[byte >> 4U], k_digits[byte & 15U]};
        }
    }
    return link;
}

std::string make_fact(const char* name, const std::string& value_html) {
    return std::string("<dt>") + name + "</dt><dd>" + value_html + "</dd>\n";
}

std::string make_tile(const char* name, const std::string& value, const std::string& note) {
    return std::string("<dl class=\"card\"><dt>") + name + "</dt><dd>" + value +
           "</dd><dd class=\"note\">" + note + "</dd></dl>\n";
}

std::string make_header(const RunLog& log) {
    const auto or_dash = [](const std::string& text) {
        return text.empty() ? std::string("none") : escape_html(text);
    };
    return "<header>\n<h1>" + escape_html(log.scene) + "</h1>\n<dl class=\"facts\">\n" +
           make_fact("input", or_dash(log.input)) + make_fact("spawn", or_dash(log.spawn)) +
           make_fact("players", format_figure(static_cast<double>(log.player_names.size()))) +
           make_fact("state hash",
                     "<span class=\"hash\">" + format_hash(log.state_hash) + "</span>") +
           "</dl>\n";
}

std::string make_tiles(const RunLog& log, const RunSummary& summary) {
    const auto mm = [](double value_m) { return format_figure(value_m * k_mm_in_m) + " mm"; };
    const double path_m = summary.players.empty() ? 0.0 : summary.players.front().path_m;
    const RunStats& totals = summary.totals;
    return "<div class=\"tiles\">\n" +
           make_tile("Played", format_figure(summary.duration_s) + " s",
                     format_figure(static_cast<double>(log.frames.size())) + " frames at " +
                         format_figure(log.hz) + " Hz") +
           make_tile("Speed", format_figure(summary.frames_per_s) + " frames/s",
                     format_figure(summary.frames_per_s / log.hz) + " × real time, threads: " +
                         format_figure(static_cast<double>(log.threads))) +
           make_tile("Frame time", format_figure(summary.frame.median_us) + " µs",
                     "median; 99 % within " + format_figure(summary.frame.p99_us) + " µs") +
           make_tile("Grabs",
                     format_figure(static_cast<double>(totals.grabs_gripped)) + " of " +
                         format_figure(static_cast<double>(totals.grab_onsets)),
                     "found something to hold") +
           make_tile("Contact overlap", mm(summary.residual_m), "worst at the end of a frame") +
           make_tile("Joint error", mm(summary.joint_error_m), "worst at the end of a frame") +
           make_tile("Hand error, free", mm(summary.hand_error.one_hand_free_m),
                     "worst; one hand, nothing touched. Two hands: " +
                         mm(summary.hand_error.two_hands_m)) +
           make_tile("Push-back", mm(summary.push_back_m), "worst in one frame") +
           make_tile("Path", format_figure(path_m) + " m",
                     log.player_names.size() > 1 ? "of the first player's origin"
                                                 : "of the player's origin") +
           "</div>\n</header>\n";
}

std::string make_media(const ReportMedia& media) {
    if (media.pictures.empty() && media.video.empty()) {
        return {};
    }
    std::string html = "<section>\n<h2>Pictures</h2>\n";
    if (!media.video.empty()) {
        const std::string link = escape_link(media.video);
        html += "<video controls preload=\"metadata\" src=\"" + link + "\"><a href=\"" + link +
                "\">" + escape_html(media.video) + "</a></video>\n";
    }
    html += "<div class=\"pictures\">\n";
    for (const ReportPicture& picture : media.pictures) {
        const std::string caption = escape_html(picture.caption);
        html += "<figure><img alt=\"" + caption + "\" src=\"data:image/png;base64,";
        html += encode_base64(picture.png);
        html += "\"><figcaption>" + caption + "</figcaption></figure>\n";
    }
    return html + "</div>\n</section>\n";
}

std::string wrap_card(const std::string& html) {
    return "<div class=\"card\">" + html + "</div>\n";
}

std::string make_plots(const RunLog& log, const RunSummary& summary) {
    std::string html =
        "<section>\n<h2>Path</h2>\n<p class=\"soft\">From the open circle to the "
        "filled one, in the world; one scale for both axes.</p>\n"
        "<div class=\"pair\">\n";
    html += wrap_card(draw_line_plot(plot_head_from_above(log)));
    html += wrap_card(draw_line_plot(plot_head_from_side(log)));
    html += "</div>\n</section>\n<section>\n<h2>Constraints</h2>\n";
    html += wrap_card(draw_line_plot(plot_grab_errors(log)));
    html += wrap_card(draw_line_plot(plot_push_back(log)));
    html += wrap_card(draw_line_plot(plot_residual(log)));
    html += "</section>\n<section>\n<h2>Time</h2>\n";
    html += wrap_card(draw_line_plot(plot_stage_times(log, summary)));
    html += wrap_card(make_stage_table(summary));
    return html + "</section>\n";
}

std::string make_tables(const RunLog& log, const RunSummary& summary) {
    std::string html =
        "<section>\n<h2>Fallbacks</h2>\n<p class=\"soft\">What the runtime did "
        "instead of what was asked, and how often.</p>\n";
    html += wrap_card(make_fallback_table(summary));
    html += "</section>\n<section>\n<h2>Work</h2>\n";
    html += wrap_card(make_work_table(summary, log.frames.size()));
    html +=
        "</section>\n<section>\n<h2>Momentum</h2>\n<p class=\"soft\">Given by constraints over "
        "the whole run. What the virtual player took is what the forward phase "
        "discarded.</p>\n";
    html += wrap_card(make_momentum_table(summary.momentum));
    html += "</section>\n";
    if (summary.players.size() > 1) {
        html += "<section>\n<h2>Players</h2>\n" + wrap_card(make_player_table(summary)) +
                "</section>\n";
    }
    return html;
}

}  // namespace

std::string format_report_html(const RunLog& log, const ReportMedia& media) {
    const RunSummary summary = summarize_run(log);
    std::string html =
        "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
        "<meta name=\"viewport\" content=\"width=device-width,initial-scale=1\">\n<title>" +
        escape_html(log.scene) + " – Handhold run</title>\n<style>\n" + line_plot_css() +
        k_page_css + "</style>\n</head>\n<body>\n<main>\n";
    html += make_header(log);
    html += make_tiles(log, summary);
    html += make_media(media);
    html += make_plots(log, summary);
    html += make_tables(log, summary);
    return html + "</main>\n</body>\n</html>\n";
}

std::optional<FileError> write_report_html(const std::filesystem::path& path, const RunLog& log,
                                           const ReportMedia& media) {
    return write_file_atomically(path, format_report_html(log, media));
}

}  // namespace handhold
