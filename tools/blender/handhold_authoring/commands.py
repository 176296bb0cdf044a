"""Handhold's command-line program: export-hands, export-grip and import-grip."""
import json
import os
import shutil
import subprocess
import tempfile
from pathlib import Path

import bpy

PACKAGE = __package__


class Refused(Exception):
    """What the program said."""


def preferences():
    return bpy.context.preferences.addons[PACKAGE].preferences if PACKAGE in bpy.context.preferences.addons else None


def program() -> str:
    """From the preferences, else HANDHOLD_PROGRAM, the file in this package, the search path."""
    given = preferences()
    beside = Path(__file__).with_name("handhold.exe" if os.name == "nt" else "handhold")
    found = (bpy.path.abspath(given.program) if given and given.program else "") or os.environ.get("HANDHOLD_PROGRAM") \
        or (str(beside) if beside.is_file() else None) or shutil.which("handhold")
    if not found:
        raise Refused("the program handhold is not there: in Handhold's sources, `cmake --preset release && cmake --build --preset release --target "
                      "handhold` builds build/release/bin/handhold; then name that file in the add-on's preferences")
    return found


def run(*words) -> str:
    """Runs it. Returns its standard output; what it says on standard error is raised, or printed if it succeeds."""
    done = subprocess.run([program(), *map(str, words)], capture_output=True, text=True, check=False)
    if done.returncode != 0:
        raise Refused((done.stderr or done.stdout).strip().splitlines()[-1] if (done.stderr or done.stdout).strip() else "handhold failed")
    return done.stdout


def export_hands(folder: Path, controllers: str) -> None:
    run("export-hands", "--out", folder, *(["--controllers", controllers] if controllers else []))


def import_grip(file: Path) -> dict:
    return json.loads(run("import-grip", file))


def export_grip(grip: dict, object_file: Path, side: str, out: Path) -> str:
    """The grip as the game shows it on the object, through a scene file with both. Returns what the program remarks."""
    with tempfile.TemporaryDirectory() as folder:
        scene = Path(folder) / "scene.json"
        shutil.copyfile(object_file, Path(folder) / "object.glb")
        body = {"name": "object", "kind": "static", "shape": {"type": "mesh", "file": "object.glb"}, "grips": [grip]}
        scene.write_text(json.dumps({"name": "grip", "bodies": [body]}), encoding="utf-8")
        done = subprocess.run([program(), "export-grip", "--scene", str(scene), "--body", "object", "--grip", grip["name"], "--hand", side,
                               "--out", str(out)], capture_output=True, text=True, check=False)
        if done.returncode != 0:
            raise Refused(done.stderr.strip() or "export-grip failed")
        return done.stderr.strip()
