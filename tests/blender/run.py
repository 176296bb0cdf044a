#!/usr/bin/env python3
"""Tests the Blender add-on (tools/blender) in Blender without a window.

usage: tests/blender/run.py BUILD [test names]     BUILD: a build folder with bin/handhold and libhandhold.so
Exit status 0: they pass, 77: Blender or its numpy is missing
"""
import os
import shutil
import subprocess
import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent
SOURCE = HERE.parent.parent


def main() -> int:
    if len(sys.argv) < 2:
        print(__doc__, file=sys.stderr)
        return 2
    build = Path(sys.argv[1]).resolve()
    if shutil.which("blender") is None:
        print("skipped: Blender is missing (tools/install_packages blender)")
        return 77
    needed = [build / "bin/handhold", build / "libhandhold.so"]
    if absent := [str(one) for one in needed if not one.exists()]:
        print(f"not built: {', '.join(absent)}", file=sys.stderr)
        return 1
    # Blender's Python takes the folder of its modules from the first python3 of the search path: Debian's, which has numpy.
    environment = dict(os.environ, HANDHOLD_PROGRAM=str(needed[0]), HANDHOLD_LIBRARY=str(needed[1]),
                       PATH=os.pathsep.join(["/usr/bin", os.environ.get("PATH", "")]))
    command = ["blender", "--background", "--factory-startup", "--python-exit-code", "1", "--python", str(HERE / "authoring_test.py"),
               "--", *sys.argv[2:]]
    return subprocess.run(command, env=environment, check=False).returncode


if __name__ == "__main__":
    sys.exit(main())
