"""Scripted motions into the poses that estimators of bodies get wrong, with the truth that was scripted.

A person 1.6 m to the eyes moves from a neutral pose into the situation, stays with a little sway, and returns. Points of the arms are in the
chest's axes (x outward for both arms, y up, z back), from the shoulder, in arm lengths."""
import numpy as np

from . import estimator

HZ, SECONDS = 90.0, 4.0
EYE_M, UPPER_M, FOREARM_M, WIDTH_M = 1.6, 0.30, 0.27, 0.36
SHOULDERS_M = np.array([0.0, -0.22, 0.07])  # from the eyes of an upright head


class Situation:
    """hand: wrist of the right arm. pole: where its elbow points. back: where the back of the hand points. left: the same of the left arm, if it
    is not mirrored. head_yaw_deg, head_pitch_deg, eye_m: of the head. sway_m: of the hands."""

    def __init__(self, hand, pole, back, left=None, head_yaw_deg=0.0, head_pitch_deg=0.0, eye_m=EYE_M, sway_m=0.01):
        self.arms = [left or (hand, pole, back), (hand, pole, back)]
        self.head_yaw_deg, self.head_pitch_deg, self.eye_m, self.sway_m = head_yaw_deg, head_pitch_deg, eye_m, sway_m


NEUTRAL = Situation((0.0, -0.45, -0.55), (0.35, -0.8, 0.45), (0.6, 0.75, 0.0))
SITUATIONS = {
    "hands at the shoulders": Situation((0.05, 0.05, -0.22), (0.35, -0.8, -0.5), (0.3, 0.0, -1.0)),
    "hands crossed": Situation((-0.62, -0.25, -0.45), (0.5, -0.8, 0.0), (0.2, 0.5, -0.8)),
    "hands swapped": Situation((-0.75, -0.1, -0.55), (0.5, -0.8, 0.0), (0.1, 0.9, -0.3), left=((-0.75, -0.3, -0.45), (0.5, -0.8, 0.1), (0.1, 0.9, -0.3))),
    "head turned 80 degrees": Situation((0.05, -0.3, -0.7), (0.4, -0.8, 0.3), (0.5, 0.85, 0.0), head_yaw_deg=80.0),
    "hands behind the back": Situation((-0.2, -0.68, 0.3), (0.75, -0.2, 0.6), (0.2, 0.0, 1.0)),
    "arms hanging": Situation((0.12, -0.95, -0.05), (0.35, 0.0, 0.9), (0.95, 0.0, -0.2), sway_m=0.08),
    "overhead": Situation((0.0, 0.8, -0.25), (0.75, -0.2, -0.6), (0.2, 0.3, 0.9)),
    "crouching": Situation((0.1, -0.75, -0.5), (0.5, -0.3, 0.6), (0.7, 0.7, 0.0), head_pitch_deg=-25.0, eye_m=0.95),
}


def turn_about(axis, degrees):
    half = np.radians(np.atleast_1d(degrees)) / 2.0
    return np.concatenate([np.sin(half)[:, None] * np.asarray(axis, float), np.cos(half)[:, None]], -1)


def product(a, b):
    """Quaternions x, y, z, w."""
    vector = a[:, 3:] * b[:, :3] + b[:, 3:] * a[:, :3] + np.cross(a[:, :3], b[:, :3])
    return np.concatenate([vector, a[:, 3:] * b[:, 3:] - np.sum(a[:, :3] * b[:, :3], -1, keepdims=True)], -1)


def quaternions(x, y, z):
    """Rotations whose axes are given, by the largest component."""
    rows = []
    for m in np.stack([x, y, z], -1):
        w = np.sqrt(max(0.0, 1.0 + np.trace(m))) / 2.0
        if w > 0.1:
            rows.append([(m[2, 1] - m[1, 2]) / (4 * w), (m[0, 2] - m[2, 0]) / (4 * w), (m[1, 0] - m[0, 1]) / (4 * w), w])
            continue
        k = int(np.argmax(np.diag(m)))
        i, j = (k + 1) % 3, (k + 2) % 3
        size = np.sqrt(max(1e-12, 1.0 + m[k, k] - m[i, i] - m[j, j])) / 2.0
        row = np.zeros(4)
        row[k], row[i], row[j], row[3] = size, (m[i, k] + m[k, i]) / (4 * size), (m[j, k] + m[k, j]) / (4 * size), (m[j, i] - m[i, j]) / (4 * size)
        rows.append(row)
    return np.array(rows)


def across_unit(vectors, axis):
    return estimator.unit(vectors - np.sum(vectors * axis, -1, keepdims=True) * axis)


def arm(side, situation, share, sway):
    """(shoulder, elbow, wrist, rotation of the hand) relative to the eyes, by frame; share: 0 neutral, 1 in the situation."""
    mirror = np.array([-1.0, 1.0, 1.0]) if side == 0 else np.ones(3)
    hand, pole, back = ((1.0 - share)[:, None] * np.array(a) + share[:, None] * np.array(b) for a, b in zip(NEUTRAL.arms[side], situation.arms[side]))
    hand = (hand * (UPPER_M + FOREARM_M) + sway[:, None] * [0.3, 1.0, 0.5])
    distance = np.linalg.norm(hand, axis=-1, keepdims=True)
    hand = hand * np.minimum(1.0, 0.99 * (UPPER_M + FOREARM_M) / distance)
    distance = np.linalg.norm(hand, axis=-1, keepdims=True)
    axis = hand / distance
    along = np.clip(0.5 * (distance + (UPPER_M ** 2 - FOREARM_M ** 2) / distance), -UPPER_M, UPPER_M)
    elbow = along * axis + np.sqrt(UPPER_M ** 2 - along ** 2) * across_unit(pole, axis)
    fingers = estimator.unit(hand - elbow)
    up = across_unit(back, fingers)
    shoulder = SHOULDERS_M + [0.5 * WIDTH_M, 0.0, 0.0]
    fingers, up = fingers * mirror, up * mirror
    return shoulder * mirror + np.zeros_like(hand), (shoulder + elbow) * mirror, (shoulder + hand) * mirror, quaternions(np.cross(up, -fingers), up, -fingers)


def frames(situation):
    """(inputs (frames, 21), truth (frames, 14)) without clip and time: the columns of IN.csv and, after the first, TRUTH.csv."""
    t = np.arange(int(HZ * SECONDS)) / HZ
    share = estimator.smooth_step(t, 0.5, 1.3) - estimator.smooth_step(t, SECONDS - 1.0, SECONDS - 0.2)
    sway = situation.sway_m * np.sin(2.0 * np.pi * t) * share
    eye = np.stack([0.0 * t, EYE_M + share * (situation.eye_m - EYE_M), 0.0 * t], -1)
    head = product(turn_about([0, 1, 0], share * situation.head_yaw_deg), turn_about([1, 0, 0], share * situation.head_pitch_deg))
    sides = [arm(side, situation, share, sway) for side in (0, 1)]
    hands = [np.concatenate([eye + wrist, rotation], -1) for _, _, wrist, rotation in sides]
    joints = [eye + side[place] for place in (0, 1) for side in sides]
    ones, zeros = np.ones((len(t), 1)), np.zeros((len(t), 1))
    return t, np.concatenate([eye, head, *hands], -1), np.concatenate([ones, zeros, *joints], -1)


def csv(header, rows):
    return "\n".join([header] + [",".join(f"{value:.6f}" for value in row) for row in rows]) + "\n"


def files():
    """{"in": text, "truth": text, "calib": text} of all situations, one clip each."""
    seven = lambda start: ",".join(start + each for each in ("x", "y", "z", "qx", "qy", "qz", "qw"))
    joints = ",".join(side + joint + axis for joint in ("sh", "el") for side in "lr" for axis in "xyz")
    inputs, truths, calib = [], [], []
    for clip, (name, situation) in enumerate(SITUATIONS.items(), 1):
        t, rows, truth = frames(situation)
        inputs += [[clip, now, *row] for now, row in zip(t, rows)]
        truths += [[clip, now, *row] for now, row in zip(t, truth)]
        calib.append(f"{clip},{name},{name},scripted,{EYE_M},{UPPER_M},{FOREARM_M},{WIDTH_M}")
    return {"in": csv("clip,t," + ",".join(map(seven, "hlr")), inputs), "truth": csv("clip,t,valid,chest_yaw_deg," + joints, truths),
            "calib": "\n".join(["clip,name,subject,dataset,eye_height,upper_arm,forearm,shoulder_width", *calib]) + "\n"}
