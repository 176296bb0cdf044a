"""Draws the pictures of docs/guide/animators.md, with the add-on as an animator sees it.

Run inside Blender, with a window, by tools/blender/draw_pictures.
"""
import json
import subprocess
import sys
from pathlib import Path

import bpy
from mathutils import Matrix, Vector

SOURCE = Path(__file__).resolve().parent.parent.parent
sys.path[:0] = [str(SOURCE / "tools/blender"), str(SOURCE / "systems/host/bindings/python")]
sys.dont_write_bytecode = True
OUT, PROFILE = Path(sys.argv[sys.argv.index("--") + 1]), sys.argv[sys.argv.index("--") + 2]

from handhold_authoring import commands, gltf, grips, hands  # noqa: E402

SIZE = (768, 512)
TAB = ("1143", "255")  # where the tab is in the window that draw_pictures opens


def settings():
    return bpy.context.scene.handhold


def colour_by_material() -> None:
    """Workbench draws a material's viewport colour; Blender's importer sets the node's colour only."""
    for material in bpy.data.materials:
        if material.use_nodes and "Principled BSDF" in material.node_tree.nodes:
            colour = list(material.node_tree.nodes["Principled BSDF"].inputs["Base Color"].default_value)
            material.diffuse_color = [max(one, 0.03) for one in colour[:3]] + [1.0]
            material.roughness = 0.5


def look(eye, target, lens=50.0) -> None:
    camera = bpy.data.objects.get("eye") or bpy.data.objects.new("eye", bpy.data.cameras.new("eye"))
    if camera.name not in bpy.context.scene.collection.objects:
        bpy.context.scene.collection.objects.link(camera)
    camera.location = eye
    camera.rotation_euler = (Vector(target) - Vector(eye)).to_track_quat("-Z", "Y").to_euler()
    camera.data.lens, camera.data.clip_start = lens, 0.01
    bpy.context.scene.camera = camera


def render(name: str, frame: int = 1) -> None:
    scene = bpy.context.scene
    scene.frame_set(frame)
    colour_by_material()
    scene.render.engine = "BLENDER_WORKBENCH"
    scene.display.shading.light, scene.display.shading.color_type = "STUDIO", "MATERIAL"
    scene.display.shading.show_cavity, scene.display.shading.show_shadows = True, True
    scene.display.render_aa = "16"
    scene.world = scene.world or bpy.data.worlds.new("world")
    scene.display.shading.background_type, scene.display.shading.background_color = "VIEWPORT", (0.16, 0.17, 0.19)
    scene.render.resolution_x, scene.render.resolution_y = SIZE
    scene.render.film_transparent = False
    scene.render.filepath = str(OUT / f"{name}.png")
    bpy.ops.render.render(write_still=True)


def screenshot(name: str) -> None:
    bpy.ops.screen.screenshot(filepath=str(OUT / f"{name}.png"))


def import_gun() -> None:
    """The game's own gun, without the hand of its grip."""
    file = Path(bpy.app.tempdir) / "gun.glb"
    commands.run("export-grip", "--scene", "playground", "--body", "gun", "--grip", "handle", "--out", file)
    for one in gltf.import_file(file):
        if one.name.split(".")[0] == "object":
            settings().gripped = one
        elif one.parent is None or one.parent.name.split(".")[0] != "object":
            bpy.data.objects.remove(one)


def show_sidebar() -> None:
    for area in bpy.context.screen.areas:
        if area.type == "VIEW_3D":
            space = area.spaces[0]
            space.show_region_ui = True
            space.shading.type, space.shading.color_type = "SOLID", "MATERIAL"
            space.region_3d.view_perspective = "CAMERA"
            space.overlay.show_bones = False
            space.overlay.show_floor = space.overlay.show_cursor = False
            space.overlay.show_axis_x = space.overlay.show_axis_y = False


def steps():
    bpy.ops.preferences.addon_enable(module="handhold_authoring")
    for one in list(bpy.data.objects):
        bpy.data.objects.remove(one)
    import_gun()
    settings().file, settings().name = str(Path(bpy.app.tempdir) / "handle.json"), "handle"
    settings().controllers = PROFILE
    bpy.ops.handhold.add_hand()
    hand = bpy.context.object
    # As an animator places it by eye: beside the handle, its palm towards it.
    grip = json.loads((SOURCE / "game/assets/gun_grips.json").read_text(encoding="utf-8"))[0]
    away = gltf.pose_of([*grip["right"]["position_m"], *grip["right"]["rotation_xyzw"]]) @ Matrix.Translation((0.0, 0.03, 0.015))
    poses = hands.joints(hand)
    move = grips.object_frame(settings().gripped) @ away @ poses["wrist"].inverted()
    hands.set_pose(hand, {name: move @ pose for name, pose in poses.items()})
    hands.key(hand, hands.RELEASED)
    look((0.42, -0.28, 0.22), (0.0, 0.0, -0.01), 46.0)
    render("animators_1_placed")
    settings().shows_controllers = False
    bpy.ops.handhold.close_hand()
    render("animators_2_closed")
    Path(settings().file).write_text(json.dumps(grip), encoding="utf-8")
    bpy.ops.handhold.read_grip()  # its index finger is on the trigger
    look((0.30, -0.16, 0.06), (0.0, -0.02, -0.03), 55.0)
    render("animators_3_released", hands.RELEASED)
    render("animators_3_pressed", hands.PRESSED)
    bpy.context.scene.frame_set(hands.RELEASED)
    right, left = (next(one for one in hands.hands() if one[hands.SIDE] == side) for side in ("right", "left"))
    for part in right.children_recursive:
        part.hide_render = part.hide_viewport = True
    look((-0.42, -0.28, 0.22), (0.0, 0.0, -0.01), 46.0)
    render("animators_4_mirrored")
    for part in (left, *left.children_recursive):
        part.hide_viewport = True
    for part in right.children_recursive:
        part.hide_viewport = False
    settings().shows_controllers = True


def draw() -> None:
    """Called once by a timer, when the window is there."""
    try:
        steps()
        look((0.42, -0.28, 0.22), (0.0, 0.0, -0.01), 46.0)
        show_sidebar()
        bpy.app.timers.register(finish, first_interval=3.0)
    except BaseException:
        import traceback
        traceback.print_exc()
        bpy.ops.wm.quit_blender()


def finish() -> None:
    """Opens the add-on's tab, which Blender 3.4 lets only the mouse do, and takes the picture afterwards."""
    subprocess.Popen(["xdotool", "mousemove", *TAB, "sleep", "1.5", "click", "1", "sleep", "1.0", "mousemove", "300", "700"])
    bpy.app.timers.register(shoot, first_interval=8.0)


def shoot() -> None:
    screenshot("animators_sidebar")
    bpy.ops.wm.quit_blender()


bpy.context.preferences.view.show_splash = False
bpy.app.timers.register(draw, first_interval=1.0)
