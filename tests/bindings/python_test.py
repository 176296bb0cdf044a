"""What the Python binding offers beside the two scenes: errors, lists, texts, meshes, snapshots, and conversions from numpy."""
import gc
import os
import unittest
from unittest import mock

import numpy as np

import handhold as hh


class Binding(unittest.TestCase):
    def setUp(self):
        self.world = hh.World(gravity_mps2=(0.0, -10.0, 0.0))

    def tearDown(self):
        self.world.close()

    def test_refused_calls_raise_with_result_and_text_and_change_nothing(self):
        before = self.world.hash()
        with self.assertRaises(hh.HandholdError) as caught:
            self.world.shape_add_sphere(-1.0)
        self.assertEqual(caught.exception.result, hh.HH_ERROR_VALUE)
        self.assertGreater(len(str(caught.exception)), 20)
        self.assertEqual(self.world.hash(), before)

    def test_unknown_fields_are_refused(self):
        with self.assertRaises(TypeError):
            hh.BodyDef(weight=3.0)
        with self.assertRaises(AttributeError):
            hh.BodyDef().weight = 3.0

    def test_null_handles_ids_and_definitions_never_crash(self):
        self.assertFalse(self.world.body_is_valid(None))
        with self.assertRaises(hh.HandholdError):
            self.world.body_pose(None)
        closed = hh.World()
        closed.close()
        with self.assertRaises(hh.HandholdError):
            closed.hash()

    def test_definitions_have_the_defaults_of_the_library(self):
        self.assertEqual(hh.BodyDef().friction, 0.4)
        self.assertEqual(hh.PlayerDef().mass_kg, 80.0)
        self.assertEqual(hh.Pose().rotation, hh.Quat(0.0, 0.0, 0.0, 1.0))

    def test_lists_are_arrays_with_the_fields_of_the_structs(self):
        shape = self.world.shape_add_box((0.1, 0.1, 0.1))
        given = [self.world.body_add(shape=shape, name=f"b{i}", pose=((float(i), 0.0, 0.0),)) for i in range(5)]
        bodies = self.world.bodies()
        self.assertEqual([self.world.body_name(body) for body in bodies], [f"b{i}" for i in range(5)])
        np.testing.assert_array_equal(self.world.body_poses(bodies)["position"]["x"], np.arange(5.0))
        np.testing.assert_array_equal(self.world.body_poses(given)["position"]["x"], np.arange(5.0))
        self.assertEqual(self.world.body_find("b3"), given[3])

    def test_meshes_and_hulls_take_arrays_of_numpy(self):
        positions = np.array([[-5, 0, -5], [-5, 0, 5], [5, 0, 5], [5, 0, -5]], dtype=np.float32)
        mesh = hh.Mesh(positions=positions, indices=np.array([0, 1, 2, 0, 2, 3], dtype=np.uint32))
        self.world.body_add(shape=self.world.shape_add_mesh(mesh, (1.0, 1.0, 1.0)))
        mesh.close()
        corners = np.array([[x, y, z] for x in (-0.1, 0.1) for y in (-0.1, 0.1) for z in (-0.1, 0.1)])
        crate = self.world.body_add(kind=hh.HH_DYNAMIC, shape=self.world.shape_add_hull(corners), pose=((0.0, 0.3, 0.0),))
        for _ in range(180):
            self.world.step(1.0 / 90.0, [])
        self.assertAlmostEqual(self.world.body_pose(crate).position.y, 0.1, delta=0.01)
        hit = self.world.cast_ray((1.0, 1.0, 1.0), (1.0, -1.0, 1.0), None)
        self.assertAlmostEqual(hit.distance_m, 1.0, delta=1e-6)

    def test_snapshots_go_back(self):
        body = self.world.body_add(kind=hh.HH_DYNAMIC, shape=self.world.shape_add_sphere(0.1))
        saved = self.world.save()
        before = self.world.hash()
        self.world.body_set_velocity(body, (1.0, 0.0, 0.0), (0.0, 0.0, 0.0))
        self.world.step(1.0 / 90.0, [])
        self.assertNotEqual(self.world.hash(), before)
        self.world.restore(saved)
        self.assertEqual(self.world.hash(), before)

    def test_tuning_statistics_and_counters_have_names(self):
        self.assertEqual(hh.tuning_describe(0).name.decode().count("."), 1)
        self.world.set_tuning("hand.reach_m", [0.2])
        np.testing.assert_array_equal(self.world.get_tuning("hand.reach_m", 1), [0.2])
        self.assertEqual(len(self.world.fallbacks()), sum(hh.fallback_name(i) is not None for i in range(500)))
        self.assertEqual(self.world.get_stats().bodies, 0)

    def test_host_hooks_hear_what_is_wrong(self):
        self.world.close()
        heard = []
        hooks = hh.HostHooks(log=lambda context, level, message: heard.append(message.decode()))
        hh.set_host_hooks(hooks)
        with hh.World() as world, self.assertRaises(hh.HandholdError):
            world.shape_add_sphere(float("nan"))
        hh.set_host_hooks(None)
        self.assertEqual(len(heard), 1)

    def step(self, player, frame=1):
        sample = hh.TrackingSample(time_s=frame / 90.0, head=((0.0, 1.6, 0.0),), hands=[((-0.2, 1.4, -0.4),), ((0.2, 1.4, -0.4),)])
        self.world.step_player(1.0 / 90.0, player, [sample])

    def test_curls_need_all_joints_of_a_hand(self):
        player = self.world.player_add(name="you")
        self.step(player)
        joints = self.world.player_hand_joints(player, hh.HH_RIGHT, hh.HH_SPACE_WORLD)
        for given in (joints, list(joints)):
            curls = hh.finger_curls_of(given)
            self.assertTrue(all(0.0 <= one < 0.6 for one in curls.fingers), list(curls.fingers))
        for wrong in (None, joints[:1], joints[:25]):
            with self.assertRaises(TypeError):
                hh.finger_curls_of(wrong)

    def test_queries_outlive_the_struct_that_gave_them(self):
        asked = []
        query = hh.SurfaceQuery(closest_point=lambda *words: asked.append(1) or 0)
        self.world.set_surface_query(query)
        query.closest_point = None
        del query
        gc.collect()
        junk = [hh.SurfaceQuery(closest_point=lambda *words: self.fail("another function")) for _ in range(50)]
        self.world.body_add(name="wall")
        self.step(self.world.player_add(name="you"))
        self.assertGreater(len(asked), 0)
        self.assertEqual(len(junk), 50)

    def test_hooks_outlive_the_struct_that_gave_them(self):
        self.world.close()
        heard = []
        hh.set_host_hooks(hh.HostHooks(log=lambda context, level, message: heard.append(message)))
        gc.collect()
        junk = [hh.HostHooks(log=lambda *words: self.fail("another function")) for _ in range(50)]
        with hh.World() as world:
            with self.assertRaises(hh.HandholdError):
                world.shape_add_sphere(-1.0)
            with self.assertRaises(hh.HandholdError):
                hh.set_host_hooks(None)  # not while a world exists: the hooks stay
            gc.collect()
            before = len(heard)
            with self.assertRaises(hh.HandholdError):
                world.shape_add_sphere(-1.0)
            self.assertEqual(len(heard), before + 1)
        hh.set_host_hooks(None)
        self.assertEqual(len(junk), 50)

    def test_queries_cannot_end_their_world_and_their_errors_reach_the_step(self):
        player = self.world.player_add(name="you")
        self.world.body_add(name="wall")
        surfaces = hh.Surfaces()
        for work, error in ((lambda: self.world.close(), hh.HandholdError), (lambda: self.world.set_surfaces(None), hh.HandholdError),
                            (lambda: ["not a hit"], TypeError), (lambda: {}["no level"], KeyError)):
            surfaces.closest_point = lambda point, max_m, skip, work=work: work()
            self.world.set_surfaces(surfaces)
            with self.assertRaises(error):
                self.step(player)
        self.world.set_surfaces(None)
        self.step(player, 2)

    def test_definitions_that_are_left_out_are_the_defaults(self):
        self.assertTrue(self.world.player_is_valid(self.world.player_add()))
        self.assertTrue(self.world.body_is_valid(self.world.body_add()))
        with self.assertRaises(TypeError):
            self.world.player_set_measures(self.world.player_add())

    def test_libraries_of_another_minor_version_are_refused(self):
        for minor in (hh.HANDHOLD_VERSION_MINOR - 1, hh.HANDHOLD_VERSION_MINOR + 1):
            with mock.patch.object(hh._generated, "HANDHOLD_VERSION_MINOR", minor), self.assertRaises(ImportError):
                hh.load(os.environ["HANDHOLD_LIBRARY"])

    def test_arguments_of_another_shape_are_refused(self):
        for given in ((1.0, 1.0), 5, "box", b"box"):
            with self.assertRaises(TypeError):
                self.world.shape_add_box(given)
        player = self.world.player_add()
        for count in (1, 3):
            with self.assertRaises(TypeError):
                hh.TrackingSample(hands=[hh.Pose()] * count)
        with self.assertRaises(TypeError):
            self.world.player_set_measures([player])

    def test_arrays_of_whole_numbers_and_generators(self):
        corners = np.array([(0.0, 0.0, 0.0), (1.0, 0.0, 0.0), (0.0, 1.0, 0.0)], np.float32)
        for indices in ([0, 1, 2], np.arange(3), np.arange(3, dtype=np.uint8), (one for one in range(3))):
            hh.Mesh(positions=(float(one) for one in corners.ravel()), indices=indices).close()
        for wrong in (np.array([0.0, 1.0, 2.0]), np.array([0, 1, 2], object), np.array(["0", "1", "2"]), np.array([False, True, True]), "012"):
            with self.assertRaises(TypeError, msg=repr(wrong)):
                hh.Mesh(positions=corners, indices=wrong)
        with self.assertRaises(TypeError):
            hh.Mesh(positions=corners.astype(str), indices=[0, 1, 2])
        self.assertEqual(hh.MeshDef(positions=np.array([]), indices=np.array([])).index_count, 0)
        sample = hh.TrackingSample(hands=(hh.Pose((side, 0.0, 0.0)) for side in range(2)))
        self.assertEqual([hand.position.x for hand in sample.hands], [0.0, 1.0])

    def test_worlds_are_not_copied(self):
        import copy
        for copied in (copy.copy, copy.deepcopy):
            with self.assertRaises(TypeError):
                copied(self.world)
        self.world.step(1 / 90, [])

    def test_rows_are_structs_of_one_type_of_number_only(self):
        body = self.world.body_add()
        self.world.body_poses(np.array([[body.index, body.generation]], dtype=np.uint32))
        with self.assertRaises(TypeError):
            self.world.place_bodies(np.zeros((1, 14)))  # as large as a hh_body_motion, which begins with an id
        with self.assertRaises(TypeError):
            self.world.body_poses(np.array([[1.0, 2.0]], dtype=np.float32))
        for positions in (np.zeros(7, np.float32), np.zeros((3, 4), np.float32)):
            with self.assertRaises(TypeError):
                hh.Mesh(positions=positions, indices=[0, 1, 1])


if __name__ == "__main__":
    unittest.main(verbosity=0)
