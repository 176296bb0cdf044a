"""fit_body's parts: gradients against differences, mirrored inputs, the choice by person, the written header, that two runs agree, and that the
runtime estimates what was fitted. HANDHOLD_LAB: the handhold-lab to compare with; without it that test is skipped."""
import os
import re
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

import numpy as np

ROOT = Path(__file__).resolve().parents[2]
SCRIPT = ROOT / "tools" / "lab" / "fit_body"
sys.path.insert(0, str(ROOT / "tools" / "lab"))
from bodies import choosing, constants, direct, estimator, fades, fitting, mixing, network, recordings, scoring, situations, sweeps

SIDES = "lr"


def random_rotations(random, count):
    return estimator.unit(random.standard_normal((count, 4)))


class Motion(estimator.Motion):
    """Random heads and hands about an upright body; the truth is random too."""

    def __init__(self, random, count):
        self.head, self.look = estimator.matrices(random_rotations(random, count)), random.uniform(-3.0, 3.0, count)
        self.looks = self.look + random.uniform(-0.3, 0.3, (3, count))
        self.eye_m, self.hand_m = random.uniform(-0.1, 0.1, (count, 3)), random.uniform(-0.5, 0.5, (2, count, 3))
        self.hand = np.stack([estimator.matrices(random_rotations(random, count)) for _ in SIDES])
        self.yaw, self.shoulder_m = random.uniform(-1.0, 1.0, count), random.uniform(-0.3, 0.3, (2, count, 3))
        self.elbow_m = random.uniform(-0.4, 0.4, (2, count, 3))
        self.scale, self.upper_m, self.forearm_m = np.ones(count), np.full(count, 0.3), np.full(count, 0.27)
        self.width_m, self.arm_m = np.full(count, 0.36), np.full(count, 0.57)
        self.person, self.source = np.arange(count) % 3, np.arange(count) % 2

    def mirrored(self):
        other, mirror = Motion(np.random.default_rng(0), len(self.yaw)), np.diag(estimator.MIRROR)
        vars(other).update(vars(self))
        other.head = mirror @ self.head @ mirror
        other.hand = (mirror @ self.hand @ mirror)[::-1]
        for name in ("look", "looks", "yaw"):
            setattr(other, name, -getattr(self, name))
        other.eye_m = self.eye_m * estimator.MIRROR
        for name in ("hand_m", "shoulder_m", "elbow_m"):
            setattr(other, name, (getattr(self, name) * estimator.MIRROR)[::-1])
        return other


class Inputs(unittest.TestCase):
    def test_left_inputs_are_those_of_the_mirrored_right(self):
        motion = Motion(np.random.default_rng(1), 50)
        mirrored, yaw = motion.mirrored(), np.linspace(-3.0, 3.0, 50)
        np.testing.assert_allclose(estimator.chest_inputs(motion, yaw, 0), estimator.chest_inputs(mirrored, -yaw, 1), atol=1e-6)
        left = estimator.elbow_inputs(motion, yaw, motion.shoulder_m, 0)
        np.testing.assert_allclose(left, estimator.elbow_inputs(mirrored, -yaw, mirrored.shoulder_m, 1), atol=1e-6)

    def test_talked_chest_of_the_mirrored_body_is_mirrored(self):
        motion = Motion(np.random.default_rng(2), 50)
        yaw = estimator.talked_facing(motion, estimator.CHEST_START)[0]
        np.testing.assert_allclose(estimator.talked_facing(motion.mirrored(), estimator.CHEST_START)[0], -yaw, atol=1e-12)

    def test_right_targets_give_the_true_chest(self):
        motion = Motion(np.random.default_rng(3), 40)
        motion.looks[0] = motion.yaw  # the correction is small
        chest = fitting.Chest(motion, estimator.CHEST_START)
        yaw = chest.talked + chest.targets()[:, 0]
        np.testing.assert_allclose(estimator.wrapped(yaw - motion.yaw), 0.0, atol=1e-12)


    def test_mixed_arms_keep_their_shape_and_turn_with_the_chest(self):
        motion = Motion(np.random.default_rng(8), 200)
        mixed = mixing.mixed(motion, 3)
        self.assertEqual(len(mixed.yaw), int((1.0 + mixing.MIXED + mixing.CROSSED) * 200))
        for name in ("yaw", "eye_m", "shoulder_m", "hand_m", "elbow_m", "hand"):
            kept = getattr(mixed, name)
            np.testing.assert_array_equal(kept[..., :200] if kept.ndim == 1 else kept[:200] if len(kept) != 2 else kept[:, :200], getattr(motion, name))
        bones = lambda each: scoring.distance(each.shoulder_m, each.elbow_m)
        self.assertTrue(np.all(np.abs(bones(mixed)[:, 200:, None] - bones(motion)[:, None]).min(-1) < 1e-9))
        self.assertTrue(mixing.crossed(mixed)[200 + int(mixing.MIXED * 200):].mean() > 0.5)

    def test_arms_of_the_own_frame_change_nothing(self):
        motion = Motion(np.random.default_rng(9), 50)
        own = mixing.with_arms_of(motion, motion)
        for name in ("hand_m", "elbow_m", "hand"):
            np.testing.assert_allclose(getattr(own, name), getattr(motion, name), atol=1e-12)


class Gradients(unittest.TestCase):
    def test_pole_gradient_is_the_slope_of_its_loss(self):
        random = np.random.default_rng(4)
        pole, axis = random.standard_normal((6, 3)), estimator.unit(random.standard_normal((6, 3)))
        first = estimator.unit(np.cross(axis, [0.3, 1.0, 0.2]))
        second, wanted = np.cross(axis, first), estimator.unit(random.standard_normal((6, 2)))

        def loss(pole):
            x, y = np.sum(pole * first, -1), np.sum(pole * second, -1)
            length = np.sqrt(x * x + y * y)
            cosine = (x * wanted[:, 0] + y * wanted[:, 1]) / length
            return np.sum(np.sqrt(2.0 * (1.0 - cosine) + 0.02)) / 6.0 + 0.01 * np.sum((length - 0.5) ** 2) / 6.0

        slope = fitting.pole_gradient(np.sum(pole * first, -1), np.sum(pole * second, -1), wanted, np.full(6, 1.0 / 6.0), first, second)
        for place in np.ndindex(pole.shape):
            change = np.zeros_like(pole)
            change[place] = 1e-5
            self.assertAlmostEqual(slope[place], (loss(pole + change) - loss(pole - change)) / 2e-5, delta=2e-3)

    def test_turn_gradient_is_the_slope_of_its_loss(self):
        random = np.random.default_rng(10)
        outputs, wanted = 0.4 * random.standard_normal((6, 2)), estimator.unit(random.standard_normal((6, 2)))

        def loss(outputs):
            facing = outputs + [0.0, 1.0]
            length = np.linalg.norm(facing, axis=-1)
            return np.sum(np.sqrt(2.0 * (1.0 - np.sum(facing * wanted, -1) / length) + 0.01) + 0.01 * (length - 1.0) ** 2)

        slope = direct.turn_gradient(outputs, wanted, np.ones((6, 1)))
        for place in np.ndindex(outputs.shape):
            change = np.zeros_like(outputs)
            change[place] = 1e-6
            self.assertAlmostEqual(slope[place], (loss(outputs + change) - loss(outputs - change)) / 2e-6, delta=1e-4)

    def test_network_learns_a_function_of_its_inputs(self):
        random = np.random.default_rng(5)
        x = random.standard_normal((4000, 3)).astype(np.float32)
        wanted = (x[:, :1] * x[:, 1:2] * 0.5).astype(np.float32)
        net = network.Network(x, 16, (1.0,), random)
        error = lambda: np.mean((net.outputs(x) - wanted) ** 2)
        before = error()
        for rows, rate, _ in network.epochs(40, len(x), 200, 1e-2, random):
            net.learn((net.forward(net.scaled(x[rows])) - wanted[rows]) / len(rows), rate, 0.0)
        self.assertLess(error(), 0.1 * before)

    def test_offsets_of_sources_are_found_and_have_no_mean(self):
        source = np.array(["a"] * 300 + ["b"] * 100)
        residual = np.where(source == "a", 0.1, -0.3)
        offsets = fitting.SourceOffsets(source)
        offsets.update(residual, np.ones(400))
        np.testing.assert_allclose(offsets.angle, [0.1, -0.3])
        self.assertAlmostEqual(np.mean(offsets.rows()), 0.0)


class Choice(unittest.TestCase):
    def test_each_person_counts_equally(self):
        person = np.array([1] * 90 + [2] * 10)
        many, few = np.where(person == 1, 1.0, 3.0), np.where(person == 1, 1.1, 2.0)  # better for the many frames, for the one person
        each = [choosing.Candidate(name, 10, None, {"x": (errors, 1.0)}, person) for name, errors in (("many", many), ("few", few))]
        self.assertEqual(choosing.choose(each).name, "few")

    def test_bounds_are_those_without_one_person(self):
        mean, low, high = choosing.without_one(np.array([1.0, 2.0, 6.0]), np.array(["a", "b", "c"]))
        self.assertEqual((mean, low, high), (3.0, 1.5, 4.0))


    def test_of_equals_the_smallest_is_chosen(self):
        person = np.array([1, 2])
        each = [choosing.Candidate(name, count, None, {"x": (np.full(2, error), 1.0)}, person)
                for name, count, error in (("best", 30, 1.0), ("small", 10, 1.0005), ("worse", 5, 1.1))]
        self.assertEqual(choosing.choose(each).name, "small")
        self.assertEqual(choosing.choose(each, 0.0).name, "best")

    def test_of_equal_errors_the_least_trust_is_chosen(self):
        self.assertEqual(fades.cautious([1.0, 1.0005, 1.02], [0.9, 0.5, 0.1], 1.001), 1)

    def test_trunk_view_is_fitted_by_the_frames_that_look_up(self):
        motion = Motion(np.random.default_rng(7), 400)
        right = {**estimator.CHEST_START, "nod_rad": 0.2, "ears_behind_m": 0.12}
        lean = estimator.talked_facing(motion, right)[1]
        resting = estimator.resting_shoulders(motion, right, motion.yaw, lean, np.zeros((400, 4)))
        motion.shoulder_m = estimator.shoulders_of(motion, motion.yaw, resting)
        fitted = fitting.fit_trunk_view(motion, {**estimator.CHEST_START, "nod_rad": 0.6})
        self.assertAlmostEqual(fitted["nod_rad"], 0.2, delta=0.05)
        self.assertAlmostEqual(fitted["ears_behind_m"], 0.12, delta=0.01)


class Sweep(unittest.TestCase):
    def test_distance_of_segments_is_that_of_their_nearest_points(self):
        a, b, c, d = (np.array([each], float) for each in ([-1, 0, 0], [1, 0, 0], [0, 0.3, -1], [0, 0.3, 1]))
        self.assertAlmostEqual(sweeps.distance_m(a, b, c, d)[0], 0.3, delta=1e-3)
        self.assertAlmostEqual(sweeps.distance_m(a, b, c + 5.0, d + 5.0)[0], np.linalg.norm([4.0, 5.3, 4.0]), delta=1e-3)


class Header(unittest.TestCase):
    def test_numbers_of_the_header_are_those_that_were_scored(self):
        random = np.random.default_rng(6)
        net = constants.rounded(network.Network(random.standard_normal((50, 4)).astype(np.float32), 3, (0.2, 0.3), random))
        text = constants.network_text("some", net)
        lists = [[float(cell) for cell in re.findall(r"[-\d.e]+(?=F)", part)] for part in text.split("{\n")[2:]]
        np.testing.assert_allclose(lists[2], net.weights[0].ravel(), rtol=1e-6)
        np.testing.assert_allclose(lists[4], (net.weights[1] * net.scale).ravel(), rtol=1e-6)
        self.assertTrue(all(len(line) <= 100 for line in text.splitlines()))


class Runs(unittest.TestCase):
    def test_two_runs_write_the_same_header(self):
        with tempfile.TemporaryDirectory() as name:
            folder = Path(name)
            for part, seed in (("train", 1), ("dev", 2)):
                self.write(folder, part, np.random.default_rng(seed))
            texts = []
            for out in (folder / "a.hpp", folder / "b.hpp"):
                run = subprocess.run([sys.executable, "-B", SCRIPT, "--data", folder, "--out", out, "--hidden", "4", "--seeds", "1"], capture_output=True, text=True)
                self.assertEqual(run.returncode, 0, run.stderr)
                texts.append(out.read_text())
            self.assertEqual(texts[0], texts[1])
            self.assertIn("k_elbow_network", texts[0])

    def test_missing_data_is_one_line(self):
        run = subprocess.run([sys.executable, "-B", SCRIPT, "--data", "/nowhere", "--out", "/nowhere/x"], capture_output=True, text=True)
        self.assertEqual((run.returncode, run.stderr.count("\n")), (2, 1), run.stderr)

    def write(self, folder, part, random):
        seven = lambda start: [start + each for each in ("x", "y", "z", "qx", "qy", "qz", "qw")]
        points = [side + joint + axis for joint in ("sh", "el") for side in SIDES for axis in "xyz"]
        inputs, truth = ["clip,t," + ",".join(seven("h") + seven("l") + seven("r"))], ["clip,t,valid,chest_yaw_deg," + ",".join(points)]
        text = lambda values: ",".join(f"{value:.5f}" for value in np.ravel(values))
        for clip in (1, 2):
            for frame in range(400):
                sway, start = 0.2 * np.sin(0.05 * frame + clip), f"{clip},{frame / 10.0:.5f}"
                poses = [np.r_[place, random_rotations(random, 1)[0]] for place in ([0, 1.6, 0], [-0.2 + sway, 1.2, -0.3], [0.2, 1.2 + sway, -0.3])]
                inputs.append(f"{start},{text(poses)}")
                truth.append(f"{start},1,{20 * sway:.4f},{text([-0.18, 1.4, 0, 0.18, 1.4, 0, -0.25 + sway, 1.15, 0, 0.25, 1.15 + sway, 0])}")
        calib = ["clip,name,subject,dataset,eye_height,upper_arm,forearm,shoulder_width"] + [f"{clip},c{clip},p{clip},d,1.6,.3,.27,.36" for clip in (1, 2)]
        for name, lines in (("in", inputs), ("truth", truth), ("calib", calib)):
            (folder / f"{part}_{name}.csv").write_text("\n".join(lines) + "\n")


class Situations(unittest.TestCase):
    def test_bones_keep_their_lengths_and_hands_lie_along_the_forearm(self):
        for name, situation in situations.SITUATIONS.items():
            _, inputs, truth = situations.frames(situation)
            for side in (0, 1):
                shoulder, elbow = truth[:, 2 + 3 * side:5 + 3 * side], truth[:, 8 + 3 * side:11 + 3 * side]
                wrist, rotation = inputs[:, 7 + 7 * side:10 + 7 * side], estimator.matrices(inputs[:, 10 + 7 * side:14 + 7 * side])
                np.testing.assert_allclose(scoring.distance(shoulder, elbow), situations.UPPER_M, atol=1e-9, err_msg=name)
                np.testing.assert_allclose(scoring.distance(elbow, wrist), situations.FOREARM_M, atol=1e-9, err_msg=name)
                np.testing.assert_allclose(-rotation[..., 2], estimator.unit(wrist - elbow), atol=1e-6, err_msg=name)


@unittest.skipUnless(os.environ.get("HANDHOLD_LAB"), "no handhold-lab")
class Runtime(unittest.TestCase):
    """Each clip has one frame, in which the runtime's low-pass filters start: all its answers must equal the numpy estimator's."""

    def test_bodies_are_those_that_were_fitted(self):
        text = (ROOT / "systems/body/shared/body_constants.hpp").read_text()
        form = constants.read(text)
        with tempfile.TemporaryDirectory() as name:
            folder = Path(name)
            self.write_single_frames(folder)
            out = folder / "out.csv"
            subprocess.run([os.environ["HANDHOLD_LAB"], "body", "--in", folder / "in.csv", "--calib", folder / "calib.csv", "--out", out], check=True,
                           capture_output=True)
            recording = recordings.Recording(folder / "timed.csv")
            truth = recordings.Bodies(folder / "truth.csv", recording, is_truth=True)
            clips = recordings.Clips(folder / "calib.csv", recording)
            lines = [line.split(",") for line in out.read_text().splitlines()[1:]]
        motion = estimator.Motion(recording, truth, clips, 1000.0)
        motion.looks = np.tile(motion.look, (3, 1))
        yaw, resting = fitting.Chest(motion, form.talked).corrected(form.chest)
        arms = fitting.Arms(motion, yaw, resting, form.fade)
        elbows = [circles.elbow_m(circles.bend(each)) for circles, each in zip(arms.circles, arms.poles(form.pole, form.elbow))]
        measured = np.array(lines, float)
        np.testing.assert_allclose(estimator.wrapped(np.radians(measured[:, 2]) - yaw), 0.0, atol=1e-4)
        for place, expected in enumerate([*arms.shoulders_m, *elbows]):
            np.testing.assert_allclose(measured[:, 3 + 3 * place:6 + 3 * place], expected, atol=1e-4)

    def rare_poses(self):
        """Lines of in.csv: hands that overtake on a rail to the left; heads that look up."""
        about = lambda axis, angle: [*(np.sin(angle / 2) * np.eye(3)[axis]), np.cos(angle / 2)]
        hands = lambda x, back: [x, 1.6, back, *about(2, 0.5)]
        rail = [[0, 1.6, 0, *about(1, yaw), *hands(x, -over / 2), *hands(x, over / 2)] for yaw, x in ((0.65, -0.46), (-0.5, -0.75)) for over in np.linspace(0.0, 0.4, 9)]
        up = [[0, 1.6, 0, *about(0, pitch), *hands(-0.3, -0.3), *hands(0.25, -0.35)] for pitch in np.linspace(-0.3, 1.4, 9)]
        return ["1,0," + ",".join(f"{value:.9f}" for value in row) for row in rail + up]

    def write_single_frames(self, folder):
        """in.csv: every 20th frame of the situations, and rare poses, as clips of their own; timed.csv: the same with two rows a clip's time step apart."""
        texts = situations.files()
        head, *rows = texts["in"].splitlines()
        truth_head, *truths = texts["truth"].splitlines()
        rows, truths = rows[::20] + self.rare_poses(), truths[::20]
        truths += truths[:1] * (len(rows) - len(truths))  # not compared
        renumbered = lambda lines: [f"{clip},{clip / 90.0:.6f},{line.split(',', 2)[2]}" for clip, line in enumerate(lines, 1)]
        single = renumbered(rows)
        # The numpy reader derives the rate from steps within a clip: there all frames are of one clip.
        timed, truth = ([f"1,{line.split(',', 1)[1]}" for line in renumbered(lines)] for lines in (rows, truths))
        (folder / "in.csv").write_text("\n".join([head, *single]) + "\n")
        (folder / "timed.csv").write_text("\n".join([head, *timed]) + "\n")
        (folder / "truth.csv").write_text("\n".join([truth_head, *truth]) + "\n")
        calib_head, first = texts["calib"].splitlines()[:2]
        (folder / "calib.csv").write_text("\n".join([calib_head] + [f"{clip},{first.split(',', 1)[1]}" for clip in range(1, len(rows) + 1)]) + "\n")


if __name__ == "__main__":
    unittest.main()
