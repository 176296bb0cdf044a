"""grip_report's goals and figures, and its errors if nothing can be run."""
import argparse
import importlib.machinery
import importlib.util
import json
import math
import subprocess
import sys
import tempfile
import unittest
import xml.etree.ElementTree as ElementTree
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
SCRIPT = ROOT / "tools" / "lab" / "grip_report"
sys.path.insert(0, str(ROOT / "tools" / "lab"))
from grips import code_size, glb, labels, primitives, report, warm
from pages import files, svg
from pages.goals import limit_goal


class Goals(unittest.TestCase):
    def test_limit_is_met_at_its_value_and_missed_beyond(self):
        self.assertEqual(limit_goal("x", 3.0, 3, "%").verdict(), "met")
        self.assertEqual(limit_goal("x", 3.01, 3, "%").verdict(), "MISSED")
        self.assertEqual(limit_goal("x", 95.0, 95, "%", at_least=True).verdict(), "met")
        self.assertEqual(limit_goal("x", 94.9, 95, "%", at_least=True).verdict(), "MISSED")

    def test_missing_value_gives_not_run(self):
        self.assertEqual(limit_goal("x", math.nan, 3, "%").verdict(), "not run")
        self.assertEqual({goal.verdict() for goal in report.goals(None, None, None, None, None)}, {"not run"})

    def test_each_goal_reads_its_own_figure(self):
        whole = {"deep_share": {"any_finger_or_thumb": 0.04, "any_finger": 0.02, "thumb": 0.016}, "sync_mm_near": {"median": 4.5},
                 "penetration_mm": {"mean_of_fingers": 0.2, "mean_of_deepest": 0.4},
                 "visited_per_disc": {"median": 2, "p95": 9}, "of_reference": {"four": {"touching": 0.96}, "all": {"touching": 0.94}},
                 "not_finite": 0}
        warm_figures = {"moving_us": {"median": 70, "p99": 260, "p99_of_meshes": 240}, "stand_us": {"median": 2.1}, "shown_jumps": 0.002, "jumps": 0.011}
        verdicts = [goal.verdict() for goal in report.goals(whole, None, None, warm_figures, 0.051)]
        self.assertEqual(verdicts[:18] + verdicts[-1:], ["met", "MISSED", "MISSED", "met", "not run", "MISSED", "met", "MISSED", "met", "MISSED", "MISSED",
                                         "met", "MISSED", "met", "MISSED", "MISSED", "MISSED", "met", "MISSED"])


class Labels(unittest.TestCase):
    def test_shares_have_the_bounds_of_a_binomial_and_goals_read_them(self):
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / "labels.csv"
            path.write_text("sheet,row,column,label,reason\n" + 90 * "0,0,0,convincing,\n" + 10 * "0,0,0,ugly,claw\n")
            shares = labels.shares(path)
            path.write_text("sheet,row,column,label,reason\n0,0,0,good,\n")
            self.assertRaisesRegex(files.FormatError, "line 2: label", labels.shares, path)
        self.assertEqual([shares[word]["value"] for word in ("convincing", "acceptable", "ugly")], [0.9, 0.0, 0.1])
        # Wilson's interval of 90 of 100: 82.6 and 94.5 % (Brown, Cai, DasGupta, Interval estimation for a binomial proportion, 2001).
        self.assertAlmostEqual(shares["convincing"]["low"], 0.826, 3)
        self.assertAlmostEqual(shares["convincing"]["high"], 0.945, 3)
        verdicts = {goal.bar: goal.verdict() for goal in report.label_goals({"near": shares})}
        self.assertEqual([verdicts[f"{word}, by people: near"] for word in ("convincing", "ugly")], ["met", "MISSED"])
        self.assertEqual(verdicts["ugly, by people: play"], "not run")


class CodeSize(unittest.TestCase):
    def test_lines_members_and_values_are_counted(self):
        with tempfile.TemporaryDirectory() as folder:
            root = Path(folder)
            self.assertIsNone(code_size.count(root))
            (root / "systems/hand").mkdir(parents=True)
            (root / "components").mkdir()
            (root / "systems/hand/a.cpp").write_text("int a;\n\nint b;\n")
            structs = {"hand.hpp": code_size.STATE, "tuning.hpp": code_size.TUNING}
            for name, each in structs.items():
                (root / "components" / name).write_text("".join(
                    f"struct {one} {{\n    static constexpr int k = 1;\n    int a = 0;  // of b;\n    // c;\n    int d[2] = {{}};\n}};\n" for one in each))
            self.assertEqual(code_size.count(root), {"lines": 3, "state": 6, "tuning": 6})
        goals = report.code_goals({"lines": 5500, "state": 21, "tuning": 14})
        self.assertEqual([goal.verdict() for goal in goals], ["met", "MISSED", "met"])

    def test_the_sources_have_what_is_counted(self):
        found = code_size.count(ROOT)
        self.assertTrue(all(found[name] > 0 for name in ("lines", "state", "tuning")))
        self.assertTrue(all(list(ROOT.glob(pattern)) for pattern in code_size.SOURCES))


class Warm(unittest.TestCase):
    def write(self, folder, **figures):
        path = Path(folder) / "warm.json"
        path.write_text(json.dumps({"moving_us": [], "stand_us": [], "pops_a_disc": [], "joint_frames": 0, "jumps": 0, "shown_jumps": 0, **figures}))
        return path

    def test_percentiles_cover_all_frames_and_shares_all_joints(self):
        with tempfile.TemporaryDirectory() as folder:
            one = warm.read(self.write(folder, moving_us=[10.0] * 300, stand_us=[1.0, 3.0, 3.0], joint_frames=300, jumps=6, shown_jumps=3))
            other = warm.read(self.write(folder, moving_us=[30.0] * 100, joint_frames=100, jumps=2))
            empty = warm.read(self.write(folder))
        figures = warm.figures([[one], [other, empty], [empty]])
        self.assertEqual(figures["moving_us"], {"median": 10.0, "p99": 30.0, "p99_of_meshes": 20.0})
        self.assertEqual((figures["stand_us"]["median"], figures["jumps"], figures["shown_jumps"]), (3.0, 0.02, 0.0075))
        self.assertIsNone(warm.figures([[empty]]))
        self.assertIsNone(warm.figures([]))

    def test_recordings_are_played_where_there_are_any(self):
        with tempfile.TemporaryDirectory() as folder:
            data, lab, out = Path(folder) / "data", Path(folder) / "lab", Path(folder) / "grips.jsonl"
            self.assertFalse(warm.record(lab, data, out))
            for name in ("level/station.glb", "vr_input/b.csv", "vr_input/a.csv"):
                (data / name).parent.mkdir(parents=True, exist_ok=True)
                (data / name).write_text("")
            self.assertRaisesRegex(files.FormatError, "lab: ", warm.record, lab, data, out)
            lab.write_text('#!/bin/sh\necho "$@" > "$5"\n')
            lab.chmod(0o700)
            self.assertTrue(warm.record(lab, data, out))
            words = out.read_text().split()
            self.assertEqual((words[0], [Path(word).name for word in words[-2:]]), ("recorded-grips", ["a.csv", "b.csv"]))
            lab.write_text("#!/bin/sh\necho no level >&2\nexit 2\n")
            self.assertRaisesRegex(files.FormatError, "exit status 2: no level", warm.record, lab, data, out)

    def test_frames_of_recorded_grips_count_by_their_place_in_the_grip(self):
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / "grips.jsonl"
            path.write_text("".join(json.dumps({"us": us}) + "\n" for us in ([900.0], [700.0] + 6 * [300.0] + [20.0, 40.0])))
            found = warm.played(path)
        values = {name: {title: one["value"] for title, one in each.items()} for name, each in found.items()}
        self.assertEqual(values, {"closing_us": {"median": 800.0, "p99": 898.0}, "after_us": {"median": 300.0, "p99": 300.0},
                                  "later_us": {"median": 30.0, "p99": 39.8}})
        self.assertEqual([found["closing_us"]["median"][side] for side in ("low", "high")], [700.0, 900.0])
        self.assertEqual([found["later_us"]["p99"][side] for side in ("low", "high")], [39.8, 39.8])

    def test_invalid_file_is_refused(self):
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / "warm.json"
            for text in ("{", "[]", '{"moving_us": ["x"]}'):
                path.write_text(text)
                self.assertRaisesRegex(files.FormatError, "warm.json: expected", warm.read, path)


class Plots(unittest.TestCase):
    def test_tail_is_the_share_above(self):
        points = dict(svg.share_above([1.0, 2.0, 3.0, 4.0]))
        self.assertEqual(points, {1.0: 0.75, 2.0: 0.5, 3.0: 0.25, 4.0: 0.0})

    def test_drawings_are_well_formed_without_empty_series(self):
        drawing = ElementTree.fromstring(svg.tail_plot("a < b", "mm", {"one": ("#000", [1.0, 5.0]), "none": ("#111", [])}, 10.0, (3.0,)))
        self.assertEqual(len(drawing.findall(".//polyline")), 1)
        drawing = ElementTree.fromstring(svg.bars("a & b", [("x", 1.0), ("y", math.nan)], "%", 3.0))
        self.assertEqual(len(drawing.findall(".//rect")), 2)


def load_script():
    loader = importlib.machinery.SourceFileLoader("grip_report", str(SCRIPT))
    module = importlib.util.module_from_spec(importlib.util.spec_from_loader("grip_report", loader))
    loader.exec_module(module)
    return module


class Placements(unittest.TestCase):
    def test_baselines_close_the_first_of_the_same_hands(self):
        with tempfile.TemporaryDirectory() as folder:
            case = load_script().Case("primitives/box_20", None, argparse.Namespace(count=24, baseline_count=6, seeds="report"), folder)
            drawn = []
            for count in (12, 3):
                case._write_placements("left", count)
                drawn.append((Path(folder) / "P.jsonl").read_text().splitlines())
        self.assertEqual((len(drawn[0]), len(drawn[1])), (12, 3))
        self.assertEqual(drawn[0][:3], drawn[1])


class Refusals(unittest.TestCase):
    def run_case(self, name, said):
        grip_report = load_script()
        with tempfile.TemporaryDirectory() as folder:
            mesh, lab = Path(folder) / "mesh.glb", Path(folder) / "lab"
            glb.write_triangles(mesh, *primitives.make("box", 0.02))
            lab.write_text(f"#!/bin/sh\nprintf '{said}' >&2\nexit 2\n")
            lab.chmod(0o700)
            return grip_report.run_case(name, mesh, argparse.Namespace(lab=lab, count=4, baseline_count=4, reference_count=0, warm_frames=0, seeds="report", variants=["handhold"]))

    def test_broken_mesh_may_be_refused_with_one_line(self):
        result = self.run_case("nasty/nan", "mesh.glb: expected finite positions\\n")
        self.assertEqual((result.failures, result.notes), ([], ["nasty/nan: refused: mesh.glb: expected finite positions"]))

    def test_refusing_a_valid_mesh_or_giving_no_reason_is_a_failure(self):
        self.assertEqual(len(self.run_case("objects/mug", "mesh.glb: expected finite positions\\n").failures), 1)
        self.assertEqual(len(self.run_case("nasty/nan", "").failures), 1)


class Runs(unittest.TestCase):
    def run_report(self, *flags):
        return subprocess.run([sys.executable, "-B", SCRIPT, *flags], capture_output=True, text=True)

    def test_tool_that_cannot_run_gives_no_page(self):
        with tempfile.TemporaryDirectory() as folder:
            run = self.run_report("--lab", f"{folder}/none", "--out", f"{folder}/grip.html", "--only", "primitives/sphere_20")
            self.assertEqual(run.returncode, 2)
            self.assertIn("none", run.stderr.splitlines()[-1])
            self.assertEqual(list(Path(folder).iterdir()), [])

    def test_without_data_only_primitives_remain(self):
        run = self.run_report("--data", "/nowhere", "--list")
        self.assertEqual({line.partition("/")[0] for line in run.stdout.splitlines()}, {"primitives"})

    def test_unknown_variants_and_meshes_print_the_usage(self):
        for flags in (("--variants", "what"), ("--only", "what")):
            run = self.run_report(*flags)
            self.assertEqual((run.returncode, run.stderr.startswith("usage")), (1, True))


if __name__ == "__main__":
    unittest.main()
