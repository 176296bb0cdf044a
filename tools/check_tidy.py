#!/usr/bin/env python3
"""Runs clang-tidy (.clang-tidy, every finding an error) over the product's sources. Tests are checked by warnings and format only:
GoogleTest's macros would double the time and add no finding.

Parsing headers takes nearly all of clang-tidy's time, so sources are checked together as one joint source. Joint sources that were clean
and are unchanged, including their headers, are skipped: their marks are in the user's cache folder.

The compile commands come from build/tidy, which is configured without precompiled headers, because clang-tidy cannot read GCC's.

usage: tools/check_tidy.py [FILE...]      default: every source; a named file is checked alone; exit status 0: clean, 1: not
"""
import hashlib
import json
import os
import shlex
import subprocess
import sys
from collections import defaultdict
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
BUILD = ROOT / "build" / "tidy"
MARKS = Path(os.environ.get("XDG_CACHE_HOME", Path.home() / ".cache")) / "handhold" / "tidy"
FOLDERS = ("engine", "components", "systems", "game", "tools")
MOST_TOGETHER = 24


@dataclass(frozen=True)
class Joint:
    """Sources of one folder with the same compile flags, checked as one source."""
    flags: tuple[str, ...]
    sources: tuple[Path, ...]

    def text(self) -> str:
        return "".join(f'#include "{source}"  // NOLINT\n' for source in self.sources)

    def file(self) -> Path:
        """The source that includes them all; a single source is its own file."""
        if len(self.sources) == 1:
            return self.sources[0]
        name = hashlib.sha256(self.text().encode()).hexdigest()[:16]
        return BUILD / "joint" / f"{name}.cpp"

    def halves(self) -> list["Joint"]:
        middle = len(self.sources) // 2
        return [Joint(self.flags, self.sources[:middle]), Joint(self.flags, self.sources[middle:])]


def flags_of(command: str) -> tuple[str, ...]:
    """The flags of a compile command, without compiler, launcher, source and output."""
    words = shlex.split(command)
    compiler = next(place for place, word in enumerate(words) if Path(word).name in ("g++", "c++"))
    output = words.index("-o")
    return tuple(words[compiler + 1:output] + words[output + 2:words.index("-c")])


def sources_of(wanted: set[Path]) -> dict[tuple[str, ...], list[Path]]:
    """Our sources by compile flags, each once; only the wanted ones if any are named."""
    found = defaultdict(list)
    seen = set()
    for entry in json.loads((BUILD / "compile_commands.json").read_text(encoding="utf-8")):
        file = Path(entry["file"])
        is_ours = file.is_relative_to(ROOT) and file.relative_to(ROOT).parts[0] in FOLDERS
        if is_ours and file not in seen and (not wanted or file in wanted):
            seen.add(file)
            found[flags_of(entry["command"])].append(file)
    return found


def joints_of(sources: dict[tuple[str, ...], list[Path]], most: int) -> list[Joint]:
    joints = []
    for flags, files in sources.items():
        files.sort()
        joints += [Joint(flags, tuple(files[first:first + most])) for first in range(0, len(files), most)]
    return joints


def fingerprint(joint: Joint) -> str:
    """Hash of everything that a finding can depend on: the preprocessed sources with headers and comments (NOLINT), and the rules.
    Independent of the folder's path."""
    preprocessed = subprocess.run(["clang++", *joint.flags, "-w", "-E", "-P", "-C", str(joint.file())], cwd=BUILD, capture_output=True,
                                  check=True).stdout
    parts = [preprocessed.replace(os.fsencode(ROOT), b""), (ROOT / ".clang-tidy").read_bytes()]
    return hashlib.sha256(b"\0".join(parts)).hexdigest()


def tidy(joint: Joint) -> list[str]:
    """The findings in the sources and their headers; empty if clean. A joint source with findings is checked again in halves: names of two
    sources may clash, or one source's overload may take another's arguments. What only sources together have is no finding."""
    if len(joint.sources) > 1:
        joint.file().write_text(joint.text(), encoding="utf-8")
    mark = MARKS / fingerprint(joint)
    if mark.exists():
        mark.touch()
        return []
    run = subprocess.run(["clang-tidy", "--quiet", f"--config-file={ROOT / '.clang-tidy'}",
                          f"--header-filter=^{ROOT}/({'|'.join(FOLDERS)})/.*[.][hc]pp$", str(joint.file()), "--", *joint.flags,
                          "-w"], cwd=BUILD, capture_output=True, text=True)
    if run.returncode == 0:
        mark.touch()
        return []
    if len(joint.sources) > 1:
        return [finding for half in joint.halves() for finding in tidy(half)]
    return [run.stdout or run.stderr]


def main(arguments: list[str]) -> int:
    subprocess.run(["cmake", "--preset", "release", "-B", str(BUILD), "-DHANDHOLD_PRECOMPILE=OFF", "-DCMAKE_UNITY_BUILD=OFF",
                    "-DHANDHOLD_BUILD_TESTS=OFF"],
                   cwd=ROOT, stdout=subprocess.DEVNULL, check=True)
    (BUILD / "joint").mkdir(exist_ok=True)
    MARKS.mkdir(parents=True, exist_ok=True)
    wanted = {Path(name).resolve() for name in arguments}
    joints = joints_of(sources_of(wanted), 1 if wanted else MOST_TOGETHER)
    if not joints:
        print(f"check_tidy: no source of ours in {BUILD}/compile_commands.json", file=sys.stderr)
        return 1
    with ThreadPoolExecutor(os.cpu_count()) as workers:
        findings = [finding for found in workers.map(tidy, joints) for finding in found]
    print("".join(findings), end="")
    print(f"check_tidy: {sum(len(joint.sources) for joint in joints)} sources, {len(findings)} runs with findings")
    return 1 if findings else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
