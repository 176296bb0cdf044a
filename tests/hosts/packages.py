#!/usr/bin/env python3
"""Tries the library's packages in clean folders, as their users would.

usage: tests/hosts/packages.py BUILD WORK [--full]     BUILD: a build with BUILD_SHARED_LIBS; WORK: a folder of its own, emptied first
- cpack -G DEB: the library's packages, unpacked into a root of their own; the C and C++ samples build against it by pkg-config and find_package.
- FetchContent with a URL, from an archive of the sources.
- The vcpkg port: its manifest names what the build looks for. (Building it needs vcpkg, which is not used here.)
--full also builds the library by FetchContent and by the preset `library`, without ccache, and prints the times. Some minutes.
Exit status 0: all are as they should be.
"""
import json
import os
import re
import shutil
import subprocess
import sys
import tarfile
import time
from pathlib import Path

HERE = Path(__file__).resolve().parent
SOURCE = HERE.parent.parent
SAMPLES = HERE.parent / "samples"
NOT_SOURCES = {"build", "out", ".git", "__pycache__"}

CONSUMER = f"""cmake_minimum_required(VERSION 3.25)
project(consumer LANGUAGES C CXX)
find_package(handhold 0.2 REQUIRED)
add_executable(consumer {SAMPLES}/your_own_physics.cpp)
target_compile_features(consumer PRIVATE cxx_std_20)
target_link_libraries(consumer PRIVATE handhold::handhold)
"""
FETCHER = """cmake_minimum_required(VERSION 3.25)
project(fetcher LANGUAGES C CXX)
set(CMAKE_DISABLE_FIND_PACKAGE_GTest ON)
set(CMAKE_DISABLE_FIND_PACKAGE_rapidcheck ON)
set(CMAKE_DISABLE_FIND_PACKAGE_CLI11 ON)
include(FetchContent)
FetchContent_Declare(handhold URL file://{archive})
FetchContent_MakeAvailable(handhold)
add_executable(fetcher {samples}/hello_hand_c.c)
target_link_libraries(fetcher PRIVATE handhold::handhold m)
"""


def run(*command, **options) -> str:
    done = subprocess.run([str(word) for word in command], text=True, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, **options)
    if done.returncode != 0:
        print(" ".join(map(str, command)), done.stdout, sep="\n", file=sys.stderr)
        raise SystemExit(1)
    return done.stdout


def write_project(folder: Path, text: str) -> Path:
    folder.mkdir(parents=True)
    (folder / "CMakeLists.txt").write_text(text, encoding="utf-8")
    return folder


def check_debian(build: Path, work: Path) -> None:
    debs, root = work / "debs", work / "root"
    run("cpack", "-G", "DEB", "--config", build / "CPackConfig.cmake", "-B", debs, "-D", "CPACK_COMPONENTS_ALL=runtime;dev")
    packages = sorted(debs.glob("*.deb"))
    names = sorted(package.name.split("_")[0] for package in packages)
    if names[0] != "libhandhold-dev" or not re.fullmatch(r"libhandhold\d+\.\d+", names[1]) or len(names) != 2:
        raise SystemExit(f"packages: {names}")
    for package in packages:
        run("dpkg", "-x", package, root)
        fields = run("dpkg-deb", "-f", package, "Package", "Depends").strip().replace("\n", "; ")
        print(f"deb: {fields}")
    library = next((root / "usr").rglob("libhandhold.so.*")).parent
    environment = dict(os.environ, LD_LIBRARY_PATH=str(library), PKG_CONFIG_PATH=str(library / "pkgconfig"))
    flags = run("pkg-config", "--cflags", "--libs", "handhold", env=environment).split()
    if any(path in flag and str(root) not in flag for flag in flags for path in ("/tmp", str(SOURCE))):
        raise SystemExit(f"pkg-config gives paths outside of the package: {flags}")
    program = work / "by_pkg_config"
    run("cc", "-std=c99", SAMPLES / "hello_hand_c.c", *flags, "-lm", "-o", program)
    run(program, env=environment)
    consumer = write_project(work / "consumer", CONSUMER)
    # The shared library needs no other package to build against.
    absent = [f"-DCMAKE_DISABLE_FIND_PACKAGE_{name}=ON" for name in ("Eigen3", "PkgConfig", "box2d", "meshoptimizer", "TBB", "nlohmann_json")]
    run("cmake", "-S", consumer, "-B", consumer / "build", f"-DCMAKE_PREFIX_PATH={root / 'usr'}", "-DCMAKE_BUILD_TYPE=Release", *absent)
    run("cmake", "--build", consumer / "build")
    print(f"deb: {run(consumer / 'build' / 'consumer', env=environment).strip()}")


def check_fetch_content(work: Path, builds: bool) -> None:
    archive = work / "handhold.tar.gz"
    with tarfile.open(archive, "w:gz", compresslevel=1) as tar:
        for path in sorted(SOURCE.iterdir()):
            if path.name not in NOT_SOURCES:
                tar.add(path, f"handhold/{path.name}", filter=lambda info: None if "__pycache__" in info.name else info)
    folder = write_project(work / "fetcher", FETCHER.format(archive=archive, samples=SAMPLES))
    run("cmake", "-S", folder, "-B", folder / "build", "-G", "Ninja", "-DCMAKE_BUILD_TYPE=Release")
    if builds:
        seconds = timed_build("cmake", "--build", folder / "build", "-j2")
        run(folder / "build" / "fetcher")
        print(f"FetchContent: library and sample built in {seconds}")
    print("FetchContent: configured from a file URL")


def timed_build(*command) -> str:
    before = os.times()
    begin = time.monotonic()
    run(*command, env=dict(os.environ, CCACHE_DISABLE="1"))
    wall_s = time.monotonic() - begin
    after = os.times()
    cpu_s = after.children_user + after.children_system - before.children_user - before.children_system
    return f"{wall_s:.0f} s ({cpu_s:.0f} s of processor time)"


def check_vcpkg() -> None:
    port = SOURCE / "packaging" / "vcpkg" / "handhold"
    manifest = json.loads((port / "vcpkg.json").read_text(encoding="utf-8"))
    ports = {item if isinstance(item, str) else item["name"] for item in manifest["dependencies"]}
    text = (SOURCE / "tools" / "cmake" / "runtime_dependencies.cmake").read_text(encoding="utf-8")
    port_of = {"Eigen3": "eigen3", "Bullet": "bullet3", "box2d": "box2d", "meshoptimizer": "meshoptimizer", "TBB": "tbb",
               "nlohmann_json": "nlohmann-json", "PkgConfig": None, "draco": None}  # the last: a tool; optional, and off in the port
    wanted = set(re.findall(r"find_package\((\w+)", text))
    missing = {name for name in wanted if port_of.get(name, name) is not None and port_of.get(name, name) not in ports}
    version = re.search(r'HANDHOLD_VERSION_TEXT "([^"]+)"', (SOURCE / "systems/host/include/handhold/version.h").read_text(encoding="utf-8"))
    if missing or version is None or version[1] != manifest["version"]:
        raise SystemExit(f"vcpkg.json: version {manifest['version']}, missing {sorted(missing)}")
    for option in re.findall(r"-D(\w+)=", (port / "portfile.cmake").read_text(encoding="utf-8")):
        if option not in (SOURCE / "CMakeLists.txt").read_text(encoding="utf-8") + text:
            raise SystemExit(f"portfile.cmake sets {option}, which the build does not know")
    print("vcpkg: the manifest names every dependency; building it needs vcpkg")


def main() -> int:
    arguments = [argument for argument in sys.argv[1:] if argument != "--full"]
    is_full = "--full" in sys.argv
    if len(arguments) != 2:
        print(__doc__, file=sys.stderr)
        return 2
    build, work = Path(arguments[0]).resolve(), Path(arguments[1]).resolve()
    shutil.rmtree(work, ignore_errors=True)
    work.mkdir(parents=True)
    check_vcpkg()
    check_fetch_content(work, is_full)
    check_debian(build, work)
    if is_full:
        library = work / "library"
        run("cmake", "--preset", "library", "-B", library, cwd=SOURCE)
        print(f"preset library: built in {timed_build('cmake', '--build', library, '-j2')}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
