"""What the buttons of the sidebar do."""
import json
from pathlib import Path

import bpy

from . import commands, fitting, grips, hands, live

SIDE_ITEMS = [("right", "Right", "The right hand"), ("left", "Left", "The left hand")]


class Preferences(bpy.types.AddonPreferences):
    bl_idname = commands.PACKAGE

    program: bpy.props.StringProperty(name="Program", subtype="FILE_PATH", description="The program handhold; empty: HANDHOLD_PROGRAM, or the search path")
    binding: bpy.props.StringProperty(name="Python binding", subtype="DIR_PATH", description="The folder with the package handhold; empty: this archive's, else Python's own path")
    library: bpy.props.StringProperty(name="Library", subtype="FILE_PATH", description="The shared library; empty: HANDHOLD_LIBRARY, or the system's")

    def draw(self, _context) -> None:
        for name in ("program", "binding", "library"):
            self.layout.prop(self, name)


def switch_live(settings, on: bool) -> None:
    """Called when the artist switches the live fit. What it cannot do is shown in the sidebar."""
    live.end()
    live.refused = ""
    if not on:
        return
    try:
        if settings.gripped is None:
            raise ValueError("choose the object that is gripped")
        add_binding_to_path()
        bpy.context.scene.frame_set(hands.RELEASED)
        live.begin(settings.gripped)
    except (ImportError, OSError, ValueError) as error:
        live.refused = NO_BINDING.format(error) if isinstance(error, ImportError) else str(error)


NO_BINDING = "the Python binding or its library is not there, name them in the add-on's preferences: {}"


class Settings(bpy.types.PropertyGroup):
    name: bpy.props.StringProperty(name="Name", default="grip", description="The grip's name, unique among those of the object")
    gripped: bpy.props.PointerProperty(name="Object", type=bpy.types.Object, description="What the hand grips. Its origin is the body's frame")
    side: bpy.props.EnumProperty(name="Hand", items=SIDE_ITEMS)
    live: bpy.props.BoolProperty(name="Close While Dragging", get=lambda _: live.is_on(), set=switch_live,
                                 description="The runtime fits the hand again whenever you move it, or the object. Switched off, the hand stays as it is shown")
    controllers: bpy.props.StringProperty(name="Controller", subtype="FILE_PATH", description="A profile (.json) of a real controller; empty: a plain wand")
    shows_controllers: bpy.props.BoolProperty(name="Show Controllers", default=True, update=lambda self, _: hands.show_controllers(self.shows_controllers))
    finger: bpy.props.EnumProperty(name="Finger", items=[(name, name.title(), "") for name in fitting.FINGERS], default="index")
    mirror: bpy.props.EnumProperty(name="Mirror", items=[("NONE", "None", "The other hand has no grip"),
                                                         *((axis, axis, f"Across the plane through the object's origin with the normal {axis} (glTF's axes: Y is up)")
                                                           for axis in "XYZ")])
    priority: bpy.props.IntProperty(name="Priority", min=-100, max=100, description="Of several grips in reach, the highest is taken")
    snap_radius_m: bpy.props.FloatProperty(name="Snap radius", default=0.08, min=0.001, max=1.0, subtype="DISTANCE", unit="LENGTH")
    snap_angle_deg: bpy.props.FloatProperty(name="Snap angle", default=60.0, min=1.0, max=180.0)
    file: bpy.props.StringProperty(name="File", subtype="FILE_PATH", default="//grip.json", description="The grip as JSON, for a scene file's \"grips\"")


def add_binding_to_path() -> None:
    import os
    import sys
    given = commands.preferences()
    inside = Path(__file__).with_name("binding")  # in the archive of tools/package
    folder = bpy.path.abspath(given.binding) if given and given.binding else str(inside) if inside.is_dir() else ""
    if folder and folder not in sys.path:
        sys.path.insert(0, folder)
    if given and given.library:
        os.environ["HANDHOLD_LIBRARY"] = bpy.path.abspath(given.library)


def active_hand(context):
    """The active hand, also by one of its parts; else the only one there is."""
    gripped = context.object
    while gripped is not None and not hands.is_hand(gripped):
        gripped = gripped.parent
    all_hands = hands.hands()
    return gripped or (all_hands[0] if len(all_hands) == 1 else None)


class Operator(bpy.types.Operator):
    """An operator that reports what the program, the library or a file refuses, instead of failing with a traceback."""
    bl_options = {"REGISTER", "UNDO"}
    needs_hand, needs_object = True, True

    def execute(self, context):
        settings = context.scene.handhold
        hand = active_hand(context)
        try:
            if self.needs_hand and hand is None:
                raise ValueError("choose a hand: its armature. Add Hand makes one")
            if self.needs_object and settings.gripped is None:
                raise ValueError("choose the object that is gripped")
            if self.needs_object and hands.is_hand(settings.gripped):
                raise ValueError("the object that is gripped is a hand: choose another")
            add_binding_to_path()
            said = self.work(context, settings, hand)
        except ImportError as error:
            self.report({"ERROR"}, NO_BINDING.format(error))
            return {"CANCELLED"}
        except (commands.Refused, fitting.NothingToGrip, ValueError, OSError) as error:
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}
        if said:
            self.report({"INFO"}, said)
        return {"FINISHED"}


def new_hand(settings, side: str):
    made = hands.add(side, bpy.path.abspath(settings.controllers) if settings.controllers else "builtin")
    hands.show_controllers(settings.shows_controllers)
    return made


class AddHand(Operator):
    """Adds the game's hand, with its controller, at the 3D cursor"""
    bl_idname, bl_label = "handhold.add_hand", "Add Hand"
    needs_hand, needs_object = False, False

    def work(self, context, settings, _hand):
        made = new_hand(settings, settings.side)
        made.location = context.scene.cursor.location
        hands.key(made, hands.RELEASED)
        select(context, made)


class CloseHand(Operator):
    """Closes the hand here, as the game does: the wrist moves to the surface and fingers close on it. Keys the released pose"""
    bl_idname, bl_label = "handhold.close_hand", "Close the Hand Here"

    def work(self, context, settings, hand):
        context.scene.frame_set(hands.RELEASED)
        fit = fit_here(context, settings.gripped, hand)
        hands.key(hand, hands.RELEASED)
        return f"the wrist moved by {1000.0 * fit.moved_m:.1f} mm"


def fit_here(context, gripped, hand):
    frame = grips.object_frame(gripped)
    points, triangles = grips.gltf.triangles_of(gripped, context.evaluated_depsgraph_get())
    fit = fitting.close_hand(points, triangles, frame.inverted() @ hands.joints(hand)["wrist"], hand[hands.SIDE])
    hands.set_pose(hand, {name: frame @ pose for name, pose in fit.joints.items()})
    return fit


class TriggerFinger(Operator):
    """Bends the finger a little and keys that as its pose with the trigger pressed. Change it at that frame; scrub to preview"""
    bl_idname, bl_label = "handhold.trigger_finger", "Follow the Trigger"
    needs_object = False

    def work(self, _context, settings, hand):
        hands.squeeze(hand, settings.finger)


class KeyPose(Operator):
    """Keys all fingers at this frame"""
    bl_idname, bl_label = "handhold.key_pose", "Key Fingers"
    needs_object = False

    def work(self, context, _settings, hand):
        if context.scene.frame_current not in (hands.RELEASED, hands.PRESSED):
            raise ValueError(f"go to frame {hands.RELEASED} (released) or {hands.PRESSED} (pressed)")
        hands.key(hand, context.scene.frame_current)


class MirrorHand(Operator):
    """Adds the other hand as this one's mirror image, to be edited on its own"""
    bl_idname, bl_label = "handhold.mirror_hand", "Mirror to the Other Hand"

    def work(self, context, settings, hand):
        if settings.mirror == "NONE":
            raise ValueError("choose the mirror's axis")
        side = fitting.SIDES[1 - fitting.SIDES.index(hand[hands.SIDE])]
        frame = grips.object_frame(settings.gripped)
        poses = {at: hands.mirrored(hands.joints_at(hand, at), frame, settings.mirror.lower()) for at in (hands.RELEASED, hands.PRESSED)}
        other = next((one for one in hands.hands() if one[hands.SIDE] == side), None)
        if other is None:
            other = new_hand(settings, side)
        hands.clear_keys(other)
        for at in (hands.PRESSED, hands.RELEASED):
            hands.set_pose(other, poses[at])
            hands.key(other, at)
        context.scene.frame_set(hands.RELEASED)
        select(context, other)


class WriteGrip(Operator):
    """Writes the grip of the hands in the scene, and says what the game would show differently"""
    bl_idname, bl_label = "handhold.write_grip", "Write Grip"

    def work(self, context, settings, hand):
        if not settings.name:
            raise ValueError("the grip needs a name")
        others = [one for one in hands.hands() if one[hands.SIDE] != hand[hands.SIDE]]
        grip = grips.write([hand, *others[:1]], settings.gripped, settings)
        file = Path(bpy.path.abspath(settings.file))
        file.write_text(json.dumps(grip, indent=1) + "\n", encoding="utf-8")
        return f"{file.name}: {grips.remarks(grip, settings.gripped, hand[hands.SIDE]) or 'every finger is shown as posed'}"


def read_file(file: Path) -> dict:
    """A grip as Write Grip writes it. Says what the file lacks."""
    try:
        grip = json.loads(file.read_text(encoding="utf-8"))
    except ValueError as error:
        raise ValueError(f"{file.name}: expected JSON: {error}") from error
    sides = [side for side in fitting.SIDES if isinstance(grip, dict) and isinstance(grip.get(side), dict)]
    if not sides or not isinstance(grip.get("name"), str) or (len(sides) == 1 and any(side in grip and side not in sides for side in fitting.SIDES)):
        raise ValueError(f"{file.name}: expected a grip: an object with \"name\" and \"left\" or \"right\"")
    return grip


class ReadGrip(Operator):
    """Reads a grip, poses its hands on the object, and says what the game would show differently"""
    bl_idname, bl_label = "handhold.read_grip", "Read Grip"
    needs_hand = False

    def work(self, context, settings, _hand):
        grip = read_file(Path(bpy.path.abspath(settings.file)))
        sides = [side for side in fitting.SIDES if side in grip or "mirror" in grip]
        # All sides are read before a key is lost.
        read = [grips.poses(grip, settings.gripped, side) for side in sides]
        said = [grips.remarks(grip, settings.gripped, side) for side in sides]
        found = [next((one for one in hands.hands() if one[hands.SIDE] == side), None) or new_hand(settings, side) for side in sides]
        for hand, (poses, moving) in zip(found, read):
            grips.apply(poses, moving, hand)
            select(context, hand)
        settings.name, settings.priority = grip["name"], grip.get("priority", 0)
        settings.snap_radius_m, settings.snap_angle_deg = grip.get("snap_radius_m", 0.08), grip.get("snap_angle_deg", 60.0)
        settings.mirror = grip.get("mirror", "none").upper()
        return "; ".join(filter(None, said))


class CopyJoint(Operator):
    """Copies the joint between controller and hand, as moved in the scene, for a controller's profile: "hand" """
    bl_idname, bl_label = "handhold.copy_joint", "Copy Controller Joint"
    needs_object = False

    def work(self, context, _settings, hand):
        tracked = next((one for one in hand.children if hands.CONTROLLER in one), None)
        if tracked is None:
            raise ValueError("this hand has no controller")
        x, y, z, *turn = hands.wrist_in_controller(hand, tracked)
        context.window_manager.clipboard = json.dumps({"hand": {"position_m": [x, y, z], "rotation_xyzw": turn}})
        return "copied"


def select(context, gripped) -> None:
    for one in context.selected_objects:
        one.select_set(False)
    gripped.select_set(True)
    context.view_layer.objects.active = gripped


CLASSES = (Preferences, Settings, AddHand, CloseHand, TriggerFinger, KeyPose, MirrorHand, WriteGrip, ReadGrip, CopyJoint)


def register() -> None:
    for one in CLASSES:
        bpy.utils.register_class(one)
    bpy.types.Scene.handhold = bpy.props.PointerProperty(type=Settings)
    bpy.app.handlers.load_pre.append(live.leave_file)


def unregister() -> None:
    live.end()
    if live.leave_file in bpy.app.handlers.load_pre:
        bpy.app.handlers.load_pre.remove(live.leave_file)
    del bpy.types.Scene.handhold
    for one in reversed(CLASSES):
        bpy.utils.unregister_class(one)
