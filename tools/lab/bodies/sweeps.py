"""Scripted poses without truth, for what pictures showed and recordings hardly hold."""
import itertools

import numpy as np

from . import estimator, fitting

NECK_M = 0.05  # radius of a neck, for an eye height of 1.6 m


def rotations(axis, angle):
    half = 0.5 * np.asarray(angle)
    return estimator.matrices(np.concatenate([np.sin(half)[:, None] * np.asarray(axis, float), np.cos(half)[:, None]], -1))


def on_a_rail():
    """Both hands beside the head at one height, as on a rail to the left of the player, who looks a little towards it. From frame to frame: how far
    the near hand has overtaken the far one, where both are, the head's yaw, and the sizes of arms and shoulders."""
    overtakes, yaw, middle, height, upper, forearm, width = np.array(list(itertools.product(
        np.linspace(0.0, 0.4, 9), (0.55, 0.65, 0.75), (-0.06, 0.0, 0.06), (-0.06, 0.0, 0.06), (0.9, 1.1), (0.9, 1.1), (0.9, 1.1)))).T
    frames, ones = estimator.Tracked(), np.ones(len(yaw))
    frames.size(estimator.SCALE_EYE_M * ones, 0.30 * upper, 0.28 * forearm, 0.38 * width)
    frames.look, frames.looks = yaw, np.tile(yaw, (len(estimator.LOOK_LAGS_S), 1))
    frames.head, frames.eye_m = rotations([0, 1, 0], yaw), np.outer(ones, [0.0, estimator.SCALE_EYE_M, 0.0])
    frames.hand = np.stack([rotations([0, 0, 1], 0.5 * ones)] * 2)
    at = lambda back_m: frames.eye_m + np.stack([-0.8 * frames.arm_m, height * frames.arm_m, middle * frames.arm_m + back_m], -1)
    frames.hand_m = np.stack([at(-0.5 * overtakes), at(0.5 * overtakes)])
    return frames


def distance_m(a, b, c, d):
    """Of the segments from a to b and from c to d, by points along the first: too large by 2 mm at most."""
    along, least = d - c, np.inf
    for share in np.linspace(0.0, 1.0, 51):
        point = a + share * (b - a)
        foot = np.clip(np.sum(along * (point - c), -1) / np.sum(along * along, -1), 0.0, 1.0)
        least = np.minimum(least, np.linalg.norm(c + foot[:, None] * along - point, axis=-1))
    return least


def neck_clearance_m(frames, yaw, resting, pole, network, fade):
    """By frame, the least distance of both arms from the line between the base of the neck and the eyes."""
    arms = fitting.Arms(frames, yaw, resting, fade, estimator.Circles)
    base, least = 0.5 * (resting[0] + resting[1]), np.inf
    for side, (circles, direction) in enumerate(zip(arms.circles, arms.poles(pole, network))):
        elbow = circles.elbow_m(circles.bend(direction))
        for a, b in ((arms.shoulders_m[side], elbow), (elbow, frames.hand_m[side])):
            least = np.minimum(least, distance_m(a, b, base, frames.eye_m))
    return least
