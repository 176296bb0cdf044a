#!/usr/bin/env python3
"""Tries an archive of tools/package in an empty folder, as its user would.

usage: tests/packages/run.py ARCHIVE FILE REFERENCE WORK [RUNNER...]
    ARCHIVE: linux-x86_64, linux-arm64, windows-x86_64 or web; FILE: the archive; REFERENCE: folder with this machine's handhold-grip and
    handhold-wall, built without the archive; WORK: a folder of its own, emptied first; RUNNER: the command that runs the target's programs

C programs are compiled with the archive alone, by pkg-config, by CMake and, for Windows, against the import library with the linker for
Microsoft's formats. They run and get the reference's state hashes. The library exports the functions of tests/hosts/symbols.txt and no other,
and needs no library but those listed here. No file of the archive names the repository's folder, the home folder or that of the dependencies'
sources (HANDHOLD_CROSS_SOURCES). Unity and Python packages made of the archive have its licences. Exit status 0: all is so; a line "SKIPPED"
says what could not be tried.
"""
import fnmatch
import json
import os
import re
import shutil
import struct
import subprocess
import sys
import tarfile
import zipfile
from pathlib import Path

HERE = Path(__file__).resolve().parent
SOURCE = HERE.parent.parent
sys.path.insert(0, str(HERE.parent / "hosts"))
from run import run  # noqa: E402  (tests/hosts/run.py)

SCENES = (SOURCE / "tests/portability/grip_hash.c", SOURCE / "tests/bindings/wall_hash.c")
HELLO = SOURCE / "tests/samples/hello_hand_c.c"
STRICT = ("-std=c99", "-Wall", "-Wextra", "-Wpedantic", "-Werror")
C_AND_CPP = {"libc.so.6", "libm.so.6", "libgcc_s.so.1", "libstdc++.so.6"}
MAY_NEED = {"linux-x86_64": C_AND_CPP | {"ld-linux-x86-64.so.2"}, "linux-arm64": C_AND_CPP | {"ld-linux-aarch64.so.1"},
            "windows-x86_64": {"kernel32.dll", "msvcrt.dll"}}
# What a WebAssembly module exports beside the interface: what its JavaScript needs.
WEB_EXPORTS = {"memory", "malloc", "free", "__indirect_function_table", "_initialize", "__errno_location", "setThrew", "stackAlloc", "stackRestore",
               "stackSave"}
PROJECT = """cmake_minimum_required(VERSION 3.20)
project(trial LANGUAGES C)
find_package(handhold {version} CONFIG REQUIRED)
add_executable(by_cmake {source})
target_link_libraries(by_cmake PRIVATE handhold::handhold {libraries})
"""


class Trial:
    def __init__(self, archive: str, file: Path, reference: Path, work: Path, runner: list[str]):
        self.archive, self.runner, self.work = archive, runner, work
        shutil.rmtree(work, ignore_errors=True)
        work.mkdir(parents=True)
        with zipfile.ZipFile(file) if file.suffix == ".zip" else tarfile.open(file) as packed:
            packed.extractall(work)
        tops = list(work.iterdir())
        self.require(len(tops) == 1, f"{len(tops)} folders at the top")
        self.root = tops[0]
        self.expected = [said_by(run(reference / f"handhold-{name}")) for name in ("grip", "wall")]
        self.version = json.loads(next(self.root.rglob("handhold.json")).read_text(encoding="utf-8"))["version"]
        self.require(self.version in file.name and archive in file.name, f"{file.name} is version {self.version} for {archive}")

    def require(self, is_so: bool, otherwise: str) -> None:
        if not is_so:
            raise SystemExit(f"{self.archive}: {otherwise}")

    def check_files(self, library: Path, exported: set[str]) -> None:
        interface = set((SOURCE / "tests/hosts/symbols.txt").read_text(encoding="utf-8").split())
        self.require(exported == interface, f"exported, against symbols.txt: {sorted(exported ^ interface)}")
        self.check_paths()
        for name in ("README.md", "LICENSE", "licenses/bullet.txt", "licenses/box2d.txt", "licenses/meshoptimizer.txt", "licenses/eigen.txt"):
            self.require((self.root / name).stat().st_size > 500, f"{name} is too short")

    def check_paths(self) -> None:
        sources = Path(os.environ.get("HANDHOLD_CROSS_SOURCES", SOURCE / "build/cross/sources"))
        folders = {str(one) for folder in (SOURCE, sources, Path.home()) for one in (folder.absolute(), folder.resolve())} - {"/"}
        for path in (one for one in self.root.rglob("*") if one.is_file()):
            data = path.read_bytes()
            found = [folder for folder in sorted(folders) if f"{folder}/".encode() in data]
            self.require(not found, f"{path.name} holds paths of this machine: {found}")

    def check_packages(self, file: Path) -> None:
        """Packages for Unity and Python of the archive have its library and all its licences."""
        texts = {path.name: path.read_bytes() for path in (self.root / "licenses").iterdir()}
        for kind, folder in (("unity", "licenses"), ("python", "handhold/licenses")):
            package = self.work / kind
            if self.archive == "linux-arm64" and kind == "unity":  # Unity does not run there
                continue
            run(sys.executable, "-B", SOURCE / "packaging/assemble.py", kind, package, "--archive", file)
            copied = {path.name: path.read_bytes() for path in (package / folder).glob("*.txt")}
            self.require(copied == texts, f"the {kind} package lacks licences: {sorted(texts.keys() ^ copied.keys())}")

    def check_needed(self, needed: set[str]) -> None:
        self.require(needed <= MAY_NEED[self.archive], f"also needs {sorted(needed - MAY_NEED[self.archive])}")
        print(f"  needs {', '.join(sorted(needed))}")

    def check_hash(self, how: str, said: str, scene: int) -> None:
        self.require(said == self.expected[scene], f"{how}: {said} instead of {self.expected[scene]}")
        print(f"  {how}: {said}, as the native program")

    def by_cmake(self, *options: str, libraries: str = "") -> Path:
        folder = self.work / "by_cmake"
        folder.mkdir()
        (folder / "CMakeLists.txt").write_text(PROJECT.format(version=self.version, source=SCENES[1], libraries=libraries), encoding="utf-8")
        # On Arm, GCC otherwise fuses multiply-adds of the program, which then gives the library other numbers.
        run("cmake", "-S", folder, "-B", folder / "build", f"-DCMAKE_PREFIX_PATH={self.root}", "-DCMAKE_BUILD_TYPE=Release",
            "-DCMAKE_C_FLAGS=-ffp-contract=off", *options)
        run("cmake", "--build", folder / "build")
        return next(one for one in (folder / "build").iterdir() if one.stem == "by_cmake" and one.suffix in ("", ".exe"))


def skip(what: str) -> None:
    print(f"  SKIPPED: {what} (tools/install_packages package)")


def said_by(text: str) -> str:
    return text.partition(" step_us")[0].strip()


def try_linux(trial: Trial) -> None:
    tools = {"linux-x86_64": "", "linux-arm64": "aarch64-linux-gnu-"}[trial.archive]
    library = trial.root / f"lib/libhandhold.so.{trial.version}"
    read = run(f"{tools}readelf", "-dW", "--dyn-syms", "--version-info", library)
    names = re.findall(r" (?:GLOBAL|WEAK) +DEFAULT +\d+ (\w+)", re.sub(r".* UND .*", "", read))
    trial.check_files(library, set(names))
    trial.check_needed(set(re.findall(r"NEEDED.*\[(.*)\]", read)))
    stated = (trial.root / "README.md").read_text(encoding="utf-8")
    for prefix, name in (("GLIBC_", "glibc"), ("GLIBCXX_", "GLIBCXX")):
        newest = max((tuple(map(int, one.split("."))) for one in re.findall(prefix + r"(\d+(?:\.\d+)+)", read)))
        text = f"{name} {'.'.join(map(str, newest))}"
        trial.require(text in stated, f"needs {text}, which the README does not say")
    environment = dict(os.environ, PKG_CONFIG_LIBDIR=str(trial.root / "lib/pkgconfig"))
    flags = run("pkg-config", "--cflags", "--libs", "handhold", env=environment).split()
    for scene, source in [(None, HELLO), *enumerate(SCENES)]:
        program = trial.root / source.stem
        run(f"{tools}gcc", *STRICT, source, *flags, "-lm", "-Wl,-rpath,$ORIGIN/lib", "-o", program)
        said = run(*trial.runner, program)
        if scene is not None:
            trial.check_hash(f"{source.name} by pkg-config", said_by(said), scene)
    cross = ("-DCMAKE_SYSTEM_NAME=Linux", "-DCMAKE_SYSTEM_PROCESSOR=aarch64", f"-DCMAKE_C_COMPILER={tools}gcc") if tools else ()
    trial.check_hash("wall_hash.c by CMake", said_by(run(*trial.runner, trial.by_cmake(*cross, libraries="m"))), 1)
    if tools:
        return
    if subprocess.run(["/usr/bin/python3", "-c", "import numpy"], stderr=subprocess.DEVNULL, check=False).returncode != 0:
        skip("Python's binding, without numpy")
    else:
        environment = dict(os.environ, PYTHONPATH=str(trial.root / "bindings/python"), HANDHOLD_LIBRARY=str(library))
        for scene, line in enumerate(run("/usr/bin/python3", "-B", SOURCE / "tests/bindings/scenes.py", env=environment).strip().splitlines()):
            trial.check_hash("Python's binding", line, scene)
    if not shutil.which("mcs") or not shutil.which("mono"):
        skip("C#'s binding, without Mono")
    else:
        program = trial.root / "lib/Scenes.exe"
        run("mcs", "-unsafe", f"-out:{program}", *sorted((trial.root / "bindings/csharp").glob("*.cs")), SOURCE / "tests/bindings/Scenes.cs")
        for scene, line in enumerate(run("mono", program, env=dict(os.environ, LD_LIBRARY_PATH=str(library.parent))).strip().splitlines()):
            trial.check_hash("C#'s binding", line, scene)


def check_microsoft_headers(trial: Trial) -> None:
    """Microsoft's rules for C and C++, without their libraries: the C headers compile without a warning, with the layout that bindings use."""
    structs = json.loads((trial.root / "share/handhold/handhold.json").read_text(encoding="utf-8"))["structs"]
    facts = ["#include <handhold/handhold.h>", "#include <stddef.h>"]
    for struct in structs:
        name, layout = struct["name"], struct["layout"]["64"]
        facts.append(f"typedef char size_of_{name}[sizeof({name}) == {layout['size']} ? 1 : -1];")
        for field, offset in zip(struct["fields"], layout["offsets"]):
            facts.append(f"typedef char {field['name']}_of_{name}[offsetof({name}, {field['name']}) == {offset} ? 1 : -1];")
    source = trial.work / "layout.c"
    source.write_text("\n".join(facts) + "\n", encoding="utf-8")
    for language in (("/TC",), ("/TC", "/std:c17"), ("/TP",), ("/TP", "/std:c++20")):
        run("clang", "--driver-mode=cl", "--target=x86_64-pc-windows-msvc", *language, "/W4", "/WX", "/Zs", "-Xclang", "-ffreestanding",
            f"/I{trial.root / 'include'}", "--", source)  # a path that begins with /w is an option otherwise
    print(f"  {len(structs)} structs have the layout of handhold.json by clang-cl's rules, in C and C++, at /W4 /WX")


def try_windows(trial: Trial) -> None:
    library, imports = trial.root / "bin/handhold.dll", trial.root / "lib/handhold.lib"
    read = run("x86_64-w64-mingw32-objdump", "-p", library)
    trial.check_files(library, set(re.findall(r"^\s+\[ *\d+\].* (\w+)$", read.partition("[Ordinal/Name Pointer] Table")[2], re.MULTILINE)))
    trial.check_needed({name.lower() for name in re.findall(r"DLL Name: (\S+)", read)})
    include = f"-I{trial.root / 'include'}"
    for scene, source in [(None, HELLO), *enumerate(SCENES)]:
        program = trial.root / f"bin/{source.stem}.exe"
        run("x86_64-w64-mingw32-gcc-posix", *STRICT, include, source, imports, "-o", program)
        said = run(*trial.runner, program)
        if scene is not None:
            trial.check_hash(f"{source.name} by mingw-w64 and Wine", said_by(said), scene)
    by_cmake = trial.by_cmake("-DCMAKE_SYSTEM_NAME=Windows", "-DCMAKE_C_COMPILER=x86_64-w64-mingw32-gcc-posix")
    shutil.copy(by_cmake, trial.root / "bin")
    trial.check_hash("wall_hash.c by CMake and Wine", said_by(run(*trial.runner, trial.root / "bin" / by_cmake.name)), 1)
    check_microsoft_headers(trial)
    # As Microsoft's compiler and linker would: their object format and name lookup, without their C library, which Debian lacks.
    made = trial.work / "microsoft.obj"
    run("clang", "--target=x86_64-pc-windows-msvc", "-std=c11", "-Wall", "-Wextra", "-Werror", "-ffreestanding", "-O1", include, "-c",
        HERE / "without_runtime.c", "-o", made)
    system = trial.work / "kernel32.lib"
    (trial.work / "kernel32.def").write_text("LIBRARY kernel32.dll\nEXPORTS\n    ExitProcess\n", encoding="utf-8")
    run("llvm-dlltool", "-m", "i386:x86-64", "-d", trial.work / "kernel32.def", "-l", system)
    program = trial.root / "bin/microsoft.exe"
    run("lld-link", "/nodefaultlib", "/entry:start", "/subsystem:console", f"/out:{program}", made, imports, system)
    run(*trial.runner, program)
    print("  without_runtime.c in Microsoft's formats, linked with handhold.lib by lld-link: a hand grips the wall")


def exports_of_wasm(module: bytes) -> set[str]:
    def number(at: int) -> tuple[int, int]:
        result, shift = 0, 0
        while True:
            byte, at = module[at], at + 1
            result |= (byte & 127) << shift
            shift += 7
            if byte < 128:
                return result, at
    at, names = 8, set()
    trial_magic, = struct.unpack_from("<I", module)
    assert trial_magic == 0x6D736100
    while at < len(module):
        section = module[at]
        size, begin = number(at + 1)
        if section == 7:
            count, cursor = number(begin)
            for _ in range(count):
                length, cursor = number(cursor)
                names.add(module[cursor:cursor + length].decode())
                cursor = number(cursor + length + 1)[1]
        at = begin + size
    return names


def try_web(trial: Trial) -> None:
    module = trial.root / "handhold.wasm"
    names = exports_of_wasm(module.read_bytes())
    trial.check_files(module, {name for name in names if name.startswith("hh_")})
    others = {name for name in names if not name.startswith("hh_")}
    trial.require(others <= WEB_EXPORTS, f"also exports {sorted(others - WEB_EXPORTS)}")
    # npm packs these again, and what it always takes.
    packed = [*json.loads((trial.root / "package.json").read_text(encoding="utf-8"))["files"], "package.json", "README.md"]
    tops = {path.name for path in trial.root.iterdir()}
    omitted = {name for name in tops if not any(fnmatch.fnmatch(name, pattern) for pattern in packed)}
    trial.require(not omitted, f"package.json omits {sorted(omitted)}")
    modules = trial.work / "node_modules"
    modules.mkdir()
    trial.root = trial.root.rename(modules / "handhold")
    for name in ("same_scene", "wall_scene"):
        shutil.copy(SOURCE / f"game/web/package/test/{name}.mjs", trial.work)
    shutil.copy(HERE / "hashes.mjs", trial.work)
    for place, line in enumerate(run(*trial.runner, trial.work / "hashes.mjs").strip().splitlines()):
        trial.check_hash(("handhold.wasm in Node", "handhold-core.wasm in Node")[place // 2], line, place % 2)


def main() -> int:
    if len(sys.argv) < 5 or sys.argv[1] not in {*MAY_NEED, "web"}:
        print(__doc__, file=sys.stderr)
        return 2
    archive, file, reference, work = sys.argv[1], *(Path(one).resolve() for one in sys.argv[2:5])
    trial = Trial(archive, file, reference, work, sys.argv[5:])
    {"linux-x86_64": try_linux, "linux-arm64": try_linux, "windows-x86_64": try_windows, "web": try_web}[archive](trial)
    if archive != "web":
        trial.check_packages(file)
    return 0


if __name__ == "__main__":
    sys.exit(main())
