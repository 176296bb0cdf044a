"""Which fingers can touch, by brute force: on the palm as it is shown, each finger closes from fully open in steps of a quarter of a degree, all
hinges at their coupled rates, until it is closed. The first touch of a link stops its hinge and those before it; the others go on. A link that
begins inside the surface and comes out is not stopped until it was clear; one that goes deeper is stopped at once.

Steps that cannot matter are passed over: no point of a link moves farther in a step than its hinges turn times the way to it, so a link with
a gap has as many free steps as its gap holds of these. A thumb is tried at several oppositions, and reaches if one of them does."""
import math

import numpy as np
from scipy.spatial.transform import Rotation

from .capsules import clearance
from .grasps import FINGERS

STEP_RAD = math.radians(0.25)
OPPOSITIONS = 5
TOUCH_M = 2e-3
DEEPER_M = 5e-5  # less is noise of the measurement
COARSE = {"spacing_m": 8e-3, "tolerance_m": 5e-5, "relative": 0.3}


class Sweep:
    """One finger of many hands at once. Rows are hands, columns links."""

    def __init__(self, surface, finger, positions, rotations, opposition_rad):
        count = len(positions)
        self.solid, self.sheet = surface, surface.as_sheet()
        self.finger, self.opposition, self.links = finger, opposition_rad, np.arange(finger.links)
        self.positions, self.rotations = positions, rotations
        range_rad = np.abs(finger.upper - finger.lower)
        self.steps = max(1, math.ceil(range_rad.max() / STEP_RAD))
        self.rates = range_rad / self.steps
        self.step = np.zeros(count, int)
        self.stopped_at = np.full((count, finger.links), self.steps)  # the step that each hinge stops at
        self.stopped = np.zeros(count, int)  # hinges from the first on
        self.due = np.zeros((count, finger.links), int)  # the step that each link must be looked at again
        start = self.gaps(self.solid, *np.nonzero(self.due == 0)).reshape(self.due.shape)
        self.buried = start <= 0.0  # began inside, not clear since
        self.least_m = start  # the best gap so far of a buried link
        self.plan(*np.nonzero(self.due == 0), start.ravel())

    def gaps(self, surface, hand, link):
        """Clearances of these links of these hands, as they stand."""
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
        """How far a link's farthest point moves in a step, at most."""
        reach = np.zeros(len(hand))
        for hinge in self.links:
            turns = (hinge >= self.stopped[hand]) & (hinge <= link)
            way = np.array([self.finger.length[hinge:last + 1].sum() for last in self.links])[link]
            reach += np.where(turns, self.rates[hinge] * way, 0.0)
        return np.maximum(reach, 1e-12)

    def plan(self, hand, link, gap):
        """When each link is looked at again. A buried one: when it can be clear, but after its first step to see where it goes."""
        safe = np.where(gap > 0, gap * (1.0 - COARSE["relative"]), -gap) - COARSE["tolerance_m"]
        free = np.clip(np.floor(safe / self.motion_m(hand, link)), 1, self.steps + 1).astype(int)
        first = self.buried[hand, link] & (self.step[hand] == 0)
        self.due[hand, link] = self.step[hand] + np.where(first, 1, free)

    def look(self, hand, link):
        """Measures links that are due; returns which touch."""
        buried = self.buried[hand, link]
        gap = np.empty(len(hand))
        # A link that was clear comes from outside: only the distance matters.
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
        """Stops the hinges of touching links and those before."""
        last = np.zeros(len(self.step), int)
        np.maximum.at(last, hand, link + 1)
        now = (self.links < last[:, None]) & (self.links >= self.stopped[:, None])
        self.stopped_at = np.where(now, self.step[:, None], self.stopped_at)
        self.stopped = np.maximum(self.stopped, last)

    def run(self):
        """True where a link touched on its way and the finger, at its end, lies on the surface."""
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
        for opposition in np.linspace(low, high, OPPOSITIONS) if high > low else (low,):
            todo = np.nonzero(~result[:, FINGERS.index(name)])[0]
            if len(todo):
                hit = Sweep(surface, finger, positions[todo], rotations[todo], opposition).run()
                result[todo[hit], FINGERS.index(name)] = True
    return result


def reached_by(surface, fingers, grasps, count):
    """For grasps of a file: (grasps, fingers). `count` of them are asked, evenly chosen among those that can be (0: all); none of the others reach."""
    asked = [i for i, grasp in enumerate(grasps) if grasp.gripped and grasp.is_finite() and any(grasp.rotation_xyzw)]
    if count and len(asked) > count:
        asked = [asked[i * len(asked) // count] for i in range(count)]
    result = np.zeros((len(grasps), len(FINGERS)), bool)
    if asked:
        positions, rotations = (np.array([getattr(grasps[i], key) for i in asked]) for key in ("position_m", "rotation_xyzw"))
        result[asked] = reached(surface, fingers, positions, rotations)
    return result
