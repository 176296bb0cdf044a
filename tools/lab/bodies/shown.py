"""Figures of bodies as the game shows them: where shoulders and chest face, how far the neck bends, arms in the trunk, bent wrists."""
import numpy as np

from . import estimator, recordings
from .scoring import mean, wrapped_deg

TRUNK_M = 0.11  # radius of the trunk, for an eye height of estimator.SCALE_EYE_M
WRIST_DEG = 100.0
FOREARM = np.linspace(0.0, 0.75, 4)  # points of the forearm; the rest of it goes with the hand, whose place is given


def yaw_of_line_deg(left, right):
    """Yaw square to the level line from left to right; 0 faces -Z, positive turns left."""
    line = right - left
    return np.degrees(np.arctan2(-line[:, 2], line[:, 0]))


def angle_deg(a, b):
    return np.degrees(np.arctan2(np.linalg.norm(np.cross(a, b), axis=-1), np.sum(a * b, -1)))


class Shown:
    """The columns of OUT.csv that describe the shown body; left first."""

    def __init__(self, path):
        points = [f"shown_{side}{joint}" for joint in ("sh", "el") for side in recordings.SIDES] + ["chest", "waist", "hips"]
        columns = recordings.read_numbers(path, [name + axis for name in points for axis in recordings.XYZ] + ["chestq" + axis for axis in "xyzw"])
        left, right, left_elbow, right_elbow, *trunk = (recordings.vectors(columns, name) for name in points)
        self.shoulder_m, self.elbow_m, self.trunk_m = np.stack([left, right]), np.stack([left_elbow, right_elbow]), trunk
        self.chest = estimator.matrices(recordings.vectors(columns, "chestq", "xyzw"))

    def trunk_distance_m(self, points):
        """Distance from the line from chest to waist to hips."""
        least = np.inf
        for top, bottom in zip(self.trunk_m, self.trunk_m[1:]):
            line = bottom - top
            share = np.clip(np.sum(line * (points - top), -1) / np.maximum(np.sum(line * line, -1), 1e-12), 0.0, 1.0)
            least = np.minimum(least, np.linalg.norm(top + share[:, None] * line - points, axis=-1))
        return least


def acceleration_deg(yaw_deg, recording, counted):
    """Mean length of the second difference, deg/s^2, of the frames whose neighbours are of the same clip."""
    bend = np.full(len(yaw_deg), np.nan)
    inside = (recording.clip[2:] == recording.clip[:-2]) & counted[1:-1]
    bend[1:-1] = np.where(inside, np.abs(wrapped_deg(yaw_deg[2:] - 2.0 * yaw_deg[1:-1] + yaw_deg[:-2])) * recording.hz ** 2, np.nan)
    return mean(bend)


def crossed_hands(recording, truth):
    """Mask of frames with the left hand to the right of the right one, as the true chest faces."""
    return estimator.to_facing(np.radians(truth.yaw_deg), recording.hand_m[1] - recording.hand_m[0])[:, 0] < 0.0


def figures(recording, truth, scored_yaw_deg, shown, scale):
    """{name: (mean error of the yaw or None, its acceleration)} of each facing, and {name: value} of the others. scale: eye heights by row, over SCALE_EYE_M."""
    ahead = -shown.chest[..., 2]
    facings = {"scored facing": scored_yaw_deg, "shown shoulders": yaw_of_line_deg(*shown.shoulder_m), "shown chest": np.degrees(np.arctan2(-ahead[:, 0], -ahead[:, 2]))}
    yaws = {name: (mean(np.abs(wrapped_deg(yaw - truth.yaw_deg))[truth.valid]), acceleration_deg(yaw, recording, truth.valid)) for name, yaw in facings.items()}
    yaws["true chest"] = (None, acceleration_deg(truth.yaw_deg, recording, truth.valid))
    yaws["true shoulders"] = (None, acceleration_deg(yaw_of_line_deg(*truth.shoulder_m), recording, truth.valid))
    percent = lambda mask: 100.0 * float(np.mean(mask[truth.valid]))
    inside = lambda points: shown.trunk_distance_m(points) < TRUNK_M * scale
    elbows, forearms, wrists = np.zeros((3, len(scale)), bool)
    for elbow, hand, xyzw in zip(shown.elbow_m, recording.hand_m, recording.hand_xyzw):
        elbows |= inside(elbow)
        for share in FOREARM:
            forearms |= inside(elbow + share * (hand - elbow))
        wrists |= angle_deg(hand - elbow, -estimator.matrices(xyzw)[..., 2]) > WRIST_DEG
    up = estimator.matrices(recording.head_xyzw)[..., 1]
    crossed = truth.valid & crossed_hands(recording, truth)
    scored_error = np.abs(wrapped_deg(scored_yaw_deg - truth.yaw_deg))
    return yaws, {"yaw with crossed hands, deg": mean(scored_error[crossed]), "crossed hands, % of frames": percent(crossed), "neck bend, deg": mean(angle_deg(up, shown.chest[..., 1])[truth.valid]), "elbows in the trunk, % of frames": percent(elbows),
                  "forearms in the trunk, % of frames": percent(forearms), f"wrists over {WRIST_DEG:.0f} deg, % of frames": percent(wrists)}


def text(yaws, others):
    """Lines for a terminal."""
    lines = [f"{name:16} yaw error {'-' if error is None else f'{error:.2f}':>5} deg, acceleration {acceleration:5.0f} deg/s^2" for name, (error, acceleration) in yaws.items()]
    return lines + [", ".join(f"{name} {value:.1f}" for name, value in others.items())]


def lines(path, recording, truth, clips, scored_yaw_deg):
    """The text for an OUT.csv; nothing if its tool does not write the shown body."""
    if not recordings.has_column(path, "chestqx"):
        return []
    scale = np.array([clips.measures[clip][0] for clip in recording.clip]) / estimator.SCALE_EYE_M
    return ["As the game shows it:"] + text(*figures(recording, truth, scored_yaw_deg, Shown(path), scale))
