"""Rows of a match report: what was measured, by which command, against which goal."""
import html
import math

from matches import soak
from pages.goals import Goal, figure

MIXED = {"rtt-ms": 150, "jitter-ms": 40, "loss": 0.05}  # the network of most rows
TICKS_PER_S = 90
MATCHES, CORES = 16, 2


class Row(Goal):
    def __init__(self, bar, measured, goal, passed, command):
        super().__init__(bar, measured, goal, passed)
        self.command = command


def cell(value, digits=3):
    return "-" if value is None or not math.isfinite(value) else f"{value:.{digits}g}" if abs(value) < 1000 else f"{value:.0f}"


def bounded(bar, values, limits, unit, command, digits=3):
    """A row of one or more values, each with its upper limit. A value of NaN: not run. No value is rounded to its limit."""
    missing = any(value is None or not math.isfinite(value) for value in values)
    passed = None if missing else all(value <= limit for value, limit in zip(values, limits))
    return Row(bar, " / ".join(cell(value, digits) for value in values) + f" {unit}", "<= " + " / ".join(f"{limit:g}" for limit in limits) + f" {unit}",
               passed, command)


def not_run(bar, goal, command):
    return Row(bar, "-", goal, None, command)


def own_hand(figures, command):
    hand, share = figures["own_hand"], figures["filled_share"]
    return [Row(f"own hand, against what was confirmed: {hand['ticks']} ticks",
                f"{hand['unexplained']} different beyond filled ones; filled {100 * share:.3f} %", "0; <= 0.5 %",
                hand["unexplained"] == 0 and hand["ticks"] > 0 and share <= 0.005, command)]


def together(figures, command):
    shared = figures["beyond_true_motion_mm"]["own_view_shared_load"]
    return [Row("pull a bar, swing a door, hand over a tool, hold each other: hashes of confirmed ticks",
                f"{figures['hashes_compared']} compared, {figures['hashes_different']} different; {figures['shared_holds']} ticks shared, "
                f"{figures['player_holds']} with a held player, {figures['throws']} throws", "0 different",
                figures["hashes_different"] == 0 and figures["exit"] == 0, command),
            bounded("own view beyond the true motion while sharing a body, a tick, 99 %", [shared["shown_p99"]], [8], "mm", command)]


def recorded(figures, age_ms, limits, whose, command):
    """Rows of recorded people at about this state age."""
    age = figures["others_age_ms"]
    at = f"{whose}, state age {age['median']:.0f} ms (95 %: {age['p95']:.0f})"
    errors = [figure(figures, "others_shown_error_mm", key) for key in ("median", "p95")]
    jump = figure(figures, "beyond_true_motion_mm", "others_hands", "shown_p99")
    stepped = figures["others_hand_error_mm"]
    return [bounded(f"others' shown hands against the truth, median / 95 %; {at}; as stepped {cell(stepped['median'])} / {cell(stepped['p95'])}",
                    errors, limits, "mm", command),
            bounded(f"their motion beyond the true one, a tick, 99 %; {whose}, goal age {age_ms} ms", [jump], [15], "mm", command)]


def input_bytes(figures, whose, command):
    return [bounded(f"bytes of an input, mean; {whose}", [figures["input_bytes"]["mean"]], [8], "B", command)]


def rollback(counters, ticks, limit_ms, command):
    measured = [figure(counters, f"frame_ms_{name}") for name in ("median", "p99")]
    row = bounded(f"frame that steps {ticks} ticks again, 8 players in the arena, one thread, 99 % (median {cell(measured[0])})", measured[1:], [limit_ms],
                  "ms", command)
    return [row]


def server_tick(counters, command):
    return [bounded("server: step of a tick, 8 players in the arena, median / 99 %", [figure(counters, f"tick_us_{name}") / 1000 for name in ("median", "p99")],
                    [0.25, 0.5], "ms", command)]


def server_process(measured, command):
    """Processor time of a whole server process; MATCHES of them must fit on CORES."""
    cores = MATCHES * measured["cpu_share"]
    in_time = measured["ticks_per_s"] >= 0.99 * TICKS_PER_S
    return [Row(f"{MATCHES} matches of 8 on {CORES} cores: processor time of `handhold serve` at {measured['ticks_per_s']:.1f} ticks/s, times {MATCHES}",
                f"{1000 * measured['cpu_share'] / TICKS_PER_S:.3g} ms a tick; {cores:.3g} cores", f"<= {CORES} cores, {TICKS_PER_S} ticks/s",
                cores <= CORES and in_time, command)]


def bandwidth(figures, packets, limits, command):
    return [bounded(f"bandwidth of a peer, 8 players, {packets:g} packets/s with UDP and IPv4 headers: up / down",
                    [figures["kbps_up"]["mean"], figures["kbps_down"]["mean"]], limits, "kbit/s", command)]


def freeze(figures, command):
    frozen = figures["freeze"]
    inside, outside = frozen["others_frame_ms"], frozen["others_frame_ms_before_and_after"]
    return [Row(f"others while a peer freezes for {frozen['seconds']:g} s ({frozen['filled']} inputs filled): ticks/s; a frame's median / 99 %, and at other times",
                f"{frozen['others_ticks_per_s']:.1f}; {cell(inside['median'])} / {cell(inside['p99'])}, {cell(outside['median'])} / {cell(outside['p99'])} ms",
                f"{TICKS_PER_S} ticks/s +- 1", abs(frozen["others_ticks_per_s"] - TICKS_PER_S) <= 1 and frozen["filled"] > 0, command)]


def joining(figures, command):
    return [bounded("joining a match of 8 at 100 ms: time to play, median / longest", [figures["join_s"]["median"], figures["join_s"]["max"]], [2, 2], "s", command)]


def matches(runs, wanted_minutes, wanted_seeds, command):
    total = soak.summary(runs)
    faulty = "".join(f"; seed {seed}: {', '.join(faults)}" for seed, faults in total["faulty"][:5])
    done = f"{total['minutes']:.0f} minutes, {total['seeds']} seeds and networks: {total['hashes_compared']} hashes compared"
    passed = not total["faulty"] and total["seeds"] > 0
    is_whole = total["minutes"] >= wanted_minutes and total["seeds"] >= wanted_seeds
    return [Row(f"simulated matches, each checked to grip, throw, share and roll back: {done}",
                f"{total['hashes_different']} different, {total['stalls']} stalls; {total['grips']} grips, {total['throws']} throws{faulty}",
                f"0, 0; {wanted_minutes:g} minutes, {wanted_seeds} seeds", passed if is_whole or not passed else None, command)]


def hostile(runs, command):
    """`runs`: inputs by target; None: a finding."""
    found = [name for name, count in runs.items() if count is None]
    total = sum(count or 0 for count in runs.values())
    return [Row("hostile messages, fuzzed under ASan: " + (", ".join(f"{name} {count}" for name, count in runs.items() if count) or "-"),
                f"{total} inputs, " + (f"findings in {', '.join(found)}" if found else "no finding"), "10000000 inputs, no finding",
                False if found else True if total >= 10_000_000 else None, command)]


def markdown(table):
    lines = ["| figure | measured | goal | | command |", "|---|---|---|---|---|"]
    for row in table:
        lines.append("| " + " | ".join(text.replace("|", "\\|") for text in (row.bar, row.measured, row.goal, row.verdict(), f"`{row.command}`")) + " |")
    return "\n".join(lines) + "\n"


def page(table, style):
    rows = ""
    for row in table:
        kind = {"met": "pass", "MISSED": "miss"}.get(row.verdict(), "")
        rows += (f'<tr><td>{html.escape(row.bar)}<br><code>{html.escape(row.command)}</code></td><td class="n">{html.escape(row.measured)}</td>'
                 f'<td class="n">{html.escape(row.goal)}</td><td class="{kind}">{row.verdict()}</td></tr>')
    return (f'<!doctype html><html lang="en"><meta charset="utf-8"><title>Matches, measured</title><style>{style}td.n{{white-space:normal}}'
            "code{color:#555;font-size:12px}</style><h1>Matches, measured</h1>"
            "<p>Times are processor times of one thread unless they are called frames. Scenes and fields: docs/reference/lab.md.</p>"
            f'<table><tr><th>figure</th><th class="n">measured</th><th class="n">goal</th><th></th></tr>{rows}</table></html>\n')
