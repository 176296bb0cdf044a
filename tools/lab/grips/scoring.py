"""Figures of posed hands. Depths and gaps in millimetres, of grasps that grip and are finite, unless a name says otherwise."""
import collections
import math

import numpy as np

from . import critic, style
from .capsules import clearance
from .grasps import FINGERS

DEEP_MM, TOUCH_MM = 3.0, 2.0
PARTS = FINGERS + ("palm",)
CRITIC = critic.read_critic()


def spread(values):
    """Median, 95th and 99th percentile and maximum of the finite values."""
    values = np.asarray([value for value in values if math.isfinite(value)], float)
    if not len(values):
        return {"count": 0}
    median, p95, p99 = np.percentile(values, (50, 95, 99))
    return {"count": len(values), "mean": float(values.mean()), "median": float(median), "p95": float(p95), "p99": float(p99),
            "max": float(values.max())}


def share(flags):
    flags = np.asarray(flags, bool)
    return float(flags.mean()) if len(flags) else math.nan


def part_gaps_mm(surface, grasps, capsules):
    """(grasps, PARTS): minimum clearance of each part's capsules; NaN if one is not finite, infinite if the hand has no such part."""
    wanted = np.array([grasp.gripped for grasp in grasps])[capsules.grasp] if len(capsules.grasp) else np.zeros(0, bool)
    gaps = np.full((len(grasps), len(PARTS)), np.inf)
    place = np.array([PARTS.index(part) for part in capsules.part], int)[wanted]
    value = 1e3 * clearance(surface, capsules.a[wanted], capsules.b[wanted], capsules.radius[wanted])
    np.minimum.at(gaps, (capsules.grasp[wanted], place), value)  # minimum propagates NaN
    return gaps


def score_grasp(grasp, gaps):
    """Figures of one grasp."""
    there = {part: gap for part, gap in zip(PARTS, gaps.tolist()) if gap != math.inf}
    return {"id": grasp.id, "gripped": grasp.gripped, "finite": grasp.is_finite() and not any(map(math.isnan, there.values())),
            "gap_mm": there, "depth_mm": {part: max(0.0, -gap) for part, gap in there.items()}}


def search_figures(grasps):
    """Visited triangles per disc, by finger: pops to the first hit, and the walk."""
    fingers = [finger for grasp in grasps for finger in grasp.fingers if finger["discs"] > 0]
    return {"visited_per_disc": spread([finger["visited"] / finger["discs"] for finger in fingers]),
            "walked_per_disc": spread([finger["walked"] / finger["discs"] for finger in fingers]),
            "fallbacks": dict(sorted(collections.Counter(finger["fallback"] for grasp in grasps for finger in grasp.fingers).items()))}


def depth_figures(gaps):
    """gaps: (grasps, PARTS), finite or infinite."""
    depth = np.maximum(0.0, -gaps)
    fingers, four = depth[:, :5], depth[:, 1:5]
    has_finger = np.isfinite(gaps[:, :5])
    has_thumb, has_palm = np.isfinite(gaps[:, 0]), np.isfinite(gaps[:, 5])
    near = np.abs(gaps[:, :5]) < TOUCH_MM
    return {
        "deep_share": {"any_finger_or_thumb": share((fingers > DEEP_MM).any(1)), "any_finger": share((four > DEEP_MM).any(1)),
                       "thumb": share(depth[has_thumb, 0] > DEEP_MM), "palm": share(depth[has_palm, 5] > DEEP_MM)},
        "penetration_mm": {"mean_of_fingers": float(fingers[has_finger].mean()) if has_finger.any() else math.nan,
                           "mean_of_deepest": float(fingers.max(1).mean()) if len(fingers) else math.nan,
                           "fingers": spread(fingers[has_finger]), "palm": spread(depth[has_palm, 5])},
        "fingers_within_2_mm": {"four": share(near[:, 1:][has_finger[:, 1:]]), "thumb": share(near[has_thumb, 0]),
                                "all": share(near[has_finger])},
    }


def reference_figures(gaps, reached):
    """Share of touching fingers among those that the reference brings to contact (reached, (grasps, 5))."""
    near = (np.abs(gaps[:, :5]) < TOUCH_MM) & reached
    part = lambda columns: {"reached": int(reached[:, columns].sum()),
                            "touching": float(near[:, columns].sum() / reached[:, columns].sum()) if reached[:, columns].any() else math.nan}
    return {"four": part(slice(1, 5)), "thumb": part(slice(0, 1)), "all": part(slice(0, 5))}


class Measured:
    """One file's grasps with their measurements.

    gaps_mm: (grasps, PARTS). each: one dictionary per grasp. used: gripped and finite. near: by the placements' kinds, {id: kind}; None:
    not known. reached: (grasps, 5), fingers that the reference brings to contact; None: not evaluated. style: one row per grasp
    (style.rows_of). expected: (grasps, critic.LABELS), shares of the labels; tip_mm: (grasps, FINGERS), gaps of the digits' ends."""

    def __init__(self, surface, grasps, capsules, kinds=None, reached=None):
        self.grasps = grasps
        self.gaps_mm = part_gaps_mm(surface, grasps, capsules)
        self.each = [score_grasp(grasp, row) for grasp, row in zip(grasps, self.gaps_mm)]
        self.style = style.rows_of(surface, grasps, capsules, self.gaps_mm)
        _, self.tip_mm = critic.tips(surface, grasps, capsules)
        self.expected = CRITIC.shares(critic.features(surface, grasps, capsules, self.gaps_mm))
        for one, row, shares in zip(self.each, self.style, self.expected):
            one["expected"] = dict(zip(critic.LABELS, shares.tolist()))
            one["classes"] = [name for name in style.CLASSES if row[name]]
        self.used = np.array([one["gripped"] and one["finite"] for one in self.each])
        self.near = None if kinds is None else np.array([kinds.get(grasp.id) == "near" for grasp in grasps])
        self.reached = reached
        if reached is not None:
            for one, row in zip(self.each, reached):
                one["reference_reaches"] = [name for name, hit in zip(FINGERS, row) if hit]


def critic_figures(measured, near=None):
    """Expected shares of convincing and ugly hands, with 95 % bounds over files. near: only placements of this kind; None: all."""
    rows = [(one, one.used if near is None else one.used & (one.near == near)) for one in measured if near is None or one.near is not None]
    rows = [one.expected[used] for one, used in rows if used.any()]
    if not rows:
        return {}
    return {name: style.bounded(style.mean_of, [row[:, critic.LABELS.index(name)] for row in rows]) for name in ("convincing", "ugly")}


def worst_tips_mm(one):
    """Gap of the farthest finger's end, of each used hand of a file that has a finger."""
    tips = one.tip_mm[one.used, style.FOUR]
    tips = tips[np.isfinite(tips).any(1)]
    return np.nanmax(tips, 1) if len(tips) else np.zeros(0)


def deepest_mm(measured):
    """Depth of the deepest finger or thumb of each used grasp."""
    return np.maximum(0.0, -np.concatenate([one.gaps_mm[one.used, :5] for one in measured]).min(1)) if measured else np.zeros(0)


def figures(measured):
    """Figures of all grasps of one or several files together."""
    grasps = [grasp for one in measured for grasp in one.grasps]
    gripped = [grasp for grasp in grasps if grasp.gripped]
    result = {
        "grasps": len(grasps), "gripped": len(gripped), "gripped_share": share([grasp.gripped for grasp in grasps]),
        "not_finite": sum(not one["finite"] for file in measured for one in file.each),
        "reasons": dict(sorted(collections.Counter(grasp.reason for grasp in grasps if not grasp.gripped).items())),
        **depth_figures(np.concatenate([one.gaps_mm[one.used] for one in measured])),
        "sync_mm": spread([grasp.sync_mm for grasp in gripped]), "sync_deg": spread([grasp.sync_deg for grasp in gripped]),
        **search_figures(gripped),
        "us": {stage: spread([grasp.us.get(stage, math.nan) for grasp in gripped]) for stage in ("search", "palm", "fingers", "total")},
    }
    result["style"] = style.figures(measured)
    result["critic"] = {"all": critic_figures(measured), "near": critic_figures(measured, True), "harsh": critic_figures(measured, False)}
    tips = [tip for tip in map(worst_tips_mm, measured) if len(tip)]
    result["worst_tip_mm"] = spread(np.concatenate(tips) if tips else ())
    if tips:
        result["worst_tip_median_mm"] = style.bounded(lambda drawn: float(np.median(np.concatenate(drawn))), tips)
    known = [one for one in measured if one.near is not None]
    if known:
        result["sync_mm_near"] = spread([grasp.sync_mm for one in known for grasp, near in zip(one.grasps, one.near) if near and grasp.gripped])
        result["near"] = depth_figures(np.concatenate([one.gaps_mm[one.used & one.near] for one in known]))
    asked = [one for one in measured if one.reached is not None]
    if asked:
        result["of_reference"] = reference_figures(np.concatenate([one.gaps_mm[one.used] for one in asked]),
                                                   np.concatenate([one.reached[one.used] for one in asked]))
    return result


def without_nan(value):
    """Replaces NaN by None, since JSON has no NaN."""
    if isinstance(value, dict):
        return {key: without_nan(part) for key, part in value.items()}
    if isinstance(value, list):
        return [without_nan(part) for part in value]
    return None if isinstance(value, float) and not math.isfinite(value) else value
