"""The body report: goals, tables, plots over time, pictures, the page."""
import html
import math

import numpy as np

from pages import svg
from pages.goals import STYLE, goals_html, limit_goal, table_html, text

from . import scoring, stick_figures

TRUTH_COLOR = "#1c1c1e"
MOST_POINTS = 400  # points of a line over time


# Limits by figure. dev: people by whom the constants were chosen; body_eval: what the release before reached.
GOALS = {
    "dev": {"yaw_deg": 8.2, "shoulder_cm": 4.7, "elbow_cm": 5.4, "own_swivel_deg": 14.0, "pops_per_min": 1.0, "jerk_ratio": 1.4},
    "body_eval": {"yaw_deg": 8.5, "shoulder_cm": 5.1, "elbow_cm": 6.2, "own_swivel_deg": 16.4, "pops_per_min": 0.933, "jerk_ratio": 1.43},
}


def goals(ours, limits):
    """The project's goals for these recordings. limits: of GOALS."""
    mean = lambda name: scoring.value_of(ours, name, dict(scoring.EVALUATED)[name])
    return [limit_goal(NAMES[name], mean(name), limit, "") for name, limit in limits.items()]


COLUMNS = (
    ("minutes", lambda f: f["minutes"]),
    ("yaw deg: mean / median / p95", lambda f: triple(f["yaw_deg"])),
    ("shoulder cm", lambda f: triple(f["shoulder_cm"])),
    ("elbow cm", lambda f: triple(f["elbow_cm"])),
    ("swivel deg", lambda f: triple(f["swivel_deg"])),
    ("less its source's", lambda f: triple(f["own_swivel_deg"])),
    ("pops per minute", lambda f: f["pops_per_min"]),
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


NAMES = {"yaw_deg": "chest yaw, deg", "shoulder_cm": "shoulder, cm", "elbow_cm": "elbow, cm", "swivel_deg": "swivel, deg", "own_swivel_deg": "swivel less its source's, deg", "pops_per_min": "pops per minute",
         "jerk_ratio": "jerk, x truth's"}
PEOPLE_HEAD = ("", "mean person", "deviation among people", "worst person", "", "without one person: lowest", "highest", "standard error")


def people_html(spreads):
    keys = ("mean", "deviation", "worst", "worst_residual", "least_without_one", "most_without_one", "error")
    return table_html(PEOPLE_HEAD, [[NAMES[name]] + [each[key] if key == "worst" else exact(each[key]) for key in keys] for name, each in spreads.items()])


def people_text(spreads):
    """One line per figure, for a terminal."""
    return [f"{NAMES[name]:28} mean person {exact(each['mean']):>5} +- {exact(each['deviation']):<5} worst {each['worst_residual']:.3g} ({each['worst']}); "
            f"all but one: {exact(each['least_without_one'])} to {exact(each['most_without_one'])}" for name, each in spreads.items()]


def places_html(errors, places):
    """Errors of the first estimator by the position of the hand."""
    rows = []
    for name, mask in places.items():
        mask = mask & errors.valid
        rows.append([name, f"{100.0 * mask.sum() / max(1, 2 * errors.valid.sum()):.1f} %"]
                    + [exact(scoring.mean(values[mask])) for values in (errors.shoulder_cm, errors.elbow_cm, errors.swivel_deg)])
    return table_html(["hand", "of all", "shoulder cm", "elbow cm", "swivel deg"], rows)


def thinned(t_s, values):
    """At most MOST_POINTS points of a line."""
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
    """runs: {title: (color, bodies, errors)}, the evaluated one first."""
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
    """Frames of a person with median, 95th percentile and largest elbow error."""
    elbow = errors.elbow_cm.mean(0)
    order = [row for row in np.flatnonzero(rows)[np.argsort(elbow[rows], kind="stable")] if math.isfinite(elbow[row])]
    if not order:  # no valid truth of this person's elbows
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


def plots_html(runs, alone, limits):
    of = lambda name: {title: (color, values[np.isfinite(values)].tolist()) for title, (color, _, errors) in runs.items()
                       for values in (getattr(errors, name).ravel(),)}
    people = sorted(((person, figures["elbow_cm"]["mean"]) for person, figures in alone.items()), key=lambda row: -row[1])
    return (svg.tail_plot("Elbow errors above x", "cm", of("elbow_cm"), 40.0, (limits["elbow_cm"],))
            + svg.tail_plot("Chest yaw errors above x", "deg", of("yaw_deg"), 90.0, (limits["yaw_deg"],))
            + svg.tail_plot("Elbow swivel errors above x", "deg", of("own_swivel_deg"), 180.0, (limits["own_swivel_deg"],))
            + svg.bars("Elbow error by person, mean", people, "cm", limits["elbow_cm"]))


def page(table, limits, recording, truth, clips, runs, scores):
    """runs: {title: (color, bodies, errors)}, the evaluated one first.

    scores: {title: figures}; for the evaluated estimator {person: figures} and the spreads over people."""
    everybody, alone, spreads = scores
    first = next(iter(runs))
    _, bodies, errors = runs[first]
    keys = svg.keys_html({"truth": stick_figures.TRUTH[0], first: stick_figures.OURS[0]})
    return f"""<!doctype html><html lang="en"><meta charset="utf-8"><title>Arms and chest, measured</title><style>{STYLE}</style>
<h1>Arms and chest, measured</h1>
<p>Estimated from a head and two hands alone, against motion capture: {len(np.unique(recording.clip))} recordings of {len(clips.people)} people,
{everybody[first]["minutes"]:.1f} minutes. Handhold's constants were fitted to other people; body_constants.hpp names the data. docs/decisions/0091-fitted-body-estimate.md
says how. Meaning of each figure: docs/reference/lab.md.</p>
<h2>Goals</h2>{goals_html(table)}
<h2>Compared with the baselines</h2>{figures_html("estimator", everybody.items())}
<div class="plots">{plots_html(runs, alone, limits)}</div>
<h2>By person</h2>{figures_html("person", alone.items())}
<p>Dependence on the recorded persons: each person with equal weight, and all but one person together.</p>{people_html(spreads)}
<h2>By hand position</h2>{places_html(errors, scoring.where_hands_are(recording, truth))}
<h2>Over time</h2><p>The longest recording of each person.</p><div class="plots">{over_time_html(recording, truth, clips, runs)}</div>
<h2>Poses</h2><p>Head, hands (black) and truth (grey) as recorded; the left arm is paler. For each person the frames with median,
95th percentile and largest elbow error.</p>{keys}<div class="sheet">{pictures_html(recording, truth, clips, bodies, errors)}</div></html>
"""
