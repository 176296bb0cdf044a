#!/usr/bin/env python3
"""Installs the runtime library of a build and builds and runs this folder's project against it, and nothing else.

usage: tests/consumer/run.py BUILD WORK     BUILD: a build of the library; WORK: a folder of its own, emptied first
Exit status 0: every header that is installed finds what it includes, and the project runs.
"""
import re
import shutil
import subprocess
import sys
from pathlib import Path

INCLUDE = re.compile(r'^\s*#\s*include\s*([<"])([^>"]+)[>"]', re.MULTILINE)
# Beside the standard library, whose headers have neither folder nor ending; compilers for x86 bring emmintrin.h and xmmintrin.h.
LIBRARIES = re.compile(r"Eigen/\w+|[a-z_]+|std(bool|def|int)\.h|nlohmann/json_fwd\.hpp|[ex]mmintrin\.h")


def lost_includes(root: Path) -> list[str]:
    """What installed headers include that is neither installed nor one of the library's own dependencies."""
    lost = []
    for header in sorted([*root.rglob("*.hpp"), *root.rglob("*.h")]):
        for mark, path in INCLUDE.findall(header.read_text(encoding="utf-8")):
            is_ours = path.startswith("handhold/")
            found = (root / path).is_file() if is_ours else mark == "<" and LIBRARIES.fullmatch(path)
            if not found:
                lost.append(f"{header.relative_to(root)} includes {path}, which is not installed")
    return lost


def run(*command) -> None:
    subprocess.run([str(word) for word in command], check=True)


def main() -> int:
    if len(sys.argv) != 3:
        print(__doc__, file=sys.stderr)
        return 2
    build, work = Path(sys.argv[1]).resolve(), Path(sys.argv[2]).resolve()
    shutil.rmtree(work, ignore_errors=True)
    prefix = work / "prefix"
    for component in ("runtime", "dev"):
        run("cmake", "--install", build, "--prefix", prefix, "--component", component)
    lost = lost_includes(prefix / "include")
    if lost:
        print("\n".join(lost), file=sys.stderr)
        return 1
    here = Path(__file__).resolve().parent
    run("cmake", "-S", here, "-B", work / "build", f"-DCMAKE_PREFIX_PATH={prefix}", "-DCMAKE_BUILD_TYPE=Release",
        "-DCMAKE_CXX_FLAGS=-Wall -Wextra -Werror")
    run("cmake", "--build", work / "build")
    run(work / "build" / "push_off")
    return 0


if __name__ == "__main__":
    sys.exit(main())
