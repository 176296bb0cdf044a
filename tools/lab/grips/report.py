"""What a report makes of measured grasps: goals, tables, the page. The goals are those of the project's design of hands."""
import html
import math

from . import scoring, svg

STYLE = """body{font:15px/1.5 system-ui,sans-serif;max-width:1340px;margin:2rem auto;padding:0 1rem;color:#1c1c1e;background:#fff}
h1,h2{font-weight:600}table{border-collapse:collapse;font-variant-numeric:tabular-nums;margin:.7rem 0}td,th{padding:.15rem .55rem;text-align:left;
border-bottom:1px solid #e3e3e6}td.n,th.n{text-align:right}.miss{color:#b3261e;font-weight:600}.pass{color:#0b6e4f}
.plots{display:flex;flex-wrap:wrap;gap:1.5rem}figure{margin:0;width:640px;max-width:100%}.title{font:600 14px system-ui}
.tick{font:12px system-ui;fill:#555}.grid{stroke:#e3e3e6}.mark{stroke:#888;stroke-dasharray:4 3}figcaption span{margin-right:1rem;font-size:13px}
figcaption i{display:inline-block;width:10px;height:10px;border-radius:5px;margin-right:.4rem}.sheet{display:flex;flex-wrap:wrap;gap:.7rem}
.sheet figure{width:420px}.sheet img{width:100%}.wide{overflow-x:auto}"""


class Goal:
    def __init__(self, bar, measured, goal, passed):
        self.bar, self.measured, self.goal, self.passed = bar, measured, goal, passed

    def verdict(self):
        return {True: "met", False: "MISSED", None: "not run"}[self.passed]


def judged(bar, value, limit, unit, least=False):
    """A goal that is an upper limit, or with least a lower one. What was not measured was not run."""
    goal = f"{'>=' if least else '<='} {limit:g} {unit}".strip()
    if value is None or not math.isfinite(value):
        return Goal(bar, "-", goal, None)
    return Goal(bar, f"{value:.3g} {unit}".strip(), goal, value >= limit if least else value <= limit)


def percent(value):
    return math.nan if value is None else 100.0 * value


def figure(figures, *path):
    for key in path:
        if figures is None or key not in figures:
            return math.nan
        figures = figures[key]
    return figures


def goals(whole, flat, nasty):
    """whole: figures of objects, level and primitives; flat: of boxes, plates, rails; nasty: of broken meshes. None: not run."""
    deep = lambda figures, part: percent(figure(figures, "deep_share", part))
    return [
        judged("pops a disc, cold: median", figure(whole, "visited_per_disc", "median"), 2, ""),
        judged("the same, 95th percentile", figure(whole, "visited_per_disc", "p95"), 8, ""),
        judged("grasps with a finger or thumb deeper than 3 mm", deep(whole, "any_finger_or_thumb"), 3, "%"),
        judged("the same, fingers without the thumb", deep(whole, "any_finger"), 3, "%"),
        judged("the same, boxes, plates, rails", deep(flat, "any_finger_or_thumb"), 0.5, "%"),
        judged("sync, near placements: median", figure(whole, "sync_mm_near", "median"), 4, "mm"),
        judged("fingers within 2 mm, of the reference's: four", percent(figure(whole, "of_reference", "four", "touching")), 95, "%", least=True),
        judged("the same, thumb with them", percent(figure(whole, "of_reference", "all", "touching")), 95, "%", least=True),
        judged("mean penetration of fingers", figure(whole, "penetration_mm", "mean_of_fingers"), 0.3, "mm"),
        judged("the same, of each grasp's deepest finger", figure(whole, "penetration_mm", "mean_of_deepest"), 0.3, "mm"),
        judged("thumb deeper than 3 mm", deep(whole, "thumb"), 1.5, "%"),
        judged("whole hand, cold, thread time: median", figure(whole, "us", "total", "median"), 80, "us"),
        judged("the same, 99th percentile", figure(whole, "us", "total", "p99"), 250, "us"),
        judged("hands with a number that is not finite", float(figure(whole, "not_finite")), 0, ""),
        judged("the same, broken meshes", float(figure(nasty, "not_finite")), 0, ""),
        Goal("contact angle against the oracle", "-", "<= 0.05 mm", None),
        Goal("finger jumps over 10 degrees while sliding", "-", "<= 1 %", None),
        Goal("a hand that did not move", "-", "<= 2 us", None),
    ]


# --- Tables

COLUMNS = (
    ("hands", lambda f: f["grasps"]),
    ("gripped %", lambda f: percent(f["gripped_share"])),
    ("any > 3 mm %", lambda f: percent(f["deep_share"]["any_finger_or_thumb"])),
    ("fingers %", lambda f: percent(f["deep_share"]["any_finger"])),
    ("thumb %", lambda f: percent(f["deep_share"]["thumb"])),
    ("palm %", lambda f: percent(f["deep_share"]["palm"])),
    ("near: any %", lambda f: percent(figure(f, "near", "deep_share", "any_finger_or_thumb"))),
    ("mean depth mm", lambda f: f["penetration_mm"]["mean_of_fingers"]),
    ("deepest mm", lambda f: figure(f, "penetration_mm", "fingers", "max")),
    ("within 2 mm %", lambda f: percent(f["fingers_within_2_mm"]["all"])),
    ("of reference %", lambda f: percent(figure(f, "of_reference", "four", "touching"))),
    ("thumb of it %", lambda f: percent(figure(f, "of_reference", "thumb", "touching"))),
    ("sync near mm", lambda f: figure(f, "sync_mm_near", "median")),
    ("pops a disc", lambda f: triple(f["visited_per_disc"], "median", "p95", "max")),
    ("walk", lambda f: figure(f, "walked_per_disc", "median")),
    ("us", lambda f: triple(f["us"]["total"], "median", "p99")),
)


def triple(values, *keys):
    return " / ".join(text(figure(values, key)) for key in keys)


def text(value):
    if isinstance(value, str):
        return value
    if isinstance(value, int):
        return str(value)
    if not math.isfinite(value):
        return "-"
    return "0" if value == 0 else f"{value:.2g}" if abs(value) < 10 else f"{value:.0f}"


def table_html(head, rows):
    cells = "".join(f'<th class="{"n" if i else ""}">{html.escape(cell)}</th>' for i, cell in enumerate(head))
    body = ""
    for row in rows:
        body += "<tr>" + "".join(f'<td class="{"n" if i else ""}">{html.escape(str(cell))}</td>' for i, cell in enumerate(row)) + "</tr>"
    return f'<div class="wide"><table><tr>{cells}</tr>{body}</table></div>'


def figures_html(first, rows):
    """rows: (name, figures)."""
    return table_html([first] + [name for name, _ in COLUMNS], [[name] + [text(of(figures)) for _, of in COLUMNS] for name, figures in rows])


def fallbacks_html(rows):
    kinds = sorted({kind for _, figures in rows for kind in figures["fallbacks"]})
    counts = [[name] + [figures["fallbacks"].get(kind, 0) for kind in kinds] for name, figures in rows]
    reasons = [[name, reason or "(none given)", count] for name, figures in rows for reason, count in figures["reasons"].items()]
    return (table_html(["fingers by fallback"] + kinds, counts)
            + (table_html(["hands that grip nothing", "reason", "hands"], reasons) if reasons else ""))


def goals_html(table):
    rows = ""
    for goal in table:
        style = {"met": "pass", "MISSED": "miss"}.get(goal.verdict(), "")
        rows += (f"<tr><td>{html.escape(goal.bar)}</td><td class=n>{html.escape(goal.measured)}</td><td class=n>{html.escape(goal.goal)}</td>"
                 f'<td class="{style}">{goal.verdict()}</td></tr>')
    return f"<table><tr><th>bar</th><th class=n>measured</th><th class=n>goal</th><th></th></tr>{rows}</table>"


def plots_html(by_variant, case_rows):
    """by_variant: {title: (color, [Measured])}."""
    per_disc = lambda files: [finger["visited"] / finger["discs"] for file in files for grasp in file.grasps if grasp.gripped
                              for finger in grasp.fingers if finger["discs"] > 0 and math.isfinite(finger["visited"])]
    total_us = lambda files: [grasp.us["total"] for file in files for grasp in file.grasps
                              if grasp.gripped and math.isfinite(grasp.us.get("total", math.nan))]
    sync = lambda files: [grasp.sync_mm for file in files for grasp in file.grasps if grasp.gripped and math.isfinite(grasp.sync_mm)]
    series = lambda of: {name: (color, of(files)) for name, (color, files) in by_variant.items()}
    deep = sorted(((name, percent(figures["deep_share"]["any_finger_or_thumb"])) for name, figures in case_rows), key=lambda row: -row[1])
    return (svg.tail_plot("Grasps whose deepest finger is deeper than x", "mm", series(lambda files: scoring.deepest_mm(files).tolist()), 15.0, (3.0,))
            + svg.tail_plot("Searches that visit more than x triangles a disc", "pops a disc", series(per_disc), 50.0, (2.0, 8.0))
            + svg.tail_plot("Hands that cost more than x", "us, thread time", series(total_us), 1000.0, (80.0, 250.0))
            + svg.tail_plot("Palms that are moved farther than x", "mm", series(sync), 60.0, (4.0,))
            + svg.bars("Any finger deeper than 3 mm, by mesh", deep, "%", 3.0))


def page(table, variant_tables, case_rows, by_variant, pictures, notes):
    """variant_tables: {group: [(variant, figures)]}; case_rows: [(case, figures)] of the first variant; pictures: [(case, data URI)]."""
    groups = "".join(f"<h3>{html.escape(group)}</h3>{figures_html('variant', rows)}" for group, rows in variant_tables.items())
    sheet = "".join(f'<figure><img src="{uri}" alt="{html.escape(case)}"><figcaption>{html.escape(case)}</figcaption></figure>' for case, uri in pictures)
    said = "".join(f"<li>{html.escape(note)}</li>" for note in notes)
    return f"""<!doctype html><html lang="en"><meta charset="utf-8"><title>Hands on surfaces, measured</title><style>{STYLE}</style>
<h1>Hands on surfaces, measured</h1>
<p>Depths and gaps are measured from the posed capsules on the mesh as it is in its file, by code that shares nothing with what posed them; negative
gaps are depths. Half of the placements are near (palm within 2 cm, 30 degrees), half harsh (3 cm behind to 6 cm before, 60 degrees). Each hand is
solved cold, alone, on one thread. What each figure means: docs/lab.md.</p>
<h2>Goals</h2>{goals_html(table)}{f"<ul>{said}</ul>" if said else ""}
<h2>Beside the baselines</h2>{groups}
<div class="plots">{plots_html(by_variant, case_rows)}</div>
<h2>By mesh</h2>{figures_html("mesh", case_rows)}
<h2>Fallbacks</h2>{fallbacks_html([row for rows in variant_tables.values() for row in rows[:1]])}
{f'<h2>Pictures</h2><div class="sheet">{sheet}</div>' if sheet else ""}</html>
"""
