"""Classes of odd looks and the blind gallery's scores, against cases whose answer is known."""
import csv
import importlib.machinery
import importlib.util
import json
import math
import sys
import tempfile
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tools" / "lab"))
import numpy as np

from grips import style
from grips.grasps import Capsules
from pages import files

OFF, ON = 15.0, 0.5


def flags(gaps, bends, tip=5.0, sync_mm=3.0, sync_deg=5.0, overlap=-3.0, fan=8.0):
    """Classes of one grasp. gaps: thumb to little, palm; bends: thumb to little."""
    found = style.flags(np.array([gaps]), np.array([tip]), np.array([bends], float), np.array([sync_mm]), np.array([sync_deg]),
                        np.array([overlap]), np.array([fan]))
    return {name for name, flag in found.items() if flag[0]}


class Classes(unittest.TestCase):
    even = [40, 90, 95, 100, 95]

    def test_hand_around_a_rail_has_none(self):
        self.assertEqual(flags([ON] * 6, self.even), set())

    def test_finger_off_with_its_neighbours_is_not_astray(self):
        gaps = [ON, OFF, ON, ON, ON, ON]
        self.assertEqual(flags(gaps, self.even), {"finger_off"})
        self.assertEqual(flags(gaps, [40, 45, 95, 100, 95]), {"finger_off", "finger_astray"})

    def test_middle_finger_is_compared_with_the_mean_of_both_neighbours(self):
        gaps = [ON, ON, OFF, ON, ON, ON]
        self.assertNotIn("finger_astray", flags(gaps, [40, 60, 95, 120, 95]))
        self.assertIn("finger_astray", flags(gaps, [40, 60, 45, 120, 95]))

    def test_limits_of_bends(self):
        self.assertEqual(flags([ON] * 6, [40, 20, 121, 100, 95]), {"neighbours_apart"})
        self.assertEqual(flags([ON] * 6, [40, 90, 166, 100, 95]), {"finger_folded"})
        self.assertEqual(flags([ON] * 6, [40, 15, 90, 90, 95]), {"one_straight"})

    def test_thumb_on_its_base(self):
        self.assertEqual(flags([ON] * 6, self.even, tip=25.0), {"thumb_base_only"})
        self.assertEqual(flags([5.0] + [ON] * 5, self.even, tip=25.0), set())

    def test_palms(self):
        self.assertEqual(flags([ON] * 6, self.even, sync_mm=61.0), {"palm_far"})
        self.assertEqual(flags([ON] * 6, self.even, sync_deg=46.0), {"hand_turned"})
        self.assertEqual(flags([ON] * 5 + [-3.1], self.even), {"palm_deep"})

    def test_digits_apart_and_through_each_other(self):
        self.assertEqual(flags([ON] * 6, self.even, overlap=2.1), {"thumb_through"})
        self.assertEqual(flags([ON] * 6, self.even, fan=35.1), {"fanned"})

    def test_touching_fingers_are_counted(self):
        self.assertEqual(flags([ON, 5, 5, 5, 5, ON], self.even), {"none_touches"})
        self.assertEqual(flags([ON, 5, ON, 5, 5, ON], self.even), {"one_touches"})

    def test_missing_fingers_break_no_rule(self):
        gaps = [ON, ON, ON, math.inf, math.inf, ON]
        self.assertEqual(flags(gaps, [40, 90, 95, math.nan, math.nan]), set())


class Digits(unittest.TestCase):
    """Capsules of a hand against closed forms."""

    @staticmethod
    def hand(**parts):
        capsules = Capsules()
        for name, points in parts.items():
            for a, b in zip(points, points[1:]):
                capsules.add(0, {"finger": name, "a_m": list(a), "b_m": list(b), "radius_m": 0.008}, "test")
        capsules.pack()
        return [None], capsules

    def test_distance_of_segments_is_the_least_over_samples(self):
        rng = np.random.default_rng(7)
        a, b, c, d = rng.normal(size=(4, 200, 3))
        b[:20], d[:20] = a[:20] + [1, 0, 0], c[:20] + [2, 0, 0]  # parallel
        share = np.linspace(0.0, 1.0, 101)
        first = a[:, None] + share[:, None] * (b - a)[:, None]
        second = c[:, None] + share[:, None] * (d - c)[:, None]
        sampled = np.linalg.norm(first[:, :, None] - second[:, None], axis=-1).min((1, 2))
        found = style.between_segments(a, b, c, d)
        self.assertTrue((found <= sampled + 1e-9).all())
        self.assertLess((sampled - found).max(), 0.05)

    def test_thumb_across_a_finger(self):
        for height, overlap in ((0.010, 6.0), (0.016, 0.0), (0.020, -4.0)):
            grasps, capsules = self.hand(thumb=[(-0.05, height, -0.03), (0.05, height, -0.03)], index=[(0, 0, 0), (0, 0, -0.04), (0, 0, -0.06)])
            self.assertAlmostEqual(style.thumb_overlaps_mm(grasps, capsules)[0], overlap)

    def test_fan_is_measured_from_knuckle_to_tip(self):
        for degrees in (10.0, 80.0):
            tip = (0.1 * math.sin(math.radians(degrees)), 0.0, -0.1 * math.cos(math.radians(degrees)))
            grasps, capsules = self.hand(index=[(0, 0, 0), (0, 0.03, -0.03), (0, 0, -0.09)], middle=[(0, 0, 0), (0.01, 0.0, 0.0), tip])
            self.assertAlmostEqual(style.fans_deg(grasps, capsules)[0], degrees)

    def test_hand_without_thumb_or_neighbours(self):
        grasps, capsules = self.hand(index=[(0, 0, 0), (0, 0, -0.04)])
        self.assertEqual(style.thumb_overlaps_mm(grasps, capsules)[0], -math.inf)
        self.assertEqual(style.fans_deg(grasps, capsules)[0], 0.0)


class Bounds(unittest.TestCase):
    def test_bounds_of_independent_files_are_those_of_the_normal_distribution(self):
        rng = np.random.default_rng(5)
        drawn = [rng.random(50) < 0.2 for _ in range(60)]
        found = style.bounded(style.mean_of, drawn)
        half = 1.96 * math.sqrt(0.2 * 0.8 / 3000)
        self.assertAlmostEqual(found["high"] - found["low"], 2 * half, delta=0.3 * 2 * half)
        self.assertTrue(found["low"] < found["value"] < found["high"])

    def test_files_that_differ_widen_the_bounds(self):
        same = style.bounded(style.mean_of, [np.array([0, 1] * 20)] * 20)
        split = style.bounded(style.mean_of, [np.full(40, i % 2) for i in range(20)])
        self.assertEqual(same["value"], split["value"])
        self.assertEqual(same["high"] - same["low"], 0.0)
        self.assertGreater(split["high"] - split["low"], 0.3)

    def test_one_file_has_no_bounds(self):
        self.assertTrue(math.isnan(style.bounded(style.mean_of, [np.array([1.0])])["low"]))


def load_gallery():
    loader = importlib.machinery.SourceFileLoader("grip_gallery", str(ROOT / "tools" / "lab" / "grip_gallery"))
    module = importlib.util.module_from_spec(importlib.util.spec_from_loader("grip_gallery", loader))
    loader.exec_module(module)
    return module


class Blind(unittest.TestCase):
    def write(self, folder, orders, answers):
        folder = Path(folder)
        (folder / "key.json").write_text(json.dumps([{"pair": i, "mesh": "m", "id": i, "order": order} for i, order in enumerate(orders)]))
        with open(folder / "answers.csv", "w", newline="") as out:
            csv.writer(out).writerows([["pair", "better", "upper", "lower"], *[[i, *answer] for i, answer in enumerate(answers)]])
        return folder

    def test_answers_are_counted_by_variant_and_not_by_side(self):
        with tempfile.TemporaryDirectory() as folder:
            self.write(folder, [[0, 1], [1, 0], [1, 0]], [["upper", "convincing", "ugly"], ["lower", "ugly", "convincing"],
                                                          ["same", "acceptable", "acceptable"]])
            lines = load_gallery().score(Path(folder))
        self.assertEqual(lines[0], "3 pairs, 1 the same")
        self.assertIn("A: better in 2 of 2", lines[1])
        self.assertIn("convincing 67 %, acceptable 33 %, ugly 0 %", lines[1])
        self.assertIn("B: better in 0 of 2", lines[2])

    def test_unfilled_answers_are_refused_with_the_line(self):
        with tempfile.TemporaryDirectory() as folder:
            self.write(folder, [[0, 1]], [["", "ugly", "ugly"]])
            self.assertRaisesRegex(files.FormatError, "line 2: better: expected one of upper", load_gallery().score, Path(folder))

    def test_wilson_bounds(self):
        low, high = load_gallery().wilson(50, 100)
        self.assertAlmostEqual(low, 0.4038, places=4)  # Wilson 1927, as tabulated
        self.assertAlmostEqual(high, 0.5962, places=4)


if __name__ == "__main__":
    unittest.main()
