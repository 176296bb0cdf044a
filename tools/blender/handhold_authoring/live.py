"""The fit while the artist drags a hand: a timer asks where each hand is and closes it there again."""
import bpy
from bpy.app.handlers import persistent

from . import fitting, grips, hands

EVERY_S = 0.02
STILL_M = 1e-5  # less is no move

refused = ""  # why it could not begin, for the sidebar
_closers: dict = {}  # by side: the gripped object, and the world with it
_seen: dict = {}  # by hand: the wrist in the object's frame at the last fit


def is_on() -> bool:
    """Kept here and not in the scene, whose properties are saved with the file and come back with an undo."""
    return bool(_closers)


def begin(gripped) -> None:
    """Prepares the object. Called again when it was changed."""
    points, triangles = grips.gltf.triangles_of(gripped, bpy.context.evaluated_depsgraph_get())
    _seen.clear()
    _closers.update({side: (gripped, fitting.Closer(points, triangles, side)) for side in fitting.SIDES})
    if not bpy.app.timers.is_registered(tick):
        bpy.app.timers.register(tick)


def end() -> None:
    """Hands stay as they are shown: their objects go to the fitted wrists."""
    if bpy.app.timers.is_registered(tick):
        bpy.app.timers.unregister(tick)
    for hand in hands.hands() if _closers else ():
        hands.set_pose(hand, hands.joints(hand))
        hands.key(hand, hands.RELEASED)
    _closers.clear()
    _seen.clear()


@persistent
def leave_file(_file) -> None:
    """Blender's handler before it opens another file."""
    global refused
    end()
    refused = ""


def tick():
    """Fits the hands that have moved. Returns the time until the next call, as Blender's timers want it, or None: no more."""
    if bpy.context.scene.frame_current == hands.RELEASED and bpy.context.mode != "POSE":  # there the artist turns single bones
        for hand in hands.hands():
            if is_on():  # the hand before it has not found the object deleted
                follow(hand)
    return EVERY_S if is_on() else None


def follow(hand) -> bool:
    """Closes the hand where the artist holds it, or opens it if nothing is in reach. False: it has not moved."""
    gripped, closer = _closers[hand[hands.SIDE]]
    try:
        frame = grips.object_frame(gripped)
        wrist = frame.inverted() @ hands.tracked_wrist(hand)
    except ReferenceError:  # the object was deleted
        end()
        return False
    before = _seen.get(hand.name)
    if before is not None and max(abs(a - b) for row, old in zip(wrist, before) for a, b in zip(row, old)) < STILL_M:
        return False
    _seen[hand.name] = wrist
    try:
        fit = closer.close(wrist)
        hands.set_pose(hand, {name: frame @ pose for name, pose in fit.joints.items()}, moves_object=False)
    except fitting.NothingToGrip:
        hands.open_hand(hand)
    hands.key(hand, hands.RELEASED)
    return True
