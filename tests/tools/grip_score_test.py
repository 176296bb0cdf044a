"""grip_score against closed forms: planes, spheres, boxes and sheets without inside."""
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

from grips import capsules, glb, placements, primitives, scoring
from grips.grasps import read_grasps
from grips.surface import Surface
from grips.tree import TriangleTree

EXACT_M = capsules.TOLERANCE_M + 1e-7


def box(size_m, edge_m=0.02):
    points, faces = primitives.box(size_m, edge_m)
    return Surface(points[faces])


def sheet(size_m=1.0, edge_m=0.05):
    cells = math.ceil(size_m / edge_m)
    points, faces = primitives.grid((-0.5 * size_m, -0.5 * size_m, 0.0), (size_m, 0, 0), (0, size_m, 0), cells, cells)
    return points[faces]


def sphere(radius_m, edge_m=0.004):
    points, faces = primitives.sphere(radius_m, edge_m)
    return points[faces]


def clear(surface, a, b, radius):
    return capsules.clearance(surface, [a], [b], [radius])[0]


def random_capsules(count, reach_m, seed):
    rng = np.random.default_rng(seed)
    a = rng.uniform(-reach_m, reach_m, (count, 3))
    return a, a + rng.uniform(-0.03, 0.03, (count, 3)), rng.uniform(0.004, 0.012, count)


class CapsuleAgainstSolid(unittest.TestCase):
    def test_gap_to_a_wall_is_the_nearer_ends_distance_minus_the_radius(self):
        wall = box((1.0, 1.0, 0.1))
        self.assertAlmostEqual(clear(wall, (0, 0, 0.08), (0.03, 0.01, 0.07), 0.008), 0.02 - 0.008, delta=EXACT_M)

    def test_depth_in_a_wall_is_the_deeper_ends_depth_plus_the_radius(self):
        wall = box((1.0, 1.0, 0.1))
        self.assertAlmostEqual(clear(wall, (0, 0, 0.07), (0.01, 0.01, 0.04), 0.008), -(0.01 + 0.008), delta=EXACT_M)

    def test_depth_in_a_thin_plate_is_half_its_thickness_plus_the_radius(self):
        plate = box((0.4, 0.4, 0.012))
        self.assertAlmostEqual(clear(plate, (0.01, 0.02, -0.05), (0, 0.02, 0.043), 0.008), -(0.006 + 0.008), delta=EXACT_M)

    def test_distance_outside_a_box_is_the_closed_form(self):
        half = np.array((0.15, 0.1, 0.075))
        solid = box(2 * half)
        points = np.random.default_rng(1).uniform(-0.3, 0.3, (2000, 3))
        off = np.abs(points) - half
        expected = np.linalg.norm(np.maximum(off, 0.0), axis=1) + np.minimum(off.max(1), 0.0)
        np.testing.assert_allclose(solid.signed_distance(points), expected, atol=1e-9)

    def test_depth_in_a_sphere_is_the_closed_form(self):
        radius = 0.06
        surface = Surface(sphere(radius))
        a, b, r = random_capsules(300, 0.09, 2)
        t = np.clip(-np.einsum("ij,ij->i", a, b - a) / np.einsum("ij,ij->i", b - a, b - a), 0.0, 1.0)
        expected = np.linalg.norm(a + t[:, None] * (b - a), axis=1) - radius - r
        # Chords of 4 mm lie up to edge^2 / (4 R) below the sphere.
        np.testing.assert_allclose(capsules.clearance(surface, a, b, r), expected, atol=2e-4)

    def test_long_capsule_with_clear_ends_is_measured_at_its_deepest_point(self):
        surface = Surface(sphere(0.02, 0.002))
        self.assertAlmostEqual(clear(surface, (-0.1, 0.011, 0.003), (0.13, 0.011, 0.003), 0.008), math.hypot(0.011, 0.003) - 0.028, delta=1e-4)

    def test_capsule_of_zero_length_is_a_sphere(self):
        wall = box((1.0, 1.0, 0.1))
        self.assertAlmostEqual(clear(wall, (0, 0, 0.06), (0, 0, 0.06), 0.008), 0.002, delta=EXACT_M)

    def test_rigid_motion_of_the_world_changes_nothing(self):
        points, faces = primitives.rail(0.035, 0.01)
        a, b, r = random_capsules(100, 0.1, 3)
        turn = np.array([[0.36, 0.48, -0.8], [-0.8, 0.6, 0.0], [0.48, 0.64, 0.6]])
        offset = np.array((3.0, -2.0, 5.0))
        here = capsules.clearance(Surface(points[faces]), a, b, r)
        there = capsules.clearance(Surface(points[faces] @ turn.T + offset), a @ turn.T + offset, b @ turn.T + offset, r)
        np.testing.assert_allclose(there, here, atol=2 * EXACT_M)

    def test_mirrored_hands_on_a_mirrored_mesh_have_equal_depths(self):
        points, faces = primitives.rail(0.035, 0.01)
        a, b, r = random_capsules(100, 0.1, 4)
        flip = np.array((-1.0, 1.0, 1.0))
        here = capsules.clearance(Surface(points[faces]), a, b, r)
        there = capsules.clearance(Surface((points * flip)[faces[:, ::-1]]), a * flip, b * flip, r)
        np.testing.assert_allclose(there, here, atol=2 * EXACT_M)


def distance_to_triangle(p, a, b, c):
    """Minimum over the plane, the sides and the corners, each by its own formula."""
    n = np.cross(b - a, c - a)
    weights = [np.cross(v - u, p - u) @ n for u, v in ((a, b), (b, c), (c, a))]
    found = [abs((p - a) @ n) / np.linalg.norm(n)] if min(weights) >= 0 else []
    for u, v in ((a, b), (b, c), (c, a)):
        t = (p - u) @ (v - u) / ((v - u) @ (v - u))
        found += [np.linalg.norm(p - u), np.linalg.norm(p - v)] + ([np.linalg.norm(p - u - t * (v - u))] if 0 <= t <= 1 else [])
    return min(found)


class Tree(unittest.TestCase):
    def setUp(self):
        """Triangles with edges from half a millimetre to metres, including needles."""
        rng = np.random.default_rng(8)
        sizes = 10.0 ** rng.uniform(-3.3, 0.3, (300, 1, 1))
        self.triangles = rng.uniform(-0.3, 0.3, (300, 1, 3)) + sizes * rng.uniform(-1, 1, (300, 3, 3))
        self.triangles[::5, 2] = self.triangles[::5, 1] + 1e-3 * (self.triangles[::5, 2] - self.triangles[::5, 1])
        self.points = rng.uniform(-0.4, 0.4, (60, 3))
        self.tree = TriangleTree(self.triangles)

    def test_closest_triangle_equals_brute_force(self):
        expected = [min(distance_to_triangle(point, *corners) for corners in self.triangles) for point in self.points]
        np.testing.assert_allclose(self.tree.closest(self.points)[0], expected, atol=1e-9)

    def test_winding_number_equals_the_sum_of_solid_angles(self):
        a, b, c = (self.triangles[None, :, side] - self.points[:, None] for side in range(3))
        la, lb, lc = (np.linalg.norm(v, axis=2) for v in (a, b, c))
        top = np.einsum("ijk,ijk->ij", a, np.cross(b, c))
        below = la * lb * lc + (a * b).sum(2) * lc + (b * c).sum(2) * la + (c * a).sum(2) * lb
        np.testing.assert_allclose(self.tree.winding(self.points), (2 * np.arctan2(top, below)).sum(1) / (4 * math.pi), atol=0.05)


class Inside(unittest.TestCase):
    def test_single_sheet_has_no_inside_and_depths_up_to_the_radius(self):
        surface = Surface(sheet())
        self.assertAlmostEqual(clear(surface, (0, 0, 0.003), (0.02, 0, 0.01), 0.008), 0.003 - 0.008, delta=EXACT_M)
        self.assertAlmostEqual(clear(surface, (0, 0, -0.003), (0.02, 0, -0.01), 0.008), 0.003 - 0.008, delta=EXACT_M)
        self.assertAlmostEqual(clear(surface, (0, 0, -0.03), (0.02, 0, 0.03), 0.008), -0.008, delta=EXACT_M)

    def test_inside_is_independent_of_winding_duplicates_and_jitter(self):
        triangles = sphere(0.06, 0.01)
        rng = np.random.default_rng(5)
        flipped = rng.random(len(triangles)) < 0.15
        written = {"inside out": triangles[:, ::-1], "flipped": np.where(flipped[:, None, None], triangles[:, ::-1], triangles),
                   "twice, both ways": np.concatenate([triangles, triangles[:, ::-1]]), "shuffled soup": rng.permutation(triangles),
                   "jittered soup": triangles + rng.normal(0.0, 2e-5, triangles.shape),
                   "degenerates": np.concatenate([triangles, triangles[:50, [0, 1, 1]]])}
        points = rng.uniform(-0.08, 0.08, (500, 3))
        radius = np.linalg.norm(points, axis=1)
        points, expected = points[np.abs(radius - 0.06) > 1e-3], (radius < 0.06)[np.abs(radius - 0.06) > 1e-3]
        for name, soup in written.items():
            with self.subTest(name):
                np.testing.assert_array_equal(Surface(soup).is_inside(points), expected)

    def test_holes_keep_most_of_the_inside(self):
        triangles = sphere(0.06, 0.006)
        kept = triangles[np.random.default_rng(6).random(len(triangles)) > 0.06]
        self.assertTrue(Surface(kept).is_inside(np.random.default_rng(7).uniform(-0.03, 0.03, (200, 3))).all())

    def test_objects_in_a_room_have_an_inside_and_the_room_has_none(self):
        room, thing = primitives.box((4.0, 3.0, 5.0), 0.5), primitives.box((0.1, 0.1, 0.1), 0.05)
        surface = Surface(np.concatenate([room[0][room[1][:, ::-1]], thing[0][thing[1]]]))
        np.testing.assert_array_equal(surface.is_inside(np.array([[0, 0, 0], [0.2, 0, 0], [1.9, 0, 0], [3.0, 0, 0]])), [True, False, False, False])

    def test_small_room_has_no_inside_and_thin_inverted_solid_is_flipped(self):
        quarters, plate = primitives.box((0.8, 1.8, 1.0), 0.2), primitives.box((1.9, 0.1, 1.9), 0.2)
        corners = quarters[1][:, ::-1]
        self.assertFalse(Surface(quarters[0][corners]).is_inside(np.array([[0, 0, 0], [0.35, 0, 0], [0.5, 0, 0]])).any())
        np.testing.assert_array_equal(Surface(plate[0][plate[1][:, ::-1]]).is_inside(np.array([[0, 0, 0], [0, 0.2, 0]])), [True, False])

    def test_intersecting_solids_are_one(self):
        points, faces = primitives.rail(0.035, 0.01)
        surface = Surface(points[faces])
        np.testing.assert_array_equal(surface.is_inside(np.array([[0, 0, 0], [0.336, 0, 0], [0.336, 0, -0.08], [0, 0, -0.03]])),
                                      [True, True, True, False])


class Placements(unittest.TestCase):
    def setUp(self):
        self.surface = box((0.3, 0.2, 0.15))

    def palms(self, kind, count=400, seed=1):
        positions, rotations = placements.place(self.surface, kind, count, seed)
        turns = placements.Rotation.from_quat(rotations)
        return positions + turns.apply(placements.PALM_CENTER_HS_M), turns.apply((0.0, -1.0, 0.0))

    def test_near_palms_are_within_2_cm_outside(self):
        distance = self.surface.signed_distance(self.palms("near")[0])
        self.assertTrue(((distance >= 0) & (distance <= 0.02 + 1e-9)).all())

    def test_near_palms_face_a_side_within_30_degrees(self):
        _, facing = self.palms("near")
        self.assertGreaterEqual(np.abs(facing).max(1).min(), math.cos(math.radians(30.0)) - 1e-9)

    def test_harsh_palms_reach_inside_and_outside(self):
        distance = self.surface.signed_distance(self.palms("harsh")[0])
        self.assertLess(distance.min(), -0.02)
        self.assertGreater(distance.max(), 0.05)
        self.assertLessEqual(distance.max(), 0.06 + 1e-9)

    def test_seed_determines_the_placements(self):
        np.testing.assert_array_equal(self.palms("near")[0], self.palms("near")[0])
        self.assertFalse(np.allclose(self.palms("near")[0], self.palms("near", seed=2)[0]))

    def test_palms_are_distributed_by_area(self):
        facing = np.abs(self.palms("near", 3000)[1]).argmax(1)
        areas = np.array((0.2 * 0.15, 0.3 * 0.15, 0.3 * 0.2))
        np.testing.assert_allclose(np.bincount(facing, minlength=3) / 3000, areas / areas.sum(), atol=0.03)


def grasp_line(index=0, z_m=0.056, radius_m=0.008, gripped=True, **more):
    """An index finger parallel to a wall whose face is at z = 0.05."""
    return {"id": index, "gripped": gripped, "reason": "" if gripped else "nothing in reach", "sync_mm": 2.0, "sync_deg": 1.0,
            "wrist": {"position_m": [0, 0, 0.1], "rotation_xyzw": [0, 0, 0, 1]},
            "capsules": [{"finger": "index", "link": 0, "a_m": [0, 0, z_m], "b_m": [0.03, 0, z_m], "radius_m": radius_m}],
            "fingers": [{"name": "index", "discs": 3, "visited": 6, "walked": 30, "fallback": "none"}], "us": {"total": 50.0}, **more}


class Figures(unittest.TestCase):
    def score(self, *lines, **options):
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / "G.jsonl"
            path.write_text("".join(json.dumps(line) + "\n" for line in lines))
            return scoring.figures([scoring.Measured(box((1.0, 1.0, 0.1), 0.1), *read_grasps(path), **options)])

    def test_depths_shares_and_touches_are_counted(self):
        # 2 mm deep, 4 mm deep, 1 mm off, 3 mm off.
        figures = self.score(*(grasp_line(i, z) for i, z in enumerate((0.056, 0.054, 0.059, 0.061))))
        self.assertAlmostEqual(figures["deep_share"]["any_finger"], 0.25)
        self.assertAlmostEqual(figures["penetration_mm"]["mean_of_fingers"], (2.0 + 4.0) / 4, delta=0.03)
        self.assertAlmostEqual(figures["penetration_mm"]["fingers"]["max"], 4.0, delta=0.03)
        self.assertEqual(figures["visited_per_disc"]["median"], 2.0)
        self.assertEqual(figures["us"]["total"]["median"], 50.0)
        self.assertAlmostEqual(self.score(grasp_line(0, 0.059), grasp_line(1, 0.061))["fingers_within_2_mm"]["four"], 0.5)

    def test_non_finite_hands_are_counted_and_excluded(self):
        figures = self.score(grasp_line(0, 0.056), grasp_line(1, math.nan), grasp_line(2, 0.056, sync_mm=None))
        self.assertEqual(figures["not_finite"], 2)
        self.assertAlmostEqual(figures["penetration_mm"]["mean_of_fingers"], 2.0, delta=0.03)

    def test_hands_without_grip_are_counted_by_reason_and_not_measured(self):
        figures = self.score(grasp_line(0, 0.059), grasp_line(1, 0.05, gripped=False))
        self.assertEqual((figures["gripped_share"], figures["reasons"]), (0.5, {"nothing in reach": 1}))
        self.assertEqual(figures["deep_share"]["any_finger"], 0.0)

    def test_sync_of_near_placements_is_separate(self):
        figures = self.score(grasp_line(0), grasp_line(1, sync_mm=9.0), kinds={0: "near", 1: "harsh"})
        self.assertEqual((figures["sync_mm_near"]["median"], figures["sync_mm"]["median"]), (2.0, 5.5))


class BrokenFiles(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)
        self.mesh, self.out = self.folder / "m.glb", self.folder / "out.json"
        glb.write_triangles(self.mesh, *primitives.box((1.0, 1.0, 0.1), 0.1))

    def run_score(self, text, mesh=None):
        path = self.folder / "G.jsonl"
        path.write_text(text)
        return subprocess.run([sys.executable, "-B", ROOT / "tools/lab/grip_score", mesh or self.mesh, path, "--json", self.out],
                              capture_output=True, text=True)

    def assert_refused(self, run, *words):
        self.assertEqual((run.returncode, run.stderr.count("\n"), run.stdout), (2, 1, ""), run.stderr)
        for word in words:
            self.assertIn(word, run.stderr)
        self.assertFalse(self.out.exists())

    def test_valid_file_is_scored(self):
        run = self.run_score(json.dumps(grasp_line(0, 0.059)) + "\n")
        self.assertEqual(run.returncode, 0, run.stderr)
        self.assertEqual(json.loads(self.out.read_text())["fingers_within_2_mm"]["four"], 1.0)

    def test_each_breach_gives_one_line_that_names_the_place(self):
        good = json.dumps(grasp_line(0))
        wrong_finger = json.dumps(grasp_line(1)).replace('"finger": "index"', '"finger": "sixth"')
        for text, words in ((good + "\n{", ("line 2", "JSON")), (good + "\n" + wrong_finger, ("line 2", "capsules: 0", "finger")),
                            (good + "\n" + good, ("line 2", "twice")), ("", ("at least one",)), ("[]", ("line 1", "object")),
                            (json.dumps({**grasp_line(0), "capsules": []}), ("line 1", "posed hand")),
                            (good.replace('"radius_m": 0.008', '"radius_m": "x"'), ("radius_m", "number"))):
            with self.subTest(words):
                self.assert_refused(self.run_score(text), *words)

    def test_invalid_mesh_is_named(self):
        broken = self.folder / "broken.glb"
        good = json.dumps(grasp_line(0))
        broken.write_bytes(b"glTF")
        self.assert_refused(self.run_score(good, broken), "broken.glb", "glTF")
        broken.write_bytes(self.mesh.read_bytes()[:-400])
        self.assert_refused(self.run_score(good, broken), "broken.glb", "longer than the file")
        self.assert_refused(self.run_score(good, self.folder / "none.glb"), "none.glb", "cannot be read")

    def test_wrong_flags_print_the_usage(self):
        run = subprocess.run([sys.executable, "-B", ROOT / "tools/lab/grip_score", "--what"], capture_output=True, text=True)
        self.assertEqual(run.returncode, 1)
        self.assertIn("usage", run.stderr)


class Glb(unittest.TestCase):
    def test_written_mesh_reads_back(self):
        points, faces = primitives.box((0.5, 0.25, 1.0), 0.25)
        with tempfile.TemporaryDirectory() as folder:
            glb.write_triangles(f"{folder}/m.glb", points, faces)
            np.testing.assert_array_equal(glb.read_triangles(f"{folder}/m.glb"), points[faces])

    def test_node_transform_translates_rotates_and_mirrors(self):
        half = math.sqrt(0.5)
        matrix = glb.node_matrix({"translation": [1, 2, 3], "rotation": [0, half, 0, half], "scale": [2, 1, -1]})
        # x rotates to -z about y; z, mirrored, to -x.
        np.testing.assert_allclose(matrix @ [1, 1, 1, 1], [1 - 1, 2 + 1, 3 - 2, 1], atol=1e-12)


if __name__ == "__main__":
    unittest.main()
