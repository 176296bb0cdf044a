#!/usr/bin/env python3
"""Checks that every C++ sample in the documents is compiled code. Prints `file:line: what is wrong` for each breach.

A page names the region of a program that its fence shows:

    <!-- sample: tests/samples/hello_hand.cpp#grip -->
    ```cpp
    hands.grip(wall);
    ```

The program, which the build compiles and ctest runs, marks that region with the same comment before and after it (in C: /* [grip] */):

    // [grip]
    hands.grip(wall);
    // [grip]

- Every ```cpp fence of a *.md file follows such a line. Its text equals the region's, without common indentation and without markers of
  inner regions.
- The program is in tests/samples/, and marks the region exactly once.

usage: tools/check_samples.py [--fix] [ROOT]      exit status 0: none, 1: some
--fix copies the regions into the pages.
"""
import re
import sys
import textwrap
from pathlib import Path
from typing import NamedTuple

NOT_OURS = {"build", "out", ".git"}
SAMPLE = re.compile(r"<!-- sample: (\S+)#([\w-]+) -->")
MARKER = re.compile(r"\s*(?://|/\*) \[([\w-]+)\](?: \*/)?\s*")
FENCE = re.compile(r"(`{3,})\s*(\w*).*")
CPP = {"cpp", "c", "cc", "cxx", "hpp"}


class Fence(NamedTuple):
    begin: int  # index of the opening line
    end: int  # of the closing one
    language: str


class BadSample(Exception):
    pass


def fences_of(lines: list[str]) -> list[Fence]:
    fences = []
    opening = None
    for number, line in enumerate(lines):
        match = FENCE.fullmatch(line)
        if match and opening is None:
            opening = (number, match[1], match[2])
        elif opening and line.rstrip() == opening[1]:
            fences.append(Fence(opening[0], number, opening[2]))
            opening = None
    return fences


def region_of(root: Path, file: str, name: str) -> list[str]:
    """The lines that a page must show. Raises BadSample."""
    if not re.fullmatch(r"tests/samples/[\w-]+\.(cpp|c)", file):
        raise BadSample(f"{file} is not a program in tests/samples/")
    if not (root / file).is_file():
        raise BadSample(f"{file} does not exist")
    lines = (root / file).read_text(encoding="utf-8").split("\n")
    marked = [number for number, line in enumerate(lines) if (match := MARKER.fullmatch(line)) and match[1] == name]
    if len(marked) != 2:
        raise BadSample(f"{file} has {len(marked)} lines `// [{name}]`, expected 2")
    region = [line for line in lines[marked[0] + 1:marked[1]] if not MARKER.fullmatch(line)]
    return textwrap.dedent("\n".join(region)).strip("\n").split("\n")


def first_difference(shown: list[str], region: list[str]) -> tuple[int, str]:
    """Index of the first line of `shown` that differs from the region, and the region's line there."""
    for number, line in enumerate(region):
        if number >= len(shown) or shown[number] != line:
            return number, f"`{line}`"
    return len(region), "the end of the region"


def check_page(root: Path, page: Path, fix: bool) -> list[str]:
    lines = page.read_text(encoding="utf-8").split("\n")
    file = page.relative_to(root).as_posix()
    breaches = []
    fixed = list(lines)
    fences = fences_of(lines)
    for fence in reversed(fences):  # in reverse, so a fix does not move the lines before it
        sample = SAMPLE.fullmatch(lines[fence.begin - 1].rstrip()) if fence.begin > 0 else None
        if sample is None:
            if fence.language in CPP:
                breaches.append(f"{file}:{fence.begin + 1}: a C++ fence without a line `<!-- sample: FILE#REGION -->` before it")
            continue
        shown = lines[fence.begin + 1:fence.end]
        try:
            region = region_of(root, sample[1], sample[2])
        except BadSample as error:
            breaches.append(f"{file}:{fence.begin}: {error}")
            continue
        if shown == region:
            continue
        fixed[fence.begin + 1:fence.end] = region
        if not fix:
            number, expected = first_difference(shown, region)
            breaches.append(f"{file}:{fence.begin + 2 + number}: not as in {sample[1]}#{sample[2]}, which has {expected}")
    after_sample = {fence.begin - 1 for fence in fences}
    within = {number for fence in fences for number in range(fence.begin, fence.end + 1)}
    for number, line in enumerate(lines):
        if line.startswith("<!-- sample:") and number not in within and (number not in after_sample or not SAMPLE.fullmatch(line.rstrip())):
            breaches.append(f"{file}:{number + 1}: expected `<!-- sample: FILE#REGION -->` directly before a fence")
    if fix and fixed != lines:
        page.write_text("\n".join(fixed), encoding="utf-8")
    return breaches


def check_tree(root: Path, fix: bool = False) -> list[str]:
    breaches = []
    for page in sorted(root.rglob("*.md")):
        if page.relative_to(root).parts[0] not in NOT_OURS:
            breaches.extend(check_page(root, page, fix))
    return sorted(breaches)


def main(arguments: list[str]) -> int:
    fix = "--fix" in arguments
    folders = [argument for argument in arguments if argument != "--fix"]
    root = Path(folders[0]) if folders else Path(__file__).resolve().parent.parent
    if not (root / "README.md").is_file():
        print(f"check_samples: {root}: no README.md here", file=sys.stderr)
        return 1
    breaches = check_tree(root, fix)
    for breach in breaches:
        print(breach)
    return 1 if breaches else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
