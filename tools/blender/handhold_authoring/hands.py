"""Hands in a Blender scene: an armature whose bones are the joints of the runtime's hand.

Bones point along the fingers, as Blender's importer turns them. The property `handhold_axes` of a bone is the joint's frame in the bone's.
The object moves the hand as a whole; bones only rotate. Frame RELEASED has the pose with the trigger released, frame PRESSED that with it pressed.
"""
import math
import tempfile
from pathlib import Path

import bpy
from mathutils import Matrix, Quaternion

from . import commands, fitting, gltf

RELEASED, PRESSED = 1, 11
AXES = "handhold_axes"
SIDE = "handhold_side"
CONTROLLER = "handhold_controller"
FOLLOWS_DEG = 0.5  # a finger that turns more between the two frames follows the trigger
SQUEEZE_RAD = math.radians(12.0)  # first pressed pose of a trigger finger, for the artist to change
BONES_OF = {name: f"{'thumb' if name == 'thumb' else ('pinky' if name == 'little' else name) + '-finger'}-" for name in fitting.FINGERS}


def is_hand(one) -> bool:
    return one is not None and one.type == "ARMATURE" and SIDE in one


def hands() -> list:
    return [one for one in bpy.data.objects if is_hand(one) and one.users_scene]


def add(side: str, controllers: str = ""):
    """A hand of the runtime with the controller in it. `controllers`: a profile's file, or "builtin"; empty: none."""
    with tempfile.TemporaryDirectory() as folder:
        commands.export_hands(Path(folder), controllers)
        file = Path(folder) / f"robot_hand_{side}.glb"
        nodes = gltf.read_nodes(file)
        made = gltf.import_file(file)
    hand = next(one for one in made if one.type == "ARMATURE")
    hand.name = f"hand_{side}"
    hand[SIDE] = side
    hand.show_in_front = True
    for bone in hand.data.bones:
        axes = bone.matrix_local.inverted() @ gltf.to_blender(nodes[bone.name]["pose"])
        bone[AXES] = [number for row in axes for number in row]
    for bone in hand.pose.bones:
        bone.rotation_mode = "QUATERNION"
    set_pose(hand, {name: nodes[name]["pose"] for name in hand.data.bones.keys()})
    attach_controller(hand, [one for one in made if one.name.startswith("controller")], nodes)
    return hand


def attach_controller(hand, parts, nodes) -> None:
    """Joins the controller to the wrist: an empty at the tracked pose, the model below it, and keys of trigger and squeeze button."""
    tracked = next((one for one in parts if one.name.split(".")[0] == "controller"), None)
    if tracked is None:
        return
    bpy.context.view_layer.update()
    tracked.empty_display_type, tracked.empty_display_size = "ARROWS", 0.04
    tracked[CONTROLLER] = True
    place = tracked.matrix_world.copy()
    tracked.parent, tracked.parent_type, tracked.parent_bone = hand, "BONE", "wrist"
    bpy.context.view_layer.update()
    tracked.matrix_world = place
    for part in parts:
        if part == tracked or part.parent is not None:
            continue
        model = part.matrix_world.copy()
        part.parent = tracked
        part.matrix_parent_inverse = place.inverted()
        part.matrix_basis = model
        part.rotation_mode = "QUATERNION"
        extras = nodes[part.name.split(".")[0]]["extras"]
        if "pressed_trigger" in extras:
            pressed = model @ gltf.to_blender(gltf.pose_of(extras["pressed_trigger"]))
            for frame, at in ((RELEASED, model), (PRESSED, pressed)):
                part.location, part.rotation_quaternion = at.to_translation(), at.to_quaternion()
                part.keyframe_insert("location", frame=frame)
                part.keyframe_insert("rotation_quaternion", frame=frame)
            part.location, part.rotation_quaternion = model.to_translation(), model.to_quaternion()
            make_linear(part)


def show_controllers(shows: bool) -> None:
    for hand in hands():
        for tracked in (one for one in hand.children if CONTROLLER in one):
            for part in (tracked, *tracked.children_recursive):
                part.hide_viewport = part.hide_render = not shows


def make_linear(one) -> None:
    for curve in one.animation_data.action.fcurves:
        for key in curve.keyframe_points:
            key.interpolation = "LINEAR"


def axes_of(bone) -> Matrix:
    numbers = list(bone.bone[AXES])
    return Matrix([numbers[row:row + 4] for row in range(0, 16, 4)])


def joints(hand) -> dict:
    """Poses of the joints in the scene, by name, in glTF's axes, at the current frame."""
    bpy.context.view_layer.update()
    world = gltf.rigid(hand.matrix_world)
    return {bone.name: gltf.to_gltf(gltf.rigid(world @ bone.matrix @ axes_of(bone))) for bone in hand.pose.bones if AXES in bone.bone}


def joints_at(hand, frame: int) -> dict:
    scene = bpy.context.scene
    before = scene.frame_current
    scene.frame_set(frame)
    found = joints(hand)
    scene.frame_set(before)
    return found


def is_fixed(name: str) -> bool:
    """Joints of the palm, whose place no grip changes."""
    return name == "wrist" or name.endswith("finger-metacarpal")


def set_pose(hand, wanted: dict, moves_object: bool = True) -> None:
    """Places the hand and turns its bones so that the joints get these poses (in the scene, glTF's axes). Where they lie follows from the bones.
    Without `moves_object` the object stays where the artist holds it, and the bone of the wrist moves from it.
    Key the pose before the next update of the scene, which takes keyed bones back to their keys."""
    wrist = hand.pose.bones["wrist"]
    bone_wrist = gltf.to_blender(wanted["wrist"]) @ axes_of(wrist).inverted()
    if moves_object:
        hand.matrix_world = bone_wrist @ wrist.bone.matrix_local.inverted()
    posed = {}
    to_hand = hand.matrix_world.inverted()
    for bone in hand.pose.bones:  # parents first
        rest = bone.bone.matrix_local
        local = bone.parent.bone.matrix_local.inverted() @ rest if bone.parent else rest
        above = posed[bone.parent.name] @ local if bone.parent else local
        bone.location, bone.rotation_quaternion, bone.scale = (0.0, 0.0, 0.0), Quaternion(), (1.0, 1.0, 1.0)
        if bone == wrist and not moves_object:
            bone.location, bone.rotation_quaternion, _ = (above.inverted() @ to_hand @ bone_wrist).decompose()
        elif not is_fixed(bone.name) and bone.name in wanted:
            goal = to_hand @ gltf.to_blender(wanted[bone.name]) @ axes_of(bone).inverted()
            bone.rotation_quaternion = (above.inverted() @ goal).to_quaternion()
        posed[bone.name] = above @ Matrix.Translation(bone.location) @ bone.rotation_quaternion.to_matrix().to_4x4()


def open_hand(hand) -> None:
    """The hand as it is without anything to grip, where its object is."""
    for bone in hand.pose.bones:
        bone.location, bone.rotation_quaternion = (0.0, 0.0, 0.0), Quaternion()


def tracked_wrist(hand) -> Matrix:
    """Where the artist holds the wrist, in the scene and glTF's axes, wherever its bone has moved from there."""
    wrist = hand.pose.bones["wrist"]
    return gltf.to_gltf(gltf.rigid(hand.matrix_world @ wrist.bone.matrix_local @ axes_of(wrist)))


def finger_bones(hand, finger: str = "") -> list:
    return [bone for bone in hand.pose.bones if bone.name.startswith(BONES_OF[finger] if finger else tuple(BONES_OF.values()))]


def key(hand, frame: int, finger: str = "") -> None:
    for bone in finger_bones(hand, finger):
        bone.keyframe_insert("rotation_quaternion", frame=frame)
    make_linear(hand)


def clear_keys(hand) -> None:
    hand.animation_data_clear()


def squeeze(hand, finger: str) -> None:
    """Bends the finger's last two links towards the palm from the released pose and keys that as its pressed pose."""
    scene = bpy.context.scene
    scene.frame_set(RELEASED)
    key(hand, RELEASED, finger)
    links = [bone for bone in finger_bones(hand, finger) if not bone.name.endswith(("-tip", "-metacarpal"))][-2:]
    for bone in links:
        axes = axes_of(bone).to_quaternion()
        bend = axes @ Quaternion((1.0, 0.0, 0.0), -SQUEEZE_RAD) @ axes.inverted()  # -Z of the joint towards its -Y, the palm
        bone.rotation_quaternion = bone.rotation_quaternion @ bend
    key(hand, PRESSED, finger)
    scene.frame_set(PRESSED)


def mirrored(poses: dict, frame: Matrix, axis: str) -> dict:
    """Poses of the other hand: the mirror image across the plane through the object's origin with that normal, in the object's frame (glTF's)."""
    plane = Matrix.Identity(4)
    plane["xyz".index(axis)]["xyz".index(axis)] = -1.0
    own = Matrix.Diagonal((-1.0, 1.0, 1.0, 1.0))  # a left joint's +X is a right one's -X, mirrored
    return {name: frame @ plane @ frame.inverted() @ pose @ own for name, pose in poses.items()}


def wrist_in_controller(hand, tracked) -> list:
    """The wrist in the tracked pose's frame: position and quaternion x, y, z, w."""
    bpy.context.view_layer.update()
    return gltf.numbers_of(gltf.to_gltf(gltf.rigid(tracked.matrix_world)).inverted() @ joints(hand)["wrist"])
