"""A model of how people rate a posed hand: ordinal logistic regression on eleven features of the pose and its gaps.

For features x of a hand, z = clip((x - mean) / sd, -3, 3) and e = z . weight; P(ugly) = 1 - s(e - t0) and P(convincing) = s(e - t1), where s
is the logistic function and t0 < t1 are thresholds (McCullagh, Regression models for ordinal data, 1980). Angles are in degrees, gaps in
millimetres. A feature whose joint or digit the hand lacks is 0."""
import csv
import math
import pathlib

import numpy as np
from scipy.optimize import minimize
from scipy.special import expit

from pages import files
from . import style
from .grasps import FINGERS

MODEL = pathlib.Path(__file__).with_suffix(".json")
# feature: what it measures; "finger" means the four without the thumb, "tip" the end of the last link.
FEATURES = {
    "tip_max": "largest gap of a finger's tip, 0 to 50",
    "fan_max": "largest angle between neighbouring fingers' directions, knuckle to tip",
    "thumb_tip": "gap of the thumb's tip, 0 to 50",
    "touch_not_tip": "number of fingers within 3 mm whose tip is more than 15 mm off",
    "hyper": "sum over fingers of max(0, 0.6 q2 - q1 - 20): knuckle stretched, middle joint bent",
    "flex_gap": "mean over fingers of their gap, 0 to 20, times max(0, 60 - total bend) / 60",
    "flex_max": "largest total bend of a finger",
    "thumb_mis_air": "0.35 times the fingers' mean bend less the thumb's, 0 to 60; times (thumb tip gap - 4) / 10, 0 to 1",
    "nb_mcp_max": "largest difference of neighbouring fingers' knuckle angles",
    "wrap_n": "number of fingers whose tip is more than 8 mm below the grip surface's plane and within 8 mm of a surface",
    "thumb_bend": "max(0, last minus middle hinge of the thumb - 30)",
}
LABELS = ("ugly", "acceptable", "convincing")  # 0, 1, 2 in a file of labels
HIDDEN = "hidden"  # label of a hand of which a person sees too little; counts in no share
LIMIT = 3.0  # of z
RIDGE = 3.0  # from 0.3 to 30 the held-out loss of the first 694 labels changes by 0.5 %
FOLDS = 10
TOUCH_MM, OFF_MM, BELOW_MM, TIP_MM = 3.0, 15.0, 8.0, (-10.0, 60.0)


def check_label(label, place):
    """place: what an error begins with."""
    if label not in (*LABELS, HIDDEN):
        raise files.FormatError(f"{place}: label: expected one of {', '.join((*LABELS, HIDDEN))}")


def hinges_deg(grasps):
    """(grasps, FINGERS, 3): hinge angles from the knuckle; NaN where the hand has no such hinge."""
    angles = np.full((len(grasps), len(FINGERS), 3), np.nan)
    for row, grasp in enumerate(grasps):
        for finger in grasp.fingers:
            curls = np.degrees(finger["curl_rad"][:3])
            angles[row, FINGERS.index(finger["name"]), :len(curls)] = curls
    return angles


def tips(surface, grasps, capsules):
    """Ends (grasps, FINGERS, 3) of the digits' last links and their gaps in mm, clipped to TIP_MM; NaN without the digit."""
    ends, gaps = np.full((len(grasps), len(FINGERS), 3), np.nan), np.full((len(grasps), len(FINGERS)), np.nan)
    rows = [row for row, part in enumerate(capsules.part) if part != "palm" and grasps[capsules.grasp[row]].gripped]
    rows = [row for row in rows if np.isfinite(capsules.b[row]).all()]
    # A digit's links are listed from its base, so its last row stays.
    last = {(capsules.grasp[row], FINGERS.index(capsules.part[row])): row for row in rows}
    if last:
        place, row = tuple(np.array(list(last)).T), np.array(list(last.values()))
        ends[place] = capsules.b[row]
        gaps[place] = np.clip(1e3 * (surface.distance(capsules.b[row]) - capsules.radius[row]), *TIP_MM)
    return ends, gaps


def features(surface, grasps, capsules, gaps_mm):
    """(grasps, FEATURES). gaps_mm: as scoring.part_gaps_mm."""
    ends, tip = tips(surface, grasps, capsules)
    angle = hinges_deg(grasps)
    bend = np.where(np.isfinite(angle[:, :, 0]), np.nansum(angle, 2), np.nan)
    four = style.FOUR
    largest = lambda values, low: np.max(np.where(np.isfinite(values), values, low), 1)
    mean = lambda values: np.nansum(values, 1) / np.maximum(1, np.isfinite(values).sum(1))
    knuckle, middle = angle[:, four, 0], angle[:, four, 1]
    gap, fingers_bend = gaps_mm[:, four], bend[:, four]
    normal = np.array([grasp.normal for grasp in grasps]).reshape(-1, 1, 3)
    point = np.array([grasp.point_m for grasp in grasps]).reshape(-1, 1, 3)
    height_mm = 1e3 * ((ends[:, four] - point) * normal).sum(2)
    beside = np.abs(np.diff(knuckle, axis=1))
    thumb_bend, thumb_tip = np.nan_to_num(bend[:, 0]), np.nan_to_num(tip[:, 0])
    value = {
        "tip_max": np.clip(largest(tip[:, four], 0.0), 0.0, 50.0),
        "fan_max": style.fans_deg(grasps, capsules),
        "thumb_tip": np.clip(thumb_tip, 0.0, 50.0),
        "touch_not_tip": ((gap < TOUCH_MM) & (tip[:, four] > OFF_MM)).sum(1),
        "hyper": np.nansum(np.maximum(0.0, 0.6 * middle - knuckle - 20.0), 1),
        "flex_gap": mean(np.where(np.isfinite(fingers_bend), np.clip(gap, 0.0, 20.0) * np.maximum(0.0, 60.0 - fingers_bend) / 60.0, np.nan)),
        "flex_max": largest(fingers_bend, 0.0),
        "thumb_mis_air": np.clip(0.35 * mean(fingers_bend) - thumb_bend, 0.0, 60.0) * np.clip((thumb_tip - 4.0) / 10.0, 0.0, 1.0),
        "nb_mcp_max": largest(beside, 0.0),
        "wrap_n": ((height_mm < -BELOW_MM) & (tip[:, four] < BELOW_MM)).sum(1),
        "thumb_bend": np.maximum(0.0, np.nan_to_num(angle[:, 0, 2] - angle[:, 0, 1]) - 30.0),
    }
    return np.stack([np.asarray(value[name], float) for name in FEATURES], 1)


class Critic:
    def __init__(self, mean, sd, weight, thresholds):
        self.mean, self.sd, self.weight, self.thresholds = (np.asarray(part, float) for part in (mean, sd, weight, thresholds))

    def shares(self, values):
        """Probabilities (rows, LABELS)."""
        liking = np.clip((values - self.mean) / self.sd, -LIMIT, LIMIT) @ self.weight
        above = expit(liking[:, None] - self.thresholds)
        return np.stack([1.0 - above[:, 0], above[:, 0] - above[:, 1], above[:, 1]], 1)

    def text(self, labels):
        """As one line of JSON per member."""
        members = {"features": list(FEATURES), "mean": self.mean, "sd": self.sd, "weight": self.weight, "thresholds": self.thresholds}
        lines = [f' "{key}": {list_text(value)}' for key, value in members.items()]
        return "{\n" + ",\n".join([*lines, f' "labels": {labels}']) + "\n}\n"


def list_text(values):
    return "[" + ", ".join(f'"{value}"' if isinstance(value, str) else f"{value:.6g}" for value in values) + "]"


def read_critic(path=MODEL):
    value = files.read_json(path)
    if files.member(value, "features", path) != list(FEATURES):
        raise files.FormatError(f"{path}: features: expected {', '.join(FEATURES)}")
    part = lambda key, count: files.numbers(files.member(value, key, path), count, f"{path}: {key}")
    critic = Critic(*(part(key, len(FEATURES)) for key in ("mean", "sd", "weight")), part("thresholds", 2))
    finite = all(np.isfinite(values).all() for values in (critic.mean, critic.sd, critic.weight, critic.thresholds))
    if not finite or critic.sd.min() <= 0.0 or critic.thresholds[0] > critic.thresholds[1]:
        raise files.FormatError(f"{path}: expected finite numbers, deviations above 0 and rising thresholds")
    return critic


def read_labels(path):
    """Features (rows, FEATURES), labels (rows,) and groups (rows,) of a CSV with the columns label, group and every feature."""
    rows = list(csv.DictReader(files.read_text(path).splitlines()))
    missing = [name for name in ("label", "group", *FEATURES) if not rows or name not in rows[0]]
    if missing:
        raise files.FormatError(f"{path}: expected rows with the columns {', '.join(missing)}")
    values, labels = [], []
    for line, row in enumerate(rows, 2):
        if row["label"] not in ("0", "1", "2"):
            raise files.FormatError(f"{path}: line {line}: label: expected 0, 1 or 2")
        try:
            values.append([float(row[name]) for name in FEATURES])
        except (TypeError, ValueError):
            raise files.FormatError(f"{path}: line {line}: expected a number for every feature") from None
        if not files.finite(values[-1]):
            raise files.FormatError(f"{path}: line {line}: expected finite features")
        labels.append(int(row["label"]))
    if len(set(labels)) < len(LABELS):
        raise files.FormatError(f"{path}: expected hands of all three labels")
    return np.array(values), np.array(labels), np.array([row["group"] for row in rows])


def fit(values, labels):
    """The critic that maximises the labels' likelihood, less RIDGE / 2 |weight|^2. Every label must occur."""
    mean, sd = values.mean(0), values.std(0)
    sd = np.where(sd > 1e-9, sd, 1.0)
    z = np.clip((values - mean) / sd, -LIMIT, LIMIT)
    count = z.shape[1]

    def loss(x):
        weight, low, step = x[:count], x[count], x[count + 1]
        liking, high = z @ weight, low + math.exp(step)  # the thresholds' order is built in
        above = np.stack([expit(liking - low), expit(liking - high)], 1)
        share = np.choose(labels, [1.0 - above[:, 0], above[:, 0] - above[:, 1], above[:, 1]])
        share = np.maximum(share, 1e-300)
        # Derivatives of each row's probability by its two margins.
        slope = above * (1.0 - above)
        by_low = np.choose(labels, [-slope[:, 0], slope[:, 0], 0.0 * slope[:, 0]]) / share
        by_high = np.choose(labels, [0.0 * slope[:, 1], -slope[:, 1], slope[:, 1]]) / share
        gradient = np.concatenate([-(by_low + by_high) @ z + RIDGE * weight, [(by_low + by_high).sum(), by_high.sum() * math.exp(step)]])
        return -np.log(share).sum() + 0.5 * RIDGE * weight @ weight, gradient

    start = np.concatenate([np.zeros(count), [-1.0, 0.0]])
    x = minimize(loss, start, jac=True, method="L-BFGS-B", options={"maxiter": 2000, "ftol": 1e-12, "gtol": 1e-7}).x
    return Critic(mean, sd, x[:count], (x[count], x[count] + math.exp(x[count + 1])))


def held_out_shares(values, labels, groups):
    """Probabilities of every row by critics that have seen no row of its group; None if there are too few groups."""
    names = np.unique(groups)
    if len(names) < 2:
        return None
    shares = np.zeros((len(labels), len(LABELS)))
    for fold in np.array_split(np.random.default_rng(1).permutation(names), min(FOLDS, len(names))):
        out = np.isin(groups, fold)
        if len(set(labels[~out])) < len(LABELS):
            return None
        shares[out] = fit(values[~out], labels[~out]).shares(values[out])
    return shares


def area_under_curve(score, flags):
    """Probability that a flagged row scores higher than another one; ties count half (Hanley, McNeil 1982)."""
    if flags.all() or not flags.any():
        return math.nan
    one, other = score[flags][:, None], score[~flags][None, :]
    return float((one > other).mean() + 0.5 * (one == other).mean())
