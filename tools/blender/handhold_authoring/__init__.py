"""Blender add-on: authored grips with Handhold's own hands, controllers and fit. Guide: docs/guide/animators.md. Talk rows 9 and 10."""

bl_info = {
    "name": "Handhold grips",
    "author": "Handhold",
    "version": (0, 2, 0),
    "blender": (3, 4, 0),
    "location": "3D View > Sidebar > Handhold",
    "description": "Pose hands on objects as the game fits them, and write authored grips",
    "category": "Animation",
}

from . import operators, panel  # noqa: E402


def register() -> None:
    operators.register()
    panel.register()


def unregister() -> None:
    panel.unregister()
    operators.unregister()
