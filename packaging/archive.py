#!/usr/bin/env python3
"""Packs the library of a build into an archive that needs nothing but the system's C and C++ runtimes; tools/package builds and tries it.

usage: packaging/archive.py linux-x86_64|linux-arm64|windows-x86_64|web BUILD SOURCES FOLDER
    BUILD: the build folder (build/cross/...), SOURCES: the dependencies' sources (build/cross/sources), FOLDER: where the archive is written

Prints the archive's path. The same inputs make the same bytes: files are sorted, their owner is root and their time is SOURCE_DATE_EPOCH, else
the beginning of 2000.
"""
import gzip
import io
import os
import re
import subprocess
import sys
import tarfile
import tempfile
import time
import zipfile
from dataclasses import dataclass
from pathlib import Path

SOURCE = Path(__file__).resolve().parent.parent
HOST = SOURCE / "systems/host"
TEMPLATES = SOURCE / "packaging/archives"
TIME_S = int(os.environ.get("SOURCE_DATE_EPOCH", "946684800"))
DOCS, COMMON = Path("/usr/share/doc"), Path("/usr/share/common-licenses")
# The texts that cover what is inside the library, by target. Debian's copyright files name every author.
LICENSES = {
    "all": {"bullet": "{sources}/bullet/LICENSE.txt", "bullet-authors": "{sources}/bullet/debian/copyright", "box2d": "{sources}/box2d/LICENSE",
            "meshoptimizer": "{sources}/meshoptimizer/LICENSE.md", "eigen": f"{DOCS}/libeigen3-dev/copyright", "mpl-2.0": f"{COMMON}/MPL-2.0",
            "nlohmann-json": f"{DOCS}/nlohmann-json3-dev/copyright"},
    "linux": {},
    "windows": {"gcc-runtime": f"{DOCS}/gcc-mingw-w64-x86-64-posix-runtime/copyright", "gpl-3": f"{COMMON}/GPL-3",
                "mingw-w64-runtime": f"{DOCS}/mingw-w64-x86-64-dev/copyright"},
    "web": {"emscripten-system-libraries": f"{DOCS}/emscripten/copyright"},
}


@dataclass(frozen=True)
class Entry:
    data: bytes = b""
    link: str = ""  # a symbolic link's target
    is_program: bool = False


def version() -> str:
    return re.search(r'HANDHOLD_VERSION_TEXT "([^"]+)"', (HOST / "include/handhold/version.h").read_text(encoding="utf-8"))[1]


def filled(name: str, target: str) -> bytes:
    """A file of packaging/archives with @NAME@ replaced."""
    system, _, processor = target.partition("-")
    number = version()
    words = {"VERSION": number, "MINOR_VERSION": number.rpartition(".")[0], "TARGET": target, "SYSTEM": system.capitalize(), "PROCESSOR": processor}
    return re.sub(r"@([A-Z_]+)@", lambda found: words[found[1]], (TEMPLATES / name).read_text(encoding="utf-8")).encode()


def public_headers() -> dict[str, Entry]:
    """Those for hosts of the C interface: headers of source embedders include the library's own."""
    files = {}
    for path in sorted((HOST / "include/handhold").glob("*.h*")):
        text = path.read_bytes()
        if not re.search(rb'^#include "(engine|components|systems)/|^#include <handhold/(files|rigs|tuning)\.hpp>', text, re.MULTILINE):
            files[f"include/handhold/{path.name}"] = Entry(text)
    return files


def licenses(target: str, sources: Path) -> dict[str, Entry]:
    texts = LICENSES["all"] | LICENSES[target.partition("-")[0]]
    files = {f"licenses/{name}.txt": Entry(Path(path.format(sources=sources)).read_bytes()) for name, path in texts.items()}
    return files | {"LICENSE": Entry((SOURCE / "LICENSE").read_bytes())}


def stripped(library: Path, tool: str) -> bytes:
    with tempfile.TemporaryDirectory() as folder:
        out = Path(folder) / library.name
        subprocess.run([tool, "--strip-unneeded", "-o", out, library], check=True)
        return out.read_bytes()


def import_library(definitions: bytes, name: str) -> bytes:
    """A .lib in the short form of Microsoft's linker. The .def file lists the functions that the DLL exports."""
    with tempfile.TemporaryDirectory() as folder:
        (Path(folder) / "handhold.def").write_bytes(definitions)
        subprocess.run(["llvm-dlltool", "-m", "i386:x86-64", "-D", name, "-d", "handhold.def", "-l", "out.lib"], cwd=folder, check=True)
        return (Path(folder) / "out.lib").read_bytes()


def exported_by_dll(library: Path) -> list[str]:
    text = subprocess.run(["x86_64-w64-mingw32-objdump", "-p", library], check=True, capture_output=True, text=True).stdout
    return sorted(re.findall(r"^\s*\[ *\d+\](?: \+base\[ *\d+\]  ?[0-9a-f]+)? (\w+)$", text, re.MULTILINE))


def native_library(target: str, build: Path) -> dict[str, Entry]:
    number = version()
    if target == "windows-x86_64":
        library = build / "bin/handhold.dll"
        names = exported_by_dll(library)
        definitions = "\n".join(["LIBRARY handhold.dll", "EXPORTS", *(f"    {name}" for name in names), ""]).encode()
        return {"bin/handhold.dll": Entry(library.read_bytes(), is_program=True), "lib/handhold.def": Entry(definitions),
                "lib/handhold.lib": Entry(import_library(definitions, "handhold.dll"))}
    tool = {"linux-x86_64": "strip", "linux-arm64": "aarch64-linux-gnu-strip"}[target]
    full, soname = f"libhandhold.so.{number}", f"libhandhold.so.{number.rpartition('.')[0]}"
    return {f"lib/{full}": Entry(stripped(build / full, tool), is_program=True), f"lib/{soname}": Entry(link=full), "lib/libhandhold.so": Entry(link=soname),
            "lib/pkgconfig/handhold.pc": Entry(filled("handhold.pc", target))}


def native_files(target: str, build: Path, sources: Path) -> dict[str, Entry]:
    files = public_headers() | licenses(target, sources) | native_library(target, build)
    for name in ("handholdConfig.cmake", "handholdConfigVersion.cmake"):
        files[f"lib/cmake/handhold/{name}"] = Entry(filled(name, target))
    bindings = HOST / "bindings"
    files["share/handhold/handhold.json"] = Entry((bindings / "handhold.json").read_bytes())
    for path in sorted((bindings / "csharp").glob("*.cs")):
        files[f"bindings/csharp/{path.name}"] = Entry(path.read_bytes())
    for path in sorted((bindings / "python/handhold").glob("*.py")):
        files[f"bindings/python/handhold/{path.name}"] = Entry(path.read_bytes())
    system = target.partition("-")[0]
    return files | {"README.md": Entry(filled(f"{system}.md", target) + filled("inside.md", target))}


def web_files(build: Path, sources: Path) -> dict[str, Entry]:
    """The npm package that tools/cross makes, with the description of the interface and all licences."""
    files = {path.name: Entry(path.read_bytes()) for path in sorted((build / "package").iterdir()) if path.is_file()}
    return files | licenses("web", sources) | {"handhold.json": Entry((HOST / "bindings/handhold.json").read_bytes())}


def write_tar(path: Path, top: str, files: dict[str, Entry]) -> None:
    raw = io.BytesIO()
    with tarfile.open(fileobj=raw, mode="w", format=tarfile.USTAR_FORMAT) as tar:
        for name, entry in sorted(files.items()):
            info = tarfile.TarInfo(f"{top}/{name}")
            info.mtime, info.mode, info.uname, info.gname = TIME_S, 0o755 if entry.is_program else 0o644, "root", "root"
            if entry.link:
                info.type, info.linkname, info.mode = tarfile.SYMTYPE, entry.link, 0o777
            info.size = len(entry.data)
            tar.addfile(info, io.BytesIO(entry.data))
    path.write_bytes(gzip.compress(raw.getvalue(), compresslevel=9, mtime=TIME_S))


def write_zip(path: Path, top: str, files: dict[str, Entry]) -> None:
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED, compresslevel=9) as archive:
        for name, entry in sorted(files.items()):
            info = zipfile.ZipInfo(f"{top}/{name}" if top else name, time.gmtime(TIME_S)[:6])
            info.external_attr = (0o755 if entry.is_program else 0o644) << 16
            info.compress_type = zipfile.ZIP_DEFLATED
            archive.writestr(info, entry.data, compresslevel=9)


def main() -> int:
    if len(sys.argv) != 5 or sys.argv[1] not in ("linux-x86_64", "linux-arm64", "windows-x86_64", "web"):
        print(__doc__, file=sys.stderr)
        return 2
    target, build, sources, folder = sys.argv[1], *(Path(one).resolve() for one in sys.argv[2:])
    folder.mkdir(parents=True, exist_ok=True)
    name = f"handhold-{version()}-{target}"
    if target == "web":
        path = folder / f"{name}.tgz"
        write_tar(path, "package", web_files(build, sources))
    elif target == "windows-x86_64":
        path = folder / f"{name}.zip"
        write_zip(path, name, native_files(target, build, sources))
    else:
        path = folder / f"{name}.tar.gz"
        write_tar(path, name, native_files(target, build, sources))
    print(path)
    return 0


if __name__ == "__main__":
    sys.exit(main())
