"""What a report makes of errors: goals, tables, plots over time, pictures, the page."""
import html
import math

import numpy as np

from pages import svg
from pages.goals import STYLE, goals_html, judged, table_html, text

from . import scoring, stick_figures

TRUTH_COLOR = "#1c1c1e"
MOST_POINTS = 400  # of a line over time


def goals(ours):
    """Those of the project for these recordings."""
    return [
        judged("chest yaw: mean error", ours["yaw_deg"]["mean"], 8.5, "deg"),
        judged("elbow: mean error", ours["elbow_cm"]["mean"], 7.0, "cm"),
        judged("swivel: mean error", ours["swivel_deg"]["mean"], 22.0, "deg"),
        judged("elbow pops", ours["pops_per_min"], 1.5, "a minute"),
        judged("elbow jerk, of the truth's", ours["jerk_ratio"], 1.5, "times"),
    ]


COLUMNS = (
    ("minutes", lambda f: f["minutes"]),
    ("yaw deg: mean / median / p95", lambda f: triple(f["yaw_deg"])),
    ("shoulder cm", lambda f: triple(f["shoulder_cm"])),
    ("elbow cm", lambda f: triple(f["elbow_cm"])),
    ("swivel deg", lambda f: triple(f["swivel_deg"])),
    ("pops a minute", lambda f: f["pops_per_min"]),
    ("jerk, x truth's", lambda f: f["jerk_ratio"]),
    ("bones stretched %", lambda f: f["stretch_percent"]["mean"]),
)


def exact(value):
    return f"{value:.1f}" if math.isfinite(value) and 10.0 <= abs(value) < 100.0 else text(value)


def triple(values):
    return " / ".join(exact(value) for value in values.values())


def figures_html(first, rows):
    """rows: (name, figures)."""
    cell = lambda value: value if isinstance(value, str) else exact(value)
    return table_html([first] + [name for name, _ in COLUMNS], [[name] + [cell(of(figures)) for _, of in COLUMNS] for name, figures in rows])


NAMES = {"yaw_deg": "chest yaw, deg", "shoulder_cm": "shoulder, cm", "elbow_cm": "elbow, cm", "swivel_deg": "swivel, deg", "pops_per_min": "pops a minute",
         "jerk_ratio": "jerk, x truth's"}
PEOPLE_HEAD = ("", "mean person", "deviation among people", "worst person", "", "without one person: least", "most", "standard error")


def people_html(spreads):
    keys = ("mean", "deviation", "worst", "worst_residual", "least_without_one", "most_without_one", "error")
    return table_html(PEOPLE_HEAD, [[NAMES[name]] + [each[key] if key == "worst" else exact(each[key]) for key in keys] for name, each in spreads.items()])


def people_text(spreads):
    """A line for each figure, for a terminal."""
    return [f"{NAMES[name]:18} mean person {exact(each['mean']):>5} +- {exact(each['deviation']):<5} worst {each['worst_residual']:.3g} ({each['worst']}); "
            f"all but one: {exact(each['least_without_one'])} to {exact(each['most_without_one'])}" for name, each in spreads.items()]


def places_html(errors, places):
    """Errors of the first estimator by where the hand is."""
    rows = []
    for name, mask in places.items():
        mask = mask & errors.valid
        rows.append([name, f"{100.0 * mask.sum() / max(1, 2 * errors.valid.sum()):.1f} %"]
                    + [exact(scoring.mean(values[mask])) for values in (errors.shoulder_cm, errors.elbow_cm, errors.swivel_deg)])
    return table_html(["hand", "of all", "shoulder cm", "elbow cm", "swivel deg"], rows)


def thinned(t_s, values):
    """At most MOST_POINTS of a line."""
    step = max(1, -(-len(values) // MOST_POINTS))
    return list(zip((t_s - t_s[0])[::step].tolist(), values[::step].tolist()))


def longest_clips(recording, clips):
    """{person: rows of the longest recording}."""
    chosen = {}
    for person in clips.people:
        own = [clip for clip in np.unique(recording.clip) if clips.person[clip] == person]
        longest = max(own, key=lambda clip: np.sum(recording.clip == clip))
        chosen[person] = np.flatnonzero(recording.clip == longest)
    return chosen


def over_time_html(recording, truth, clips, runs):
    """runs: {title: (color, bodies, errors)}, the one judged first."""
    drawn = ""
    for person, rows in longest_clips(recording, clips).items():
        name, t_s = clips.name[recording.clip[rows[0]]], recording.t_s[rows]
        yaw = np.degrees(np.unwrap(np.radians(truth.yaw_deg[rows])))
        beside = lambda bodies: yaw + scoring.wrapped_deg(bodies.yaw_deg[rows] - truth.yaw_deg[rows])
        yaws = {title: (color, thinned(t_s, beside(bodies))) for title, (color, bodies, _) in reversed(runs.items())}
        yaws["truth"] = (TRUTH_COLOR, thinned(t_s, yaw))
        elbows = {title: (color, thinned(t_s, errors.elbow_cm[:, rows].mean(0))) for title, (color, _, errors) in reversed(runs.items())}
        drawn += (svg.lines(f"Chest yaw, {person}, {name}", "s", "deg", yaws)
                  + svg.lines(f"Elbow error, both arms, {person}, {name}", "s", "cm", elbows, low=0.0))
    return drawn


def moments(errors, rows):
    """Frames of a person where the elbows are as wrong as mostly, as in the worst twentieth, and at worst."""
    elbow = errors.elbow_cm.mean(0)
    order = [row for row in np.flatnonzero(rows)[np.argsort(elbow[rows], kind="stable")] if math.isfinite(elbow[row])]
    if not order:  # nobody knows where this person's elbows were
        return []
    return [(title, order[min(len(order) - 1, int(share * len(order)))]) for title, share in (("median", 0.5), ("95th percentile", 0.95), ("worst", 1.0))]


def pictures_html(recording, truth, clips, bodies, errors):
    drawn = ""
    for person in clips.people:
        for title, row in moments(errors, clips.rows_of(recording, person)):
            caption = (f"{person}, {title}: {clips.name[recording.clip[row]]} at {recording.t_s[row]:.2f} s; elbows {errors.elbow_cm[0, row]:.1f} and "
                       f"{errors.elbow_cm[1, row]:.1f} cm off, chest {errors.yaw_deg[row]:.0f} deg")
            drawn += stick_figures.picture(recording, truth, bodies, row, caption)
    return drawn


def plots_html(runs, alone, goal_cm):
    of = lambda name: {title: (color, values[np.isfinite(values)].tolist()) for title, (color, _, errors) in runs.items()
                       for values in (getattr(errors, name).ravel(),)}
    people = sorted(((person, figures["elbow_cm"]["mean"]) for person, figures in alone.items()), key=lambda row: -row[1])
    return (svg.tail_plot("Elbows that are farther off than x", "cm", of("elbow_cm"), 40.0, (goal_cm,))
            + svg.tail_plot("Chests that face farther off than x", "deg", of("yaw_deg"), 90.0, (8.5,))
            + svg.tail_plot("Elbows that are turned farther than x about the arm's line", "deg", of("swivel_deg"), 180.0, (22.0,))
            + svg.bars("Elbow error by person, mean", people, "cm", goal_cm))


def page(table, recording, truth, clips, runs, scores):
    """runs: {title: (color, bodies, errors)}, the one judged first.

    scores: {title: figures}; of the one judged {person: figures} and the spreads over people."""
    everybody, alone, spreads = scores
    first = next(iter(runs))
    _, bodies, errors = runs[first]
    keys = svg.keys_html({"truth": stick_figures.TRUTH[0], first: stick_figures.OURS[0]})
    return f"""<!doctype html><html lang="en"><meta charset="utf-8"><title>Arms and chest, measured</title><style>{STYLE}</style>
<h1>Arms and chest, measured</h1>
<p>Estimated from a head and two hands alone, against motion capture: {len(np.unique(recording.clip))} recordings of {len(clips.people)} people,
{everybody[first]["minutes"]:.1f} minutes. Some constants of Handhold's estimator were moved part of the distance towards the best fit for these people. docs/decisions/0034-chest-and-elbow-estimate.md
names them and gives the scores with one person left out of the fit. What each figure means: docs/reference/lab.md.</p>
<h2>Goals</h2>{goals_html(table)}
<h2>Beside the baselines</h2>{figures_html("estimator", everybody.items())}
<div class="plots">{plots_html(runs, alone, 7.0)}</div>
<h2>By person</h2>{figures_html("person", alone.items())}
<p>How much the figures hang on who was recorded: each person counted once, and all but one person together.</p>{people_html(spreads)}
<h2>By where the hand is</h2>{places_html(errors, scoring.where_hands_are(recording, truth))}
<h2>Over time</h2><p>The longest recording of each person.</p><div class="plots">{over_time_html(recording, truth, clips, runs)}</div>
<h2>Poses</h2><p>Head, hands (black) and truth (grey) as recorded; the left arm is paler. Of each person the moments where the elbows are as far off as
mostly, as in the worst twentieth, and at worst.</p>{keys}<div class="sheet">{pictures_html(recording, truth, clips, bodies, errors)}</div></html>
"""
