#!/usr/bin/env python3
"""Runs clang-tidy (.clang-tidy, every finding an error) over the product's sources. Files that were clean and have not changed since,
headers included, are skipped: their marks lie in the build folder. Tests are held to warnings and format only: GoogleTest's macros
would double the time and add no finding.

The compile commands come from build/tidy, which is configured without precompiled headers: clang-tidy cannot read GCC's.

usage: tools/check_tidy.py [FILE...]      default: every source; exit status 0: clean, 1: not
"""
import hashlib
import json
import os
import shlex
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
BUILD = ROOT / "build" / "tidy"
FOLDERS = {"engine", "components", "systems", "game", "tools"}


def sources_of(build: Path, wanted: set[Path]) -> list[dict]:
    """The entries of the compile database that are ours and, if any are named, wanted."""
    entries = json.loads((build / "compile_commands.json").read_text(encoding="utf-8"))
    ours = []
    for entry in entries:
        file = Path(entry["file"])
        is_ours = file.is_relative_to(ROOT) and file.relative_to(ROOT).parts[0] in FOLDERS
        if is_ours and (not wanted or file in wanted):
            ours.append(entry)
    return ours


def fingerprint(entry: dict) -> str:
    """Of all that a finding can depend on: the source with its headers as the compiler sees them, and the rules."""
    command = shlex.split(entry["command"])
    command[:] = [word for word in command if Path(word).name != "ccache"]
    without_output = command[:command.index("-o")] + command[command.index("-o") + 2:]
    preprocessed = subprocess.run([word for word in without_output if word != "-c"] + ["-E"], cwd=entry["directory"],
                                  capture_output=True, check=True).stdout
    # Comments hold NOLINT, so the source itself counts too; a NOLINT in a header comes with a change of its own.
    parts = [preprocessed, Path(entry["file"]).read_bytes(), (ROOT / ".clang-tidy").read_bytes()]
    return hashlib.sha256(b"\0".join(parts)).hexdigest()


def tidy(entry: dict) -> str:
    """The findings in one source and its headers; empty where it is clean."""
    mark = BUILD / "clean" / fingerprint(entry)
    if mark.exists():
        return ""
    run = subprocess.run(["clang-tidy", "--quiet", "--extra-arg=-Wno-unknown-warning-option", "-p", str(BUILD), entry["file"]],
                         capture_output=True, text=True)
    if run.returncode == 0:
        mark.touch()
        return ""
    return run.stdout or run.stderr


def main(arguments: list[str]) -> int:
    subprocess.run(["cmake", "--preset", "release", "-B", str(BUILD), "-DHANDHOLD_PRECOMPILE=OFF", "-DHANDHOLD_BUILD_TESTS=OFF"],
                   cwd=ROOT, stdout=subprocess.DEVNULL, check=True)
    (BUILD / "clean").mkdir(exist_ok=True)
    entries = sources_of(BUILD, {Path(name).resolve() for name in arguments})
    if not entries:
        print(f"check_tidy: no source of ours in {BUILD}/compile_commands.json", file=sys.stderr)
        return 1
    with ThreadPoolExecutor(os.cpu_count()) as workers:
        findings = [found for found in workers.map(tidy, entries) if found]
    print("".join(findings), end="")
    print(f"check_tidy: {len(entries)} sources, {len(findings)} with findings")
    return 1 if findings else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
