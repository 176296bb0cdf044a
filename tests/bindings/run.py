#!/usr/bin/env python3
"""Tests a binding of the C interface against the shared library of a build.

usage: tests/bindings/run.py generated|layouts|python|csharp|javascript BUILD WORK     WORK: a folder of its own, emptied first
    generated   the generated files are what the headers say, and unclear headers are errors
    layouts     C compilers agree with handhold.json on every size, offset and value: this machine's, and clang's for wasm32
    python      the Python binding gets the state hashes of C programs that make the same calls, and plays matches
    csharp      the C# binding does, under Mono; the Unity package compiles against stand-ins of Unity's types
    javascript  the JavaScript binding keeps its views, callbacks and arrays, against a library of JavaScript functions
Exit status 0: it does, 77: Mono, numpy or another program is missing
"""
import json
import os
import re
import shutil
import subprocess
import sys
import tarfile
from pathlib import Path

HERE = Path(__file__).resolve().parent
SOURCE = HERE.parent.parent
sys.path.insert(0, str(HERE.parent / "hosts"))
from run import run  # noqa: E402  (tests/hosts/run.py)

BINDINGS = SOURCE / "systems/host/bindings"
INCLUDE = SOURCE / "systems/host/include"


def skip(what: str) -> None:
    print(f"skipped: {what} is missing (tools/install_packages test)")
    raise SystemExit(77)


def expected_lines(library: Path, work: Path) -> list[str]:
    """What C programs print that make the calls of the bindings' tests. Their hands grip as they should."""
    lines = []
    for source in (SOURCE / "tests/portability/grip_hash.c", HERE / "wall_hash.c"):
        program = work / source.stem
        run("cc", "-std=c99", "-Wall", "-Wextra", "-Wpedantic", "-Werror", f"-I{INCLUDE}", source, library, "-lm", f"-Wl,-rpath,{library.parent}",
            "-o", program)
        lines.append(run(program).partition(" step_us")[0].strip())
    described = json.loads((BINDINGS / "handhold.json").read_text(encoding="utf-8"))
    value = {value["name"]: value["value"] for enum in described["enums"] for value in enum["values"]}
    # The left hand holds the chain, the right one the wall. In the second scene a hand moves 0.2 m while it grips a wall.
    said = (rf"0x[0-9a-f]{{16}} grips {value['HH_GRIP_HELD']} {value['HH_GRIP_SURFACE']}", r"0x[0-9a-f]{16} grabs 1 moved_mm 200\.000")
    if not all(re.fullmatch(pattern, line) for pattern, line in zip(said, lines, strict=True)):
        print("C says", *lines, "instead of", *said, sep="\n", file=sys.stderr)
        raise SystemExit(1)
    return lines


def compare(expected: list[str], said: str) -> None:
    lines = said.strip().splitlines()
    if lines != expected:
        print("C says", *expected, "the binding says", *lines, sep="\n", file=sys.stderr)
        raise SystemExit(1)
    print("\n".join(lines))


def check_licenses(kind: str, library: Path, work: Path) -> None:
    """A package made of an archive has its licences; an archive without any is refused."""
    command = (sys.executable, "-B", SOURCE / "packaging/assemble.py", kind, work / "of_archive", "--archive", work / "archive.tar.gz")
    for places in (["lib/libhandhold.so", "licenses/box2d.txt"], ["lib/libhandhold.so"]):
        with tarfile.open(work / "archive.tar.gz", "w:gz", compresslevel=1) as archive:
            for place in places:
                archive.add(library.resolve() if place.endswith(".so") else SOURCE / "LICENSE", f"handhold/{place}")
        done = subprocess.run([str(word) for word in command], capture_output=True, text=True, check=False)
        found = [path.relative_to(work / "of_archive").as_posix() for path in (work / "of_archive").rglob("box2d.txt")]
        expected = (0, ["licenses/box2d.txt" if kind == "unity" else "handhold/licenses/box2d.txt"]) if len(places) == 2 else (1, [])
        if (done.returncode, found) != expected:
            raise SystemExit(f"{kind} package of an archive with {places}: status {done.returncode}, licences {found}, {done.stderr}")


def check_generated() -> None:
    run(sys.executable, "-B", BINDINGS / "generate.py", "--check")
    print(run(sys.executable, "-B", HERE / "generator_test.py").strip())


def check_javascript(work: Path) -> None:
    if shutil.which("node") is None:
        skip("Node")
    for source in (*(SOURCE / "game/web/package/src").glob("*.js"), *(BINDINGS / "javascript").glob("*.js")):
        shutil.copy(source, work)
    shutil.copy(SOURCE / "game/web/package/package.json", work)
    shutil.copy(HERE / "javascript_test.mjs", work)
    print(run("node", "--test", work / "javascript_test.mjs"))


def check_layouts(work: Path) -> None:
    described = json.loads((BINDINGS / "handhold.json").read_text(encoding="utf-8"))
    values = [f'HH_SAME({value["name"]}, {value["value"]});' for enum in described["enums"] for value in enum["values"]]
    compilers = {"64": ["cc"], "wasm32": ["clang", "--target=wasm32", "-ffreestanding"]}
    missing = [command[0] for command in compilers.values() if shutil.which(command[0]) is None]
    for name, command in compilers.items():
        if command[0] in missing:
            continue
        checks = []
        for struct in described["structs"]:
            layout = struct["layout"][name]
            checks.append(f'HH_SAME(sizeof({struct["name"]}), {layout["size"]});')
            checks += [f'HH_SAME(offsetof({struct["name"]}, {one["name"]}), {at});' for one, at in zip(struct["fields"], layout["offsets"])]
        source = work / f"layouts_{name}.c"
        source.write_text("#include <stddef.h>\n#include <handhold/handhold.h>\n"
                          "#define HH_SAME(a, b) _Static_assert((a) == (b), #a)\n" + "\n".join(checks + values) + "\n", encoding="utf-8")
        run(*command, "-std=c11", "-fsyntax-only", f"-I{INCLUDE}", source)
        print(f"{name}: {len(described['structs'])} structs, {len(checks)} sizes and offsets, {len(values)} values")
    if missing:
        skip(" and ".join(missing))


def check_python(library: Path, work: Path) -> None:
    if subprocess.run([sys.executable, "-c", "import numpy"], stderr=subprocess.DEVNULL).returncode != 0:
        skip("numpy of this Python")
    environment = dict(os.environ, PYTHONPATH=str(BINDINGS / "python"), HANDHOLD_LIBRARY=str(library))
    compare(expected_lines(library, work), run(sys.executable, "-B", HERE / "scenes.py", env=environment))
    for name in ("python_test.py", "match_test.py"):
        print(run(sys.executable, "-B", HERE / name, env=environment))
    check_licenses("python", library, work)


def check_csharp(library: Path, work: Path) -> None:
    for program in ("mcs", "mono"):
        if shutil.which(program) is None:
            skip(f"Mono's {program}")
    environment = dict(os.environ, LD_LIBRARY_PATH=str(library.parent))
    sources = sorted((BINDINGS / "csharp").glob("*.cs"))
    for name in ("Scenes", "Lifetimes", "Matches"):
        run("mcs", "-unsafe", "-warnaserror", f"-out:{work}/{name}.exe", *sources, HERE / f"{name}.cs")
    compare(expected_lines(library, work), run("mono", work / "Scenes.exe", env=environment))
    for name in ("Lifetimes", "Matches"):
        print(run("mono", work / f"{name}.exe", env=environment).strip())
    print(run("mono", work / "Lifetimes.exe", "without", env=dict(os.environ, LD_LIBRARY_PATH="")).strip())
    package = work / "unity"
    run(sys.executable, "-B", SOURCE / "packaging/assemble.py", "unity", package, "--library", library)
    # Unity ignores files without a .meta file, and finds scripts by its GUID.
    files = [path for path in package.rglob("*") if path.suffix != ".meta" and "Samples~" not in path.parts]
    guids = {path.with_name(path.name + ".meta").read_text(encoding="utf-8").splitlines()[1] for path in files}
    if len(guids) != len(files) or not any(package.glob("Runtime/Plugins/*/libhandhold.so")):
        raise SystemExit("a GUID is there twice, or the library is not in the folder of its platform")
    # Scripts use Unity's and System's namespaces too: no public name may be ambiguous.
    names = {name for source in package.glob("Runtime/**/*.cs")
             for name in re.findall(r"^    public (?:\w+ )*(?:class|struct|enum|interface|delegate [\w*]+) (\w+)", source.read_text(encoding="utf-8"), re.MULTILINE)}
    (package / "Names.cs").write_text("using System; using System.Collections.Generic; using System.Threading.Tasks; using UnityEngine; using Handhold;\n"
                                      f"static class Names {{ static readonly Type[] all = {{ {', '.join(f'typeof({name})' for name in sorted(names))} }};\n"
                                      "    static int Count() => all.Length; }\n", encoding="utf-8")
    print(f"{len(names)} names beside Unity's")
    unity = [*sorted(package.rglob("*.cs")), HERE / "UnityStandIns.cs", HERE / "UnityScene.cs"]
    run("mcs", "-unsafe", "-warnaserror", "-define:UNITY_5_3_OR_NEWER", f"-out:{work}/unity.exe", *unity)
    print(run("mono", work / "unity.exe", env=environment).strip())
    check_licenses("unity", library, work)


def main() -> int:
    if len(sys.argv) != 4 or sys.argv[1] not in ("generated", "layouts", "python", "csharp", "javascript"):
        print(__doc__, file=sys.stderr)
        return 2
    name, build, work = sys.argv[1], Path(sys.argv[2]).resolve(), Path(sys.argv[3]).resolve()
    shutil.rmtree(work, ignore_errors=True)
    work.mkdir(parents=True)
    library = build / "libhandhold.so"
    {"generated": check_generated, "layouts": lambda: check_layouts(work), "python": lambda: check_python(library, work),
     "csharp": lambda: check_csharp(library, work), "javascript": lambda: check_javascript(work)}[name]()
    return 0


if __name__ == "__main__":
    sys.exit(main())
