"""Errors of estimated bodies per frame, and figures for a selection of frames. Meaning of each figure: docs/reference/lab.md."""
import math

import numpy as np

CM_PER_M = 100.0
BENT_M = 0.04  # below this distance of the true elbow from the line shoulder-hand, the swivel is undefined
POP_M, CALM_M = 0.05, 0.03  # an elbow pops if it moves farther than POP_M in a frame while the true one moves less than CALM_M


def wrapped_deg(angle):
    return (angle + 180.0) % 360.0 - 180.0


def unit(vectors):
    return vectors / np.maximum(np.linalg.norm(vectors, axis=-1, keepdims=True), 1e-12)


def across(vectors, axis):
    return vectors - np.sum(vectors * axis, -1, keepdims=True) * axis


def turned(vectors, source, target):
    """Applies the smallest rotation from unit vectors source to target."""
    axis, cosine = np.cross(source, target), np.sum(source * target, -1, keepdims=True)
    along = np.sum(axis * vectors, -1, keepdims=True) / np.maximum(1.0 + cosine, 1e-9)
    return cosine * vectors + np.cross(axis, vectors) + along * axis


def swivel_deg(hand, true, estimated):
    """Angle from the estimated elbow to the true one about the line from shoulder to hand, after that line is rotated onto the true one; NaN if
    the true arm is straight.

    true, estimated: (shoulder, elbow)."""
    line, line_estimated = unit(hand - true[0]), unit(hand - estimated[0])
    offset = across(true[1] - true[0], line)
    offset_estimated = turned(across(estimated[1] - estimated[0], line_estimated), line_estimated, line)
    angle = np.arctan2(np.sum(np.cross(offset_estimated, offset) * line, -1), np.sum(offset_estimated * offset, -1))
    return np.where(np.linalg.norm(offset, axis=-1) > BENT_M, np.degrees(angle), np.nan)


def medians(values, sources):
    """Of each source's rows the median of (2, rows) values; 0 if it has none."""
    result = np.zeros(values.shape[1])
    for name in ["all"] if sources is None else np.unique(sources):
        rows = np.full(len(result), True) if sources is None else sources == name
        known = values[:, rows][np.isfinite(values[:, rows])]
        result[rows] = np.median(known) if len(known) else 0.0
    return result


def distance(a, b):
    return np.linalg.norm(a - b, axis=-1)


class Errors:
    """Errors per frame (rows), or per arm and frame (2, rows); NaN if excluded: invalid truth or missing neighbours.

    own_swivel_deg: swivel without each source's median, which depends on how the source defines its joints. jerk_mps3, true_jerk_mps3: third differences of the elbow, from the frame before to two frames after. pops: 1 if the elbow pops."""

    def __init__(self, recording, truth, estimate, sources=None):
        """sources: name of each row's source; None: all are of one."""
        self.clip, self.t_s, self.hz, self.valid = recording.clip, recording.t_s, recording.hz, truth.valid
        counted = np.where(truth.valid, 1.0, np.nan)
        self.yaw_deg = counted * np.abs(wrapped_deg(estimate.yaw_deg - truth.yaw_deg))
        self.shoulder_cm = counted * CM_PER_M * distance(estimate.shoulder_m, truth.shoulder_m)
        self.elbow_cm = counted * CM_PER_M * distance(estimate.elbow_m, truth.elbow_m)
        inward = np.array([[-1.0], [1.0]])  # the same sign for both arms
        swivel = counted * inward * swivel_deg(recording.hand_m, (truth.shoulder_m, truth.elbow_m), (estimate.shoulder_m, estimate.elbow_m))
        self.swivel_deg = np.abs(swivel)
        self.own_swivel_deg = np.abs(wrapped_deg(swivel - medians(swivel, sources)))
        lengths = [distance(body.shoulder_m, body.elbow_m) + distance(body.elbow_m, recording.hand_m) for body in (estimate, truth)]
        self.stretch_percent = counted * 100.0 * np.abs(lengths[0] / np.maximum(lengths[1], 1e-9) - 1.0)
        self.jerk_mps3 = counted * self._jerk(estimate.elbow_m)
        self.true_jerk_mps3 = counted * self._jerk(truth.elbow_m)
        self.pops = self._pops(estimate.elbow_m, truth.elbow_m)

    def _jerk(self, points):
        jerk = np.full(points.shape[:2], np.nan)
        third = points[:, 3:] - 3.0 * points[:, 2:-1] + 3.0 * points[:, 1:-2] - points[:, :-3]
        jerk[:, 1:-2] = np.where(self.clip[3:] == self.clip[:-3], np.linalg.norm(third, axis=-1) * self.hz ** 3, np.nan)
        return jerk

    def _pops(self, estimated, true):
        went, truly_went = (np.linalg.norm(np.diff(points, axis=1), axis=-1) for points in (estimated, true))
        steady = (self.clip[1:] == self.clip[:-1]) & self.valid[1:] & self.valid[:-1]
        pops = np.zeros(estimated.shape[:2])
        pops[:, 1:] = (went > POP_M) & (truly_went < CALM_M) & steady
        return pops


def spread(values):
    """Mean, median and 95th percentile of the finite values."""
    values = values[np.isfinite(values)]
    if not len(values):
        return {"mean": math.nan, "median": math.nan, "p95": math.nan}
    return {"mean": float(values.mean()), "median": float(np.median(values)), "p95": float(np.percentile(values, 95))}


def mean(values):
    return spread(values)["mean"]


def figures(errors, rows):
    """Figures for the selected frames; rows is a mask."""
    minutes = np.sum(errors.valid & rows) / errors.hz / 60.0
    jerk, true_jerk = mean(errors.jerk_mps3[:, rows]), mean(errors.true_jerk_mps3[:, rows])
    return {
        "minutes": float(minutes),
        **{name: spread(getattr(errors, name)[..., rows]) for name in ("yaw_deg", "shoulder_cm", "elbow_cm", "swivel_deg", "own_swivel_deg", "stretch_percent")},
        "pops_per_min": float(errors.pops[:, rows].sum() / minutes) if minutes > 0.0 else math.nan,
        "jerk_ratio": jerk / true_jerk if true_jerk > 0.0 else math.nan,
    }


def where_hands_are(recording, truth):
    """{position: (2, frames) mask}: each hand relative to its true shoulder, in the true chest's frame, in arm lengths (the clip's
    median)."""
    yaw = np.radians(truth.yaw_deg)
    from_shoulder = recording.hand_m - truth.shoulder_m
    right = np.cos(yaw) * from_shoulder[..., 0] - np.sin(yaw) * from_shoulder[..., 2]
    back = np.sin(yaw) * from_shoulder[..., 0] + np.cos(yaw) * from_shoulder[..., 2]
    arm = distance(truth.shoulder_m, truth.elbow_m) + distance(truth.elbow_m, recording.hand_m)
    for clip in np.unique(recording.clip):
        of_clip = recording.clip == clip
        arm[:, of_clip] = np.median(arm[:, of_clip], axis=1, keepdims=True)
    outward, up, back = np.array([[-1.0], [1.0]]) * right / arm, from_shoulder[..., 1] / arm, back / arm
    reach = np.linalg.norm(from_shoulder, axis=-1) / arm
    return {"hanging": up < -0.85, "in front": (back < -0.45) & (np.abs(up) < 0.45), "overhead": up > 0.35, "stretched out": reach > 0.97,
            "behind": (back > 0.12) & (up > -0.9), "crossed": outward < -0.45, "at the shoulder": reach < 0.45}


EVALUATED = (("yaw_deg", "mean"), ("shoulder_cm", "mean"), ("elbow_cm", "mean"), ("swivel_deg", "mean"), ("own_swivel_deg", "mean"), ("pops_per_min", None), ("jerk_ratio", None))


def value_of(figures, name, part):
    return figures[name] if part is None else figures[name][part]


def over_people(errors, people):
    """Dependence of the figures on the recorded persons. people: {name: mask}.

    For each of EVALUATED: mean and deviation over persons with equal weight; the worst person; and with one person left out at a time,
    the lowest and highest pooled figure and the jackknife standard error."""
    alone = {name: figures(errors, rows) for name, rows in people.items()}
    everybody = np.logical_or.reduce(list(people.values()))
    without = {name: figures(errors, everybody & ~rows) for name, rows in people.items()} if len(people) > 1 else {}
    result = {}
    for name, part in EVALUATED:
        own = {person: value_of(each, name, part) for person, each in alone.items() if math.isfinite(value_of(each, name, part))}
        left = [value_of(each, name, part) for each in without.values()]
        worst = max(own, key=own.get, default="-")
        result[name] = {"mean": mean(np.array(list(own.values()))), "deviation": float(np.std(list(own.values()), ddof=1)) if len(own) > 1 else math.nan,
                        "worst": worst, "worst_residual": own.get(worst, math.nan),
                        "least_without_one": min(left, default=math.nan), "most_without_one": max(left, default=math.nan),
                        "error": float(np.std(left) * math.sqrt(len(left) - 1.0)) if len(left) > 1 else math.nan}
    return alone, result
