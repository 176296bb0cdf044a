#!/usr/bin/env python3
"""Makes a package of a binding in a folder.

usage: packaging/assemble.py unity|python FOLDER [--library FILE]... [--archive FILE]...
    --library: the shared library to put inside, such as build/library/libhandhold.so, for Unity one for each platform; the user's installed one is
               found without it (Python)
    --archive: takes the library and the licences of everything inside out of an archive of tools/package, such as
               build/packages/handhold-0.2.0-windows-x86_64.zip
"""
import argparse
import hashlib
import shutil
import sys
import tarfile
import tempfile
import zipfile
from pathlib import Path

SOURCE = Path(__file__).resolve().parent.parent
BINDINGS = SOURCE / "systems/host/bindings"

# Unity's importer settings. Key: folder below Plugins. Value: Unity's platform, CPU, and the editor's operating system.
PLUGINS = {"linux": ("Standalone: Linux64", "x86_64", "Linux"), "windows": ("Standalone: Win64", "x86_64", "Windows"),
           "macos": ("Standalone: OSXUniversal", "AnyCPU", "OSX"), "android": ("Android: Android", "ARM64", "")}


def copy(source: Path, target: Path) -> None:
    target.parent.mkdir(parents=True, exist_ok=True)
    shutil.copyfile(source, target)


def platform_of(library: Path) -> str:
    """The folder for a library: those of Linux and Android have one name."""
    if library.suffix in (".dll", ".dylib"):
        return {".dll": "windows", ".dylib": "macos"}[library.suffix]
    read = library.read_bytes()
    header = read[:20]
    folder = {62: "linux", 183: "android"}.get(int.from_bytes(header[18:20], "little"))  # e_machine: x86-64, AArch64
    if header[:4] != b"\x7fELF" or folder is None:
        raise SystemExit(f"{library}: neither a .dll, a .dylib nor an ELF library for x86-64 or AArch64")
    if folder == "android" and b"libc.so.6" in read:
        raise SystemExit(f"{library}: for Linux on Arm, where Unity does not run")
    return folder


def library_of(archive: Path, folder: Path) -> Path:
    """Unpacks an archive into `folder` and returns its library's path."""
    with zipfile.ZipFile(archive) if archive.suffix == ".zip" else tarfile.open(archive) as packed:
        packed.extractall(folder)
    found = [*folder.rglob("handhold.dll"), *folder.rglob("libhandhold.so")]
    if len(found) != 1:
        raise SystemExit(f"{archive}: no archive with a shared library")
    return found[0]


def copy_licenses(unpacked: Path, target: Path) -> None:
    """Copies the licences of an unpacked archive. Archives of different dependencies share no package: one of their texts would be lost."""
    texts = sorted(unpacked.glob("*/licenses/*.txt"))
    if not texts:
        raise SystemExit("the archive has no licenses")
    for text in texts:
        if (target / text.name).exists() and (target / text.name).read_bytes() != text.read_bytes():
            raise SystemExit(f"the archives differ in licenses/{text.name}")
        copy(text, target / text.name)


def plugin_importer(platform: str) -> str:
    def entry(first: str, settings: dict) -> str:
        lines = "".join(f"\n        {name}: {value}" for name, value in settings.items())
        return f"\n  - first:\n      {first}\n    second:\n      enabled: 1\n      settings:{lines}"
    first, cpu, system = PLUGINS[platform]
    editor = entry("Editor: Editor", {"CPU": cpu, "DefaultValueInitialized": "true", "OS": system}) if system else ""
    return f"PluginImporter:\n  serializedVersion: 2\n  platformData:\n  - first:\n      Any: \n    second:\n      enabled: 0\n      settings: {{}}" \
           f"{editor}{entry(first, {'CPU': cpu})}\n"


def write_metas(folder: Path) -> None:
    """Unity ignores files of packages that have no .meta file; scenes find scripts by its GUID."""
    for path in sorted(folder.rglob("*")):
        name = path.relative_to(folder)
        if path.suffix == ".meta" or any(part.endswith("~") for part in name.parts):
            continue
        guid = hashlib.md5(f"io.handhold.unity/{name.as_posix()}".encode()).hexdigest()
        importer = "folderAsset: yes\n" if path.is_dir() else plugin_importer(name.parts[2]) if name.parts[:2] == ("Runtime", "Plugins") else ""
        path.with_name(path.name + ".meta").write_text(f"fileFormatVersion: 2\nguid: {guid}\n{importer}", encoding="utf-8")


def parse(words: list[str]) -> argparse.Namespace:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("kind", choices=("unity", "python"))
    parser.add_argument("folder", type=Path)
    parser.add_argument("--library", type=Path, action="append", default=[])
    parser.add_argument("--archive", type=Path, action="append", default=[])
    return parser.parse_args(words)


def make(given: argparse.Namespace) -> None:
    temporary = tempfile.TemporaryDirectory()
    unpacked = {Path(temporary.name) / str(place): archive for place, archive in enumerate(given.archive)}
    given.library += [library_of(archive, place) for place, archive in unpacked.items()]
    folder = given.folder
    shutil.copytree(SOURCE / "packaging" / given.kind, folder, dirs_exist_ok=True)
    copy(SOURCE / "LICENSE", folder / "LICENSE.md")
    if given.kind == "unity":
        for source in (BINDINGS / "csharp").glob("*.cs"):
            copy(source, folder / "Runtime" / source.name)
    else:
        shutil.copytree(BINDINGS / "python/handhold", folder / "handhold", dirs_exist_ok=True, ignore=shutil.ignore_patterns("__pycache__"))
        copy(BINDINGS / "handhold.json", folder / "handhold/handhold.json")
    for library in given.library:
        plugins = folder / "Runtime/Plugins" / platform_of(library) if given.kind == "unity" else folder / "handhold"
        copy(library.resolve(), plugins / library.name)
    licenses = folder / ("licenses" if given.kind == "unity" else "handhold/licenses")
    shutil.rmtree(licenses, ignore_errors=True)
    for place in unpacked:
        copy_licenses(place, licenses)
    if given.kind == "unity":
        write_metas(folder)


def main() -> int:
    make(parse(sys.argv[1:]))
    return 0


if __name__ == "__main__":
    sys.exit(main())
