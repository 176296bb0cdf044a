#!/usr/bin/env python3
"""Checks that the documents name existing files and tests. Prints `file:line: what is missing` for each breach.

- Relative links, pictures and #anchors of every *.md file resolve.
- docs/talk_map.md, docs/reference/stages.md and docs/guide/: every `folder/file` in backticks exists, every `Suite.Test` is a test.
- docs/guide/: `name` in [file](path) names something in that file. A tuning number in backticks, such as `hand.reach_m`, and a counter after the
  word "counter" or "counters" are strings of components/.
- docs/decisions/: every page starts with `# number. title` and a status, is short, and is in the index with both. A status names later
  pages that exist.

usage: tools/check_docs.py [ROOT]      exit status 0: none, 1: some
"""
import re
import sys
from pathlib import Path
from typing import Iterator

CODE_FOLDERS = ("engine", "components", "systems", "game", "tests", "tools", "docs")
GUIDE = "docs/guide/"
MAPS = ("docs/talk_map.md", "docs/reference/stages.md")
NOT_OURS = {"build", "out", ".git"}
DECISIONS = "docs/decisions"
DECISION_LINES = 15
DECISION_COLUMNS = 100

LINK = re.compile(r"!?\[[^\]]*\]\(([^)\s]+)\)")
INLINE_CODE = re.compile(r"`([^`]+)`")
FENCE = re.compile(r"^```.*?^```", re.DOTALL | re.MULTILINE)
HEADING = re.compile(r"^#+\s+(.*?)\s*$", re.MULTILINE)
REPOSITORY_PATH = re.compile(rf"(?:{'|'.join(CODE_FOLDERS)})/[\w./-]+")
DECISION_FILE = re.compile(r"(\d{4})-[a-z0-9-]+\.md")
DECISION_TITLE = re.compile(r"# (\d+)\. (.+)")
DECISION_STATUS = re.compile(r"Status: (accepted|(?:superseded|amended) by (\d+(?:, \d+)*))")
NAMED_IN_FILE = re.compile(r"((?:`\w+`(?:, | and ))*`\w+`) in \[[^\]]*\]\(([^)\s#]+)\)")
TUNING_NAME = re.compile(r"([a-z]+)\.[a-z_0-9]+")
COUNTERS = re.compile(r"\b[Cc]ounters? ((?:`\w+`(?: \([^)]*\))?(?:, | and )?)+)")
STRING = re.compile(r'"([\w.]+)"')
TEST_NAME = re.compile(r"[A-Z]\w*\.[A-Z]\w*")
TEST_DEFINITION = re.compile(r"\b(?:TEST|TEST_F|TEST_P|RC_GTEST_PROP|RC_GTEST_FIXTURE_PROP)\(\s*(\w+),\s*(\w+)")


def without_fences(text: str) -> str:
    return FENCE.sub(lambda m: "\n" * m[0].count("\n"), text)


def anchors_of(text: str) -> set[str]:
    """The anchors that GitHub generates for headings."""
    anchors = set()
    for heading in HEADING.findall(without_fences(text)):
        kept = re.sub(r"[^\w\- ]", "", heading.lower())
        anchors.add(kept.replace(" ", "-"))
    return anchors


def link_breaches(document: Path, line: str) -> Iterator[str]:
    for target in LINK.findall(INLINE_CODE.sub("", line)):
        if re.match(r"[a-z]+:", target):
            continue  # web links are not checked, since a check must not need the network
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


def guide_breaches(document: Path, strings: set[str], line: str) -> Iterator[str]:
    for names, path in NAMED_IN_FILE.findall(line):
        file = document.parent / path
        text = file.read_text(encoding="utf-8") if file.is_file() else ""
        for name in INLINE_CODE.findall(names):
            if not re.search(rf"\b{name}\b", text):
                yield f"{path} has no {name}"
    groups = {name.partition(".")[0] for name in strings if "." in name}
    for name in INLINE_CODE.findall(line):
        tuning = TUNING_NAME.fullmatch(name)
        if tuning and tuning[1] in groups and name not in strings and not re.fullmatch(r"\w+\.(cpp|hpp|h|csv|json)", name):
            yield f"no tuning number is called {name}"
    for listed in COUNTERS.finditer(line):
        for name in INLINE_CODE.findall(listed[1]):
            if not name.startswith("_") and name not in strings:
                yield f"no counter is called {name}"


def decision_page_breaches(page: Path, numbers: set[int], index_rows: set[str]) -> Iterator[tuple[int, str]]:
    """Pairs of line number and breach."""
    number = int(page.name[:4])
    lines = page.read_text(encoding="utf-8").splitlines()
    if len(lines) > DECISION_LINES:
        yield DECISION_LINES + 1, f"more than {DECISION_LINES} lines"
    for at, line in enumerate(lines, start=1):
        if len(line) > DECISION_COLUMNS:
            yield at, f"more than {DECISION_COLUMNS} characters"
    title = DECISION_TITLE.fullmatch(lines[0]) if lines else None
    status = DECISION_STATUS.fullmatch(lines[1]) if len(lines) > 1 else None
    if title is None or int(title[1]) != number:
        yield 1, f"the first line is not `# {number}. title`"
        return
    if status is None:
        yield 2, "no line `Status: accepted`, `Status: superseded by N` or `Status: amended by N`"
        return
    for named in map(int, re.findall(r"\d+", status[2] or "")):
        if named not in numbers:
            yield 2, f"decision {named} does not exist"
        elif named <= number:
            yield 2, f"decision {named} is not later than this one"
    row = f"| [{number}]({page.name}) | {title[2]} | {status[1]} |"
    if row not in index_rows:
        yield 1, f"{DECISIONS}/README.md has no row {row}"


def decision_breaches(root: Path) -> list[str]:
    folder = root / DECISIONS
    index = folder / "README.md"
    index_rows = set(index.read_text(encoding="utf-8").splitlines()) if index.is_file() else set()
    documents = sorted(file for file in folder.glob("*.md") if file != index)
    pages = [file for file in documents if DECISION_FILE.fullmatch(file.name)]
    numbers = [int(page.name[:4]) for page in pages]
    breaches = [f"{DECISIONS}/{file.name}:1: not called NNNN-short-title.md" for file in documents if file not in pages]
    for page, number in zip(pages, numbers):
        if numbers.count(number) > 1:
            breaches.append(f"{DECISIONS}/{page.name}:1: another page has number {number}")
        found = decision_page_breaches(page, set(numbers), index_rows)
        breaches.extend(f"{DECISIONS}/{page.name}:{at}: {what}" for at, what in found)
    return breaches


def tests_of(root: Path) -> set[str]:
    tests = set()
    for file in (root / "tests").rglob("*.cpp"):
        tests.update(f"{suite}.{name}" for suite, name in TEST_DEFINITION.findall(file.read_text(encoding="utf-8")))
    return tests


def strings_of(root: Path) -> set[str]:
    """String literals of components/: names of tuning numbers, stages and fallbacks; and names of StageStats' members."""
    strings = set()
    for file in [*(root / "components").rglob("*.hpp"), *(root / "components").rglob("*.cpp")]:
        text = file.read_text(encoding="utf-8")
        strings.update(STRING.findall(text))
        if file.name == "stats.hpp":
            strings.update(re.findall(r"\b(\w+) = 0", text))
    return strings


def check_tree(root: Path) -> list[str]:
    breaches = []
    tests = tests_of(root)
    strings = strings_of(root)
    for document in sorted(root.rglob("*.md")):
        file = document.relative_to(root)
        if file.parts[0] in NOT_OURS:
            continue
        lines = without_fences(document.read_text(encoding="utf-8")).split("\n")
        for number, line in enumerate(lines, start=1):
            found = list(link_breaches(document, line))
            if file.as_posix() in MAPS or file.as_posix().startswith(GUIDE):
                found.extend(name_breaches(root, tests, line))
            if file.as_posix().startswith(GUIDE):
                found.extend(guide_breaches(document, strings, line))
            breaches.extend(f"{file.as_posix()}:{number}: {what}" for what in found)
    return breaches + decision_breaches(root)


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
