"""The Blender add-on, as an animator uses it. Run inside Blender by tests/blender/run.py."""
import json
import math
import sys
import tempfile
import time
import unittest
from pathlib import Path

import bpy
import numpy as np
from mathutils import Matrix, Quaternion, Vector

SOURCE = Path(__file__).resolve().parent.parent.parent
sys.path[:0] = [str(SOURCE / "tools/blender"), str(SOURCE / "systems/host/bindings/python")]
sys.dont_write_bytecode = True

import handhold  # noqa: E402
import handhold_authoring  # noqa: E402
from handhold_authoring import commands, fitting, gltf, grips, hands, live  # noqa: E402

WORK = Path(tempfile.mkdtemp())
BAR_RADIUS_M = 0.018
# A wrist from which the right hand closes on the bar: the palm, which looks along -Y of the wrist, is a bar's radius from its axis.
NEAR = (0.0, 0.036, 0.085)


def bar(scale=(1.0, 1.0, 1.0)):
    """A bar along X in glTF's and Blender's axes, at a place and rotation that are not the scene's."""
    bpy.ops.mesh.primitive_cylinder_add(vertices=24, radius=BAR_RADIUS_M, depth=0.3)
    made = bpy.context.object
    made.data.transform(Matrix.Rotation(math.pi / 2, 4, "Y"))
    made.name, made.scale = "bar", scale
    made.location, made.rotation_euler = (0.4, -0.3, 1.1), (0.3, 0.2, 0.9)
    bpy.context.view_layer.update()
    return made


def settings():
    return bpy.context.scene.handhold


def place(hand, gripped, wrist) -> None:
    """Moves the hand's wrist to a place in the object's frame (glTF's axes), without rotation."""
    poses = hands.joints(hand)
    move = grips.object_frame(gripped) @ Matrix.Translation(wrist) @ poses["wrist"].inverted()
    hands.set_pose(hand, {name: move @ pose for name, pose in poses.items()})


def furthest_m(a: dict, b: dict) -> float:
    return max((a[name].to_translation() - b[name].to_translation()).length for name in a)


def worst_turn(a: dict, b: dict) -> float:
    return max(a[name].to_quaternion().rotation_difference(b[name].to_quaternion()).angle for name in a)


class Authoring(unittest.TestCase):
    def setUp(self) -> None:
        bpy.ops.wm.read_factory_settings(use_empty=True)
        if "handhold_authoring" in bpy.context.preferences.addons:
            handhold_authoring.unregister()
        bpy.ops.preferences.addon_enable(module="handhold_authoring")
        settings().file = str(WORK / "grip.json")

    def gripping_hand(self, side="right"):
        settings().gripped = bar()
        settings().side = side
        bpy.ops.handhold.add_hand()
        hand = bpy.context.object
        place(hand, settings().gripped, NEAR)
        self.assertEqual(bpy.ops.handhold.close_hand(), {"FINISHED"})
        return hand, settings().gripped

    def test_hand_is_the_games_hand_with_its_controller(self) -> None:
        for side in fitting.SIDES:
            hand = hands.add(side, "builtin")
            commands.export_hands(WORK, "builtin")
            nodes = gltf.read_nodes(WORK / f"robot_hand_{side}.glb")
            found = hands.joints(hand)
            self.assertEqual(set(found), {name for name in fitting.JOINTS if name})
            expected = {name: nodes[name]["pose"] for name in found}
            self.assertLess(furthest_m(found, expected), 2e-6)
            self.assertLess(worst_turn(found, expected), 1e-3)
            tracked = next(one for one in hand.children if hands.CONTROLLER in one)
            self.assertGreater(len(tracked.children), 3)
            with handhold.World() as world:
                joint = world.hand_in_controller(fitting.SIDES.index(side))
            expected = [*(getattr(joint.position, axis) for axis in "xyz"), *(getattr(joint.rotation, axis) for axis in "xyzw")]
            np.testing.assert_allclose(hands.wrist_in_controller(hand, tracked), expected, atol=1e-5)

    def test_closing_is_the_runtimes_fit_wherever_the_object_is(self) -> None:
        hand, gripped = self.gripping_hand()
        frame = grips.object_frame(gripped).inverted()
        shown = {name: frame @ pose for name, pose in hands.joints(hand).items()}
        points, triangles = gltf.triangles_of(gripped, bpy.context.evaluated_depsgraph_get())
        fit = fitting.close_hand(points, triangles, Matrix.Translation(NEAR), "right")
        self.assertLess(furthest_m(shown, fit.joints), 2e-4)  # single precision of two frames
        # The program's own fit of a new grip at this wrist.
        gltf.write_triangles(WORK / "object.glb", points, triangles)
        (WORK / "scene.json").write_text(json.dumps({"name": "s", "bodies": [
            {"name": "object", "kind": "static", "shape": {"type": "mesh", "file": "object.glb"}}]}))
        commands.run("export-grip", "--scene", WORK / "scene.json", "--body", "object", "--grip", "new", "--out", WORK / "new.glb",
                     "--wrist", *NEAR, 0, 0, 0, 1)
        other = gltf.read_nodes(WORK / "new.glb")
        self.assertLess(furthest_m(shown, {name: other[name]["pose"] for name in shown}), 0.004)
        # Fingers are on the bar: each last joint's middle is a finger's radius from its surface, within 6 mm, on its far side or below.
        for finger in ("index", "middle", "ring", "pinky"):
            tip = shown[f"{finger}-finger-tip"].to_translation()
            away = math.hypot(tip.y, tip.z) - BAR_RADIUS_M
            self.assertGreater(away, 0.0)
            self.assertLess(away, 0.016)

    def test_a_hand_out_of_reach_is_refused_and_stays(self) -> None:
        settings().gripped = bar()
        bpy.ops.handhold.add_hand()
        hand = bpy.context.object
        place(hand, settings().gripped, (0.0, 0.5, 0.0))
        before = hands.joints(hand)
        with self.assertRaisesRegex(RuntimeError, "in the hand's reach"):
            bpy.ops.handhold.close_hand()
        self.assertLess(furthest_m(before, hands.joints(hand)), 1e-6)
        settings().gripped = None
        with self.assertRaisesRegex(RuntimeError, "choose the object"):
            bpy.ops.handhold.close_hand()

    def test_dragged_hand_is_fitted_where_it_is_held(self) -> None:
        """The timer's function, called as the timer does; tests have no window in which Blender runs timers."""
        hand, gripped = self.gripping_hand()
        settings().live = True
        self.assertEqual(live.refused, "")
        self.assertTrue(bpy.app.timers.is_registered(live.tick))
        frame = grips.object_frame(gripped)
        points, triangles = gltf.triangles_of(gripped, bpy.context.evaluated_depsgraph_get())
        place(hand, gripped, NEAR)
        held = hand.matrix_world.copy()
        times_s = []
        for step in range(8):  # along the bar and about it, as a drag moves the object, and away at last
            far = 0.5 if step == 7 else 0.0
            hand.matrix_world = gltf.to_blender(frame) @ Matrix.Translation((0.01 * step, 0.0, far)) @ Matrix.Rotation(0.05 * step, 4, "X") \
                @ gltf.to_blender(frame).inverted() @ held
            bpy.context.view_layer.update()
            object_was = hand.matrix_world.copy()
            begin_s = time.perf_counter()
            self.assertEqual(live.tick(), live.EVERY_S)
            times_s.append(time.perf_counter() - begin_s)
            shown = {name: frame.inverted() @ pose for name, pose in hands.joints(hand).items()}
            wrist = frame.inverted() @ hands.tracked_wrist(hand)
            self.assertEqual(hand.matrix_world, object_was)  # Blender's drag owns it
            if far:
                self.assertLess((shown["wrist"].to_translation() - wrist.to_translation()).length, 1e-5)
                self.assertTrue(all(abs(bone.rotation_quaternion.angle) < 1e-6 for bone in hands.finger_bones(hand)))
            else:  # as the button closes it there, from a world of its own
                self.assertLess(furthest_m(shown, fitting.close_hand(points, triangles, wrist, "right").joints), 2e-4, step)
            self.assertFalse(live.follow(hand))  # it has not moved
        print(f"a fit while dragging: median {1000.0 * sorted(times_s)[len(times_s) // 2]:.0f} ms, longest {1000.0 * max(times_s):.0f} ms")
        place(hand, gripped, NEAR)
        live.tick()
        shown = hands.joints(hand)
        settings().live = False  # the object goes to the fitted wrist, and nothing that is seen moves
        self.assertFalse(bpy.app.timers.is_registered(live.tick))
        self.assertLess(furthest_m(shown, hands.joints(hand)), 1e-5)
        self.assertLess(furthest_m(shown, hands.joints_at(hand, hands.RELEASED)), 1e-5)
        self.assertLess((hands.tracked_wrist(hand).to_translation() - shown["wrist"].to_translation()).length, 1e-6)
        self.assertEqual(hand.pose.bones["wrist"].location.length, 0.0)

    def test_live_fit_says_what_is_missing_and_survives_deletions(self) -> None:
        settings().live = True
        self.assertFalse(settings().live)
        self.assertIn("choose the object", live.refused)
        self.gripping_hand()
        settings().side = "left"
        bpy.ops.handhold.add_hand()
        self.assertEqual(len(hands.hands()), 2)
        settings().live = True
        self.assertEqual(live.refused, "")
        bpy.data.objects.remove(settings().gripped)
        self.assertIsNone(live.tick())
        self.assertFalse(settings().live)
        self.assertFalse(bpy.app.timers.is_registered(live.tick))
        self.assertIsNone(live.tick())

    def test_live_fit_is_off_in_another_file_and_in_a_reopened_one(self) -> None:
        file = str(WORK / "live.blend")
        self.gripping_hand()
        settings().live = True
        bpy.ops.wm.save_as_mainfile(filepath=file)
        self.assertTrue(settings().live)  # saving does not end it
        bpy.ops.wm.open_mainfile(filepath=file)
        self.assertEqual(len(hands.hands()), 1)
        self.assertFalse(settings().live)
        self.assertFalse(bpy.app.timers.is_registered(live.tick))
        settings().live = True
        live.tick()
        self.assertEqual((settings().live, live.refused), (True, ""))
        bpy.ops.wm.read_homefile(use_empty=True)
        self.assertFalse(settings().live)

    def test_edited_grip_is_written_and_read_back_equal(self) -> None:
        hand, gripped = self.gripping_hand()
        for bone in hands.finger_bones(hand, "little")[1:4]:  # lifted by the artist
            bone.rotation_quaternion = (1.0, 0.0, 0.0, 0.0)
        knuckle = hand.pose.bones["ring-finger-phalanx-proximal"]  # spread
        metacarpal = knuckle.bone.parent.matrix_local.to_quaternion()
        up = (knuckle.bone.matrix_local.to_quaternion().inverted() @ metacarpal @ hands.axes_of(knuckle.parent).to_quaternion()) @ Vector((0.0, 0.0, 1.0))
        knuckle.rotation_quaternion = Quaternion(up, 0.15) @ knuckle.rotation_quaternion
        bpy.ops.handhold.key_pose()
        settings().finger = "index"
        bpy.ops.handhold.trigger_finger()
        settings().name, settings().priority, settings().snap_radius_m = "crank", 3, 0.05
        at = {frame: hands.joints_at(hand, frame) for frame in (hands.RELEASED, hands.PRESSED)}
        self.assertEqual(bpy.ops.handhold.write_grip(), {"FINISHED"})
        written = json.loads((WORK / "grip.json").read_text())
        self.assertEqual((written["name"], written["priority"]), ("crank", 3))
        self.assertEqual([name for name, posed in written["right"]["fingers"].items() if "pressed_curl_deg" in posed], ["index"])
        self.assertGreater(abs(written["right"]["fingers"]["ring"]["spread_deg"]), 3.0)
        for one in (hand, *hand.children_recursive):
            bpy.data.objects.remove(one)
        settings().name, settings().priority = "other", 0
        self.assertEqual(bpy.ops.handhold.read_grip(), {"FINISHED"})
        self.assertEqual((settings().name, settings().priority), ("crank", 3))
        again = hands.hands()[0]
        shown = {frame: hands.joints_at(again, frame) for frame in at}
        for frame, poses in at.items():  # turns that no hinge makes are lost
            self.assertLess(furthest_m(poses, shown[frame]), 2e-4, frame)
        bpy.ops.handhold.write_grip()
        bpy.ops.handhold.read_grip()
        for frame, poses in shown.items():
            self.assertLess(furthest_m(poses, hands.joints_at(again, frame)), 2e-6, frame)
        twice = json.loads((WORK / "grip.json").read_text())
        for finger, posed in written["right"]["fingers"].items():
            for name, angles in posed.items():
                np.testing.assert_allclose(twice["right"]["fingers"][finger][name], angles, atol=1e-3, err_msg=f"{finger} {name}")

    def test_refused_grips_keep_the_keys(self) -> None:
        hand, gripped = self.gripping_hand()
        bpy.ops.handhold.key_pose()
        settings().name = "crank"
        self.assertEqual(bpy.ops.handhold.write_grip(), {"FINISHED"})
        written = json.loads((WORK / "grip.json").read_text())
        curves = len(hand.animation_data.action.fcurves)
        self.assertGreater(curves, 20)
        bent = json.loads(json.dumps(written))
        next(iter(bent["right"]["fingers"].values()))["curl_deg"] = "much"
        for text in ("[]", "{", json.dumps({"name": "x"}), json.dumps({"right": written["right"]}), json.dumps({**written, "right": 3}), json.dumps(bent)):
            (WORK / "grip.json").write_text(text)
            with self.assertRaises(RuntimeError, msg=text):
                bpy.ops.handhold.read_grip()
            self.assertEqual(len(hand.animation_data.action.fcurves), curves, text)

    def test_refused_grips_of_two_hands_change_neither(self) -> None:
        hand, gripped = self.gripping_hand("left")
        bpy.ops.handhold.key_pose()
        settings().name, settings().mirror = "crank", "X"
        bpy.ops.handhold.mirror_hand()
        self.assertEqual(bpy.ops.handhold.write_grip(), {"FINISHED"})
        written = json.loads((WORK / "grip.json").read_text())
        both = hands.hands()
        self.assertEqual([side in written for side in fitting.SIDES], [True, True])
        place(hand, gripped, (0.0, 0.3, 0.0))  # a pose that the grip does not have

        def state():
            keys = {one[hands.SIDE]: [[tuple(key.co) for key in curve.keyframe_points] for curve in one.animation_data.action.fcurves] for one in both}
            return keys, {one[hands.SIDE]: hands.joints(one) for one in both}
        before = state()
        bent = json.loads(json.dumps(written))
        next(iter(bent[fitting.SIDES[1]]["fingers"].values()))["curl_deg"] = "much"
        empty, camera = bpy.data.objects.new("empty", None), bpy.data.objects.new("camera", bpy.data.cameras.new("camera"))
        for one in (empty, camera):
            bpy.context.collection.objects.link(one)
        for grip, of in ((bent, gripped), (written, empty), (written, camera)):
            (WORK / "grip.json").write_text(json.dumps(grip))
            settings().gripped = of
            with self.assertRaises(RuntimeError, msg=of.name):
                bpy.ops.handhold.read_grip()
            self.assertEqual(state(), before, of.name)
            self.assertEqual(hands.hands(), both, of.name)

    def test_trigger_is_previewed_by_finger_and_controller(self) -> None:
        hand, _ = self.gripping_hand()
        settings().finger = "index"
        bpy.ops.handhold.trigger_finger()
        tips = [hands.joints_at(hand, frame)["index-finger-tip"].to_translation() for frame in (hands.RELEASED, 6, hands.PRESSED)]
        whole = (tips[2] - tips[0]).length
        self.assertGreater(whole, 0.004)
        self.assertLess(abs((tips[1] - tips[0]).length / whole - 0.5), 0.05)
        tracked = next(one for one in hand.children if hands.CONTROLLER in one)
        moving = [one for one in tracked.children if one.animation_data]
        self.assertGreaterEqual(len(moving), 1)
        bpy.context.scene.frame_set(hands.RELEASED)
        before = [one.matrix_world.copy() for one in moving]
        bpy.context.scene.frame_set(hands.PRESSED)
        self.assertTrue(any((one.matrix_world - old).median_scale > 0 or one.matrix_world != old for one, old in zip(moving, before)))

    def test_mirrored_hand_is_the_one_that_the_game_mirrors(self) -> None:
        hand, gripped = self.gripping_hand()
        settings().finger, settings().mirror = "index", "X"
        bpy.ops.handhold.trigger_finger()
        bpy.ops.handhold.write_grip()
        alone = json.loads((WORK / "grip.json").read_text())
        self.assertEqual(alone["mirror"], "x")
        self.assertNotIn("left", alone)
        bpy.context.view_layer.objects.active = hand
        bpy.ops.handhold.mirror_hand()
        left = next(one for one in hands.hands() if one[hands.SIDE] == "left")
        shown = {frame: hands.joints_at(left, frame) for frame in (hands.RELEASED, hands.PRESSED)}
        grips.apply(*grips.poses(alone, gripped, "left"), left)  # by the program
        for frame, poses in shown.items():
            self.assertLess(furthest_m(poses, hands.joints_at(left, frame)), 2e-5, frame)
        bpy.ops.handhold.write_grip()
        both = json.loads((WORK / "grip.json").read_text())
        self.assertNotIn("mirror", both)
        np.testing.assert_allclose(both["left"]["fingers"]["index"]["pressed_curl_deg"], both["right"]["fingers"]["index"]["pressed_curl_deg"], atol=0.02)

    def test_scaled_and_mirrored_objects_keep_their_outer_side(self) -> None:
        gripped = bar((-1.0, 1.2, 0.9))
        points, triangles = gltf.triangles_of(gripped, bpy.context.evaluated_depsgraph_get())
        corners = points[triangles]
        volume = np.einsum("ij,ij->i", corners[:, 0], np.cross(corners[:, 1], corners[:, 2])).sum() / 6.0
        self.assertAlmostEqual(volume / (math.pi * BAR_RADIUS_M**2 * 0.3 * 1.2 * 0.9), 1.0, delta=0.03)

    def test_binding_takes_blenders_vectors_and_quaternions(self) -> None:
        pose = handhold.Pose(position=Vector((1.0, 2.0, 3.0)), rotation=Quaternion((0.5, 0.1, 0.2, 0.3)))
        self.assertEqual(pose.position, handhold.Vec3(1.0, 2.0, 3.0))
        np.testing.assert_allclose([getattr(pose.rotation, axis) for axis in "xyzw"], (0.1, 0.2, 0.3, 0.5), atol=1e-7)
        with handhold.World() as world:
            world.body_add(shape=world.shape_add_box(Vector((1.0, 2.0, 3.0))), pose=(Vector((0.0, 1.0, 0.0)), Quaternion()))
            self.assertEqual(world.bodies().size, 1)
            for wrong in (Vector((1.0, 2.0)), Vector((1.0, 2.0, 3.0, 4.0)), "123", b"123", 3.0):
                with self.assertRaises(TypeError, msg=repr(wrong)):
                    world.shape_add_box(wrong)

    def test_unknown_controller_says_what_the_program_says(self) -> None:
        settings().controllers = str(WORK / "absent.json")
        with self.assertRaisesRegex(RuntimeError, "absent.json"):
            bpy.ops.handhold.add_hand()


if __name__ == "__main__":
    done = unittest.main(argv=["authoring_test", *sys.argv[sys.argv.index("--") + 1:]], exit=False, verbosity=2)
    sys.exit(0 if done.result.wasSuccessful() else 1)
