"""body_report's figures against closed forms and another program, and its errors if nothing can be run."""
import json
import os
import stat
import subprocess
import sys
import tempfile
import unittest
import xml.etree.ElementTree as ElementTree
from pathlib import Path

import numpy as np

ROOT = Path(__file__).resolve().parents[2]
SCRIPT = ROOT / "tools" / "lab" / "body_report"
DATA = Path(os.environ.get("HANDHOLD_DATA_DIR") or ROOT.parent / "shared" / "data") / "body_eval"
sys.path.insert(0, str(ROOT / "tools" / "lab"))
from bodies import recordings, report, scoring, shown, stick_figures
from pages import svg

IN = "clip,t," + ",".join(f"h{axis}" for axis in ("x", "y", "z", "qx", "qy", "qz", "qw")) + "".join(
    f",{side}{axis}" for side in "lr" for axis in ("x", "y", "z", "qx", "qy", "qz", "qw"))
OUT = "clip,t,chest_yaw_deg," + ",".join(side + part + axis for part in ("sh", "el") for side in "lr" for axis in "xyz")


class Case:
    """Hanging arms in one or several clips, in memory; tests change what they need."""

    def __init__(self, clip):
        rows = len(clip)
        self.clip, self.t_s, self.hz = np.array(clip, float), np.arange(rows) / 90.0, 90.0
        self.head_m, self.head_xyzw = np.tile([0.0, 1.6, -0.1], (rows, 1)), np.tile([0.0, 0.0, 0.0, 1.0], (rows, 1))
        self.shoulder_m = np.stack([np.tile([side * 0.18, 1.4, 0.0], (rows, 1)) for side in (-1, 1)])
        self.hand_m = self.shoulder_m + [0.0, -0.5, 0.0]
        self.elbow_m = self.shoulder_m + [0.0, -0.25, 0.1]
        self.yaw_deg, self.valid = np.zeros(rows), np.ones(rows, bool)

    def copy(self):
        other = Case(self.clip)
        for name, value in vars(self).items():
            setattr(other, name, np.copy(value))
        return other


def measure(truth, estimate):
    return scoring.Errors(truth, truth, estimate)


def everything(errors):
    return scoring.figures(errors, np.ones(len(errors.clip), bool))


class Scores(unittest.TestCase):
    def test_yaw_error_wraps_to_the_short_angle(self):
        truth, estimate = Case([1] * 4), Case([1] * 4)
        truth.yaw_deg[:], estimate.yaw_deg[:] = 179.0, -179.0
        self.assertAlmostEqual(everything(measure(truth, estimate))["yaw_deg"]["mean"], 2.0)

    def test_distances_are_centimetres_over_both_arms(self):
        truth = Case([1] * 4)
        estimate = truth.copy()
        estimate.elbow_m[0] += [0.03, 0.0, 0.04]
        figures = everything(measure(truth, estimate))
        self.assertAlmostEqual(figures["elbow_cm"]["mean"], 2.5)
        self.assertAlmostEqual(figures["shoulder_cm"]["mean"], 0.0)

    def test_swivel_is_the_angle_about_the_line_from_shoulder_to_hand(self):
        for angle_deg in (0.0, 30.0, 90.0, 170.0):
            truth = Case([1] * 4)
            estimate = truth.copy()
            angle = np.radians(angle_deg)
            estimate.elbow_m = estimate.shoulder_m + [0.1 * np.sin(angle), -0.2, 0.1 * np.cos(angle)]
            self.assertAlmostEqual(everything(measure(truth, estimate))["swivel_deg"]["mean"], angle_deg)

    def test_arm_moved_by_the_smallest_rotation_has_no_swivel(self):
        truth = Case([1])
        tilt = np.radians(20.0)
        # About the hand, in the plane x-y: the axis z is perpendicular to both lines, so this is the smallest rotation.
        turn = np.array([[np.cos(tilt), -np.sin(tilt), 0.0], [np.sin(tilt), np.cos(tilt), 0.0], [0.0, 0.0, 1.0]])
        estimate = truth.copy()
        for side in (0, 1):
            hand = truth.hand_m[side]
            estimate.shoulder_m[side], estimate.elbow_m[side] = (hand + (points[side] - hand) @ turn.T for points in (truth.shoulder_m, truth.elbow_m))
        self.assertAlmostEqual(everything(measure(truth, estimate))["swivel_deg"]["mean"], 0.0, places=5)

    def test_constant_swivel_of_each_source_is_no_error_of_its_own(self):
        truth, estimate = Case([1] * 4 + [2] * 4), Case([1] * 4 + [2] * 4)
        for rows, angle in ((slice(0, 4), 0.3), (slice(4, 8), -0.5)):
            for side, sign in ((0, -1.0), (1, 1.0)):  # mirrored arms
                estimate.elbow_m[side, rows] = truth.shoulder_m[side, rows] + [0.1 * np.sin(sign * angle), -0.25, 0.1 * np.cos(sign * angle)]
        sources = np.array(["a"] * 4 + ["b"] * 4)
        errors = scoring.Errors(truth, truth, estimate, sources)
        self.assertAlmostEqual(everything(errors)["own_swivel_deg"]["mean"], 0.0)
        self.assertAlmostEqual(everything(errors)["swivel_deg"]["mean"], np.degrees(0.4))
        together = scoring.Errors(truth, truth, estimate)
        self.assertAlmostEqual(everything(together)["own_swivel_deg"]["mean"], np.degrees(0.4))

    def test_straight_true_arm_has_no_swivel(self):
        truth = Case([1] * 3)
        truth.elbow_m = truth.shoulder_m + [0.0, -0.25, 0.039]
        self.assertTrue(np.isnan(measure(truth, Case([1] * 3)).swivel_deg).all())

    def test_jerk_of_a_cubic_is_six_times_its_factor(self):
        truth = Case([1] * 12 + [2] * 12)
        estimate = truth.copy()
        truth.elbow_m[:, :, 0] += 2.0 * truth.t_s ** 3
        estimate.elbow_m[:, :, 0] += 3.0 * truth.t_s ** 3
        errors = measure(truth, estimate)
        self.assertAlmostEqual(scoring.mean(errors.true_jerk_mps3), 12.0, places=4)
        self.assertAlmostEqual(everything(errors)["jerk_ratio"], 1.5, places=6)

    def test_clip_change_adds_neither_jerk_nor_pops(self):
        truth = Case([1] * 6 + [2] * 6)
        estimate = truth.copy()
        estimate.elbow_m[:, 6:] += [1.0, 0.0, 0.0]
        errors = measure(truth, estimate)
        self.assertLess(scoring.mean(errors.jerk_mps3), 1e-6)
        self.assertEqual(errors.pops.sum(), 0)

    def test_pop_is_over_5_cm_while_the_true_elbow_moves_under_3(self):
        for way_m, true_way_m, pops in ((0.051, 0.029, 2), (0.049, 0.0, 0), (0.06, 0.031, 0)):
            truth = Case([1] * 5400)  # a minute
            estimate = truth.copy()
            truth.elbow_m[0, 100:] += [true_way_m, 0.0, 0.0]
            estimate.elbow_m[0, 100:] += [way_m, 0.0, 0.0]
            estimate.elbow_m[0, 200:] -= [way_m, 0.0, 0.0]
            truth.elbow_m[0, 200:] -= [true_way_m, 0.0, 0.0]
            self.assertAlmostEqual(everything(measure(truth, estimate))["pops_per_min"], pops)

    def test_invalid_frames_are_excluded(self):
        truth = Case([1] * 8)
        estimate = truth.copy()
        truth.valid[3] = False
        estimate.elbow_m[:, 3] += 5.0
        estimate.yaw_deg[3] = 90.0
        figures = everything(measure(truth, estimate))
        self.assertEqual((figures["elbow_cm"]["p95"], figures["yaw_deg"]["mean"], figures["pops_per_min"]), (0.0, 0.0, 0.0))

    def test_leaving_a_person_out_keeps_the_others(self):
        truth = Case([1] * 30 + [2] * 10)
        estimate = truth.copy()
        estimate.yaw_deg[:30], estimate.yaw_deg[30:] = 4.0, 8.0
        people = {"one": truth.clip == 1, "two": truth.clip == 2}
        alone, spreads = scoring.over_people(measure(truth, estimate), people)
        yaw = spreads["yaw_deg"]
        self.assertAlmostEqual(alone["two"]["yaw_deg"]["mean"], 8.0)
        self.assertAlmostEqual(yaw["mean"], 6.0)
        self.assertAlmostEqual(yaw["deviation"], 8.0 ** 0.5)
        self.assertEqual((yaw["worst"], yaw["worst_residual"]), ("two", 8.0))
        self.assertAlmostEqual(yaw["least_without_one"], 4.0)
        self.assertAlmostEqual(yaw["most_without_one"], 8.0)
        self.assertAlmostEqual(yaw["error"], 2.0)

    def test_hand_positions_are_in_the_chests_frame(self):
        truth = Case([1] * 4)
        truth.yaw_deg[:] = 90.0  # the chest faces -X
        truth.hand_m[1] = truth.shoulder_m[1] + [-0.5, 0.0, 0.0]
        places = scoring.where_hands_are(truth, truth)
        self.assertTrue(places["hanging"][0].all() and places["in front"][1].all())
        self.assertFalse(places["in front"][0].any() or places["crossed"].any() or places["behind"].any())

    @unittest.skipUnless((DATA / "score.py").exists(), "no data")
    def test_figures_agree_with_the_data_sets_scorer(self):
        recording = recordings.Recording(DATA / "in.csv")
        truth = recordings.Bodies(DATA / "truth.csv", recording, is_truth=True)
        rng = np.random.default_rng(3)
        columns = np.concatenate([truth.yaw_deg[:, None], truth.shoulder_m[0], truth.shoulder_m[1], truth.elbow_m[0], truth.elbow_m[1]], 1)
        columns += rng.normal(0.0, 0.01, columns.shape) * np.array([500.0] + [1.0] * 12) + np.where(rng.random(len(columns)) < 1e-3, 0.1, 0.0)[:, None]
        with tempfile.TemporaryDirectory() as folder:
            out = Path(folder) / "out.csv"
            np.savetxt(out, np.column_stack([recording.clip, recording.t_s, columns]), "%.6f", ",", header=OUT, comments="")
            ours = everything(scoring.Errors(recording, truth, recordings.Bodies(out, recording)))
            run = subprocess.run([sys.executable, "-B", DATA / "score.py", DATA / "in.csv", DATA / "truth.csv", out, "--json", "-"],
                                 capture_output=True, text=True, check=True)
        theirs = json.loads(run.stdout)["total"]
        for name in ("yaw_deg", "shoulder_cm", "elbow_cm", "swivel_deg"):
            np.testing.assert_allclose(list(ours[name].values()), theirs[name], rtol=1e-6)
        self.assertGreater(ours["pops_per_min"], 1.0)
        self.assertAlmostEqual(ours["pops_per_min"] / theirs["pops_per_min"], 1.0, places=4)
        self.assertAlmostEqual(ours["jerk_ratio"] / theirs["jerk_ratio"], 1.0, places=6)


class ShownBodies(unittest.TestCase):
    """Four frames of an upright body with hanging arms."""

    def setUp(self):
        self.case = Case([1] * 4)
        self.case.hand_xyzw = np.tile([0.0, 0.0, 0.0, 1.0], (2, 4, 1))
        self.body = shown.Shown.__new__(shown.Shown)
        self.body.shoulder_m, self.body.elbow_m = self.case.shoulder_m, self.case.elbow_m
        self.body.trunk_m = [np.tile(point, (4, 1)) for point in ([0.0, 1.4, 0.0], [0.0, 1.1, 0.0], [0.0, 0.9, 0.0])]
        self.body.chest = np.tile(np.eye(3), (4, 1, 1))

    def figures(self):
        return shown.figures(self.case, self.case, self.case.yaw_deg, self.body, np.ones(4))

    def turn(self, degrees, axis):
        c, s = np.cos(np.radians(degrees)), np.sin(np.radians(degrees))
        return np.array({"x": [[1, 0, 0], [0, c, -s], [0, s, c]], "y": [[c, 0, s], [0, 1, 0], [-s, 0, c]]}[axis])

    def test_turned_shoulders_and_chest_have_their_own_yaw(self):
        turn = self.turn(20.0, "y")
        self.body.shoulder_m = self.case.shoulder_m @ turn.T
        self.body.chest = np.tile(self.turn(-7.0, "y"), (4, 1, 1))
        yaws, _ = self.figures()
        np.testing.assert_allclose([yaws[name][0] for name in ("scored facing", "shown shoulders", "shown chest")], [0.0, 20.0, 7.0], atol=1e-9)

    def test_acceleration_is_the_second_difference(self):
        self.case.yaw_deg = np.array([178.0, 179.0, -179.0, -176.0])  # a second difference of 1 degree
        self.assertAlmostEqual(self.figures()[0]["true chest"][1], 90.0 ** 2)

    def test_neck_bends_by_the_angle_between_head_and_chest(self):
        self.body.chest = np.tile(self.turn(-12.0, "x"), (4, 1, 1))
        self.assertAlmostEqual(self.figures()[1]["neck bend, deg"], 12.0)

    def test_arms_in_the_trunk_and_bent_wrists_are_counted_by_frame(self):
        self.assertEqual([value for name, value in self.figures()[1].items() if "frames" in name], [0.0, 0.0, 0.0, 0.0])
        self.body.elbow_m = self.body.elbow_m.copy()
        self.body.elbow_m[0, 1] = [0.0, 1.2, 0.05]
        self.case.hand_xyzw[1, 2:] = [0.0, np.sin(np.radians(85.0)), 0.0, np.cos(np.radians(85.0))]  # fingers back along the forearm, nearly
        self.body.elbow_m[1, 2:] = self.case.hand_m[1, 2:] + [0.0, 0.0, 0.3]
        values = self.figures()[1]
        self.assertEqual([values["elbows in the trunk, % of frames"], values["wrists over 100 deg, % of frames"]], [25.0, 50.0])
        self.assertGreaterEqual(values["forearms in the trunk, % of frames"], 25.0)


class Drawings(unittest.TestCase):
    def test_each_goal_reads_its_own_figure(self):
        figures = {"yaw_deg": {"mean": 8.5}, "elbow_cm": {"mean": 7.1}, "pops_per_min": 1.6, "jerk_ratio": 1.5}
        limits = {"yaw_deg": 8.5, "elbow_cm": 7.0, "pops_per_min": 1.5, "jerk_ratio": 1.5}
        self.assertEqual([goal.verdict() for goal in report.goals(figures, limits)], ["met", "MISSED", "MISSED", "met"])

    def test_lines_break_at_missing_values(self):
        drawing = svg.lines("a < b", "s", "cm", {"one": ("#000", [(0.0, 1.0), (1.0, 2.0), (2.0, float("nan")), (3.0, 4.0)]), "none": ("#111", [])})
        self.assertEqual(len(ElementTree.fromstring(drawing).findall(".//polyline")), 2)

    def test_moments_have_median_95th_percentile_and_largest_error(self):
        truth = Case([1] * 45)
        estimate = truth.copy()
        off_cm = np.random.default_rng(5).permutation(41).astype(float)
        estimate.elbow_m[0, :41, 0] += 0.02 * off_cm  # one arm: the mean of both is off_cm
        truth.valid[41:] = False
        errors = measure(truth, estimate)
        found = report.moments(errors, np.ones(45, bool))
        self.assertEqual([title for title, _ in found], ["median", "95th percentile", "worst"])
        np.testing.assert_allclose([errors.elbow_cm[:, row].mean() for _, row in found], [20.0, 38.0, 40.0])
        own = np.arange(45) < 11  # one person: the others are excluded
        self.assertEqual([row for _, row in report.moments(errors, own)][2], int(np.argmax(off_cm[:11])))
        self.assertEqual(report.moments(errors, np.arange(45) == 7), [(title, 7) for title in ("median", "95th percentile", "worst")])
        self.assertEqual(report.moments(errors, np.arange(45) > 40), [])  # no truth there

    def test_side_view_shows_the_person_facing_right(self):
        local = stick_figures.about(90.0, np.array([1.0, 1.0, 1.0]), np.array([[0.0, 1.0, 1.0], [1.0, 1.0, 0.0], [1.0, 2.0, 1.0]]))
        np.testing.assert_allclose(local, [[0.0, 0.0, -1.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]], atol=1e-12)  # ahead, right, up
        ahead, right, up = stick_figures.seen(local, "right") - stick_figures.seen(np.zeros(3), "right")
        self.assertTrue(ahead[0] > 0.0 and abs(right[0]) < 1e-9 and up[1] < 0.0)
        self.assertLess((stick_figures.seen(local[1], "front") - stick_figures.seen(np.zeros(3), "front"))[0], 0.0)

    def test_forward_rotates_minus_z(self):
        # a quarter turn left
        np.testing.assert_allclose(stick_figures.forward([0.0, np.sqrt(0.5), 0.0, np.sqrt(0.5)]), [-1.0, 0.0, 0.0], atol=1e-12)


class Runs(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)
        rows = [f"{clip},{frame / 90.0:.6f}" for clip in (1, 2) for frame in range(20)]
        pose, arms = "0,0,0,0,0,0,1", "-.18,1.4,0,.18,1.4,0,-.18,1.1,.1,.18,1.1,"
        bodies = [f"0,{arms}{1e-3 * (frame % 20) ** 3:.4f}" for frame in range(40)]
        self.write("in.csv", [IN] + [f"{row},{pose},{pose},{pose}" for row in rows])
        self.write("calib.csv", ["clip,name,subject,eye_height,upper_arm,forearm,shoulder_width", "1,walk,she,1.6,.3,.3,.36", "2,wave,he,1.6,.3,.3,.36"])
        self.write("truth.csv", [OUT.replace("clip,t,", "clip,t,valid,")] + [f"{row},1,{body}" for row, body in zip(rows, bodies)])
        self.write("exact.csv", [OUT] + [f"{row},{body}" for row, body in zip(rows, bodies)])
        self.lab = self.folder / "lab"
        self.lab.write_text(f'#!/bin/sh\nwhile [ "$1" != --out ]; do shift; done\ncp "{self.folder}/exact.csv" "$2"\n')
        self.lab.chmod(self.lab.stat().st_mode | stat.S_IXUSR)
        self.page = self.folder / "body.html"

    def write(self, name, lines):
        (self.folder / name).write_text("\n".join(lines) + "\n")

    def run_report(self, *flags):
        command = [sys.executable, "-B", SCRIPT, "--lab", self.lab, "--data", self.folder, "--out", self.page, *flags]
        return subprocess.run(command, capture_output=True, text=True)

    def expect_refused(self, said):
        run = self.run_report()
        self.assertEqual((run.returncode, run.stderr.count("\n"), self.page.exists()), (2, 1, False), run.stderr)
        self.assertIn(said, run.stderr)

    def test_perfect_estimate_meets_every_goal_on_a_self_contained_page(self):
        run = self.run_report("--strict")
        self.assertEqual(run.returncode, 0, run.stderr)
        self.assertEqual(run.stdout.count(" met"), 6)
        page = self.page.read_text()
        self.assertEqual((page.count("http"), page.count("src=")), (0, 0))
        self.assertEqual(page.count("from the right</text>"), 6)  # three moments of each person
        self.assertIn("wave", page)

    def test_shown_body_is_printed_if_the_tool_writes_it(self):
        self.assertNotIn("As the game shows it", self.run_report().stdout)
        names = [f"shown_{side}{joint}{axis}" for joint in ("sh", "el") for side in "lr" for axis in "xyz"]
        names += [part + axis for part in ("chest", "waist", "hips") for axis in "xyz"] + ["chestq" + axis for axis in "xyzw"]
        head, *rows = (self.folder / "exact.csv").read_text().splitlines()
        shown_cells = "-.18,1.4,0,.18,1.4,0,-.18,1.1,.1,.18,1.1,.1,0,1.4,0,0,1.1,0,0,.9,0,0,0,0,1"
        self.write("exact.csv", [f"{head},{','.join(names)}"] + [f"{row},{shown_cells}" for row in rows])
        run = self.run_report()
        self.assertEqual(run.returncode, 0, run.stderr)
        self.assertIn("shown shoulders  yaw error  0.00 deg", run.stdout)
        self.assertIn("neck bend, deg 0.0", run.stdout)

    def test_strict_fails_if_a_goal_is_missed(self):
        text = (self.folder / "exact.csv").read_text().replace(",0,-.18,1.4", ",30,-.18,1.4")
        (self.folder / "exact.csv").write_text(text)
        run = self.run_report("--strict")
        self.assertEqual((run.returncode, run.stdout.count("MISSED")), (1, 1), run.stdout)
        self.assertEqual(self.run_report().returncode, 0)

    def test_missing_data_gives_one_error_line_and_no_page(self):
        for name in ("in.csv", "calib.csv", "truth.csv"):
            kept = (self.folder / name).read_bytes()
            (self.folder / name).unlink()
            self.expect_refused(name)
            (self.folder / name).write_bytes(kept)

    def test_broken_files_are_named_with_their_line(self):
        kept = (self.folder / "truth.csv").read_text()
        for bad, said in ((kept.replace("chest_yaw_deg", "yaw"), "line 1: expected a column chest_yaw_deg"),
                          (kept.replace("1,0.100000,1,0,", "1,0.100000,1,east,"), "line 11: expected a finite number in column chest_yaw_deg"),
                          (kept.replace("1,0.100000,1,0,", "1,0.200000,1,0,"), "line 11: expected the clip and time"),
                          (kept.replace("1,0.100000,1,0,", "1,0.100000,1,"), "line 11: expected 16 cells, found 15"),
                          (kept.rpartition("\n2,")[0] + "\n", "expected 40 rows, found 39")):
            (self.folder / "truth.csv").write_text(bad)
            self.expect_refused(f"truth.csv: {said}")

    def test_error_of_a_failing_tool_is_quoted(self):
        self.lab.write_text("#!/bin/sh\necho no arms >&2\nexit 2\n")
        self.expect_refused("exit status 2: no arms")
        self.lab.unlink()
        self.expect_refused("lab: No such file")

    def test_wrong_flags_print_the_usage(self):
        run = self.run_report("--what")
        self.assertEqual((run.returncode, run.stderr.startswith("usage")), (1, True))


if __name__ == "__main__":
    unittest.main()
