#!/usr/bin/env python3
"""Makes the packages that pip, Unity and Blender install, of the archives of tools/package.

usage: packaging/engine_packages.py FOLDER ARCHIVE...
    ARCHIVE: handhold-VERSION-linux-x86_64.tar.gz and its like, made from these sources: the bindings are taken from here, the libraries from there

Writes into FOLDER and prints the paths:
    handhold-VERSION-py3-none-PLATFORM.whl   the Python binding with one platform's library, for `pip install FILE`
    io.handhold.unity-VERSION.tgz            for Unity's package manager, "Add package from tarball", with the libraries of Linux and Windows
    handhold_authoring-VERSION.zip           the Blender add-on with the binding and those libraries, for Preferences, Add-ons, Install

The same inputs make the same bytes.
"""
import base64
import hashlib
import sys
import tempfile
from pathlib import Path

import archive
import assemble
from archive import SOURCE, Entry

# A wheel's platform, by archive. The newest versions that the library asks for are those of manylinux_2_34.
WHEELS = {"linux-x86_64.tar.gz": "manylinux_2_34_x86_64", "linux-arm64.tar.gz": "manylinux_2_34_aarch64", "windows-x86_64.zip": "win_amd64"}
# Where Unity and Blender with this add-on run.
DESKTOP = ("linux-x86_64.tar.gz", "windows-x86_64.zip")
METADATA = """Metadata-Version: 2.1
Name: handhold
Version: {version}
Summary: Handhold for tools: hands that grip any surface, by ctypes and numpy
License: MIT
Requires-Python: >=3.9
Requires-Dist: numpy
"""
WHEEL = """Wheel-Version: 1.0
Generator: handhold
Root-Is-Purelib: false
Tag: py3-none-{platform}
"""


def read_folder(folder: Path) -> dict[str, Entry]:
    return {path.relative_to(folder).as_posix(): Entry(path.read_bytes()) for path in sorted(folder.rglob("*")) if path.is_file()}


def assembled(kind: str, archives: list[Path]) -> dict[str, Entry]:
    with tempfile.TemporaryDirectory() as folder:
        words = [word for one in archives for word in ("--archive", str(one))]
        assemble.make(assemble.parse([kind, folder, *words]))
        return read_folder(Path(folder))


def wheel(archived: Path, platform: str, version: str) -> dict[str, Entry]:
    info = f"handhold-{version}.dist-info"
    files = {name: entry for name, entry in assembled("python", [archived]).items() if name.startswith("handhold/")}
    files |= {f"{info}/METADATA": Entry(METADATA.format(version=version).encode()), f"{info}/WHEEL": Entry(WHEEL.format(platform=platform).encode()),
              f"{info}/LICENSE": Entry((SOURCE / "LICENSE").read_bytes())}

    def record(name: str, data: bytes) -> str:
        digest = base64.urlsafe_b64encode(hashlib.sha256(data).digest()).rstrip(b"=").decode()
        return f"{name},sha256={digest},{len(data)}\n"
    records = "".join(record(name, entry.data) for name, entry in sorted(files.items()))
    return files | {f"{info}/RECORD": Entry(f"{records}{info}/RECORD,,\n".encode())}


def add_on(archives: list[Path]) -> dict[str, Entry]:
    """The add-on as a folder in a zip, with the binding where operators.add_binding_to_path looks."""
    files = {f"handhold_authoring/{path.name}": Entry(path.read_bytes()) for path in sorted((SOURCE / "tools/blender/handhold_authoring").glob("*.py"))}
    for one in archives:
        files |= {f"handhold_authoring/binding/{name}": entry for name, entry in assembled("python", [one]).items() if name.startswith("handhold/")}
    return files | {"handhold_authoring/LICENSE": Entry((SOURCE / "LICENSE").read_bytes())}


def main() -> int:
    if len(sys.argv) < 3:
        print(__doc__, file=sys.stderr)
        return 2
    folder, version = Path(sys.argv[1]), archive.version()
    folder.mkdir(parents=True, exist_ok=True)
    found = {path.name.removeprefix(f"handhold-{version}-"): path for path in map(Path, sys.argv[2:])}
    if unknown := [str(path) for name, path in found.items() if name not in WHEELS]:
        raise SystemExit(f"{', '.join(unknown)}: no native archive of version {version}")
    for name, archived in found.items():
        path = folder / f"handhold-{version}-py3-none-{WHEELS[name]}.whl"
        archive.write_zip(path, "", wheel(archived, WHEELS[name], version))
        print(path)
    desktop = [found[name] for name in DESKTOP if name in found]
    if desktop:
        path = folder / f"io.handhold.unity-{version}.tgz"
        archive.write_tar(path, "package", assembled("unity", desktop))
        print(path)
        path = folder / f"handhold_authoring-{version}.zip"
        archive.write_zip(path, "", add_on(desktop))
        print(path)
    return 0


if __name__ == "__main__":
    sys.dont_write_bytecode = True
    sys.exit(main())
