#!/usr/bin/env python3
"""Installs the packages of packaging/engine_packages.py as their users would, without a network, and tries them.

usage: tests/packages/installed.py PACKAGES REFERENCE WORK [PROGRAM]
    PACKAGES: the folder with the packages; REFERENCE: folder with this machine's handhold-grip and handhold-wall; WORK: a folder of its own,
    emptied first; PROGRAM: the program handhold, which the Blender add-on runs

The wheel by pip in a virtual environment, Unity's package compiled against stand-ins of Unity's types and run by Mono, the add-on by Blender's own installer: each gets
the reference's state hashes, or closes a hand. Exit status 0: they do; a line "SKIPPED" says what could not be tried.
"""
import os
import shutil
import subprocess
import sys
import tarfile
from pathlib import Path

HERE = Path(__file__).resolve().parent
SOURCE = HERE.parent.parent
sys.path.insert(0, str(HERE.parent / "hosts"))
from run import run  # noqa: E402  (tests/hosts/run.py)

PYTHON = "/usr/bin/python3"
BLENDER = """
import bpy, math, sys
from mathutils import Matrix
assert bpy.ops.preferences.addon_install(filepath=sys.argv[-1]) == {"FINISHED"}
assert bpy.ops.preferences.addon_enable(module="handhold_authoring") == {"FINISHED"}
bpy.ops.mesh.primitive_cylinder_add(radius=0.018, depth=0.3)
bar = bpy.context.object
bar.data.transform(Matrix.Rotation(math.pi / 2, 4, "Y"))
settings = bpy.context.scene.handhold
settings.gripped = bar
bpy.ops.handhold.add_hand()
hand = bpy.context.object
from handhold_authoring import gltf, grips, hands
poses = hands.joints(hand)
move = grips.object_frame(bar) @ Matrix.Translation((0.0, 0.036, 0.085)) @ poses["wrist"].inverted()
hands.set_pose(hand, {name: move @ pose for name, pose in poses.items()})
assert bpy.ops.handhold.close_hand() == {"FINISHED"}
tip = hands.joints(hand)["middle-finger-tip"].to_translation()
away_m = math.hypot(tip.y, tip.z) - 0.018
assert 0.0 < away_m < 0.016, away_m
import handhold
assert "handhold_authoring" in handhold.__file__, handhold.__file__
print(f"TRIED a finger ends {1000.0 * away_m:.1f} mm from the bar")
"""


def skip(what: str) -> None:
    print(f"  SKIPPED: {what}")


def can(*command: str) -> bool:
    try:
        return subprocess.run(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, check=False).returncode == 0
    except OSError:
        return False


def one(folder: Path, pattern: str) -> Path:
    found = sorted(folder.glob(pattern))
    if len(found) != 1:
        raise SystemExit(f"{folder}: {len(found)} files {pattern}")
    return found[0]


def compare(how: str, said: str, expected: list[str]) -> None:
    if said.strip().splitlines() != expected:
        raise SystemExit(f"{how}: {said.strip()} instead of {expected}")
    print(f"  {how}: {expected}, as the native programs")


def try_wheel(packages: Path, expected: list[str], work: Path) -> None:
    if not can(PYTHON, "-c", "import numpy, venv, ensurepip"):
        skip("the wheel, without Debian's numpy and venv (tools/install_packages package)")
        return
    wheel = one(packages, "handhold-*-py3-none-manylinux*_x86_64.whl")
    # As docs/guide/in_your_engine.md says. Debian's pip installs nothing outside of a virtual environment.
    environment = {name: text for name, text in os.environ.items() if name not in ("HANDHOLD_LIBRARY", "LD_LIBRARY_PATH", "PYTHONPATH")}
    run(PYTHON, "-m", "venv", "--system-site-packages", work / "v", env=environment)
    run(work / "v/bin/pip", "install", "--no-index", wheel, env=environment)
    compare("wheel by pip", run(work / "v/bin/python", "-B", SOURCE / "tests/bindings/scenes.py", env=environment), expected)


def try_unity(packages: Path, expected: list[str], work: Path) -> None:
    with tarfile.open(one(packages, "io.handhold.unity-*.tgz")) as packed:
        packed.extractall(work / "unity")
    package = work / "unity/package"
    for name in ("package.json", "Runtime/Plugins/windows/handhold.dll", "Runtime/Plugins/linux/libhandhold.so.meta", "licenses/bullet.txt"):
        if not (package / name).is_file():
            raise SystemExit(f"Unity's package lacks {name}")
    if not shutil.which("mcs") or not shutil.which("mono"):
        skip("Unity's package, without Mono (tools/install_packages package)")
        return
    sources = sorted(package.rglob("*.cs"))
    run("mcs", "-unsafe", "-warnaserror", "-define:UNITY_5_3_OR_NEWER", f"-out:{work}/unity.exe", *sources,
        SOURCE / "tests/bindings/UnityStandIns.cs", SOURCE / "tests/bindings/UnityScene.cs")
    environment = dict(os.environ, LD_LIBRARY_PATH=str(package / "Runtime/Plugins/linux"))
    print(f"  Unity's package under Mono: {run('mono', work / 'unity.exe', env=environment).strip()}")
    binding = [source for source in sources if source.parent.name == "Runtime" and "UnityEngine" not in source.read_text(encoding="utf-8")]
    run("mcs", "-unsafe", f"-out:{work}/scenes.exe", *binding, SOURCE / "tests/bindings/Scenes.cs")
    compare("its binding", run("mono", work / "scenes.exe", env=environment), expected)


def try_blender(packages: Path, program: Path | None, work: Path) -> None:
    if program is None or not program.is_file() or not shutil.which("blender"):
        skip("the Blender add-on, without Blender (tools/install_packages package) or the program build/release/bin/handhold")
        return
    script = work / "install.py"
    script.write_text(BLENDER, encoding="utf-8")
    environment = dict(os.environ, HANDHOLD_PROGRAM=str(program.resolve()), BLENDER_USER_SCRIPTS=str(work / "scripts"), BLENDER_USER_CONFIG=str(work / "config"),
                       PATH=os.pathsep.join(["/usr/bin", os.environ.get("PATH", "")]))
    said = run("blender", "--background", "--factory-startup", "--python-exit-code", "1", "--python", script, "--",
               one(packages, "handhold_authoring-*.zip"), env=environment)
    print(f"  Blender add-on by Blender's installer: {said.partition('TRIED ')[2].splitlines()[0]}")


def main() -> int:
    if len(sys.argv) not in (4, 5):
        print(__doc__, file=sys.stderr)
        return 2
    packages, reference, work = (Path(word).resolve() for word in sys.argv[1:4])
    shutil.rmtree(work, ignore_errors=True)
    work.mkdir(parents=True)
    expected = [run(reference / f"handhold-{name}").partition(" step_us")[0].strip() for name in ("grip", "wall")]
    try_wheel(packages, expected, work)
    try_unity(packages, expected, work)
    try_blender(packages, Path(sys.argv[4]) if len(sys.argv) == 5 else None, work)
    return 0


if __name__ == "__main__":
    sys.exit(main())
