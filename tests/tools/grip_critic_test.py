"""The critic's features against closed forms, its fit against labels drawn from a known model, and the sheets of hands to be labelled."""
import csv
import json
import math
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tools" / "lab"))
import numpy as np

from grips import critic, primitives, scoring, sheets
from grips import labels as people
from grips.grasps import FINGERS, read_grasps
from grips.surface import Surface
from pages import files

FLOOR_M = 0.1  # height of a slab of which only the upper face matters
RADIUS_M = 0.008


def slab():
    points, faces = primitives.box((2.0, 2.0 * FLOOR_M, 2.0), 0.1)
    return Surface(points[faces])


def digit_points(x_m, height_m, tip_height_m, turn_deg=0.0):
    """Knuckle and tip of a straight digit 0.1 m long on the ground plan, pointing turn_deg from -Z."""
    turn = math.radians(turn_deg)
    return (x_m, FLOOR_M + height_m, 0.0), (x_m + 0.1 * math.sin(turn), FLOOR_M + tip_height_m, -0.1 * math.cos(turn))


def hand_line(curls_deg, points, surface_height_m=0.0, number=0):
    """A line of G.jsonl: curls and points by digit; the grip surface faces up at a height over the slab."""
    capsules = [{"finger": name, "link": 0, "a_m": a, "b_m": b, "radius_m": RADIUS_M} for name, (a, b) in points.items()]
    return {"id": number, "gripped": True, "reason": "", "wrist": {"position_m": [0, 0, 0], "rotation_xyzw": [0, 0, 0, 1]}, "sync_mm": 1.0, "sync_deg": 1.0,
            "surface": {"triangle": 0, "point_m": [0, FLOOR_M + surface_height_m, 0], "normal": [0, 1, 0]}, "capsules": capsules,
            "fingers": [{"name": name, "curl_rad": [math.radians(angle) for angle in angles]} for name, angles in curls_deg.items()], "us": {}}


def features_of(line):
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "G.jsonl"
        path.write_text(json.dumps(line) + "\n")
        grasps, capsules = read_grasps(path)
    surface = slab()
    row = critic.features(surface, grasps, capsules, scoring.part_gaps_mm(surface, grasps, capsules))[0]
    return dict(zip(critic.FEATURES, row.tolist()))


class Features(unittest.TestCase):
    curls = {"thumb": [10, 20, 20], "index": [40, 40, 20], "middle": [40, 40, 20], "ring": [40, 40, 20], "little": [40, 40, 20]}

    def points(self, gap_m=0.0, **changed):
        points = {name: digit_points(0.02 * i, RADIUS_M + gap_m, RADIUS_M + gap_m) for i, name in enumerate(FINGERS)}
        return {**points, **changed}

    def check(self, line, **expected):
        found = features_of(line)
        for name, value in expected.items():
            self.assertAlmostEqual(found[name], value, delta=0.03, msg=name)

    def test_hand_flat_on_a_slab(self):
        self.check(hand_line(self.curls, self.points()), tip_max=0, fan_max=0, thumb_tip=0, touch_not_tip=0, hyper=0, flex_gap=0, flex_max=100, thumb_mis_air=0,
                   nb_mcp_max=0, wrap_n=0, thumb_bend=0)

    def test_tips_in_the_air(self):
        points = self.points(ring=digit_points(0.06, RADIUS_M, RADIUS_M + 0.030), thumb=digit_points(0.0, RADIUS_M, RADIUS_M + 0.012))
        self.check(hand_line(self.curls, points), tip_max=30, thumb_tip=12, touch_not_tip=1)
        self.check(hand_line(self.curls, self.points(little=digit_points(0.08, 0.2, 0.2))), tip_max=50)

    def test_angles(self):
        curls = {**self.curls, "thumb": [0, 5, 50], "index": [10, 80, 20], "ring": [70, 90, 60]}
        # hyper: index 48 - 10 - 20; the others are below 0
        self.check(hand_line(curls, self.points()), hyper=18, flex_max=220, nb_mcp_max=30, thumb_bend=15)

    def test_straight_fingers_off_the_surface(self):
        curls = {**self.curls, "index": [10, 10, 10], "middle": [0, 0, 0]}
        # gaps of 5 mm: index with half the weight, middle with all of it
        self.check(hand_line(curls, self.points(gap_m=0.005)), flex_gap=(2.5 + 5.0) / 4)

    def test_straight_thumb_in_the_air_beside_bent_fingers(self):
        curls = {**self.curls, "thumb": [0, 0, 0]}
        points = self.points(thumb=digit_points(0.0, RADIUS_M, RADIUS_M + 0.009))
        self.check(hand_line(curls, points), thumb_mis_air=0.35 * 100 * 0.5)

    def test_tips_beyond_the_grip_surface(self):
        # The grip surface is 20 mm over the slab, the tips' ends RADIUS_M over it: 12 mm below.
        self.check(hand_line(self.curls, self.points(), surface_height_m=0.020), wrap_n=4)
        self.check(hand_line(self.curls, self.points(), surface_height_m=0.015), wrap_n=0)

    def test_hand_with_two_fingers_and_two_hinges(self):
        points = {name: self.points()[name] for name in ("index", "middle")}
        self.check(hand_line({"index": [40, 40], "middle": [30, 40]}, points), tip_max=0, thumb_tip=0, thumb_bend=0, thumb_mis_air=0, nb_mcp_max=10, flex_max=80)

    def test_fan(self):
        self.check(hand_line(self.curls, self.points(index=digit_points(0.02, RADIUS_M, RADIUS_M, 25.0))), fan_max=25)


def draw_labels(count, seed, weight=None):
    """Features, labels drawn from a known critic, and that critic."""
    rng = np.random.default_rng(seed)
    size = len(critic.FEATURES)
    truth = critic.Critic(np.zeros(size), np.ones(size), rng.normal(0.0, 1.0, size) if weight is None else weight, (-3.0, 0.2))
    values = rng.normal(0.0, 1.0, (count, size))
    edges = truth.shares(values).cumsum(1)
    return values, (rng.uniform(size=count)[:, None] > edges).sum(1).clip(0, 2), truth


class Fit(unittest.TestCase):
    def test_fit_finds_the_model_that_drew_the_labels(self):
        for seed in (1, 2, 3):
            values, labels, truth = draw_labels(20000, seed)
            fitted = critic.fit(values, labels)
            unseen = draw_labels(2000, seed + 10)[0]
            # 13 parameters from 20000 rows: an error of about sqrt(13 / 20000 * 0.25) = 0.013 (root mean square)
            self.assertLess(np.abs(fitted.shares(unseen) - truth.shares(unseen)).mean(), 0.015)

    def test_shares_are_those_of_the_formula(self):
        size = len(critic.FEATURES)
        weight = np.zeros(size)
        weight[0] = -2.0
        model = critic.Critic(np.full(size, 10.0), np.full(size, 5.0), weight, (-1.0, 1.0))
        row = np.full((1, size), 15.0)  # z = 1, e = -2
        logistic = lambda x: 1.0 / (1.0 + math.exp(-x))
        np.testing.assert_allclose(model.shares(row)[0], [1 - logistic(-1), logistic(-1) - logistic(-3), logistic(-3)])
        np.testing.assert_allclose(model.shares(np.full((1, size), 1e6)), model.shares(np.full((1, size), 25.0)))  # z is limited to 3

    def test_labels_without_relation_are_not_predicted(self):
        rng = np.random.default_rng(4)
        values, labels = rng.normal(size=(600, len(critic.FEATURES))), rng.integers(0, 3, 600)
        shares = critic.held_out_shares(values, labels, np.arange(600) % 20)
        self.assertAlmostEqual(critic.area_under_curve(shares[:, 2], labels == 2), 0.5, delta=0.08)

    def test_held_out_rows_are_predicted_without_their_group(self):
        # Within each group the labels depend on a feature that has another sign in the other groups.
        rng = np.random.default_rng(5)
        values = rng.normal(size=(400, len(critic.FEATURES)))
        groups = np.arange(400) % 2
        labels = (np.where(groups == 0, 1, -1) * values[:, 0] > 0) * 2
        labels[:40] = 1
        shares = critic.held_out_shares(values, labels, groups)
        self.assertLess(critic.area_under_curve(shares[:, 2], labels == 2), 0.2)

    def test_area_under_the_curve(self):
        flags = np.array([True, True, False, False])
        self.assertEqual(critic.area_under_curve(np.array([3.0, 1.0, 2.0, 1.0]), flags), (1 + 1 + 0 + 0.5) / 4)

    def test_command_writes_a_model_that_reads_back(self):
        values, labels, _ = draw_labels(300, 6)
        with tempfile.TemporaryDirectory() as folder:
            path, out = Path(folder) / "labels.csv", Path(folder) / "critic.json"
            with open(path, "w", newline="") as file:
                csv.writer(file).writerows([["label", "reason", "group", *critic.FEATURES], *([label, "", f"m{i % 9}", *row] for i, (label, row) in enumerate(zip(labels, values)))])
            run = subprocess.run([str(ROOT / "tools/lab/grip_critic"), str(path), "--out", str(out), "--test", str(path)], capture_output=True, text=True)
            self.assertEqual((run.returncode, run.stderr), (0, ""))
            self.assertIn("held out by mesh: 300 hands", run.stdout)
            shares = critic.fit(values, labels).shares(values)
            np.testing.assert_allclose(critic.read_critic(out).shares(values), shares, atol=1e-4)

    def test_bad_labels_are_refused_with_the_line(self):
        values, labels, _ = draw_labels(30, 7)
        rows = [[label, "m", *row] for label, row in zip(labels.tolist(), values.tolist())]
        for change, said in (((3, 0, 5), "line 5: label"), ((4, 4, "x"), "line 6: expected a number"), ((4, 4, "nan"), "line 6: expected finite")):
            bad = [list(row) for row in rows]
            bad[change[0]][change[1]] = change[2]
            with tempfile.TemporaryDirectory() as folder:
                path = Path(folder) / "labels.csv"
                with open(path, "w", newline="") as file:
                    csv.writer(file).writerows([["label", "group", *critic.FEATURES], *bad])
                self.assertRaisesRegex(files.FormatError, said, critic.read_labels, path)


class Sheets(unittest.TestCase):
    variants = [{"a": range(10), "b": range(5)}, {"a": range(10), "c": range(7)}]

    def test_each_variant_has_its_count_and_each_sheet_one_mesh(self):
        key = sheets.choose(self.variants, 8, 1)
        for variant in (0, 1):
            own = [(one["mesh"], one["id"]) for one in key if one["variant"] == variant]
            self.assertEqual((len(own), len(set(own))), (8, 8))
            self.assertTrue(all(number in self.variants[variant][mesh] for mesh, number in own))
        places = {(one["sheet"], one["row"], one["column"]) for one in key}
        self.assertEqual(len(places), len(key))
        for entries in sheets.sheets_of(key).values():
            self.assertEqual(len({one["mesh"] for one in entries}), 1)
            self.assertLessEqual(len(entries), sheets.HANDS)

    def test_places_do_not_tell_the_variant(self):
        first = np.zeros(2)
        for seed in range(200):
            for one in sheets.choose([{"a": range(30)}, {"a": range(30)}], 12, seed):
                if (one["row"], one["column"]) == (0, 0):
                    first[one["variant"]] += 1
        # Binomial with share 1/2: beyond four standard deviations with probability below 1e-4.
        self.assertLess(abs(first[0] - first[1]), 4 * math.sqrt(first.sum()))

    def test_labels_are_read_by_place_and_missing_ones_refused(self):
        key = sheets.choose(self.variants, 3, 2)
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / "labels.csv"
            path.write_text(sheets.form(key))
            self.assertRaisesRegex(files.FormatError, "line 2: label: expected one of ugly", sheets.read_labels, path, key)
            lines = sheets.form(key).replace(",,", ",convincing,").splitlines()
            lines[1:] = lines[:0:-1]
            lines[1] = lines[1].replace("convincing", "ugly")
            path.write_text("\n".join(lines) + "\n")
            self.assertEqual([label for label, _ in sheets.read_labels(path, key)], ["convincing"] * (len(key) - 1) + ["ugly"])
            path.write_text("\n".join(lines[:-1]) + "\n")
            self.assertRaisesRegex(files.FormatError, "expected a row of sheet", sheets.read_labels, path, key)

    def test_labels_become_rows_for_the_critic_without_hidden_hands(self):
        key = [{"mesh": "a", "variant": 0, "id": i} for i in range(4)]
        values = np.arange(4.0 * len(critic.FEATURES)).reshape(4, -1)
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / "labels.csv"
            path.write_text(sheets.labels_csv([("ugly", "a, \"quoted\" one"), ("acceptable", ""), ("convincing", ""), ("hidden", "")], key, values))
            read, labels, groups = critic.read_labels(path)
        np.testing.assert_array_equal(read, values[:3])
        self.assertEqual((labels.tolist(), groups.tolist()), ([0, 1, 2], ["a"] * 3))

    def test_shares_leave_out_hidden_hands(self):
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / "labels.csv"
            path.write_text("label\nhidden\nugly\nconvincing\nhidden\n")
            shares = people.shares(path)
        self.assertEqual([shares[word]["value"] for word in critic.LABELS], [0.5, 0.0, 0.5])


if __name__ == "__main__":
    unittest.main()
