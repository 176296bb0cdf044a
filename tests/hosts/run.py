#!/usr/bin/env python3
"""Installs the library of a build, and builds and runs this folder's hosts against it and nothing else.

usage: tests/hosts/run.py BUILD WORK     BUILD: a build with BUILD_SHARED_LIBS; WORK: a folder of its own, emptied first
Exit status 0: all hosts run; pkg-config builds the C host; add_subdirectory and FetchContent configure without the tests' dependencies; the
shared library exports exactly the functions of symbols.txt; programs of the release before get what earlier.py says.
"""
import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

from earlier import Broken, check_earlier_release

HERE = Path(__file__).resolve().parent
SOURCE = HERE.parent.parent
HOSTS = ["c99", "no_exceptions", "misuse", "misuse_physics", "allocators", "streaming"]

OPTIONAL_HOSTS = {"bullet_host": "Bullet in double precision", "ode_host": "Open Dynamics Engine (libode-dev)"}


def run(*command, **options) -> str:
    done = subprocess.run([str(word) for word in command], text=True, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, **options)
    if done.returncode != 0:
        print(" ".join(map(str, command)), done.stdout, sep="\n", file=sys.stderr)
        raise SystemExit(1)
    return done.stdout


def exported(library: Path) -> list[str]:
    lines = run("nm", "-D", "--defined-only", library).splitlines()
    return sorted(line.split()[-1].split("@")[0] for line in lines)


def declared(include: Path) -> list[str]:
    text = "".join(header.read_text(encoding="utf-8") for header in (include / "handhold").glob("*.h"))
    return sorted(set(re.findall(r"^HH_API [^;(]*?\b(hh_\w+)\(", text, re.MULTILINE)))


def check_symbols(prefix: Path) -> None:
    library = next(prefix.rglob("libhandhold.so"))
    listed = (HERE / "symbols.txt").read_text(encoding="utf-8").split()
    for name, found in (("exported", exported(library)), ("declared", declared(prefix / "include"))):
        if found != listed:
            print(f"functions {name}, against symbols.txt: {sorted(set(found) ^ set(listed))}", file=sys.stderr)
            raise SystemExit(1)
    soname = re.search(r"SONAME.*\[(.*)\]", run("readelf", "-d", library))
    if soname is None or not re.fullmatch(r"libhandhold\.so\.\d+\.\d+", soname[1]):
        print(f"no versioned SONAME: {soname}", file=sys.stderr)
        raise SystemExit(1)


def check_pkg_config(prefix: Path, work: Path) -> None:
    folder = next(prefix.rglob("pkgconfig"))
    environment = dict(os.environ, PKG_CONFIG_PATH=str(folder))
    flags = run("pkg-config", "--cflags", "--libs", "handhold", env=environment).split()
    program = work / "with_pkg_config"
    run("cc", "-std=c99", HERE.parent / "samples" / "hello_hand_c.c", *flags, "-lm", f"-Wl,-rpath,{folder.parent}", "-o", program)
    run(program)


SUBPROJECT = """cmake_minimum_required(VERSION 3.25)
project(embedder LANGUAGES C CXX)
set(CMAKE_DISABLE_FIND_PACKAGE_GTest ON)
set(CMAKE_DISABLE_FIND_PACKAGE_rapidcheck ON)
set(CMAKE_DISABLE_FIND_PACKAGE_benchmark ON)
set(CMAKE_DISABLE_FIND_PACKAGE_CLI11 ON)
{how}
add_executable(host host.c)
target_link_libraries(host PRIVATE handhold::handhold)
"""
WAYS = {
    "add_subdirectory": "add_subdirectory({source} handhold)",
    "FetchContent": "include(FetchContent)\nFetchContent_Declare(handhold SOURCE_DIR {source})\nFetchContent_MakeAvailable(handhold)",
}


def check_subprojects(work: Path) -> None:
    for name, how in WAYS.items():
        folder = work / name
        folder.mkdir(parents=True)
        (folder / "host.c").write_text("int main(void) { return 0; }\n", encoding="utf-8")
        (folder / "CMakeLists.txt").write_text(SUBPROJECT.format(how=how.format(source=SOURCE)), encoding="utf-8")
        run("cmake", "-S", folder, "-B", folder / "build")


def main() -> int:
    if len(sys.argv) != 3:
        print(__doc__, file=sys.stderr)
        return 2
    build, work = Path(sys.argv[1]).resolve(), Path(sys.argv[2]).resolve()
    shutil.rmtree(work, ignore_errors=True)
    prefix = work / "prefix"
    for component in ("runtime", "dev"):
        run("cmake", "--install", build, "--prefix", prefix, "--component", component)
    check_symbols(prefix)
    run("cmake", "-S", HERE, "-B", work / "build", f"-DCMAKE_PREFIX_PATH={prefix}", "-DCMAKE_BUILD_TYPE=Release")
    run("cmake", "--build", work / "build")
    for host in HOSTS:
        print(f"{host}: {run(work / 'build' / host).strip().splitlines()[-1]}")
    for host, what in OPTIONAL_HOSTS.items():
        program = work / "build" / host
        print(f"{host}: {run(program).strip() if program.exists() else f'skipped, {what} is missing'}")
    check_pkg_config(prefix, work)
    check_subprojects(work)
    try:
        print("\n".join(f"release 0.1: {line}" for line in check_earlier_release(prefix, work)))
    except Broken as error:
        print(error, file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
