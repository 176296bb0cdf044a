"""What a player sees wrong in a grasp that does not penetrate: classes of design/hands.md's table, with confidence bounds.

Each class is a flag per grasp. Bounds are percentiles of a bootstrap that draws whole files (one mesh with one seed) with replacement,
because grasps of one mesh resemble each other (Efron, Tibshirani, An introduction to the bootstrap, 1993, chapter 8)."""
import math

import numpy as np

from .grasps import FINGERS

DRAWS = 1000
TOUCH_MM, OFF_MM, TIP_OFF_MM, DEEP_MM = 2.0, 10.0, 20.0, 3.0
STRAIGHT_DEG, CURLED_DEG, FOLDED_DEG, APART_DEG, ASTRAY_DEG, TURNED_DEG = 20.0, 60.0, 165.0, 100.0, 40.0, 45.0
FAR_MM = 60.0
THROUGH_MM, FANNED_DEG = 2.0, 35.0
FOUR = slice(1, 5)
# class: (title, goal in percent)
CLASSES = {
    "finger_off": ("a finger more than 10 mm off while another touches", 3.0),
    "finger_astray": ("of these, bent by 40 degrees more or less than its neighbours", 1.0),
    "neighbours_apart": ("neighbouring fingers' bends differ by more than 100 degrees", 2.0),
    "finger_folded": ("a finger bent by more than 165 degrees", 1.5),
    "thumb_base_only": ("thumb touches by its base only", 2.0),
    "one_straight": ("one straight finger, the others curled", 1.0),
    "thumb_through": ("thumb and a finger overlap by more than 2 mm", 1.0),
    "fanned": ("neighbouring fingers point more than 35 degrees apart, knuckle to tip", 10.0),
    "hand_turned": ("hand turned by more than 45 degrees", 0.3),
    "palm_far": ("palm moved by more than 60 mm", 0.3),
    "palm_deep": ("palm deeper than 3 mm", 1.5),
    "none_touches": ("no finger touches", 0.3),
    "one_touches": ("one finger touches", 0.3),
}


def bends_deg(grasps):
    """(grasps, FINGERS): total bend of each digit; NaN if the hand has no such digit."""
    bends = np.full((len(grasps), len(FINGERS)), np.nan)
    for row, grasp in enumerate(grasps):
        for finger in grasp.fingers:
            if finger["curl_rad"]:
                bends[row, FINGERS.index(finger["name"])] = math.degrees(sum(finger["curl_rad"]))
    return bends


def thumb_tip_gaps_mm(surface, grasps, capsules):
    """Gap of the end of each thumb's last link; NaN without one."""
    gaps = np.full(len(grasps), np.nan)
    if not len(capsules.grasp):
        return gaps
    rows = np.nonzero((capsules.part == "thumb") & np.isfinite(capsules.b).all(1))[0]
    # A thumb's links are listed from its base, so its last row stays.
    last = dict(zip(capsules.grasp[rows].tolist(), rows.tolist()))
    if last:
        number, row = np.array(list(last)), np.array(list(last.values()))
        gaps[number] = 1e3 * (surface.distance(capsules.b[row]) - capsules.radius[row])
    return gaps


def between_segments(a, b, c, d):
    """Least distances of segments ab and cd, (..., 3) each: of each end to the other segment, or 0 where the segments cross within their
    lengths. Source: the minimum of a convex function over a square lies on its border or where its gradient vanishes."""
    u, v, w = b - a, d - c, a - c
    uu, vv, uv, uw, vw = ((x * y).sum(-1) for x, y in ((u, u), (v, v), (u, v), (u, w), (v, w)))
    along = lambda top, bottom: np.clip(np.divide(top, bottom, out=np.zeros_like(top), where=bottom > 1e-18), 0.0, 1.0)
    distance = lambda s, t: np.linalg.norm(w + s[..., None] * u - t[..., None] * v, axis=-1)
    zero, one = np.zeros_like(uu), np.ones_like(uu)
    ends = [distance(zero, along(vw, vv)), distance(one, along(vw + uv, vv)), distance(along(-uw, uu), zero), distance(along(uv - uw, uu), one)]
    least = np.minimum.reduce(ends)
    bottom = uu * vv - uv * uv
    skew = bottom > 1e-12 * uu * vv
    s = np.divide(uv * vw - vv * uw, bottom, out=zero.copy(), where=skew)
    t = np.divide(uu * vw - uv * uw, bottom, out=zero.copy(), where=skew)
    inside = skew & (s >= 0.0) & (s <= 1.0) & (t >= 0.0) & (t <= 1.0)
    return np.where(inside, np.minimum(least, distance(s, t)), least)


def rows_by_part(grasps, capsules):
    """For each grasp {part: its capsules' rows in order from the base}."""
    rows = [{} for _ in grasps]
    for row, (grasp, part) in enumerate(zip(capsules.grasp.tolist(), capsules.part.tolist())):
        rows[grasp].setdefault(part, []).append(row)
    return rows


def thumb_overlaps_mm(grasps, capsules):
    """Deepest overlap of a thumb's capsule with a finger's; below 0: the least gap; -infinity without both."""
    overlaps = np.full(len(grasps), -np.inf)
    for number, parts in enumerate(rows_by_part(grasps, capsules)):
        thumb, fingers = parts.get("thumb", []), [row for name in FINGERS[1:] for row in parts.get(name, [])]
        if thumb and fingers:
            i, j = (index.ravel() for index in np.meshgrid(thumb, fingers))
            gap = between_segments(capsules.a[i], capsules.b[i], capsules.a[j], capsules.b[j]) - capsules.radius[i] - capsules.radius[j]
            overlaps[number] = -1e3 * gap.min()
    return overlaps


def fans_deg(grasps, capsules):
    """Largest angle between neighbouring fingers' directions, knuckle to tip; 0 without neighbours."""
    fans = np.zeros(len(grasps))
    for number, parts in enumerate(rows_by_part(grasps, capsules)):
        ways = [capsules.b[rows[-1]] - capsules.a[rows[0]] for rows in (parts.get(name) for name in FINGERS[1:]) if rows]
        for one, other in zip(ways, ways[1:]):
            fans[number] = max(fans[number], math.degrees(math.atan2(np.linalg.norm(np.cross(one, other)), np.dot(one, other))))
    return fans


def apart(bends):
    """Largest difference of neighbouring fingers' bends, thumbs left out; 0 without neighbours."""
    return np.nan_to_num(np.abs(np.diff(bends[:, FOUR], axis=1)), nan=0.0).max(1)


def astray(off, bend):
    """Fingers off the surface whose bend differs by more than ASTRAY_DEG from the mean of their neighbours'."""
    padded = np.pad(bend, ((0, 0), (1, 1)), constant_values=np.nan)
    beside = np.stack([padded[:, :-2], padded[:, 2:]])
    known = np.isfinite(beside)
    mean = np.where(known, beside, 0.0).sum(0) / np.maximum(known.sum(0), 1)
    return (off & known.any(0) & (np.abs(bend - mean) > ASTRAY_DEG)).any(1)


def flags(gaps, tips, bends, sync_mm, sync_deg, overlaps, fans):
    """{class: (grasps,) flags}. gaps: as scoring.part_gaps_mm."""
    four, bend = gaps[:, FOUR], bends[:, FOUR]
    near = np.abs(four) < TOUCH_MM
    touching = near | (four < 0.0)
    off = np.isfinite(four) & (four > OFF_MM)
    straight, curled = bend < STRAIGHT_DEG, bend > CURLED_DEG
    there = np.isfinite(bend).sum(1)
    return {
        "finger_off": off.any(1) & touching.any(1),
        "finger_astray": astray(off, bend) & touching.any(1),
        "neighbours_apart": apart(bends) > APART_DEG,
        "finger_folded": (bend > FOLDED_DEG).any(1),
        "thumb_base_only": (np.abs(gaps[:, 0]) < TOUCH_MM) & (tips > TIP_OFF_MM),
        "one_straight": (straight.sum(1) == 1) & (curled.sum(1) == there - 1) & (there > 2),
        "thumb_through": overlaps > THROUGH_MM,
        "fanned": fans > FANNED_DEG,
        "hand_turned": sync_deg > TURNED_DEG,
        "palm_far": sync_mm > FAR_MM,
        "palm_deep": np.isfinite(gaps[:, 5]) & (gaps[:, 5] < -DEEP_MM),
        "none_touches": touching.sum(1) == 0,
        "one_touches": touching.sum(1) == 1,
    }


def bounded(of, files):
    """Value of `of` over all files with its 95 % bounds. of: figure of a list of arrays, one per file."""
    value = of(files)
    if len(files) < 2:
        return {"value": value, "low": math.nan, "high": math.nan}
    rng = np.random.default_rng(1)
    draws = [of([files[i] for i in rng.integers(0, len(files), len(files))]) for _ in range(DRAWS)]
    low, high = np.nanpercentile(draws, (2.5, 97.5))
    return {"value": value, "low": float(low), "high": float(high)}


def mean_of(files):
    """Mean of all values of several arrays."""
    count = sum(len(one) for one in files)
    return sum(float(np.sum(one)) for one in files) / count if count else math.nan


def p95_of(files):
    values = np.concatenate(files)
    return float(np.percentile(values, 95)) if len(values) else math.nan


def figures(measured):
    """Shares of every class, of grasps in any class, palm sync and turn, each with bounds. measured: scoring.Measured, one per file."""
    used = [one.style[one.used] for one in measured if one.used.any()]
    if not used:
        return {}
    names = used[0].dtype.names
    result = {name: bounded(mean_of, [one[name] for one in used]) for name in CLASSES}
    result["any_class"] = bounded(mean_of, [np.any([one[name] for name in CLASSES], axis=0) for one in used])
    for name in ("sync_mm", "turn_deg"):
        quantity, unit = name.split("_")
        result[f"{quantity}_mean_{unit}"] = bounded(mean_of, [one[name] for one in used])
        result[f"{quantity}_p95_{unit}"] = bounded(p95_of, [one[name] for one in used])
    result["part_deep"] = bounded(mean_of, [one["part_deep"] for one in used])
    assert set(CLASSES) < set(names)
    return result


def rows_of(surface, grasps, capsules, gaps):
    """Structured array, one row per grasp: every class, sync_mm, turn_deg, and part_deep (any part, the palm included)."""
    sync_mm, sync_deg = (np.array([getattr(grasp, key) for grasp in grasps], float) for key in ("sync_mm", "sync_deg"))
    classes = flags(gaps, thumb_tip_gaps_mm(surface, grasps, capsules), bends_deg(grasps), sync_mm, sync_deg,
                    thumb_overlaps_mm(grasps, capsules), fans_deg(grasps, capsules))
    rows = np.zeros(len(grasps), [(name, bool) for name in CLASSES] + [("sync_mm", float), ("turn_deg", float), ("part_deep", bool)])
    for name, flag in classes.items():
        rows[name] = flag
    rows["sync_mm"], rows["turn_deg"] = sync_mm, sync_deg
    rows["part_deep"] = (np.where(np.isfinite(gaps), gaps, 0.0) < -DEEP_MM).any(1)
    return rows
