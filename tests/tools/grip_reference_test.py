"""The brute-force reference on planes, where reach has a closed form."""
import json
import math
import sys
import tempfile
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tools" / "lab"))
import numpy as np

from grips import primitives, reference, rig
from grips.surface import Surface
from pages import files

LENGTH_M, RADIUS_M = 0.04, 0.008
INDEX = reference.FINGERS.index("index")
THUMB = reference.FINGERS.index("thumb")


def finger(name="index", **more):
    """Two coupled links along -Z from the wrist, from level to straight down."""
    return {"name": name, "link_count": 2, "base_hs": {"position_m": [0, 0, 0], "rotation_xyzw": [0, 0, 0, 1]},
            "length_m": [LENGTH_M, LENGTH_M], "radius_m": [RADIUS_M, RADIUS_M], "lower_rad": [0, 0], "upper_rad": [math.pi / 2, 0],
            "opposition_axis_hs": [0, 0, -1], "lower_opposition_rad": 0, "upper_opposition_rad": 0, **more}


def read(*fingers):
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "rig.json"
        path.write_text(json.dumps({"side": "right", "fingers": list(fingers)}))
        return rig.read_rig(path)


def floor(top_m=0.0):
    """A slab whose upper face is at y = top_m."""
    points, faces = primitives.box((0.6, 0.1, 0.6), 0.05)
    return (points + (0, top_m - 0.05, 0))[faces]


def reaches(triangles, heights_m, fingers, column=INDEX):
    positions = np.array([(0.01, height, 0.02) for height in heights_m])
    rotations = np.tile((0.0, 0.0, 0.0, 1.0), (len(positions), 1))
    return reference.reached(Surface(triangles), fingers, positions, rotations)[:, column].tolist()


class Reach(unittest.TestCase):
    def test_reach_is_the_fingers_length_plus_its_radius(self):
        limit = 2 * LENGTH_M + RADIUS_M
        self.assertEqual(reaches(floor(), (0.03, 0.05, limit - 1e-3, limit + 1e-3, 0.2), read(finger())), [True, True, True, False, False])

    def test_link_that_starts_inside_and_moves_deeper_stops_at_once(self):
        # At 1 mm depth it still counts as lying on the surface, at 4 mm not.
        self.assertEqual(reaches(floor(), (RADIUS_M - 1e-3, RADIUS_M - 4e-3), read(finger())), [True, False])

    def test_link_that_starts_inside_and_moves_out_continues(self):
        ceiling = floor(0.1 + 2 * RADIUS_M + 0.05)  # its lower face is 2 radii above a wrist at 0.05
        opened = read(finger(lower_rad=[-0.5, 0]))
        self.assertEqual(reaches(ceiling, (0.05,), opened), [False])
        self.assertEqual(reaches(np.concatenate([ceiling, floor()]), (0.05,), opened), [True])

    def test_later_joints_continue_after_the_first_link_stops(self):
        # The first link touches a bar under its middle; the second continues alone until its tip is on the floor.
        bar = primitives.box((0.02, 0.02, 0.01), 0.01)
        stopper = (bar[0] + (0.01, 0.05 - RADIUS_M - 0.0101, 0.005))[bar[1]]
        sweep = reference.Sweep(Surface(np.concatenate([stopper, floor(0.01)])), read(finger(upper_rad=[math.pi / 2, math.pi / 2]))["index"],
                                np.array([(0.01, 0.05, 0.02)]), np.array([(0.0, 0.0, 0.0, 1.0)]), 0.0)
        self.assertEqual(sweep.run().tolist(), [True])
        first, second = sweep.stopped_at[0]
        self.assertLess(first, 5)
        level = math.radians(0.25) * first
        turn = math.asin((0.05 - 0.01 - RADIUS_M) / LENGTH_M - math.sin(level)) - level
        self.assertEqual(second, math.ceil(turn / math.radians(0.25)))

    def test_skipped_steps_change_no_contact(self):
        """Compared with the same sweep by single steps: a sphere's distance has a closed form."""
        middle, ball_m = np.array((0.012, -0.01, -0.05)), 0.05
        points, faces = primitives.sphere(ball_m, 0.002)
        one = read(finger(upper_rad=[1.3, 1.6]))["index"]
        rng = np.random.default_rng(1)
        positions = rng.uniform((-0.02, 0.03, -0.02), (0.04, 0.09, 0.06), (40, 3))
        rotations = np.tile((0.0, 0.0, 0.0, 1.0), (40, 1))
        sweep = reference.Sweep(Surface((points + middle)[faces]), one, positions, rotations, 0.0)
        clear = ~sweep.buried.any(1)
        sweep.run()
        self.assertGreater(clear.sum(), 20)
        for hand in np.nonzero(clear)[0]:
            expected = self.by_single_steps(one, positions[hand], middle, ball_m, sweep.steps)
            np.testing.assert_allclose(sweep.stopped_at[hand], expected, atol=2)  # chords: 0.02 mm, a fraction of most steps

    @staticmethod
    def by_single_steps(one, position, middle, ball_m, steps):
        at, stopped = np.full(one.links, steps), 0
        for step in range(1, steps + 1):
            curl = one.lower + (one.upper - one.lower) * np.minimum(at, step) / steps
            points = one.points_hs(curl[None, :], 0.0)[0] + position
            for link in range(one.links - 1, stopped - 1, -1):
                way = points[link + 1] - points[link]
                t = np.clip((middle - points[link]) @ way / (way @ way), 0, 1)
                if np.linalg.norm(points[link] + t * way - middle) <= ball_m + one.radius[link]:
                    at[stopped:link + 1] = step
                    stopped = link + 1
                    break
        return at

    def test_thumb_reaches_if_one_of_its_oppositions_does(self):
        # Level, it rotates about its own axis' side: only an opposition of half a turn brings the floor in front of it.
        up = finger("thumb", base_hs={"position_m": [0, 0, 0], "rotation_xyzw": [0, 0, 1, 0]})
        fixed, opposed = read(up), read({**up, "lower_opposition_rad": 0, "upper_opposition_rad": math.pi})
        self.assertEqual(reaches(floor(), (0.05,), fixed, THUMB), [False])
        self.assertEqual(reaches(floor(), (0.05,), opposed, THUMB), [True])


class Kinematics(unittest.TestCase):
    def test_positive_curl_rotates_towards_the_palm(self):
        points = read(finger())["index"].points_hs(np.array([[math.pi / 6, math.pi / 3]]), 0.0)[0]
        half, root = LENGTH_M / 2, LENGTH_M * math.sqrt(0.75)
        np.testing.assert_allclose(points, [(0, 0, 0), (0, -half, -root), (0, -half - LENGTH_M, -root)], atol=1e-12)

    def test_invalid_rig_names_the_member(self):
        for broken, word in ((finger(link_count=4), "link_count"), (finger("sixth"), "name"), (finger(length_m=[0.1]), "length_m"),
                             ({**finger(), "base_hs": {}}, "base_hs"), (finger(upper_rad=[None, 1]), "finite")):
            with self.subTest(word), self.assertRaisesRegex(files.FormatError, word):
                read(broken)


if __name__ == "__main__":
    unittest.main()
