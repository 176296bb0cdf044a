"""The grip report: goals, tables, the page. The goals are those of the project's design of hands."""
import html
import math

from pages import svg
from pages.goals import STYLE, figure, goals_html, limit_goal, percent, table_html, text, triple

from . import scoring, style


MOST_TIP_MM = 0.05
LABELLED = {"near": (85, 1), "harsh": (65, 4), "play": (85, 2)}  # kinds of sheets: convincing, ugly, in %


def bounded_goal(title, found, limit, unit, scale=1.0, at_least=False):
    """found: a figure with its 95 % bounds (style.bounded), or anything else: not run."""
    value, low, high = (scale * figure(found, key) if isinstance(found, dict) else math.nan for key in ("value", "low", "high"))
    goal = limit_goal(title, value, limit, unit, at_least)
    if math.isfinite(value) and math.isfinite(low):
        goal.measured += f" [{low:.1f} {high:.1f}]"
    return goal


def style_goals(whole):
    """Goals for every class of style.py, and for the palm's sync and turn."""
    classes = [bounded_goal(title, figure(whole, "style", name), limit, "%", 100.0) for name, (title, limit) in style.CLASSES.items()]
    moved = (("palm sync: mean", "sync_mean_mm", 10, "mm"), ("palm sync: 95th percentile", "sync_p95_mm", 40, "mm"),
             ("palm turn: mean", "turn_mean_deg", 12, "deg"), ("palm turn: 95th percentile", "turn_p95_deg", 30, "deg"))
    return classes + [bounded_goal(title, figure(whole, "style", name), limit, unit) for title, name, limit, unit in moved]


def critic_goals(whole):
    """Shares that the critic expects people to name."""
    goals = []
    for kind, convincing, ugly in (("near", 85, 1), ("harsh", 65, 4)):
        shares = figure(whole, "critic", kind)
        of = lambda name: shares.get(name) if isinstance(shares, dict) else None
        goals += [bounded_goal(f"expected convincing, {kind} placements", of("convincing"), convincing, "%", 100.0, at_least=True),
                  bounded_goal(f"expected ugly, {kind} placements", of("ugly"), ugly, "%", 100.0)]
    return goals + [bounded_goal("tip gap of the worst finger: median", figure(whole, "worst_tip_median_mm"), 4, "mm")]


def played_goals(played):
    """Costs in recorded sessions (warm.played)."""
    rows = (("closing hand", "closing_us", 500, 1000), ("each of six frames after", "after_us", 500, 1000), ("later frames", "later_us", 50, 250))
    return [bounded_goal(f"{title}, recorded play: {name}", figure(played, key, quantile), limit, "us")
            for title, key, *limits in rows for name, quantile, limit in zip(("median", "99th percentile"), ("median", "p99"), limits)]


def label_goals(people):
    """Shares that people named (labels.shares), by kind of sheet; a missing kind was not shown to people."""
    return [bounded_goal(f"{word}, by people: {kind}", figure(people, kind, word), limit, "%", 100.0, at_least=word == "convincing")
            for kind, both in LABELLED.items() for word, limit in zip(("convincing", "ugly"), both)]


def code_goals(size):
    """Size of the code (code_size.count)."""
    return [limit_goal(title, float(figure(size, name)), limit, "")
            for title, name, limit in (("lines of code of hands and their geometry", "lines", 5500), ("state fields of a shown hand", "state", 20),
                                       ("tuning values of palm, fingers and thumb", "tuning", 14))]


def goals(whole, flat, nasty, warm, worst_tip_mm, played=None, unseen=None, people=None, size=None):
    """whole: figures of objects, level and primitives; flat: of boxes, plates, rails; nasty: of broken meshes; warm: of hands that move
    as recorded, and stand (warm.py); worst_tip_mm: of chains against the oracle; played: costs in recorded sessions (warm.played); unseen:
    figures of another hand's rig; people: {kind: labels.shares}; size: code_size.count. None: not run."""
    deep = lambda figures, part: percent(figure(figures, "deep_share", part))
    return [
        limit_goal("pops per disc, cold: median", figure(whole, "visited_per_disc", "median"), 2, ""),
        limit_goal("the same, 95th percentile", figure(whole, "visited_per_disc", "p95"), 8, ""),
        limit_goal("grasps with a finger or thumb deeper than 3 mm", deep(whole, "any_finger_or_thumb"), 3, "%"),
        limit_goal("the same, fingers without the thumb", deep(whole, "any_finger"), 3, "%"),
        limit_goal("the same, boxes, plates, rails", deep(flat, "any_finger_or_thumb"), 0.5, "%"),
        limit_goal("sync, near placements: median", figure(whole, "sync_mm_near", "median"), 4, "mm"),
        limit_goal("fingers within 2 mm, share of the reference's: four", percent(figure(whole, "of_reference", "four", "touching")), 95, "%", at_least=True),
        limit_goal("the same, with the thumb", percent(figure(whole, "of_reference", "all", "touching")), 95, "%", at_least=True),
        limit_goal("mean penetration of fingers", figure(whole, "penetration_mm", "mean_of_fingers"), 0.3, "mm"),
        limit_goal("the same, of each grasp's deepest finger", figure(whole, "penetration_mm", "mean_of_deepest"), 0.3, "mm"),
        limit_goal("thumb deeper than 3 mm", deep(whole, "thumb"), 1.5, "%"),
        limit_goal("whole hand, warm, thread time: median", figure(warm, "moving_us", "median"), 80, "us"),
        limit_goal("the same, 99th percentile", figure(warm, "moving_us", "p99"), 250, "us"),
        limit_goal("the same, mean of the meshes' percentiles", figure(warm, "moving_us", "p99_of_meshes"), 250, "us"),
        limit_goal("a resting hand: median", figure(warm, "stand_us", "median"), 2, "us"),
        limit_goal("shown fingers that jump over 10 degrees, moving", percent(figure(warm, "shown_jumps")), 0, "%"),
        limit_goal("target poses that jump over 10 degrees, moving", percent(figure(warm, "jumps")), 1, "%"),
        limit_goal("hands with non-finite numbers", float(figure(whole, "not_finite")), 0, ""),
        limit_goal("the same, broken meshes", float(figure(nasty, "not_finite")), 0, ""),
        *style_goals(whole), bounded_goal("any part, palm included, deeper than 3 mm", figure(whole, "style", "part_deep"), 1.5, "%", 100.0),
        *label_goals(people), *critic_goals(whole), *played_goals(played), *code_goals(size),
        limit_goal("another hand's rig: fingers within 2 mm", percent(figure(unseen, "fingers_within_2_mm", "four")), 90, "%", at_least=True),
        limit_goal("tip of a closed chain, distance from the oracle's: worst", worst_tip_mm, MOST_TIP_MM, "mm"),
    ]


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
    ("thumb of reference %", lambda f: percent(figure(f, "of_reference", "thumb", "touching"))),
    ("sync near mm", lambda f: figure(f, "sync_mm_near", "median")),
    ("pops per disc", lambda f: triple(f["visited_per_disc"], "median", "p95", "max")),
    ("walk", lambda f: figure(f, "walked_per_disc", "median")),
    ("us", lambda f: triple(f["us"]["total"], "median", "p99")),
    ("convincing %", lambda f: percent(figure(f, "critic", "all", "convincing", "value"))),
    ("ugly %", lambda f: percent(figure(f, "critic", "all", "ugly", "value"))),
)


def figures_html(first, rows):
    """rows: (name, figures)."""
    return table_html([first] + [name for name, _ in COLUMNS], [[name] + [text(of(figures)) for _, of in COLUMNS] for name, figures in rows])


def fallbacks_html(rows):
    kinds = sorted({kind for _, figures in rows for kind in figures["fallbacks"]})
    counts = [[name] + [figures["fallbacks"].get(kind, 0) for kind in kinds] for name, figures in rows]
    reasons = [[name, reason or "(none given)", count] for name, figures in rows for reason, count in figures["reasons"].items()]
    return (table_html(["fingers by fallback"] + kinds, counts)
            + (table_html(["hands without grip", "reason", "hands"], reasons) if reasons else ""))


def plots_html(by_variant, case_rows):
    """by_variant: {title: (color, [Measured])}."""
    per_disc = lambda files: [finger["visited"] / finger["discs"] for file in files for grasp in file.grasps if grasp.gripped
                              for finger in grasp.fingers if finger["discs"] > 0 and math.isfinite(finger["visited"])]
    total_us = lambda files: [grasp.us["total"] for file in files for grasp in file.grasps
                              if grasp.gripped and math.isfinite(grasp.us.get("total", math.nan))]
    sync = lambda files: [grasp.sync_mm for file in files for grasp in file.grasps if grasp.gripped and math.isfinite(grasp.sync_mm)]
    series = lambda of: {name: (color, of(files)) for name, (color, files) in by_variant.items()}
    deep = sorted(((name, percent(figures["deep_share"]["any_finger_or_thumb"])) for name, figures in case_rows), key=lambda row: -row[1])
    return (svg.tail_plot("Grasps whose deepest finger penetrates more than x", "mm", series(lambda files: scoring.deepest_mm(files).tolist()), 15.0, (3.0,))
            + svg.tail_plot("Searches that visit more than x triangles per disc", "pops per disc", series(per_disc), 50.0, (2.0, 8.0))
            + svg.tail_plot("Hands that cost more than x", "us, thread time", series(total_us), 1000.0, (80.0, 250.0))
            + svg.tail_plot("Palms with a sync larger than x", "mm", series(sync), 60.0, (4.0,))
            + svg.bars("Any finger deeper than 3 mm, by mesh", deep, "%", 3.0))


def page(table, variant_tables, case_rows, by_variant, pictures, notes):
    """variant_tables: {group: [(variant, figures)]}; case_rows: [(case, figures)] of the first variant; pictures: [(case, data URI)]."""
    groups = "".join(f"<h3>{html.escape(group)}</h3>{figures_html('variant', rows)}" for group, rows in variant_tables.items())
    sheet = "".join(f'<figure><img src="{uri}" alt="{html.escape(case)}"><figcaption>{html.escape(case)}</figcaption></figure>' for case, uri in pictures)
    said = "".join(f"<li>{html.escape(note)}</li>" for note in notes)
    return f"""<!doctype html><html lang="en"><meta charset="utf-8"><title>Hands on surfaces, measured</title><style>{STYLE}</style>
<h1>Hands on surfaces, measured</h1>
<p>Depths and gaps are measured from the posed capsules on the mesh as in its file, independently of the code that posed them; negative gaps are
depths. Half of the placements are near (palm within 2 cm, 30 degrees), half harsh (3 cm behind to 6 cm in front, 60 degrees). Each hand is solved
cold, alone, on one thread; near ones then move as the wrists of recorded grips do, and stand, for the warm figures. Meaning of each figure: docs/reference/lab.md.</p>
<h2>Goals</h2>{goals_html(table)}{f"<ul>{said}</ul>" if said else ""}
<h2>Compared with the baselines</h2>{groups}
<div class="plots">{plots_html(by_variant, case_rows)}</div>
<h2>By mesh</h2>{figures_html("mesh", case_rows)}
<h2>Fallbacks</h2>{fallbacks_html([(group, rows[0][1]) for group, rows in variant_tables.items()])}
{f'<h2>Pictures</h2><div class="sheet">{sheet}</div>' if sheet else ""}</html>
"""
