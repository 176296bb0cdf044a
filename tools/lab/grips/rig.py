"""The hand as written by `handhold-lab grip --rig-json`, and the positions of its links. Hand space is the wrist's: -Z to the fingers,
+Y the back.

Link i starts at joint i and ends at the next; the last one ends at the tip. A joint's frame has -Z along its link; a positive curl
rotates the link towards -Y. The thumb's first frame is rotated by the opposition about an axis of hand space through its first joint."""
import math

import numpy as np
from scipy.spatial.transform import Rotation

from pages.files import FormatError, member, number, numbers, read_json
from .grasps import FINGERS, named, pose


class Finger:
    def __init__(self, value, where):
        self.name = named(member(value, "name", where), FINGERS, f"{where}/name")
        self.links = member(value, "link_count", where)
        if self.links not in (2, 3) or isinstance(self.links, bool):
            raise FormatError(f"{where}/link_count: expected 2 or 3")
        position, rotation = pose(member(value, "base_hs", where), f"{where}/base_hs")
        each = lambda key: np.array(numbers(member(value, key, where)[:self.links], self.links, f"{where}/{key}"))
        self.base, self.length, self.radius = np.array(position), each("length_m"), each("radius_m")
        self.lower, self.upper = each("lower_rad"), each("upper_rad")
        self.axis = np.array(numbers(value.get("opposition_axis_hs", [0, 0, -1]), 3, f"{where}/opposition_axis_hs"))
        self.oppositions = [number(value.get(key, 0.0), f"{where}/{key}") for key in ("lower_opposition_rad", "upper_opposition_rad")]
        parts = [*position, *rotation, *self.length, *self.radius, *self.lower, *self.upper, *self.axis, *self.oppositions]
        if not all(map(math.isfinite, parts)) or not any(rotation):
            raise FormatError(f"{where}: expected finite numbers")
        self.turn = Rotation.from_quat(rotation)

    def points_hs(self, curls, opposition_rad):
        """(n, links + 1, 3): joints and tip. curls: (n, links); opposition_rad: one number or (n,)."""
        count = len(curls)
        if not count:
            return np.zeros((0, self.links + 1, 3))
        turn = Rotation.from_rotvec(np.broadcast_to(opposition_rad, (count,))[:, None] * self.axis) * self.turn
        points = np.empty((count, self.links + 1, 3))
        points[:, 0] = self.base
        for link in range(self.links):
            turn = turn * Rotation.from_rotvec(curls[:, link, None] * (-1.0, 0.0, 0.0))
            points[:, link + 1] = points[:, link] + turn.apply((0.0, 0.0, -self.length[link]))
        return points


def read_rig(path):
    """Fingers by name."""
    value = read_json(path)
    listed = member(value, "fingers", path)
    if not isinstance(listed, list) or not listed:
        raise FormatError(f"{path}: /fingers: expected a list")
    fingers = [Finger(finger, f"{path}: /fingers/{i}") for i, finger in enumerate(listed)]
    if len({finger.name for finger in fingers}) != len(fingers):
        raise FormatError(f"{path}: /fingers: expected each name once")
    return {finger.name: finger for finger in fingers}
