#!/usr/bin/env python3
"""Checks that the documents name what exists. Prints `file:line: what is missing` for each breach.

- Relative links and pictures of every *.md file resolve, their #anchors too.
- docs/talk_map.md and docs/frame.md: every `folder/file` in backticks exists, every `Suite.Test` is a test.

usage: tools/check_docs.py [ROOT]      exit status 0: none, 1: some
"""
import re
import sys
from pathlib import Path
from typing import Iterator

CODE_FOLDERS = ("engine", "components", "systems", "game", "tests", "tools", "docs")
MAPS = ("docs/talk_map.md", "docs/frame.md")
NOT_OURS = {"build", "out", ".git"}

LINK = re.compile(r"!?\[[^\]]*\]\(([^)\s]+)\)")
INLINE_CODE = re.compile(r"`([^`]+)`")
FENCE = re.compile(r"^```.*?^```", re.DOTALL | re.MULTILINE)
HEADING = re.compile(r"^#+\s+(.*?)\s*$", re.MULTILINE)
REPOSITORY_PATH = re.compile(rf"(?:{'|'.join(CODE_FOLDERS)})/[\w./-]+")
TEST_NAME = re.compile(r"[A-Z]\w*\.[A-Z]\w*")
TEST_DEFINITION = re.compile(r"\b(?:TEST|TEST_F|TEST_P|RC_GTEST_PROP|RC_GTEST_FIXTURE_PROP)\(\s*(\w+),\s*(\w+)")


def without_fences(text: str) -> str:
    return FENCE.sub(lambda m: "\n" * m[0].count("\n"), text)


def anchors_of(text: str) -> set[str]:
    """As GitHub makes them of headings."""
    anchors = set()
    for heading in HEADING.findall(without_fences(text)):
        kept = re.sub(r"[^\w\- ]", "", heading.lower())
        anchors.add(kept.replace(" ", "-"))
    return anchors


def link_breaches(document: Path, line: str) -> Iterator[str]:
    for target in LINK.findall(INLINE_CODE.sub("", line)):
        if re.match(r"[a-z]+:", target):
            continue  # of the web: not ours to check, and a check must not need the network
        path, _, anchor = target.partition("#")
        file = document.parent / path if path else document
        if not file.exists():
            yield f"link to {path}, which does not exist"
        elif anchor and anchor not in anchors_of(file.read_text(encoding="utf-8")):
            yield f"link to {target}: no such heading"


def name_breaches(root: Path, tests: set[str], line: str) -> Iterator[str]:
    for name in INLINE_CODE.findall(line):
        if REPOSITORY_PATH.fullmatch(name) and not (root / name).exists():
            yield f"{name} does not exist"
        elif TEST_NAME.fullmatch(name) and name not in tests:
            yield f"no test is called {name}"


def tests_of(root: Path) -> set[str]:
    tests = set()
    for file in (root / "tests").rglob("*.cpp"):
        tests.update(f"{suite}.{name}" for suite, name in TEST_DEFINITION.findall(file.read_text(encoding="utf-8")))
    return tests


def check_tree(root: Path) -> list[str]:
    breaches = []
    tests = tests_of(root)
    for document in sorted(root.rglob("*.md")):
        file = document.relative_to(root)
        if file.parts[0] in NOT_OURS:
            continue
        lines = without_fences(document.read_text(encoding="utf-8")).split("\n")
        for number, line in enumerate(lines, start=1):
            found = list(link_breaches(document, line))
            if file.as_posix() in MAPS:
                found.extend(name_breaches(root, tests, line))
            breaches.extend(f"{file.as_posix()}:{number}: {what}" for what in found)
    return breaches


def main(arguments: list[str]) -> int:
    root = Path(arguments[0]) if arguments else Path(__file__).resolve().parent.parent
    if not (root / "README.md").is_file():
        print(f"check_docs: {root}: no README.md here", file=sys.stderr)
        return 1
    breaches = check_tree(root)
    for breach in breaches:
        print(breach)
    return 1 if breaches else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
