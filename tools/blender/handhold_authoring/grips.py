"""Authored grips: written from hands on an object, and read back."""
import json
import tempfile
from pathlib import Path

import bpy
import numpy as np
from mathutils import Matrix

from . import commands, fitting, gltf, hands

SIDEWAYS = ("opposition_deg", "spread_deg")  # of the thumb, of a finger


def object_frame(gripped):
    """The object's frame in the scene, in glTF's axes, without scale: where its origin is."""
    return gltf.to_gltf(gltf.rigid(gripped.matrix_world))


def hand_nodes(hand, gripped, name: str, frame: int, extras: dict) -> dict:
    side = hand[hands.SIDE]
    nodes = {f"grip/{name}/{side}": {"pose": Matrix.Identity(4)}, "object": {"pose": object_frame(gripped)}}
    for joint, pose in hands.joints_at(hand, frame).items():
        nodes[joint] = {"pose": pose, "extras": extras if joint == "wrist" else {}}
    return nodes


def angles(hand, gripped, name: str, frame: int, extras: dict) -> dict:
    """One hand's grip as the program reads it: hinge angles within the hand's limits."""
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "grip.gltf"
        gltf.write_nodes(file, hand_nodes(hand, gripped, name, frame, extras))
        return commands.import_grip(file)


def read_hand(hand, gripped, settings) -> dict:
    """A grip with this hand alone: the released pose, and pressed poses of the fingers that turn until frame PRESSED."""
    extras = {"grip_priority": [settings.priority], "grip_snap_radius_m": [settings.snap_radius_m], "grip_snap_angle_deg": [settings.snap_angle_deg]}
    side = hand[hands.SIDE]
    released = angles(hand, gripped, settings.name, hands.RELEASED, extras)
    pressed = angles(hand, gripped, settings.name, hands.PRESSED, extras)[side]["fingers"]
    for finger, posed in released[side]["fingers"].items():
        after = pressed[finger]
        turns = [abs(a - b) for a, b in zip(posed["curl_deg"], after["curl_deg"])]
        turns += [abs(posed.get(way, 0.0) - after.get(way, 0.0)) for way in SIDEWAYS]
        if max(turns) > hands.FOLLOWS_DEG:
            posed.update({f"pressed_{name}": angle for name, angle in after.items()})
    return released


def write(of_hands: list, gripped, settings) -> dict:
    """The grip of one hand, or of one of each side. A mirror in the settings stands for the hand that is not there."""
    made = read_hand(of_hands[0], gripped, settings)
    for other in of_hands[1:]:
        made[other[hands.SIDE]] = read_hand(other, gripped, settings)[other[hands.SIDE]]
    if len(of_hands) == 1 and settings.mirror != "NONE":
        made["mirror"] = settings.mirror.lower()
    return made


# A triangle out of every finger's reach. On it a grip is shown exactly as it is written: nothing penetrates.
FAR = (np.array([(0.0, 100.0, 0.0), (0.0, 100.0, 1.0), (1.0, 100.0, 0.0)], dtype=np.float32), np.array([(0, 1, 2)], dtype=np.uint32))


def poses(grip: dict, gripped, side: str) -> tuple:
    """Released and pressed poses of the side's joints on the object by frame, and the fingers that follow the trigger. Changes nothing."""
    frame = object_frame(gripped)

    def joints_of(shown: dict) -> dict:
        with tempfile.TemporaryDirectory() as folder:
            file, out = Path(folder) / "object.glb", Path(folder) / "grip.glb"
            gltf.write_triangles(file, *FAR)
            commands.export_grip(shown, file, side, out)
            return {name: frame @ node["pose"] for name, node in gltf.read_nodes(out).items()}

    pressed, moving = pressed_grip(grip, side)
    made = {hands.RELEASED: joints_of(grip)}
    if moving:
        made[hands.PRESSED] = joints_of(pressed)
    return made, moving


def apply(made: dict, moving: list, hand) -> None:
    """Replaces the hand's keys by these poses."""
    of_hand = {frame: {name: pose for name, pose in joints.items() if name in hand.data.bones} for frame, joints in made.items()}
    hands.clear_keys(hand)
    if moving:
        hands.set_pose(hand, of_hand[hands.PRESSED])
        for finger in moving:
            hands.key(hand, hands.PRESSED, finger)
    hands.set_pose(hand, of_hand[hands.RELEASED])
    hands.key(hand, hands.RELEASED)
    bpy.context.scene.frame_set(hands.RELEASED)


def remarks(grip: dict, gripped, side: str) -> str:
    """What the program says about the grip on the object: the number of fingers that would penetrate and are fitted instead."""
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "object.glb"
        gltf.write_triangles(file, *gltf.triangles_of(gripped, bpy.context.evaluated_depsgraph_get()))
        return commands.export_grip(grip, file, side, Path(folder) / "grip.glb")


def pressed_grip(grip: dict, side: str) -> tuple:
    """The grip whose released angles are the pressed ones, and the names of the fingers that follow the trigger."""
    made = json.loads(json.dumps(grip))
    own = made.get(side) or made[fitting.SIDES[1 - fitting.SIDES.index(side)]]
    if not isinstance(own.get("fingers"), dict):
        return made, []
    moving = [finger for finger, posed in own["fingers"].items() if "pressed_curl_deg" in posed]
    for finger in moving:
        posed = own["fingers"][finger]
        own["fingers"][finger] = {name.removeprefix("pressed_"): angle for name, angle in posed.items() if name.startswith("pressed_")}
    return made, moving
