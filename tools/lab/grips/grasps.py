"""G.jsonl and P.jsonl as arrays (fields: docs/reference/lab.md). Lines are checked; numbers that are not finite are kept, because they
are a result."""
import math

import numpy as np

from pages.files import FormatError, member, number, numbers, read_jsonl

FINGERS = ("thumb", "index", "middle", "ring", "little")
FALLBACKS = ("none", "bvh", "open", "relaxed")


def pose(value, where):
    """Position and rotation (x y z w)."""
    return (numbers(member(value, "position_m", where), 3, f"{where}: position_m"),
            numbers(member(value, "rotation_xyzw", where), 4, f"{where}: rotation_xyzw"))


def named(value, names, where):
    if value not in names:
        raise FormatError(f"{where}: expected one of {', '.join(names)}")
    return value


class Capsules:
    """All grasps' capsules, one row each."""

    def __init__(self):
        self.grasp, self.part, self.a, self.b, self.radius = [], [], [], [], []

    def add(self, grasp, value, where):
        self.grasp.append(grasp)
        self.part.append(named(member(value, "finger", where), FINGERS + ("palm",), f"{where}: finger"))
        self.a.append(numbers(member(value, "a_m", where), 3, f"{where}: a_m"))
        self.b.append(numbers(member(value, "b_m", where), 3, f"{where}: b_m"))
        self.radius.append(number(member(value, "radius_m", where), f"{where}: radius_m"))

    def pack(self):
        self.grasp, self.part = np.array(self.grasp, int), np.array(self.part, str)
        self.a, self.b = np.array(self.a, float).reshape(-1, 3), np.array(self.b, float).reshape(-1, 3)
        self.radius = np.array(self.radius, float)


class Grasp:
    def __init__(self, value, where):
        self.id = member(value, "id", where)
        if isinstance(self.id, bool) or not isinstance(self.id, (int, str)):
            raise FormatError(f"{where}: id: expected a whole number")
        self.gripped = member(value, "gripped", where)
        if not isinstance(self.gripped, bool):
            raise FormatError(f"{where}: gripped: expected true or false")
        self.reason = str(value.get("reason") or "")
        self.position_m, self.rotation_xyzw = pose(member(value, "wrist", where), f"{where}: wrist")
        # Of the grip surface, which a palm's limits refer to; zero vectors if the hand grips nothing or the file does not tell.
        self.point_m, self.normal = self._surface(value.get("surface"), f"{where}: surface")
        self.sync_mm = number(value.get("sync_mm"), f"{where}: sync_mm")
        self.sync_deg = number(value.get("sync_deg"), f"{where}: sync_deg")
        self.fingers = [self._finger(finger, f"{where}: fingers: {i}") for i, finger in enumerate(value.get("fingers") or ())]
        self.us = {key: number(spent, f"{where}: us: {key}") for key, spent in (value.get("us") or {}).items()}

    @staticmethod
    def _surface(value, where):
        if value is None:
            return (0.0, 0.0, 0.0), (0.0, 0.0, 0.0)
        return tuple(tuple(numbers(member(value, key, where), 3, f"{where}: {key}")) for key in ("point_m", "normal"))

    @staticmethod
    def _finger(value, where):
        return {"name": named(member(value, "name", where), FINGERS, f"{where}: name"),
                "discs": number(value.get("discs"), f"{where}: discs"), "visited": number(value.get("visited"), f"{where}: visited"),
                "walked": number(value.get("walked"), f"{where}: walked"), "fallback": str(value.get("fallback", "none")),
                "curl_rad": [number(curl, f"{where}: curl_rad") for curl in value.get("curl_rad") or ()]}

    def is_finite(self):
        wrist = self.position_m + self.rotation_xyzw
        return all(math.isfinite(part) for part in wrist) and (not self.gripped or math.isfinite(self.sync_mm))


def read_grasps(path):
    """Grasps and their capsules; ids are unique."""
    grasps, capsules, seen = [], Capsules(), set()
    for where, value in read_jsonl(path):
        grasp = Grasp(value, where)
        if grasp.id in seen:
            raise FormatError(f"{where}: id {grasp.id} occurs twice")
        seen.add(grasp.id)
        listed = member(value, "capsules", where)
        if not isinstance(listed, list) or (grasp.gripped and not listed):
            raise FormatError(f"{where}: capsules: expected the posed hand")
        for i, capsule in enumerate(listed):
            capsules.add(len(grasps), capsule, f"{where}: capsules: {i}")
        grasps.append(grasp)
    if not grasps:
        raise FormatError(f"{path}: expected at least one grasp")
    capsules.pack()
    return grasps, capsules


def read_kinds(path):
    """{id: kind} of placements; kind '' if not given."""
    kinds = {}
    for where, value in read_jsonl(path):
        pose(member(value, "wrist", where), f"{where}: wrist")
        kinds[member(value, "id", where)] = str(value.get("kind", ""))
    return kinds
