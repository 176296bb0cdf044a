"""Finds by brute force which fingers can touch. On the palm as shown, each finger closes from fully open in steps of a quarter of a
degree, all joints at their coupled rates, until it is closed. The first touch of a link stops its joint and those before it; the others
continue. A link that starts inside the surface and moves out is not stopped before it was clear; one that moves deeper is stopped at
once.

Steps without effect are skipped: in one step, no point of a link moves farther than the rotation of its joints times the distance to it,
which gives the number of steps that a link with a gap can make freely. A thumb is tested at several oppositions, and reaches if any of
them does."""
import math

import numpy as np
from scipy.spatial.transform import Rotation

from .capsules import clearance
from .grasps import FINGERS

STEP_RAD = math.radians(0.25)
OPPOSITIONS = 5
TOUCH_M = 2e-3
DEEPER_M = 5e-5  # smaller changes are measurement noise
COARSE = {"spacing_m": 8e-3, "tolerance_m": 5e-5, "relative": 0.3}


class Sweep:
    """One finger of many hands at once. Rows are hands, columns are links."""

    def __init__(self, surface, finger, positions, rotations, opposition_rad):
        count = len(positions)
        self.solid, self.sheet = surface, surface.as_sheet()
        self.finger, self.opposition, self.links = finger, opposition_rad, np.arange(finger.links)
        self.positions, self.rotations = positions, rotations
        range_rad = np.abs(finger.upper - finger.lower)
        self.steps = max(1, math.ceil(range_rad.max() / STEP_RAD))
        self.rates = range_rad / self.steps
        self.step = np.zeros(count, int)
        self.stopped_at = np.full((count, finger.links), self.steps)  # the step at which each joint stops
        self.stopped = np.zeros(count, int)  # number of stopped joints, from the first on
        self.due = np.zeros((count, finger.links), int)  # the step at which each link must be measured again
        start = self.gaps(self.solid, *np.nonzero(self.due == 0)).reshape(self.due.shape)
        self.buried = start <= 0.0  # started inside, not clear since
        self.least_m = start  # largest clearance so far of a buried link
        self.plan(*np.nonzero(self.due == 0), start.ravel())

    def gaps(self, surface, hand, link):
        """Current clearances of these links of these hands."""
        finger = self.finger
        at = np.minimum(self.stopped_at[hand], self.step[hand][:, None])
        points = finger.points_hs(finger.lower + (finger.upper - finger.lower) * (at / self.steps), self.opposition)
        if not len(hand):
            return np.zeros(0)
        turns = Rotation.from_quat(self.rotations[hand])
        rows = np.arange(len(hand))
        a, b = (turns.apply(points[rows, link + end]) + self.positions[hand] for end in (0, 1))
        return clearance(surface, a, b, finger.radius[link], **COARSE)

    def motion_m(self, hand, link):
        """Upper bound of a link's motion per step."""
        reach = np.zeros(len(hand))
        for hinge in self.links:
            turns = (hinge >= self.stopped[hand]) & (hinge <= link)
            way = np.array([self.finger.length[hinge:last + 1].sum() for last in self.links])[link]
            reach += np.where(turns, self.rates[hinge] * way, 0.0)
        return np.maximum(reach, 1e-12)

    def plan(self, hand, link, gap):
        """Computes when each link is measured next. A buried link: when it can be clear, but first after one step to see which way it
        moves."""
        safe = np.where(gap > 0, gap * (1.0 - COARSE["relative"]), -gap) - COARSE["tolerance_m"]
        free = np.clip(np.floor(safe / self.motion_m(hand, link)), 1, self.steps + 1).astype(int)
        first = self.buried[hand, link] & (self.step[hand] == 0)
        self.due[hand, link] = self.step[hand] + np.where(first, 1, free)

    def look(self, hand, link):
        """Measures the links that are due; returns which touch."""
        buried = self.buried[hand, link]
        gap = np.empty(len(hand))
        # A link that was clear comes from outside, so the unsigned distance suffices.
        for surface, which in ((self.solid, buried), (self.sheet, ~buried)):
            if which.any():
                gap[which] = self.gaps(surface, hand[which], link[which])
        deeper = gap < self.least_m[hand, link] - DEEPER_M
        touching = (gap <= 0.0) & (~buried | deeper)
        self.least_m[hand, link] = np.maximum(self.least_m[hand, link], gap)
        self.buried[hand, link] = buried & (gap <= 0.0)
        self.plan(hand, link, gap)
        return touching

    def stop(self, hand, link):
        """Stops the joints of touching links and those before."""
        last = np.zeros(len(self.step), int)
        np.maximum.at(last, hand, link + 1)
        now = (self.links < last[:, None]) & (self.links >= self.stopped[:, None])
        self.stopped_at = np.where(now, self.step[:, None], self.stopped_at)
        self.stopped = np.maximum(self.stopped, last)

    def run(self):
        """True if a link touched during closing and the closed finger lies on the surface."""
        while True:
            running = self.links >= self.stopped[:, None]
            following = np.where(running, self.due, self.steps + 1).min(1)
            going = following <= self.steps
            if not going.any():
                break
            self.step[going] = following[going]
            hand, link = np.nonzero(running & going[:, None] & (self.due <= self.step[:, None]))
            touching = self.look(hand, link)
            self.stop(hand[touching], link[touching])
        self.step[:] = self.steps
        touched = np.nonzero(self.stopped > 0)[0]
        hand, link = np.repeat(touched, len(self.links)), np.tile(self.links, len(touched))
        final = self.gaps(self.solid, hand, link).reshape(-1, len(self.links)).min(1)
        result = np.zeros(len(self.positions), bool)
        result[touched] = np.abs(final) < TOUCH_M
        return result


def reached(surface, fingers, positions, rotations):
    """(hands, fingers in FINGERS' order). positions (n, 3) and quaternions (n, 4) of shown wrists."""
    result = np.zeros((len(positions), len(FINGERS)), bool)
    for name, finger in fingers.items():
        low, high = finger.oppositions
        for opposition in np.linspace(low, high, OPPOSITIONS) if name == "thumb" and high > low else (0.0,):
            todo = np.nonzero(~result[:, FINGERS.index(name)])[0]
            if len(todo):
                hit = Sweep(surface, finger, positions[todo], rotations[todo], opposition).run()
                result[todo[hit], FINGERS.index(name)] = True
    return result


def reached_by(surface, fingers, grasps, count):
    """For grasps of a file: (grasps, fingers). Tests `count` of the possible ones, evenly chosen (0: all); the others do not reach."""
    asked = [i for i, grasp in enumerate(grasps) if grasp.gripped and grasp.is_finite() and any(grasp.rotation_xyzw)]
    if count and len(asked) > count:
        asked = [asked[i * len(asked) // count] for i in range(count)]
    result = np.zeros((len(grasps), len(FINGERS)), bool)
    if asked:
        positions, rotations = (np.array([getattr(grasps[i], key) for i in asked]) for key in ("position_m", "rotation_xyzw"))
        result[asked] = reached(surface, fingers, positions, rotations)
    return result
