#!/usr/bin/env python3
"""Makes a package of a binding in a folder.

usage: packaging/assemble.py unity|python FOLDER [--library FILE]
    --library: the shared library to put inside, such as build/library/libhandhold.so; the user's installed one is found without it (Python)
"""
import shutil
import sys
from pathlib import Path

SOURCE = Path(__file__).resolve().parent.parent
BINDINGS = SOURCE / "systems/host/bindings"


def copy(source: Path, target: Path) -> None:
    target.parent.mkdir(parents=True, exist_ok=True)
    shutil.copyfile(source, target)


def main() -> int:
    words = sys.argv[1:]
    library = Path(words.pop(words.index("--library") + 1)) if "--library" in words else None
    words = [word for word in words if word != "--library"]
    if len(words) != 2 or words[0] not in ("unity", "python"):
        print(__doc__, file=sys.stderr)
        return 2
    kind, folder = words[0], Path(words[1])
    shutil.copytree(SOURCE / "packaging" / kind, folder, dirs_exist_ok=True)
    copy(SOURCE / "LICENSE", folder / "LICENSE.md")
    if kind == "unity":
        for source in (BINDINGS / "csharp").glob("*.cs"):
            copy(source, folder / "Runtime" / source.name)
        plugins = folder / "Runtime/Plugins"
    else:
        shutil.copytree(BINDINGS / "python/handhold", folder / "handhold", dirs_exist_ok=True, ignore=shutil.ignore_patterns("__pycache__"))
        copy(BINDINGS / "handhold.json", folder / "handhold/handhold.json")
        plugins = folder / "handhold"
    if library is not None:
        copy(library.resolve(), plugins / library.name)
    return 0


if __name__ == "__main__":
    sys.exit(main())
