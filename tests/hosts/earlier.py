"""Promises to programs of the release before, tried with frozen sources of it (release_0_1/).

- By version: a library with another minor version refuses `find_package(handhold 0.1)` and names its own version; its SONAME differs, so a
  program that was linked with 0.1 does not start with it.
- Compiled again without asking for a version, a program of the C interface that fills structs by their default functions does the same as before, or
  does not compile. It never compiles and then fails. A guide page says what to change.
- Columns and stages are stable between no two versions. The release's first sample, grip_a_wall.cpp, needs what COLUMN_EDITS says.

hello_hand_c.c is the first sample of the C interface, which carried version 0.1.0 before structs could grow.
"""
import re
import subprocess
from pathlib import Path

FROZEN = Path(__file__).resolve().parent / "release_0_1"
PAGE = Path(__file__).resolve().parents[2] / "docs/guide/from_0_1_to_0_2.md"
COLUMN_EDITS = [("#include <handhold/handhold.hpp>", "#include <handhold/ecs.hpp>")]  # 0.1.0's header for columns is called ecs.hpp now


class Broken(Exception):
    pass


def attempt(*command) -> tuple[bool, str]:
    done = subprocess.run([str(word) for word in command], text=True, stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
    return done.returncode == 0, done.stdout


def installed_version(prefix: Path) -> str:
    return re.search(r'HANDHOLD_VERSION_TEXT "([^"]+)"', (prefix / "include/handhold/version.h").read_text(encoding="utf-8"))[1]


def configure(prefix: Path, build: Path, wanted: str, programs: Path) -> tuple[bool, str]:
    return attempt("cmake", "-S", FROZEN, "-B", build, f"-DCMAKE_PREFIX_PATH={prefix}", f"-DWANTED={wanted}",
                   f"-DPROGRAM_FOLDER={programs}", "-DCMAKE_BUILD_TYPE=Release")


def check_version(prefix: Path, work: Path) -> str:
    version = installed_version(prefix)
    release = ".".join(version.split(".")[:2])
    is_found, text = configure(prefix, work / "asks_for_0_1", "0.1", FROZEN)
    if is_found != (release == "0.1"):
        raise Broken(f"find_package(handhold 0.1) {'accepts' if is_found else 'refuses'} {version}:\n{text}")
    if not is_found and f"version: {version}" not in text:
        raise Broken(f"find_package(handhold 0.1) does not name {version}:\n{text}")
    if not is_found and not PAGE.is_file():
        raise Broken(f"no page {PAGE}")
    library = next(prefix.rglob("libhandhold.so"))
    soname = re.search(r"SONAME.*\[(.*)\]", attempt("readelf", "-d", library)[1])
    if soname is None or soname[1] != f"libhandhold.so.{release}":
        raise Broken(f"SONAME {soname and soname[1]} of version {version}")
    return f"find_package(handhold 0.1) {'takes' if is_found else 'refuses'} {version}"


def check_program(build: Path, name: str, must_compile: bool) -> str:
    is_built, text = attempt("cmake", "--build", build, "--target", name)
    if not is_built:
        if must_compile or "error" not in text:
            raise Broken(f"{name} of release 0.1 does not compile:\n{text}")
        return f"{name} does not compile"
    does_run, text = attempt(build / name)
    if not does_run:
        raise Broken(f"{name} of release 0.1 compiles and then fails:\n{text}")
    return f"{name}: {text.strip()}"


def edited_columns(work: Path) -> Path:
    folder = work / "edited"
    folder.mkdir(parents=True)
    text = (FROZEN / "grip_a_wall.cpp").read_text(encoding="utf-8")
    for before, after in COLUMN_EDITS:
        if before not in text:
            raise Broken(f"grip_a_wall.cpp has no {before}")
        text = text.replace(before, after)
    (folder / "grip_a_wall.cpp").write_text(text, encoding="utf-8")
    return folder


def check_earlier_release(prefix: Path, work: Path) -> list[str]:
    """One line for each promise. Raises Broken."""
    work = work / "release_0_1"
    lines = [check_version(prefix, work)]
    build = work / "build"
    is_configured, text = configure(prefix, build, "", edited_columns(work))
    if not is_configured:
        raise Broken(text)
    lines.append(check_program(build, "hello_hand_c", must_compile=False))
    lines.append(check_program(build, "grip_a_wall", must_compile=True))
    return lines
