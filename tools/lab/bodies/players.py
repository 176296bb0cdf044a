"""Recordings as other players give them: hands that are lost for a while, and people of other sizes whom nobody measured."""
import dataclasses

import numpy as np

from .scoring import mean, wrapped_deg

SETTLED_S = 1.0  # a hand counts as lost when it has been lost for this long
CONVERGED_S = 20.0  # play after which the size of an unmeasured player is scored
LONG_ARM = 1.3  # drawn length over that of the bones
SHOULDER_SHARE, UPPER_SHARE = 0.25, 0.30 / 0.58  # body_proportions.hpp, and the default measures
GAP_S = 1.0 / 30.0  # between two recordings of a session


@dataclasses.dataclass
class Table:
    """Rows of IN.csv, the truth of each row, and the rows that are scored."""

    clip: np.ndarray
    t_s: np.ndarray
    cells: np.ndarray  # (rows, 21): head, left and right wrist
    lost: np.ndarray  # (2, rows)
    scored: np.ndarray  # (2, rows); by arm


def cells_of(recording, size=1.0):
    parts = [size * recording.head_m, recording.head_xyzw]
    for side in (0, 1):
        parts += [size * recording.hand_m[side], recording.hand_xyzw[side]]
    return np.concatenate(parts, 1)


def rows_by_clip(recording):
    return [np.flatnonzero(recording.clip == each) for each in np.unique(recording.clip)]


def with_losses(recording, valid, sides, seed, never=False):
    """The hands in `sides` are lost in each clip for 0.2 to 60 s from a random time on, or all the time."""
    random = np.random.default_rng(seed)
    lost, settled = np.zeros((2, len(valid)), bool), np.zeros((2, len(valid)), bool)
    for rows in rows_by_clip(recording):
        t_s = recording.t_s[rows] - recording.t_s[rows[0]]
        for side in sides:
            from_s = 0.0 if never else random.uniform(0.3, max(0.4, 0.5 * t_s[-1]))
            until_s = np.inf if never else from_s + np.exp(random.uniform(np.log(0.2), np.log(60.0)))
            now = (t_s >= from_s) & (t_s < until_s)
            lost[side, rows] = now
            settled[side, rows] = now & (t_s >= from_s + (0.0 if never else SETTLED_S))
    return Table(recording.clip, recording.t_s, cells_of(recording), lost, settled & valid)


def as_sessions(recording, clips, valid, size):
    """All recordings of a person one after the other, as one session, `size` times as large."""
    t_s, began, number = np.zeros(len(valid)), {}, {}
    clip = np.zeros(len(valid))
    for rows in rows_by_clip(recording):
        person = clips.person[recording.clip[rows[0]]]
        clip[rows] = number.setdefault(person, len(number) + 1)
        start_s = began.get(person, 0.0)
        t_s[rows] = start_s + recording.t_s[rows] - recording.t_s[rows[0]]
        began[person] = t_s[rows[-1]] + GAP_S
    order = np.lexsort((t_s, clip))
    scored = np.tile(valid & (t_s > CONVERGED_S), (2, 1))
    none = np.zeros((2, len(valid)), bool)
    return order, Table(clip, t_s, cells_of(recording, size), none, scored)


def input_text(table, order=None):
    names = "clip,t," + ",".join(f"{device}{part}" for device in ("h", "l", "r") for part in ("x", "y", "z", "qx", "qy", "qz", "qw"))
    lines = [names]
    for row in range(len(table.t_s)) if order is None else order:
        cells = [f"{value:.7g}" for value in table.cells[row]]
        for side in (0, 1):
            if table.lost[side, row]:
                cells[7 * (side + 1):7 * (side + 2)] = ["nan"] * 7
        lines.append(f"{table.clip[row]:.0f},{table.t_s[row]:.6f}," + ",".join(cells))
    return "\n".join(lines) + "\n"


def measures_of_t_pose(sizes):
    """What the runtime makes of the eye height and arm span of a person with these sizes (systems/body/shared/body_proportions.cpp)."""
    eye_height, upper_arm, forearm, width = sizes
    span = 2.0 * (upper_arm + forearm) + width
    arm = 0.5 * (1.0 - SHOULDER_SHARE) * span
    return eye_height, UPPER_SHARE * arm, (1.0 - UPPER_SHARE) * arm, SHOULDER_SHARE * span


def calibration_text(measures):
    """{clip: four measures, or None if nobody measured the person}"""
    lines = ["clip,eye_height,upper_arm,forearm,shoulder_width"]
    lines += [f"{clip:.0f}," + (",,," if sizes is None else ",".join(f"{value:.6g}" for value in sizes)) for clip, sizes in measures.items()]
    return "\n".join(lines) + "\n"


def figures(table, truth, bodies, ratio, size=1.0):
    """Errors of scored rows: chest yaw of rows with a scored arm, elbows and long arms of the scored arms."""
    elbow_cm = 100.0 * np.linalg.norm(bodies.elbow_m - size * truth.elbow_m, axis=-1)
    yaw_deg = np.abs(wrapped_deg(bodies.yaw_deg - truth.yaw_deg))
    return {"yaw": mean(yaw_deg[table.scored.any(0)]), "elbow": mean(elbow_cm[table.scored]),
            "long": 100.0 * float(np.mean(ratio[table.lost] > LONG_ARM)) if table.lost.any() else 0.0,
            "longest": float(ratio[table.lost].max()) if table.lost.any() else float(ratio[table.scored].max())}
